//! Outcomes on disk. An interrupted survey resumes from them, and results can be looked up in them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use store::lock::Lock;
use store::{Failure, Header, Log, at};
use teaming::Assignment;
use xxhash_rust::xxh3::xxh3_64;

use crate::oracle::Outcome;

/// The decision to which outcomes belong.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct DecisionKey {
    /// The program that played it, with the sources of the policy that decided the earlier rounds.
    pub program: String,
    /// Name of the scenario.
    pub scenario: String,
    /// The resolved scenario as text.
    pub resolved: String,
    /// Seed of the trial.
    pub seed: u64,
    /// The policy that decided the earlier rounds, with its options.
    pub base: String,
    /// The round.
    pub round: u32,
}

impl DecisionKey {
    /// The path of the decision's file. The name has what users look for, and a hash of everything that
    /// decides numbers.
    pub fn path(&self, folder: &Path) -> PathBuf {
        let Self { scenario, seed, base, round, .. } = self;
        let hash = xxh3_64(self.decides().as_bytes());
        let plain = |text: &str| {
            let kept =
                text.chars().map(|c| if c.is_ascii_alphanumeric() || "-_".contains(c) { c } else { '_' });
            kept.take(40).collect::<String>()
        };
        let name = format!("{}-{}-seed-{seed}-round-{round}-{hash:016x}.jsonl", plain(scenario), plain(base));
        folder.join(name)
    }

    fn decides(&self) -> String {
        let Self { program, scenario: _, resolved, seed, base, round } = self;
        format!("{program} {resolved} {seed} {base} {round}")
    }

    fn header(&self) -> Header {
        Header::new("decision's outcomes", &self.decides())
    }
}

/// An entry of the file.
#[derive(Serialize, Deserialize)]
struct Entry {
    /// The policy that decided the rest of the trial; `None` for the outcome of the round.
    then: Option<String>,
    groups: Vec<Vec<u32>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    idle: Vec<u32>,
    outcome: Outcome,
}

/// Outcomes of the assignments of one decision, in a file.
pub struct OutcomeLog {
    /// Absent if the outcomes were only looked up.
    log: Option<Log>,
    known: Known,
}

type Known = BTreeMap<(Option<String>, Assignment), Outcome>;

/// Entries by the policy that decided the rest of the trial, and by assignment.
fn known(entries: Vec<Entry>) -> Known {
    let pair = |Entry { then, groups, idle, outcome }| ((then, Assignment { groups, idle }), outcome);
    entries.into_iter().map(pair).collect()
}

impl OutcomeLog {
    /// Opens the file of a decision, or begins it.
    ///
    /// # Errors
    /// The file was changed, cannot be read or written, or another process works on it.
    pub fn open(folder: &Path, key: &DecisionKey) -> Result<Self, Failure> {
        let path = key.path(folder);
        std::fs::create_dir_all(folder).map_err(at(folder))?;
        let lock = Arc::new(Lock::of_file(&path)?);
        let (log, entries) = Log::resume(&path, &key.header(), lock)?;
        Ok(Self { log: Some(log), known: known(entries) })
    }

    /// Looks up the outcomes of a decision; there are none without a file.
    ///
    /// # Errors
    /// The file was changed, or cannot be read.
    pub fn find(folder: &Path, key: &DecisionKey) -> Result<Self, Failure> {
        Ok(Self { log: None, known: known(store::read(&key.path(folder), &key.header())?) })
    }

    /// The outcome of an assignment, if it was played.
    pub fn get(&self, then: Option<&str>, assignment: &Assignment) -> Option<&Outcome> {
        self.known.get(&(then.map(str::to_owned), assignment.clone()))
    }

    /// How far the outcomes go: `None` for the end of the round, or the policy that decided the rest of the
    /// trial.
    pub fn horizons(&self) -> BTreeSet<Option<String>> {
        self.known.keys().map(|(then, _)| then.clone()).collect()
    }

    /// All played assignments with their outcomes.
    pub fn outcomes(&self, then: Option<&str>) -> impl Iterator<Item = (Assignment, &Outcome)> {
        let is_asked = move |key: &(Option<String>, _)| key.0.as_deref() == then;
        let asked = self.known.iter().filter(move |(key, _)| is_asked(key));
        asked.map(|((_, assignment), outcome)| (assignment.clone(), outcome))
    }

    /// Adds the outcomes of assignments.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(
        &mut self,
        then: Option<&str>,
        assignments: &[&Assignment],
        outcomes: &[Outcome],
    ) -> Result<(), Failure> {
        let entry = |(assignment, outcome): (&&Assignment, &Outcome)| Entry {
            then: then.map(str::to_owned),
            groups: assignment.groups.clone(),
            idle: assignment.idle.clone(),
            outcome: outcome.clone(),
        };
        let entries: Vec<Entry> = assignments.iter().zip(outcomes).map(entry).collect();
        let log = self.log.as_mut().ok_or_else(|| Failure::run("outcomes were only looked up"))?;
        log.add(&entries)?;
        self.known.extend(known(entries));
        Ok(())
    }
}
