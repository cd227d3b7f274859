//! `usar figure`: draws one figure of a sweep for the column of a paper.

use std::io::Write;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use experiments::Failure;
use experiments::comparison::{Asked, Wishes};
use experiments::experiment::split_list;
use experiments::sweep::folder::Folder;
use pictures::Picture;
use reports::{ColumnLook, Wanted, column_figure};
use rne_core::Registry;

use super::measured_by::MeasureArguments;
use super::{output, read_sweep};
use crate::bad_value::BadValue;

/// Draw one figure of a sweep for the column of a paper, as PDF, SVG or PNG
#[derive(Debug, Args)]
#[command(after_help = "\
The names are those of the report's figures: rescuees, differences, rescuees-over-time, energy-per-rescuee, \
costs, groups, levels, sorting; a wrong name lists those of the sweep. Panels stand below each other where \
the column is narrow, and no text is smaller than 7 points. A PDF has its font embedded. --grey takes the \
colours away: policies still differ by their dashes and their places.

Examples:
  usar figure results/paper rescuees --width 88mm --metric rescuees.total
  usar figure results/paper differences --width 180mm --format svg
  usar figure results/paper rescuees-over-time --policies RNE,DIS --grey --out fig3.pdf")]
pub(crate) struct Arguments {
    /// Folder of a sweep
    folder: PathBuf,
    /// Name of the figure
    name: String,
    /// Width of the column
    #[arg(long, value_name = "MILLIMETRES", default_value = "88mm", value_parser = millimetres)]
    width: f64,
    /// Kind of file
    #[arg(long, value_enum, default_value = "pdf")]
    format: Kind,
    /// The panel of this metric alone; for `differences`, which metrics are compared: can be given several
    /// times
    #[arg(long)]
    metric: Vec<String>,
    /// Draw these policies only, by their labels, separated by commas
    #[arg(long)]
    policies: Option<String>,
    /// Differences with this policy only [default: the one that the sweep file names]
    #[arg(long)]
    baseline: Option<String>,
    /// Case number, if the sweep has axes
    #[arg(long, default_value_t = 1)]
    case: usize,
    /// Without colours
    #[arg(long)]
    grey: bool,
    /// Dots per inch of a PNG
    #[arg(long, default_value_t = 600, value_parser = clap::value_parser!(u16).range(30..=1200))]
    dpi: u16,
    /// The file to write [default: NAME.FORMAT]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Replace the file
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    pub(crate) measure: MeasureArguments,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    Pdf,
    Svg,
    Png,
}

impl Kind {
    fn ending(self) -> &'static str {
        match self {
            Self::Pdf => "pdf",
            Self::Svg => "svg",
            Self::Png => "png",
        }
    }
}

/// Name of the figure that is made from comparisons.
const DIFFERENCES: &str = "differences";

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let mut folder = read_sweep(&self.folder, registry)?;
        let cases = folder.experiment().cases.len();
        if !(1..=cases).contains(&self.case) {
            return Err(Failure::input(format!("--case: must be from 1 to {cases}, found {}", self.case)));
        }
        let path =
            self.out.clone().unwrap_or_else(|| format!("{}.{}", self.name, self.format.ending()).into());
        let (beside, name) = output::place("--out", &path, self.force)?;
        let wanted = self.wanted(&folder)?;
        let look = ColumnLook { width_mm: self.width, is_grey: self.grey, metric: self.panel(&folder)? };
        let svg = column_figure(&mut folder, &self.name, &wanted, &look)?;
        output::write(&beside, name, &self.content(svg)?)?;
        Ok(writeln!(out, "{}", path.display())?)
    }

    fn wanted(&self, folder: &Folder) -> Result<Wanted, Failure> {
        let policies = self.policies.as_deref().map(split_list);
        let wishes = Wishes {
            metrics: self.metric.clone(),
            baseline: self.baseline.clone(),
            policies: policies.map(|labels| labels.into_iter().map(str::to_owned).collect()),
            ..Wishes::default()
        };
        let asked = Asked::of(folder.experiment(), &wishes)?;
        let labels: Vec<&str> =
            folder.experiment().policies.iter().map(|policy| policy.label.as_str()).collect();
        let unknown = asked.policies.iter().flatten().find(|label| !labels.contains(&label.as_str()));
        if let Some(label) = unknown {
            return Err(Failure::input(format!(
                "--policies: must be policies of the sweep ({}), found {label:?}",
                labels.join(", ")
            )));
        }
        Ok(Wanted { asked, title: None, case: Some(self.case - 1), shown: Vec::new() })
    }

    /// The full name of the metric whose panel is drawn alone; `None` for all panels.
    fn panel(&self, folder: &Folder) -> Result<Option<String>, Failure> {
        match &self.metric[..] {
            _ if self.name == DIFFERENCES => Ok(None),
            [] => Ok(None),
            [only] => {
                let metrics = &folder.experiment().metrics;
                Ok(Some(metrics[metrics.named(only)?].name.clone()))
            }
            _ => Err(Failure::input("--metric: can be given several times for `differences` only")),
        }
    }

    fn content(&self, svg: String) -> Result<Vec<u8>, Failure> {
        let picture = Picture::of_svg(svg, f64::from(self.dpi));
        match self.format {
            Kind::Svg => Ok(picture.svg().as_bytes().to_vec()),
            Kind::Png => picture.png().map_err(Failure::input),
            Kind::Pdf => picture.pdf().map_err(Failure::run),
        }
    }
}

/// A width on paper.
fn millimetres(text: &str) -> Result<f64, BadValue> {
    let number = text.strip_suffix("mm").and_then(|number| number.trim().parse::<f64>().ok());
    let wrong = || BadValue::new("20mm to 1000mm, as in `88mm`", text);
    number.filter(|width| (20.0..=1000.0).contains(width)).ok_or_else(wrong)
}
