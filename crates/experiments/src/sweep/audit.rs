//! The audit of a finished sweep's folder: which trials, line by line, and which tables made from them are
//! not reproduced.

use std::sync::atomic::AtomicBool;

use serde_json::Value;
use store::Failure;
use store::files::FileHash;
use usar_sim::hash::Link;

use super::disk::{broken_files, inputs};
use super::folder::Folder;
use super::line::line_of;
use super::names::GIVEN;
use crate::experiment::{Experiment, check_form};
use crate::run::{FaultKind, Outcome, TrialKey};

/// How the journal's line of a trial differs from the line of the same trial run again; `None` if both are
/// equal, byte for byte.
///
/// # Errors
/// The journal cannot be read.
pub fn difference(folder: &mut Folder, again: &Outcome) -> Result<Option<String>, Failure> {
    let Some(what) = first_difference(folder, again)? else { return Ok(None) };
    let experiment = folder.shared_experiment();
    let round = again.record().and_then(|record| experiment.answers_otherwise(&again.key, record));
    Ok(Some(round.map_or(what.clone(), |round| {
        format!(
            "{what}\nThe reason: policy {} is no function of its question: asked the same question of round \
             {round} again, it answers otherwise. A policy may use nothing but the question: no clock, no \
             counter, no random numbers of its own.",
            again.key.label
        )
    })))
}

/// The first difference between the lines.
fn first_difference(folder: &mut Folder, again: &Outcome) -> Result<Option<String>, Failure> {
    let TrialKey { case, policy, label, trial, seed } = &again.key;
    let experiment = folder.shared_experiment();
    let place = experiment.describe(&experiment.cases[*case]);
    let name = format!("{place}trial {trial} of {label} (seed {seed})");
    if !folder.has(&again.key) {
        return Ok(Some(format!("{name} is not in the journal")));
    }
    let there = folder.line((*case, *policy, *trial))?;
    let now = line_of(&experiment, experiment.keep, again)?;
    if there == now {
        return Ok(None);
    }
    let recorded = match folder.outcome((*case, *policy, *trial)) {
        Ok(recorded) => recorded,
        Err(_) if !experiment.keep.has_records() => {
            let what = "differs in its metrics or its last state";
            return Ok(Some(format!("{name} {what}")));
        }
        Err(error) => return Ok(Some(format!("{name} cannot be read: {error}"))),
    };
    let timed_out =
        |outcome: &Outcome| outcome.result.as_ref().is_err_and(|fault| fault.kind == FaultKind::TimedOut);
    let what = if timed_out(&recorded) || timed_out(again) {
        "timed out in one of the two runs".to_owned()
    } else if let Some(step) = first_step(&recorded, again, &experiment) {
        step
    } else {
        let value = |line: &[u8]| serde_json::from_slice(line).unwrap_or(Value::Null);
        let [there, now] = [value(&there)["entry"].take(), value(&now)["entry"].take()];
        let what = first_field("", &there, &now).unwrap_or_else(|| "is written otherwise".to_owned());
        format!("has the same states, but not the same numbers: {what}")
    };
    Ok(Some(format!("{name} {what}")))
}

/// The first step at which the states of two runs differ, and the parts of the state that differ; or which
/// of the runs has states at all.
fn first_step(recorded: &Outcome, again: &Outcome, experiment: &Experiment) -> Option<String> {
    let links = |outcome: &Outcome| -> Vec<Link> {
        outcome.record().map(|record| record.chain.links().to_vec()).unwrap_or_default()
    };
    let (before, now) = (links(recorded), links(again));
    if !experiment.keep.has_chains() {
        return None;
    }
    if let Some((before, now)) = before.iter().zip(&now).find(|(before, now)| before != now) {
        let time_s = now.step as f64 * experiment.cases[again.key.case].scenario.dt_s;
        let parts = before.differing_parts(now).join(", ");
        let parts = if parts.is_empty() { "the chain only".to_owned() } else { parts };
        return Some(format!("differs first at step {} ({time_s:.2} s), in: {parts}", now.step));
    }
    match (before.len(), now.len()) {
        (before, now) if before == now => None,
        (0, _) => Some("failed then, and does not now".to_owned()),
        (_, 0) => Some(again.failure().unwrap_or_default()),
        (before, now) => Some(format!("has {before} links in the folder and {now} now")),
    }
}

/// The path of the first field in which two values differ, with both values.
fn first_field(path: &str, there: &Value, now: &Value) -> Option<String> {
    let join = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match (there, now) {
        (Value::Object(old), Value::Object(new)) if old.keys().eq(new.keys()) => {
            old.iter().find_map(|(key, value)| first_field(&join(key), value, &new[key]))
        }
        (Value::Array(old), Value::Array(new)) if old.len() == new.len() => {
            let pairs = old.iter().zip(new).enumerate();
            pairs.into_iter().find_map(|(i, (old, new))| first_field(&format!("{path}[{i}]"), old, new))
        }
        _ if there == now => None,
        _ => Some(format!("{path} is {there} in the folder and {now} now")),
    }
}

/// The files of a finished sweep's folder that differ from what its trials and its manifest give, one
/// sentence each. Its Parquet files, which are made from its tables, are left to who can write such files.
///
/// # Errors
/// The journal cannot be read, or there is no room for the tables in the folder of temporary files.
pub fn strange_files(folder: &mut Folder) -> Result<Vec<String>, Failure> {
    let path = folder.path().to_owned();
    let manifest = folder.manifest().clone();
    let name = |file: &str| path.join(file).display().to_string();
    let mut strange: Vec<String> = broken_files(&path, &manifest)
        .iter()
        .map(|file| {
            let is_there = path.join(file).exists();
            let what = if is_there { "does not have the checksum of the manifest" } else { "is missing" };
            format!("{}: {what}", name(file))
        })
        .collect();
    let given = path.join(GIVEN);
    strange.extend(check_form(&folder.experiment().given, &given).err().map(|failure| failure.to_string()));
    let place = tempfile::tempdir()?;
    let made = folder.tables_in(place.path(), &AtomicBool::new(false));
    let mut again: Vec<FileHash> = match made {
        Ok(made) => made.unwrap_or_default(),
        Err(failure) => {
            strange.push(format!("{}: {failure}", path.display()));
            Vec::new()
        }
    };
    let inputs = inputs(folder.experiment())?;
    again.extend(inputs.iter().map(|(name, text)| FileHash::of(name, text.as_bytes())));
    for file in again.iter().filter(|file| !manifest.files.contains(file)) {
        strange.push(format!("{}: is not what the trials in the journal give", name(&file.name)));
    }
    Ok(strange)
}
