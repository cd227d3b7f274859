//! The tables that a finished sweep has.

use std::path::Path;

use super::links::{self, LinkRow};
use super::rows::{
    RobotRow, RoundRow, group_columns, group_rows, series_columns, series_rows, trial_columns, trial_row,
};
use super::table::{Table, columns};
use crate::experiment::Experiment;
use crate::failure::Failure;
use crate::files::FileHash;
use crate::run::Outcome;

/// Their names.
pub(super) const TABLES: [&str; 6] =
    ["trials.csv", "rounds.csv", "groups.csv", "robots.csv", "series.csv", links::FILE];

/// How many of them a lean sweep has: the first.
pub(super) const LEAN_TABLES: usize = 2;

/// The tables on their way; of a lean sweep the first two only.
pub(super) struct Tables {
    trials: Table,
    trial_columns: Vec<String>,
    rounds: Table,
    large: Option<Large>,
}

/// The tables that a lean sweep leaves out.
struct Large {
    groups: Table,
    group_columns: Vec<String>,
    robots: Table,
    series: Table,
    series_columns: Vec<String>,
    hashes: Table,
}

impl Tables {
    pub(super) fn new(path: &Path, experiment: &Experiment) -> Result<Self, Failure> {
        let axes: Vec<String> = experiment.axes.iter().map(|axis| axis.path.clone()).collect();
        let table = |place: usize| Table::new(path, TABLES[place], axes.clone());
        let large = || {
            Ok::<_, Failure>(Large {
                groups: table(2)?,
                group_columns: group_columns(&experiment.base.needs),
                robots: table(3)?,
                series: table(4)?,
                series_columns: series_columns(&experiment.metrics),
                hashes: table(5)?,
            })
        };
        let large = if experiment.is_lean { None } else { Some(large()?) };
        let trial_columns = trial_columns(&experiment.metrics);
        Ok(Self { trials: table(0)?, trial_columns, rounds: table(1)?, large })
    }

    pub(super) fn add(&mut self, outcome: &Outcome, experiment: &Experiment) -> Result<(), Failure> {
        let number = outcome.key.case;
        let case = (number, experiment.cases[number].values.as_slice());
        self.trials.add_record(case, &self.trial_columns, trial_row(outcome, experiment))?;
        RoundRow::of(outcome).try_for_each(|row| self.rounds.add(case, &row))?;
        let Some(large) = &mut self.large else { return Ok(()) };
        let duration_s = experiment.cases[number].scenario.duration_s;
        for row in group_rows(outcome) {
            large.groups.add_record(case, &large.group_columns, row)?;
        }
        RobotRow::of(outcome).try_for_each(|row| large.robots.add(case, &row))?;
        for row in series_rows(outcome, duration_s) {
            large.series.add_record(case, &large.series_columns, row)?;
        }
        LinkRow::of(outcome).try_for_each(|row| large.hashes.add(case, &row))
    }

    pub(super) fn finish(self) -> Result<Vec<FileHash>, Failure> {
        let mut files =
            vec![self.trials.finish(&self.trial_columns)?, self.rounds.finish(&columns::<RoundRow>()?)?];
        if let Some(large) = self.large {
            files.push(large.groups.finish(&large.group_columns)?);
            files.push(large.robots.finish(&columns::<RobotRow>()?)?);
            files.push(large.series.finish(&large.series_columns)?);
            files.push(large.hashes.finish(&columns::<LinkRow>()?)?);
        }
        Ok(files)
    }
}
