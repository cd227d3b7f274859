//! The values of a trial that comparisons need, and reading them from `trials.csv`.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use store::{Failure, files, refuse};
use usar_sim::fit::is_result;
use usar_sim::record::TrialRecord;

use super::line::Finished;
use super::rows::{FIRST_METRIC, trial_columns};
use super::summary::{Summary, status_of};
use crate::experiment::{Experiment, Place, Shard};
use crate::metric::{Catalogue, Values};
use crate::run::{Fault, FaultKind, Outcome, TrialKey};

/// Results of trials, by place.
pub type Results = BTreeMap<Place, Measured>;

/// The values of a trial that comparisons need.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Its status in one word.
    pub status: &'static str,
    /// Values of all metrics, in the order of the experiment's catalogue; `None` for a trial without numbers.
    pub metrics: Option<Values>,
    /// Hash of its last state; 0 for a trial without numbers.
    pub hash: u128,
    /// Why it has no values.
    pub failure: Option<Box<str>>,
}

impl Measured {
    /// The values of an outcome.
    pub fn of(outcome: &Outcome, metrics: &Catalogue) -> Self {
        let failed = || Self {
            status: outcome.status(),
            metrics: None,
            hash: 0,
            failure: outcome.failure().map(Into::into),
        };
        outcome.record().map_or_else(failed, |record| Self::of_record(record, metrics))
    }

    /// The values of a trial that ran to its end.
    pub fn of_record(record: &TrialRecord, metrics: &Catalogue) -> Self {
        let values = Some(metrics.measure(record).into_iter().collect());
        let hash = number_of(&record.state_hash);
        Self { status: record.status.name(), metrics: values, hash, failure: None }
    }

    pub(super) fn of_finished(finished: &Finished, experiment: &Experiment) -> Self {
        match finished.summary(experiment) {
            Ok(summary) => Self::ended(summary),
            Err(fault) => Self::failed(&finished.key, &fault),
        }
    }

    fn ended(summary: Summary) -> Self {
        let hash = number_of(&summary.state_hash);
        let metrics = Some(summary.metrics.into_iter().collect());
        Self { status: status_of(&summary.status).unwrap_or_default(), metrics, hash, failure: None }
    }

    fn failed(key: &TrialKey, fault: &Fault) -> Self {
        Self { status: fault.kind.name(), metrics: None, hash: 0, failure: Some(fault.sentence(key).into()) }
    }

    /// Whether the trial exceeded its time limit.
    pub(super) fn is_late(&self) -> bool {
        self.status == FaultKind::TimedOut.name()
    }
}

/// The results of a finished sweep or shard, from its `trials.csv`.
pub(super) fn read_results(
    table: &Path,
    experiment: &Experiment,
    shard: Option<Shard>,
) -> Result<Results, Failure> {
    let file = files::open(table).map_err(Failure::input)?;
    let mut reader = csv::Reader::from_reader(io::BufReader::with_capacity(1 << 20, file));
    let columns = trial_columns(&experiment.metrics);
    let before = if experiment.axes.is_empty() { 0 } else { 1 + experiment.axes.len() };
    let header = reader.headers().map_err(Failure::input)?;
    if !header.iter().skip(before).eq(columns.iter()) {
        refuse!("does not have the columns of this sweep's trials");
    }
    let mut row = csv::StringRecord::new();
    let mut next = |key: &TrialKey| {
        let is_there = reader.read_record(&mut row).map_err(Failure::input)?;
        let cells: Vec<&str> = row.iter().skip(before).collect();
        if is_there { measured_in(&cells, key, experiment.metrics.len()) } else { None }
            .ok_or_else(|| Failure::input(format!("has no row of trial {} of {}", key.trial, key.label)))
    };
    let places = experiment.places(shard);
    places.map(|place| Ok((place, next(&experiment.key(place))?))).collect()
}

/// The values of a row, if it belongs to this trial.
fn measured_in(cells: &[&str], key: &TrialKey, metrics: usize) -> Option<Measured> {
    let is_of =
        cells[1].parse() == Ok(key.trial) && cells[2] == key.label && cells[3].parse() == Ok(key.seed);
    let status = status_of(cells[4]).filter(|_| is_of)?;
    if let Some(kind) = FaultKind::ALL.into_iter().find(|kind| kind.name() == status) {
        let reason = cells[FIRST_METRIC + metrics + 1].to_owned();
        return Some(Measured::failed(key, &Fault { kind, reason }));
    }
    let value = |cell: &&str| {
        if cell.is_empty() {
            Some(None)
        } else {
            Some(Some(cell.parse().ok().filter(|value| is_result(*value))?))
        }
    };
    let values: Option<Values> = cells[FIRST_METRIC..FIRST_METRIC + metrics].iter().map(value).collect();
    let hash = number_of(cells[FIRST_METRIC + metrics]);
    Some(Measured { status, metrics: Some(values?), hash, failure: None })
}

/// A hash in hexadecimal digits as a number.
fn number_of(hash: &str) -> u128 {
    u128::from_str_radix(hash, 16).unwrap_or_default()
}
