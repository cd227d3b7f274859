//! A finished trial as a line of JSON with its checksum.

use rne_core::Account;
use serde::{Deserialize, Serialize};
use thiserror::Error;
use xxhash_rust::xxh3::xxh3_64;

use super::links;
use super::summary::{Summary, SummaryError};
use crate::experiment::{Experiment, Keep, Place, Shard};
use crate::failure::Failure;
use crate::run::{Fault, Outcome, Trial, TrialKey};

/// Start of a line, before 16 hexadecimal digits.
pub(super) const HEAD: &str = "{\"xxh3_64\":\"";
/// Text between the digits and the trial.
const MIDDLE: &str = "\",\"trial\":";

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
    #[error("the checksum does not match: the line was changed or cut")]
    Changed,
    #[error("is no trial: {0}")]
    NoTrial(#[from] serde_json::Error),
    #[error("{trial} is not of this sweep")]
    OtherSweep { trial: String },
    #[error("{trial} is of another scenario, option or program")]
    OtherProgram { trial: String },
    #[error("{trial} {error}")]
    Summary { trial: String, error: SummaryError },
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
                trial.record.decisions.iter_mut().for_each(|asked| asked.decision.account = Account::None);
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
    let entry = serde_json::to_string(&entry).map_err(Failure::run)?;
    Ok(format!("{HEAD}{:016x}{MIDDLE}{entry}}}\n", xxh3_64(entry.as_bytes())).into_bytes())
}

/// The trial of a line, if it belongs to the sweep or to a shard of it; otherwise what is wrong with the
/// line.
pub(super) fn finished_of(
    line: &[u8],
    experiment: &Experiment,
    shard: Option<Shard>,
) -> Result<Finished, LineError> {
    let entry: Entry = serde_json::from_slice(sound(line).ok_or(LineError::Changed)?)?;
    let policy = experiment.policies.iter().position(|policy| policy.label == entry.policy);
    let trial = format!("trial {} of {} (seed {})", entry.trial, entry.policy, entry.seed);
    let policy =
        policy.filter(|policy| experiment.has((entry.case, *policy, entry.trial), entry.seed, shard));
    let Some(policy) = policy else { return Err(LineError::OtherSweep { trial }) };
    let key =
        TrialKey { case: entry.case, policy, trial: entry.trial, seed: entry.seed, label: entry.policy };
    if experiment.id(&key) != entry.id {
        return Err(LineError::OtherProgram { trial });
    }
    let result = match entry.outcome {
        Stored::Fault(fault) => Err(fault),
        Stored::Measured(summary) => {
            summary.check(&experiment.metrics).map_err(|error| LineError::Summary { trial, error })?;
            Ok(Kept::Summary(summary))
        }
        Stored::Ended { mut trial, links } => {
            trial.record.chain = links::decode(&links).ok_or(LineError::NoChain)?;
            Ok(Kept::Record(trial))
        }
    };
    Ok(Finished { key, result })
}

/// The label of a line's policy, if the line's checksum matches.
pub(super) fn policy_of(line: &[u8]) -> Option<String> {
    #[derive(Deserialize)]
    struct Head {
        policy: String,
    }
    serde_json::from_slice(sound(line)?).ok().map(|Head { policy }| policy)
}

/// The trial in a line whose checksum matches.
fn sound(line: &[u8]) -> Option<&[u8]> {
    let rest = line.strip_prefix(HEAD.as_bytes())?;
    let (digits, rest) = rest.split_at_checked(16)?;
    let entry = rest.strip_prefix(MIDDLE.as_bytes())?.strip_suffix(b"}\n")?;
    let digits = std::str::from_utf8(digits).ok()?;
    (u64::from_str_radix(digits, 16).ok()? == xxh3_64(entry)).then_some(entry)
}
