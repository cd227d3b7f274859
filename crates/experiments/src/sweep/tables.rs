//! The tables of a finished sweep.

use std::path::Path;

use store::Failure;
use store::files::FileHash;

use super::column::{About, abouts};
use super::line::Finished;
use super::links;
use super::rows::{self, TrialRow};
use super::table::{Rows, Table, before};
use crate::experiment::{Experiment, Keep, Shard};

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

/// What a row is in each table, in the order of [`TABLES`].
pub(super) const A_ROW_IS: [&str; TABLES.len()] = [
    "a trial",
    "a task's group in a round of a trial",
    "a robot in a trial",
    "a robot when it was grouped, in a round of a trial, with its needs as they really were",
    "a moment of a trial, every ten seconds",
    "a link of a trial's hash chain",
];

/// The columns of each table, in the order of [`TABLES`], without the case and the axes.
pub(super) fn all_columns(experiment: &Experiment) -> [Vec<About>; TABLES.len()] {
    [
        abouts(rows::trials(&experiment.metrics)),
        abouts(rows::rounds()),
        abouts(rows::robots()),
        abouts(rows::groups(&experiment.base.needs)),
        abouts(rows::series(&experiment.metrics)),
        abouts(rows::links()),
    ]
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
        let names = tables_of(keep, shard).iter();
        let tables = names
            .zip(all_columns(experiment))
            .map(|(name, columns)| Table::new(path, name, experiment, columns));
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
        trials.add(&before, &rows::trials(&experiment.metrics), &TrialRow::of(finished, experiment))?;
        let Some(trial) = finished.trial() else { return Ok(()) };
        let Some(rounds) = tables.next() else { return Ok(()) };
        rounds.add_all(&before, &rows::rounds(), rows::round_rows(key, &trial.record))?;
        let Some(robots) = tables.next() else { return Ok(()) };
        robots.add_all(&before, &rows::robots(), rows::robot_rows(key, &trial.record))?;
        let Some(groups) = tables.next() else { return Ok(()) };
        let needs = &experiment.base.needs;
        groups.add_all(&before, &rows::groups(needs), rows::group_rows(key, &trial.record))?;
        let duration_s = experiment.cases[key.case].scenario.duration_s;
        let Some(series) = tables.next() else { return Ok(()) };
        let columns = rows::series(&experiment.metrics);
        series.add_all(&before, &columns, rows::series_rows(key, trial, duration_s))?;
        let Some(hashes) = tables.next() else { return Ok(()) };
        hashes.add_all(&before, &rows::links(), rows::link_rows(key, &trial.record))
    }
}
