//! The figures of a report, each with the table of its numbers.

mod axes;
mod band;
mod course;
mod distrust;
mod gather;
mod groups;
mod metrics;
mod regret;
mod sensitivity;

use experiments::Failure;
use experiments::comparison::Comparison;
use experiments::sweep::folder::Folder;

use crate::drawing::{Figure, Sketch};

pub use distrust::distrust_map;
pub use regret::regret_figures;
pub(crate) use sensitivity::sensitivity;

/// Which part of a case is drawn.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Part<'a> {
    /// The case, from 0.
    pub case: usize,
    /// Labels of the only policies to draw; `None` for all.
    pub only: Option<&'a [String]>,
    /// Seed of the trial whose first round is drawn; `None` for the first trial.
    pub seed: Option<u64>,
}

/// Figures along the axes of a sweep: a map of the differences over two axes, and metrics along each.
pub(crate) fn along_axes(folder: &Folder, comparisons: &[Comparison]) -> Result<Vec<Figure>, Failure> {
    let maps = axes::difference_maps(folder.experiment(), comparisons)?;
    Ok(drawn(maps.into_iter().chain(axes::axes(folder, 0, None)?).collect()))
}

/// The figures that have something to draw.
fn drawn(sketches: Vec<Sketch>) -> Vec<Figure> {
    sketches.into_iter().filter(|sketch| !sketch.drawing.is_empty()).map(Sketch::drawn).collect()
}

/// All figures of a sweep's case for which there is something to draw.
pub(crate) fn figures(
    folder: &mut Folder,
    part: Part,
    comparisons: &[&Comparison],
) -> Result<Vec<Figure>, Failure> {
    sketches(folder, part, comparisons).map(drawn)
}

/// All figures of a sweep's case, before they are drawn.
pub(crate) fn sketches(
    folder: &mut Folder,
    part: Part,
    comparisons: &[&Comparison],
) -> Result<Vec<Sketch>, Failure> {
    let Part { case, only, seed } = part;
    let gathered = gather::gather(folder, case, seed)?;
    let experiment = folder.experiment();
    let mut figures = metrics::boxes(folder, case, only)?;
    figures.push(metrics::costs(folder, case, only)?);
    if !comparisons.is_empty() {
        figures.push(metrics::forest(experiment, comparisons)?);
    }
    if experiment.keep.has_records() {
        figures.push(course::over_time(experiment, &gathered, part)?);
        figures.push(course::membership(experiment, &gathered, part)?);
        figures.push(course::levels(experiment, &gathered, part)?);
        figures.push(groups::sorting(experiment, &gathered, only)?);
        figures.extend(groups::trust(experiment, &gathered)?);
    }
    Ok(figures)
}

/// The figures of a sweep along its axes, before they are drawn.
pub(crate) fn sketches_along_axes(folder: &Folder, part: Part) -> Result<Vec<Sketch>, Failure> {
    axes::axes(folder, part.case, part.only)
}

/// Whether a metric has values in a case, and all of them are zero.
pub(crate) fn is_quiet(folder: &Folder, case: usize, metric: usize) -> bool {
    let policies = 0..folder.experiment().policies.len();
    let mut values = policies.flat_map(|policy| folder.values(case, policy, metric)).peekable();
    values.peek().is_some() && values.all(|value| value == 0.0)
}
