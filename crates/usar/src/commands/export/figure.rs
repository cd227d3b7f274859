//! `usar export figure`: draws one figure of a sweep for the column of a paper.

use experiments::comparison::Asked;
use experiments::sweep::folder::Folder;
use pictures::{Picture, Width};
use reports::{ColumnLook, Wanted, column_figure};

use crate::arguments::{
    CaseArgument, ComparisonArguments, MeasureArgument, PictureArguments, PictureFile, width,
};
use crate::input::read_sweep;
use crate::prelude::*;

/// Draw one figure of a sweep for the column of a paper, as PDF, SVG or PNG
#[derive(Debug, Args)]
#[command(after_help = "\
The names are those of the report's figures: rescuees, differences, rescuees-over-time, energy-per-rescuee, \
costs, groups, levels, sorting; a wrong name lists those of the sweep. A column is \
88mm wide unless --width says otherwise. With --metric, its panel alone is drawn; for `differences`, it says \
which metrics are compared. Panels stand side by side as long as they can be read, and --height says how \
high the figure is; no text is smaller than 7 points. A PDF has its font embedded. --grey takes the \
colours away: policies still differ by their dashes and their places.

Examples:
  usar export figure results/paper rescuees --width 88mm --metric rescuees.total
  usar export figure results/paper differences --width 180mm --out differences.svg
  usar export figure results/paper rescuees-over-time --policies RNE,DIS --grey --out fig3.pdf")]
pub(crate) struct Arguments {
    /// Folder of a sweep
    folder: PathBuf,
    /// Name of the figure
    name: String,
    #[command(flatten)]
    comparison: ComparisonArguments,
    #[command(flatten)]
    case: CaseArgument,
    #[command(flatten)]
    picture: PictureArguments,
    /// Height of the figure [default: that of its panels]
    #[arg(long, value_parser = width, value_name = "HEIGHT")]
    height: Option<Width>,
    /// Without colours
    #[arg(long)]
    grey: bool,
    /// File or folder to write [default: NAME.pdf]
    #[arg(long, value_name = "FILE.pdf|svg|png")]
    out: Option<PathBuf>,
    #[command(flatten)]
    measure: MeasureArgument,
}

/// Name of the figure that is made from comparisons.
const DIFFERENCES: &str = "differences";

/// A length on paper.
fn millimetres(option: &str, length: Option<Width>) -> Result<Option<f64>, Failure> {
    match length {
        None => Ok(None),
        Some(Width::Millimetres(length)) => Ok(Some(length)),
        Some(Width::Pixels(_)) => Err(Failure::input(format!(
            "{option}: a figure is drawn for paper: must be 20mm to 1000mm, as in `88mm`"
        ))),
    }
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let registry = &self.measure.chosen_in(registry)?;
        let mut folder = read_sweep(&self.folder, registry)?;
        let case = self.case.index(folder.experiment())?;
        let path = self.out.clone().unwrap_or_else(|| format!("{}.pdf", self.name).into());
        let file = PictureFile::of(&path, &["pdf", "svg", "png"], self.picture.replace)?;
        let wanted = self.wanted(&folder, case)?;
        let look = ColumnLook {
            width_mm: millimetres("--width", self.picture.width)?.unwrap_or(88.0),
            height_mm: millimetres("--height", self.height)?,
            is_grey: self.grey,
            metric: self.panel(&folder)?,
        };
        let svg = column_figure(&mut folder, &self.name, &wanted, &look)?;
        file.write(&Picture::of_svg(svg, f64::from(self.picture.dpi.unwrap_or(600))))?;
        Ok(writeln!(out, "{}", path.display())?)
    }

    fn wanted(&self, folder: &Folder, case: usize) -> Result<Wanted, Failure> {
        let asked = Asked::of(folder.experiment(), &self.comparison.wishes())?;
        let labels: Vec<&str> =
            folder.experiment().policies.iter().map(|policy| policy.label.as_str()).collect();
        let unknown = asked.policies.iter().flatten().find(|label| !labels.contains(&label.as_str()));
        if let Some(label) = unknown {
            refuse!("--policies: must be policies of the sweep ({}), found {label:?}", labels.join(", "));
        }
        Ok(Wanted { asked, title: None, case: Some(case), shown: Vec::new() })
    }

    /// The full name of the metric whose panel is drawn alone; `None` for all panels.
    fn panel(&self, folder: &Folder) -> Result<Option<String>, Failure> {
        match &self.comparison.metric[..] {
            _ if self.name == DIFFERENCES => Ok(None),
            [] => Ok(None),
            [only] => {
                let metrics = &folder.experiment().metrics;
                Ok(Some(metrics[metrics.named(only)?].name.clone()))
            }
            _ => Err(Failure::input("--metric: can be given several times for `differences` only")),
        }
    }
}
