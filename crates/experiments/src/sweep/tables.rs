//! The tables of a finished sweep.

use std::path::Path;

use store::Failure;
use store::files::{FileHash, NewFile};
use tables::{About, Csv, abouts};

use super::line::Finished;
use super::links;
use super::rows::{self, TrialRow};
use crate::experiment::{Experiment, Keep, Shard};

/// The table that every folder has.
pub(super) const TRIALS: &str = "trials.csv";

/// Names of the tables, from the tables that every sweep keeps to those that take the most room.
pub(super) const TABLES: [&str; 7] =
    [TRIALS, "rounds.csv", "robots.csv", "groups.csv", "series.csv", links::FILE, "links.csv"];

/// The same tables as Parquet files, in the order of the tables.
pub(super) const PARQUETS: [&str; TABLES.len()] = [
    "trials.parquet",
    "rounds.parquet",
    "robots.parquet",
    "groups.parquet",
    "series.parquet",
    "hashes.parquet",
    "links.parquet",
];

/// The names of the tables that a sweep has for this `keep`. A shard has only the first; the others are
/// made when the shards are merged.
pub(super) fn tables_of(keep: Keep, shard: Option<Shard>) -> &'static [&'static str] {
    let count = match keep {
        Keep::Trials => 1,
        _ if shard.is_some() => 1,
        Keep::Rounds => 2,
        Keep::Robots => 3,
        Keep::Groups => 7,
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
    "a link over the medium in a trial, from a robot to the base or to a group-mate",
];

/// A table of a sweep's folder.
pub struct Described {
    /// Its file.
    pub csv: &'static str,
    /// The file of the same table as Parquet.
    pub parquet: &'static str,
    /// What a row is.
    pub row_is: &'static str,
    /// Its columns.
    pub columns: Vec<About>,
}

/// The tables that a sweep may have, from those that every sweep keeps to those that take the most room.
pub fn described(experiment: &Experiment) -> [Described; TABLES.len()] {
    let of = |place: usize, own: Vec<About>| Described {
        csv: TABLES[place],
        parquet: PARQUETS[place],
        row_is: A_ROW_IS[place],
        columns: rows::before(&experiment.axes).into_iter().chain(own).collect(),
    };
    [
        of(0, abouts(rows::trials(&experiment.metrics))),
        of(1, abouts(rows::rounds())),
        of(2, abouts(rows::robots())),
        of(3, abouts(rows::groups(&experiment.base.needs))),
        of(4, abouts(rows::series(&experiment.metrics))),
        of(5, abouts(rows::links())),
        of(6, abouts(rows::radio())),
    ]
}

/// The cells before a table's own columns in the rows of a case: its number from 1 and the values of the
/// axes; empty without axes.
fn before(experiment: &Experiment, case: usize) -> Vec<String> {
    let values = &experiment.cases[case].values;
    let number = (!values.is_empty()).then(|| (case + 1).to_string());
    number.into_iter().chain(values.iter().cloned()).collect()
}

/// The tables while they are written.
pub(super) struct Tables(Vec<NewFile>);

impl Tables {
    pub(super) fn new(
        path: &Path,
        experiment: &Experiment,
        keep: Keep,
        shard: Option<Shard>,
    ) -> Result<Self, Failure> {
        let begin = |table: &Described| {
            let mut names = Csv::new(NewFile::new(path, table.csv)?);
            names.add_names(&table.columns)?;
            Ok(names.finish()?)
        };
        let count = tables_of(keep, shard).len();
        Ok(Self(described(experiment)[..count].iter().map(begin).collect::<Result<_, Failure>>()?))
    }

    /// The rows of these trials, for the first `count` tables.
    pub(super) fn rows<'a>(
        count: usize,
        trials: impl Iterator<Item = &'a Finished>,
        experiment: &Experiment,
    ) -> Result<TableRows, Failure> {
        let mut rows = TableRows((0..count).map(|_| Csv::new(Vec::new())).collect());
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
        self.0.iter_mut().zip(rows.0).try_for_each(|(table, rows)| table.append(&rows.finish()?))
    }

    pub(super) fn finish(self) -> Result<Vec<FileHash>, Failure> {
        self.0.into_iter().map(NewFile::finish).collect()
    }
}

/// Rows of each table, in memory.
pub(super) struct TableRows(Vec<Csv<Vec<u8>>>);

impl TableRows {
    fn add(&mut self, finished: &Finished, experiment: &Experiment) -> Result<(), Failure> {
        let key = &finished.key;
        let before = before(experiment, key.case);
        let mut tables = self.0.iter_mut();
        let Some(trials) = tables.next() else { return Ok(()) };
        let row = std::iter::once(TrialRow::of(finished, experiment));
        trials.add(&before, &rows::trials(&experiment.metrics), row)?;
        let Some(trial) = finished.trial() else { return Ok(()) };
        let Some(rounds) = tables.next() else { return Ok(()) };
        rounds.add(&before, &rows::rounds(), rows::round_rows(key, &trial.record))?;
        let Some(robots) = tables.next() else { return Ok(()) };
        robots.add(&before, &rows::robots(), rows::robot_rows(key, &trial.record))?;
        let Some(groups) = tables.next() else { return Ok(()) };
        let needs = &experiment.base.needs;
        groups.add(&before, &rows::groups(needs), rows::group_rows(key, &trial.record))?;
        let duration_s = experiment.cases[key.case].scenario.duration_s;
        let Some(series) = tables.next() else { return Ok(()) };
        let columns = rows::series(&experiment.metrics);
        series.add(&before, &columns, rows::series_rows(key, trial, duration_s))?;
        let Some(hashes) = tables.next() else { return Ok(()) };
        hashes.add(&before, &rows::links(), rows::link_rows(key, &trial.record))?;
        let Some(radio) = tables.next() else { return Ok(()) };
        Ok(radio.add(&before, &rows::radio(), rows::radio_rows(key, &trial.record))?)
    }
}
