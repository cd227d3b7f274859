//! Recordings as files: of single trials, and of the trials of a sweep's folder.

use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};

use experiments::Failure;
use experiments::experiment::Experiment;
use experiments::limits::RECORDING_BYTES;
use experiments::run::TrialKey;
use experiments::sweep::folder::Folder;
use experiments::sweep::names::RECORDINGS;
use recording::{Options, Recorder, Recording};
use ron_tree::file::{ReadError, read};
use teaming::{Deadline, Session};
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::{InTime, Simulation};

use crate::bad_value::BadValue;
use crate::output::{create_new, trouble};
use crate::running::{Guard, STOP, session_of, tell};

/// Number of bytes that are written to disk together.
const BUFFER: usize = 1 << 16;

/// Parses a number of frames in a second of simulated time.
pub(crate) fn fps(text: &str) -> Result<f64, BadValue> {
    let fps = text.parse::<f64>().ok().filter(|fps| (0.01..=1000.0).contains(fps));
    fps.ok_or_else(|| BadValue::new("a number from 0.01 to 1000", text))
}

/// Runs a trial to its end and records it in a new file. `watch` is called after each step and may
/// interrupt the trial. The file then has the trial up to that step.
pub(crate) fn record_to(
    path: &Path,
    mut simulation: Simulation,
    session: &mut dyn Session,
    options: &Options,
    watch: &mut dyn FnMut(&Simulation) -> Result<(), Failure>,
) -> Result<TrialRecord, Failure> {
    let mut session = InTime::new(session, Deadline::when(&STOP));
    let trouble = |error: io::Error| trouble("--record", path, &error);
    let file = BufWriter::with_capacity(BUFFER, create_new("--record", path)?);
    let mut recorder = Recorder::begin(file, &simulation, options).map_err(trouble)?;
    while simulation.step(&mut session).is_none() {
        recorder.listen(&simulation).map_err(trouble)?;
        watch(&simulation)?;
    }
    let mut record = simulation.finish();
    recorder.finish(&mut record).map_err(trouble)?;
    Ok(record)
}

/// The trials of a sweep that are recorded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Recorded {
    /// All trials.
    All,
    /// The first trials of each policy and case, this many.
    First(u32),
    /// The trials with these seeds.
    Seeds(Vec<u64>),
}

impl FromStr for Recorded {
    type Err = BadValue;

    fn from_str(text: &str) -> Result<Self, BadValue> {
        let wrong = || BadValue::new("`all`, a number of trials, or `seeds=` and a list", text);
        if text == "all" {
            return Ok(Self::All);
        }
        match text.strip_prefix("seeds=") {
            Some(list) => {
                let seeds = list.split(',').map(|seed| seed.trim().parse().map_err(|_| wrong()));
                seeds.collect::<Result<_, _>>().map(Self::Seeds)
            }
            None => text.parse().ok().filter(|count| *count > 0).map(Self::First).ok_or_else(wrong),
        }
    }
}

impl Recorded {
    fn includes(&self, key: &TrialKey) -> bool {
        match self {
            Self::All => true,
            Self::First(count) => key.trial <= *count,
            Self::Seeds(seeds) => seeds.contains(&key.seed),
        }
    }
}

/// The path of a trial's recording in the folder of its sweep.
pub(crate) fn path_of(folder: &Path, experiment: &Experiment, key: &TrialKey) -> PathBuf {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    let plain: String = key.label.chars().map(|c| if is_plain(c) { c } else { '_' }).collect();
    // Different labels must have different file names.
    let label = if plain == key.label { plain } else { format!("{plain}.{}", key.policy + 1) };
    let mut path = folder.join(RECORDINGS);
    if experiment.cases.len() > 1 {
        path.push(format!("case-{}", key.case + 1));
    }
    path.join(format!("{label}-{}.usrec", key.seed))
}

/// Records trials whose results a folder has. Each trial is simulated again, and its recording is kept if
/// its result is the same.
pub(crate) fn record_trials(folder: &mut Folder, which: &Recorded, stop: &AtomicBool) -> Result<(), Failure> {
    let experiment = folder.shared_experiment();
    let keys: Vec<TrialKey> =
        experiment.keys(None).filter(|key| which.includes(key) && folder.has(key)).collect();
    for key in keys {
        let path = path_of(folder.path(), &experiment, &key);
        if stop.load(Ordering::Relaxed) {
            return Err(folder.interrupted());
        }
        let before = folder.state_hash((key.case, key.policy, key.trial))?;
        let Some(before) = before else { continue };
        if summary_hash(&path).is_some_and(|hash| hash == before) {
            continue; // it is there already
        }
        let parent = path.parent().unwrap_or(Path::new("."));
        std::fs::create_dir_all(parent).map_err(|error| trouble("--recordings", parent, &error))?;
        let underway = path.with_extension("usrec.new");
        let _ = std::fs::remove_file(&underway); // of a run that was broken off
        let guard = Guard::new(f64::INFINITY);
        let record = record_to(
            &underway,
            simulation(&experiment, &key)?,
            &mut *session(&experiment, &key)?,
            &options(&experiment, &key),
            &mut |simulation| guard.look(simulation),
        )?;
        if record.state_hash != before {
            let _ = std::fs::remove_file(&underway);
            let TrialKey { label, seed, .. } = key;
            return Err(Failure::run(format!(
                "the trial of {label} with seed {seed} came out differently when it was recorded; `usar \
                 verify` says where"
            )));
        }
        std::fs::rename(&underway, &path).map_err(|error| trouble("--recordings", &path, &error))?;
    }
    Ok(())
}

