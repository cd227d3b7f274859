//! One figure of a sweep for the column of a paper.

use experiments::comparison::Asked;
use experiments::sweep::folder::Folder;
use pictures::{Picture, Width};
use reports::{ColumnLook, Wanted, column_figure};

use super::Arguments;
use crate::input::read_sweep;
use crate::prelude::*;

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
    pub(super) fn draw_figure(&self, registry: &Registry) -> Result<(), Failure> {
        let name = self.figure.as_deref().unwrap_or_default();
        let registry = &self.measure.chosen_in(registry)?;
        let mut folder = read_sweep(&self.file, registry)?;
        let case = self.trial.case.index(folder.experiment())?;
        let file = self.picture_file(&self.to)?;
        let wanted = self.wanted(&folder, case)?;
        let look = ColumnLook {
            width_mm: millimetres("--width", self.look.picture.width)?.unwrap_or(88.0),
            height_mm: millimetres("--height", self.height)?,
            is_grey: self.grey,
            metric: self.panel(name, &folder)?,
        };
        let svg = column_figure(&mut folder, name, &wanted, &look)?;
        file.write(&Picture::of_svg(svg, f64::from(self.look.picture.dpi.unwrap_or(600))))
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
    fn panel(&self, name: &str, folder: &Folder) -> Result<Option<String>, Failure> {
        match &self.comparison.metric[..] {
            _ if name == DIFFERENCES => Ok(None),
            [] => Ok(None),
            [only] => {
                let metrics = &folder.experiment().metrics;
                Ok(Some(metrics[metrics.named(only)?].name.clone()))
            }
            _ => Err(Failure::input("--metric: can be given several times for `differences` only")),
        }
    }
}
