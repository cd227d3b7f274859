//! Outcomes on disk. An interrupted survey resumes from them, and results can be looked up in them.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use rne_core::Assignment;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_64;

use crate::failure::Failure;
use crate::files;
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
    #[must_use]
    pub fn path(&self, folder: &Path) -> PathBuf {
        let Self { program, scenario, resolved, seed, base, round } = self;
        let hash = xxh3_64(format!("{program} {resolved} {seed} {base} {round}").as_bytes());
        let plain = |text: &str| {
            let kept =
                text.chars().map(|c| if c.is_ascii_alphanumeric() || "-_".contains(c) { c } else { '_' });
            kept.take(40).collect::<String>()
        };
        let name = format!("{}-{}-seed-{seed}-round-{round}-{hash:016x}.jsonl", plain(scenario), plain(base));
        folder.join(name)
    }
}

/// One line of the file.
#[derive(Serialize, Deserialize)]
struct Line {
    /// The policy that decided the rest of the trial; `None` for the outcome of the round.
    then: Option<String>,
    groups: Vec<Vec<u32>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    idle: Vec<u32>,
    outcome: Outcome,
}

/// Outcomes of the assignments of one decision, in a file.
pub struct OutcomeLog {
    path: PathBuf,
    file: File,
    known: Known,
}

impl OutcomeLog {
    /// Opens the file of a decision, or begins it. Incomplete lines are dropped.
    ///
    /// # Errors
    /// The file cannot be read or written.
    pub fn open(folder: &Path, key: &DecisionKey) -> Result<Self, Failure> {
        let path = key.path(folder);
        let trouble = |error| Failure::storage(format!("{}: {error}", path.display()));
        fs::create_dir_all(folder).map_err(trouble)?;
        files::check_is_file(&path).map_err(trouble)?;
        let mut file = File::options()
            .create(true)
            .truncate(false)
            .read(true)
            .write(true)
            .open(&path)
            .map_err(trouble)?;
        let (known, sound) = read(&mut file).map_err(trouble)?;
        file.set_len(sound).and_then(|()| file.seek(SeekFrom::Start(sound))).map_err(trouble)?;
        Ok(Self { path, file, known })
    }

    /// The log of a decision, if its file exists.
    #[must_use]
    pub fn find(folder: &Path, key: &DecisionKey) -> Option<Self> {
        key.path(folder).is_file().then(|| Self::open(folder, key).ok()).flatten()
    }

    /// The outcome of an assignment, if it was played.
    #[must_use]
    pub fn get(&self, then: Option<&str>, assignment: &Assignment) -> Option<&Outcome> {
        self.known.get(&(then.map(str::to_owned), assignment.clone()))
    }

    /// How far the outcomes go: `None` for the end of the round, or the policy that decided the rest of the
    /// trial.
    #[must_use]
    pub fn horizons(&self) -> BTreeSet<Option<String>> {
        self.known.keys().map(|(then, _)| then.clone()).collect()
    }

    /// All played assignments with their outcomes.
    pub fn outcomes(&self, then: Option<&str>) -> impl Iterator<Item = (Assignment, &Outcome)> {
        let is_asked = move |key: &(Option<String>, _)| key.0.as_deref() == then;
        let asked = self.known.iter().filter(move |(key, _)| is_asked(key));
        asked.map(|((_, assignment), outcome)| (assignment.clone(), outcome))
    }

    /// Adds the outcome of an assignment.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn add(
        &mut self,
        then: Option<&str>,
        assignment: &Assignment,
        outcome: &Outcome,
    ) -> Result<(), Failure> {
        let line = Line {
            then: then.map(str::to_owned),
            groups: assignment.groups.clone(),
            idle: assignment.idle.clone(),
            outcome: outcome.clone(),
        };
        let mut text = serde_json::to_string(&line).map_err(Failure::run)?;
        text.push('\n');
        let written = self.file.write_all(text.as_bytes());
        written.map_err(|error| Failure::storage(format!("{}: {error}", self.path.display())))?;
        self.known.insert((line.then, assignment.clone()), line.outcome);
        Ok(())
    }
}

type Known = BTreeMap<(Option<String>, Assignment), Outcome>;

/// The outcomes in a file, and the number of bytes up to its first damaged line.
fn read(file: &mut File) -> std::io::Result<(Known, u64)> {
    let (mut known, mut sound) = (BTreeMap::new(), 0);
    let mut reader = BufReader::new(file);
    let mut text = String::new();
    while reader.read_line(&mut text)? > 0 {
        let Some(Ok(Line { then, groups, idle, outcome })) =
            text.strip_suffix('\n').map(serde_json::from_str)
        else {
            break;
        };
        known.insert((then, Assignment { groups, idle }), outcome);
        sound += text.len() as u64;
        text.clear();
    }
    Ok((known, sound))
}

#[cfg(test)]
mod tests {
    use usar_sim::metrics::TaskTotals;

    use super::*;

    #[test]
    fn outcomes_are_found_again_and_a_cut_line_is_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let key = DecisionKey {
            program: "usar".to_owned(),
            scenario: "a/b".to_owned(),
            resolved: String::new(),
            seed: 1,
            base: "RNE".to_owned(),
            round: 2,
        };
        assert!(OutcomeLog::find(folder.path(), &key).is_none());
        let outcome = |rescued| Outcome {
            tasks: vec![TaskTotals { rescued, ..TaskTotals::default() }],
            ungrouped: [0.1, 0.2],
            duration_s: 1.5,
            is_cut: false,
        };
        let assignments = [0, 1].map(|id| Assignment::new(vec![vec![id]]));
        let mut log = OutcomeLog::open(folder.path(), &key).unwrap();
        log.add(None, &assignments[0], &outcome(3)).unwrap();
        log.add(Some("DIS"), &assignments[0], &outcome(4)).unwrap();
        log.add(None, &assignments[1], &outcome(5)).unwrap();
        drop(log);
        let path = key.path(folder.path());
        assert!(path.parent() == Some(folder.path()), "{}", path.display());
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() - 3]).unwrap();
        let mut log = OutcomeLog::find(folder.path(), &key).unwrap();
        assert_eq!(log.get(None, &assignments[0]), Some(&outcome(3)));
        assert_eq!(log.get(Some("DIS"), &assignments[0]), Some(&outcome(4)));
        assert_eq!(log.outcomes(None).count(), 1);
        log.add(None, &assignments[1], &outcome(5)).unwrap();
        drop(log);
        assert_eq!(fs::read(&path).unwrap(), bytes);
        let other = DecisionKey { round: 3, ..key };
        assert!(OutcomeLog::find(folder.path(), &other).is_none());
    }
}
