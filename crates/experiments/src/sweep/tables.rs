//! The tables of a finished sweep.

use std::path::Path;

use store::Failure;
use store::files::{FileHash, NewFile};
use tables::{About, Columns, Csv, abouts};

use super::line::Finished;
use super::rows::{self, TrialRow};
use crate::experiment::{Experiment, Keep, Shard};

/// The table that every folder has.
pub(super) const TRIALS: &str = "trials.csv";

/// The tables, from those that every sweep keeps to those that take the most room: each with its file, the
/// file of the same table as Parquet, and what a row is.
pub(super) const TABLES: [[&str; 3]; 7] = [
    [TRIALS, "trials.parquet", "a trial"],
    ["rounds.csv", "rounds.parquet", "a task's group in a round of a trial"],
    ["robots.csv", "robots.parquet", "a robot in a trial"],
    [
        "groups.csv",
        "groups.parquet",
        "a robot when it was grouped, in a round of a trial, with its needs as they really were",
    ],
    ["series.csv", "series.parquet", "a moment of a trial, every ten seconds"],
    ["hashes.csv", "hashes.parquet", "a link of a trial's hash chain"],
    [
        "links.csv",
        "links.parquet",
        "a link over the medium in a trial, from a robot to the base or to a group-mate",
    ],
];

/// The names of the tables that a sweep has for this `keep`. A shard has only the first; the others are
/// made when the shards are merged.
pub(super) fn tables_of(keep: Keep, shard: Option<Shard>) -> impl ExactSizeIterator<Item = &'static str> {
    let count = match keep {
        Keep::Trials => 1,
        _ if shard.is_some() => 1,
        Keep::Rounds => 2,
        Keep::Robots => 3,
        Keep::Groups => 7,
    };
    TABLES.into_iter().take(count).map(|[csv, ..]| csv)
}

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
    let own = [
        abouts(rows::trials(&experiment.metrics)),
        abouts(rows::rounds()),
        abouts(rows::robots()),
        abouts(rows::groups(&experiment.base.needs)),
        abouts(rows::series(&experiment.metrics)),
        abouts(rows::links()),
        abouts(rows::radio()),
    ];
    let mut own = own.into_iter();
    TABLES.map(|[csv, parquet, row_is]| {
        let columns = rows::before(&experiment.axes).into_iter().chain(own.next().into_iter().flatten());
        Described { csv, parquet, row_is, columns: columns.collect() }
    })
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
        let trial = std::iter::once(TrialRow::of(finished, experiment));
        add(tables.next(), &before, &rows::trials(&experiment.metrics), trial)?;
        let Some(trial) = finished.trial() else { return Ok(()) };
        let (record, duration_s) = (&trial.record, experiment.cases[key.case].scenario.duration_s);
        let rounds = record.rounds.iter().map(|round| (record, round));
        add(tables.next(), &before, &rows::rounds(), rows::of(key, rounds))?;
        add(tables.next(), &before, &rows::robots(), rows::of(key, &record.robots))?;
        let groups = rows::groups(&experiment.base.needs);
        add(tables.next(), &before, &groups, rows::of(key, rows::grouped(record)))?;
        let series = rows::series(&experiment.metrics);
        add(tables.next(), &before, &series, rows::of(key, rows::delivered(trial, duration_s)))?;
        add(tables.next(), &before, &rows::links(), rows::of(key, record.chain.links()))?;
        let heard = record.heard.iter().flat_map(|heard| &heard.links).filter(|link| link.sent > 0);
        add(tables.next(), &before, &rows::radio(), rows::of(key, heard))
    }
}

/// Adds rows to a table, if the sweep has it.
fn add<R>(
    table: Option<&mut Csv<Vec<u8>>>,
    before: &[String],
    columns: &Columns<R>,
    rows: impl Iterator<Item = R>,
) -> Result<(), Failure> {
    Ok(table.map_or(Ok(()), |table| table.add(before, columns, rows))?)
}