/// The bytes of a recording.
fn bytes_of(path: &Path) -> Result<Vec<u8>, ReadError> {
    read(path, RECORDING_BYTES.most as u64)
}

/// The hash of the last state in a recording file; `None` if the recording is incomplete.
fn summary_hash(path: &Path) -> Option<String> {
    let recording = Recording::read(&bytes_of(path).ok()?).ok()?;
    recording.summary.map(|summary| summary.state_hash)
}

/// A recording, and its name in messages.
pub(crate) struct Shown {
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
}

impl Shown {
    /// Reads the recording; notes if it is truncated.
    pub(crate) fn read(&self) -> Result<Recording, Failure> {
        let recording = Recording::read(&self.bytes).map_err(Failure::input_at(&self.name))?;
        if let Some(rest) = recording.cut {
            tell(format_args!("note: {}: was cut short; {rest} bytes at its end were left out", self.name));
        }
        Ok(recording)
    }
}

/// The recording of a trial of a sweep: from its file, if that is a recording of this very trial, or by
/// simulating the trial again.
pub(crate) fn recording_of(folder: &Path, experiment: &Experiment, key: &TrialKey) -> Result<Shown, Failure> {
    let path = path_of(folder, experiment, key);
    let name = path.display().to_string();
    if let Ok(bytes) = bytes_of(&path)
        && let Ok(Recording { header, cut: None, .. }) = Recording::read(&bytes)
        && header.scenario.resolved == experiment.cases[key.case].scenario.resolved()
        && (header.seed, &header.policy) == (key.seed, &key.label)
    {
        return Ok(Shown { name, bytes });
    }
    let (simulation, mut session) = (simulation(experiment, key)?, session(experiment, key)?);
    let bytes = recorded(simulation, &mut *session, &options(experiment, key))?;
    Ok(Shown { name, bytes })
}

/// The recording of a trial of a sweep, to be shown beside others of the sweep: named by its policy and seed.
pub(crate) fn replay_of(folder: &Path, experiment: &Experiment, key: &TrialKey) -> Result<Shown, Failure> {
    let path = path_of(folder, experiment, key);
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(Shown { name, ..recording_of(folder, experiment, key)? })
}

fn options(experiment: &Experiment, key: &TrialKey) -> Options {
    Options::new(&key.label, experiment.policies[key.policy].measure(&experiment.registry))
}

fn session(experiment: &Experiment, key: &TrialKey) -> Result<Box<dyn Session>, Failure> {
    session_of(&experiment.policies[key.policy], &experiment.cases[key.case].scenario, key.seed)
}

fn simulation(experiment: &Experiment, key: &TrialKey) -> Result<Simulation, Failure> {
    let scenario = &experiment.cases[key.case].scenario;
    Simulation::new(scenario, key.seed).map_err(|error| Failure::run(format!("seed {}: {error}", key.seed)))
}

/// Simulates a trial and records it in memory.
pub(crate) fn recorded(
    simulation: Simulation,
    session: &mut dyn Session,
    options: &Options,
) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let record = recording::record(simulation, session, options, &mut bytes).map_err(Failure::run)?;
    match record.status {
        Status::Failed(reason) => {
            Err(Failure::run(format!("the trial of {} failed: {reason}", options.policy)))
        }
        _ => Ok(bytes),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trials_to_record_are_all_the_first_or_listed() {
        assert_eq!("all".parse(), Ok(Recorded::All));
        assert_eq!("3".parse(), Ok(Recorded::First(3)));
        assert_eq!("seeds=3, 7".parse(), Ok(Recorded::Seeds(vec![3, 7])));
        for text in ["", "0", "seeds=", "3,7", "-1"] {
            assert!(text.parse::<Recorded>().unwrap_err().to_string().contains("must be `all`"), "{text}");
        }
        assert!(fps("0").is_err() && fps("x").is_err() && fps("nan").is_err() && fps("25") == Ok(25.0));
    }
}
