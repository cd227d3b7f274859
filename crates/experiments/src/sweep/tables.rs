//! The tables of a finished sweep.

use std::path::Path;

use super::line::Finished;
use super::links::{self, LinkRow};
use super::rows::{
    RobotRow, RoundRow, group_columns, group_rows, series_columns, series_rows, trial_columns, trial_row,
};
use super::table::{Rows, Table, before, columns};
use crate::experiment::{Experiment, Keep, Shard};
use crate::failure::Failure;
use crate::files::FileHash;

/// The table that every folder has.
pub(super) const TRIALS: &str = "trials.csv";

/// Names of the tables, from the tables that every sweep keeps to those that take the most room.
pub(super) const TABLES: [&str; 6] =
    [TRIALS, "rounds.csv", "robots.csv", "groups.csv", "series.csv", links::FILE];

/// The names of the tables that a sweep has for this `keep`. A shard has only the first; the others are
/// made when the shards are merged.
pub(super) fn tables_of(keep: Keep, shard: Option<Shard>) -> &'static [&'static str] {
    let count = match keep {
        Keep::Trials => 1,
        _ if shard.is_some() => 1,
        Keep::Rounds => 2,
        Keep::Robots => 3,
        Keep::Groups => 6,
    };
    &TABLES[..count]
}

/// The columns of each table, in the order of [`TABLES`], without the case and the axes.
pub(super) fn all_columns(experiment: &Experiment) -> Result<[Vec<String>; TABLES.len()], Failure> {
    Ok([
        trial_columns(&experiment.metrics),
        columns::<RoundRow>()?,
        columns::<RobotRow>()?,
        group_columns(&experiment.base.needs),
        series_columns(&experiment.metrics),
        columns::<LinkRow>()?,
    ])
}

/// The tables while they are written.
pub(super) struct Tables(Vec<Table>);

impl Tables {
    pub(super) fn new(
        path: &Path,
        experiment: &Experiment,
        keep: Keep,
        shard: Option<Shard>,
    ) -> Result<Self, Failure> {
        let all = all_columns(experiment)?;
        let names = tables_of(keep, shard).iter();
        let tables = names.zip(&all).map(|(name, columns)| Table::new(path, name, experiment, columns));
        Ok(Self(tables.collect::<Result<_, _>>()?))
    }

    /// The rows of these trials, for the first `count` tables.
    pub(super) fn rows<'a>(
        count: usize,
        trials: impl Iterator<Item = &'a Finished>,
        experiment: &Experiment,
    ) -> Result<TableRows, Failure> {
        let mut rows = TableRows((0..count).map(|_| Rows::new()).collect());
        for finished in trials {
            rows.add(finished, experiment)?;
        }
        Ok(rows)
    }

    /// Number of tables.
    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    pub(super) fn append(&mut self, rows: TableRows) -> Result<(), Failure> {
        self.0.iter_mut().zip(rows.0).try_for_each(|(table, rows)| table.append(rows))
    }

    pub(super) fn finish(self) -> Result<Vec<FileHash>, Failure> {
        self.0.into_iter().map(Table::finish).collect()
    }
}

/// Rows of each table, in memory.
pub(super) struct TableRows(Vec<Rows>);

impl TableRows {
    fn add(&mut self, finished: &Finished, experiment: &Experiment) -> Result<(), Failure> {
        let key = &finished.key;
        let before = before(experiment, key.case);
        let mut tables = self.0.iter_mut();
        let Some(trials) = tables.next() else { return Ok(()) };
        trials.add_texts(&before, trial_row(finished, experiment))?;
        let Some(trial) = finished.trial() else { return Ok(()) };
        let Some(rounds) = tables.next() else { return Ok(()) };
        RoundRow::of(key, &trial.record).try_for_each(|row| rounds.add(&before, &row))?;
        let Some(robots) = tables.next() else { return Ok(()) };
        RobotRow::of(key, &trial.record).try_for_each(|row| robots.add(&before, &row))?;
        let Some(groups) = tables.next() else { return Ok(()) };
        group_rows(key, &trial.record).try_for_each(|row| groups.add_texts(&before, row))?;
        let duration_s = experiment.cases[key.case].scenario.duration_s;
        let Some(series) = tables.next() else { return Ok(()) };
        series_rows(key, trial, duration_s).try_for_each(|row| series.add_texts(&before, row))?;
        let Some(hashes) = tables.next() else { return Ok(()) };
        LinkRow::of(key, &trial.record).try_for_each(|row| hashes.add(&before, &row))
    }
}
