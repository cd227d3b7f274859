//! The tables that a finished sweep has.

use std::collections::BTreeMap;
use std::path::Path;

use super::file::FileHash;
use super::folder::Measured;
use super::journal::Place;
use super::links::{self, LinkRow};
use super::rows::{GroupRow, RobotRow, RoundRow, SeriesRow, TrialRow};
use super::table::{Table, columns};
use super::trial::Outcome;
use crate::experiment::Experiment;
use crate::failure::Failure;
use crate::metric::METRICS;

/// Every metric of every trial.
pub(super) const METRICS_FILE: &str = "metrics.csv";
/// The others.
pub(super) const TABLES: [&str; 6] =
    ["trials.csv", "rounds.csv", "groups.csv", "robots.csv", "series.csv", links::FILE];

/// The tables on their way; of a lean sweep the first two only.
pub(super) struct Tables {
    trials: Table,
    rounds: Table,
    large: Option<Large>,
}

/// The tables that a lean sweep leaves out.
struct Large {
    groups: Table,
    robots: Table,
    series: Table,
    hashes: Table,
}

/// The names of the columns of `trials.csv`.
pub(crate) fn trial_columns() -> Vec<String> {
    columns::<TrialRow>().unwrap_or_default()
}

impl Tables {
    pub(super) fn new(path: &Path, experiment: &Experiment) -> Result<Self, Failure> {
        let axes: Vec<String> = experiment.axes.iter().map(|axis| axis.path.clone()).collect();
        let table = |place: usize| Table::new(path, TABLES[place], axes.clone());
        let large = || {
            Ok::<_, Failure>(Large {
                groups: table(2)?,
                robots: table(3)?,
                series: table(4)?,
                hashes: table(5)?,
            })
        };
        let large = if experiment.is_lean { None } else { Some(large()?) };
        Ok(Self { trials: table(0)?, rounds: table(1)?, large })
    }

    pub(super) fn add(&mut self, outcome: &Outcome, experiment: &Experiment) -> Result<(), Failure> {
        let number = outcome.key.case;
        let case = (number, experiment.cases[number].values.as_slice());
        self.trials.add(case, &TrialRow::new(outcome, experiment))?;
        RoundRow::of(outcome).try_for_each(|row| self.rounds.add(case, &row))?;
        let Some(large) = &mut self.large else { return Ok(()) };
        let duration_s = experiment.cases[number].scenario.duration_s;
        GroupRow::of(outcome).try_for_each(|row| large.groups.add(case, &row))?;
        RobotRow::of(outcome).try_for_each(|row| large.robots.add(case, &row))?;
        SeriesRow::of(outcome, duration_s).try_for_each(|row| large.series.add(case, &row))?;
        LinkRow::of(outcome).try_for_each(|row| large.hashes.add(case, &row))
    }

    pub(super) fn finish(self) -> Result<Vec<FileHash>, Failure> {
        let mut files =
            vec![self.trials.finish(&columns::<TrialRow>()?)?, self.rounds.finish(&columns::<RoundRow>()?)?];
        if let Some(large) = self.large {
            files.push(large.groups.finish(&columns::<GroupRow>()?)?);
            files.push(large.robots.finish(&columns::<RobotRow>()?)?);
            files.push(large.series.finish(&columns::<SeriesRow>()?)?);
            files.push(large.hashes.finish(&columns::<LinkRow>()?)?);
        }
        Ok(files)
    }
}

/// `metrics.csv`: every metric of every trial that has numbers.
pub(super) fn metrics_table(
    path: &Path,
    experiment: &Experiment,
    results: &BTreeMap<Place, Measured>,
) -> Result<FileHash, Failure> {
    let axes = experiment.axes.iter().map(|axis| axis.path.clone()).collect();
    let mut table = Table::new(path, METRICS_FILE, axes)?;
    let header: Vec<&str> =
        ["policy", "trial", "seed"].into_iter().chain(METRICS.iter().map(|metric| metric.name)).collect();
    for ((case, policy, trial), measured) in results {
        let Some(metrics) = &measured.metrics else { continue };
        let key = experiment.key((*case, *policy, *trial));
        let cell = |value: &Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let row =
            [key.label, trial.to_string(), key.seed.to_string()].into_iter().chain(metrics.iter().map(cell));
        let row: Vec<String> = row.collect();
        let values = &experiment.cases[*case].values;
        table.add_record((*case, values), &header, row.iter().map(String::as_str))?;
    }
    table.finish(&header)
}
