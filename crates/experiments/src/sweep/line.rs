//! A finished trial as a line of the journal.

use ron_tree::{Problem, without_types};
use serde::{Deserialize, Serialize};
use store::Failure;
use teaming::Account;
use thiserror::Error;

use super::links;
use super::summary::Summary;
use crate::experiment::{Experiment, Keep, Place, Shard};
use crate::run::{Fault, Outcome, Trial, TrialKey};

#[derive(Serialize, Deserialize)]
struct Entry {
    id: String,
    case: usize,
    policy: String,
    trial: u32,
    seed: u64,
    outcome: Stored,
}

#[derive(Serialize, Deserialize)]
enum Stored {
    Ended { trial: Box<Trial>, links: String },
    Measured(Summary),
    Fault(Fault),
}

/// A finished trial, with as much of it as its sweep keeps.
pub(super) struct Finished {
    /// The key of the trial.
    pub key: TrialKey,
    /// The trial's results, or its fault.
    pub result: Result<Kept, Fault>,
}

/// The part of a trial that is kept, if it ran to its end.
pub(super) enum Kept {
    /// Its record.
    Record(Box<Trial>),
    /// Its summary.
    Summary(Summary),
}

/// What is wrong with a line.
#[derive(Debug, Error)]
pub(super) enum LineError {
    #[error("the checksum does not match: the line was changed")]
    Changed,
    #[error("is no trial: {}", without_types(.0))]
    NoTrial(#[from] serde_json::Error),
    #[error("{trial} is not of this sweep")]
    OtherSweep { trial: String },
    #[error("is a trial of other sources of its policy")]
    OtherProgram { place: Place },
    #[error("{trial} {error}")]
    Summary { trial: String, error: Failure },
    #[error("{trial} does not fit its scenario: {problem}")]
    Misfit { trial: String, problem: Box<Problem> },
    #[error("has no hash chain")]
    NoChain,
    #[error("is not its trials in order")]
    OtherPlace,
}

impl Finished {
    /// The place of the trial in its sweep.
    pub fn place(&self) -> Place {
        (self.key.case, self.key.policy, self.key.trial)
    }

    /// The summary of the trial, or its fault.
    pub fn summary(&self, experiment: &Experiment) -> Result<Summary, Fault> {
        match self.result.as_ref().map_err(Clone::clone)? {
            Kept::Record(trial) => Ok(Summary::of(&trial.record, &experiment.metrics)),
            Kept::Summary(summary) => Ok(summary.clone()),
        }
    }

    /// The trial with its record, if that is kept.
    pub fn trial(&self) -> Option<&Trial> {
        match &self.result {
            Ok(Kept::Record(trial)) => Some(trial),
            _ => None,
        }
    }
}

/// The line of a trial.
///
/// # Errors
/// None: a trial can be written to memory.
pub(super) fn line_of(experiment: &Experiment, keep: Keep, outcome: &Outcome) -> Result<Vec<u8>, Failure> {
    let key = &outcome.key;
    let outcome = match &outcome.result {
        Err(fault) => Stored::Fault(fault.clone()),
        Ok(trial) if keep == Keep::Trials => {
            Stored::Measured(Summary::of(&trial.record, &experiment.metrics))
        }
        Ok(trial) => {
            let has_chains = keep.has_chains();
            let links = links::encode(if has_chains { trial.record.chain.links() } else { &[] });
            let mut trial = Box::new(trial.clone());
            if !has_chains {
                let accounts = trial.record.decisions.iter_mut().map(|asked| &mut asked.decision.account);
                let long = accounts.filter(|account| !matches!(account, Account::Protocol(_)));
                long.for_each(|account| *account = Account::None);
            }
            Stored::Ended { links, trial }
        }
    };
    let entry = Entry {
        id: experiment.id(key),
        case: key.case,
        policy: key.label.clone(),
        trial: key.trial,
        seed: key.seed,
        outcome,
    };
    store::checked(&entry)
}

/// The trial of a line; otherwise what is wrong with the line.
pub(super) fn finished_in(line: &[u8], experiment: &Experiment) -> Result<Finished, LineError> {
    finished_of(store::entry_of(line).ok_or(LineError::Changed)?, experiment, None)
}

/// The trial of an entry, if it belongs to the sweep or to a shard of it; otherwise what is wrong with it.
pub(super) fn finished_of(
    entry: &[u8],
    experiment: &Experiment,
    shard: Option<Shard>,
) -> Result<Finished, LineError> {
    let entry: Entry = serde_json::from_slice(entry)?;
    let policy = experiment.policies.iter().position(|policy| policy.label == entry.policy);
    let trial = format!("trial {} of {} (seed {})", entry.trial, entry.policy, entry.seed);
    let policy =
        policy.filter(|policy| experiment.has((entry.case, *policy, entry.trial), entry.seed, shard));
    let Some(policy) = policy else { return Err(LineError::OtherSweep { trial }) };
    let key =
        TrialKey { case: entry.case, policy, trial: entry.trial, seed: entry.seed, label: entry.policy };
    if experiment.id(&key) != entry.id {
        return Err(LineError::OtherProgram { place: (key.case, key.policy, key.trial) });
    }
    let result = match entry.outcome {
        Stored::Fault(fault) => Err(fault),
        Stored::Measured(summary) => {
            summary.check(&experiment.metrics).map_err(|error| LineError::Summary { trial, error })?;
            Ok(Kept::Summary(summary))
        }
        Stored::Ended { trial: mut ended, links } => {
            ended.record.chain = links::decode(&links).ok_or(LineError::NoChain)?;
            let fits = ended.check(&experiment.cases[key.case].scenario, key.seed);
            fits.map_err(|problem| LineError::Misfit { trial, problem })?;
            Ok(Kept::Record(ended))
        }
    };
    Ok(Finished { key, result })
}
