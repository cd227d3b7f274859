//! The figures of a report, each with the table of its numbers.

mod course;
mod gather;
mod groups;
mod metrics;
mod regret;
mod sensitivity;

use experiments::Failure;
use experiments::comparison::Comparison;
use experiments::sweep::folder::Folder;

use crate::drawing::Figure;

pub(crate) use regret::regret;
pub(crate) use sensitivity::sensitivity;

/// Figures of metrics along the axes of a sweep.
pub(crate) fn along_axes(folder: &Folder) -> Result<Vec<Figure>, Failure> {
    let mut figures = metrics::axes(folder, 0)?;
    figures.retain(|figure| !figure.svg.is_empty());
    Ok(figures)
}

/// All figures of a sweep's case for which there is something to draw.
pub(crate) fn figures(
    folder: &mut Folder,
    case: usize,
    comparisons: &[&Comparison],
) -> Result<Vec<Figure>, Failure> {
    let gathered = gather::gather(folder, case)?;
    let experiment = folder.experiment();
    let mut figures = metrics::boxes(folder, case)?;
    figures.push(metrics::costs(folder, case)?);
    if !comparisons.is_empty() {
        figures.push(metrics::forest(experiment, comparisons)?);
    }
    if experiment.keep.has_records() {
        figures.push(course::over_time(experiment, case, &gathered)?);
        figures.push(course::membership(experiment, case, &gathered)?);
        figures.push(course::levels(experiment, case, &gathered)?);
        figures.push(groups::sorting(experiment, &gathered)?);
        figures.extend(groups::trust(experiment, &gathered)?);
    }
    figures.retain(|figure| !figure.svg.is_empty());
    Ok(figures)
}

/// Whether a metric has values in a case, and all of them are zero.
pub(crate) fn is_quiet(folder: &Folder, case: usize, metric: usize) -> bool {
    let policies = 0..folder.experiment().policies.len();
    let mut values = policies.flat_map(|policy| folder.values(case, policy, metric)).peekable();
    values.peek().is_some() && values.all(|value| value == 0.0)
}
