//! The study of regret: trials in which every assignment is played at every decision, in a folder that
//! survives interruptions.

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use rne_core::{Deadline, Registry};
use serde::{Deserialize, Serialize};
use usar_sim::simulation::Simulation;

use super::decision::{Plan, PlayedDecision, play_decisions};
use crate::experiment::{Digest, Experiment, PolicySpec, Program};
use crate::failure::Failure;
use crate::files::{self, NewFile};
use crate::metric::task_names;
use crate::oracle::{BranchError, Objective};

const MANIFEST: &str = "study.json";
const JOURNAL: &str = "decisions.jsonl";

/// The definition of a study: everything that decides its numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Study {
    /// Its name.
    pub name: String,
    /// Names of the tasks.
    pub tasks: Vec<String>,
    /// The resolved scenario as text.
    pub scenario: String,
    /// Policies, as written. They take turns in deciding, trial by trial.
    pub policies: Vec<String>,
    /// Seeds of the trials.
    pub seeds: Vec<u64>,
    /// The policy that decides the rest of the trial after a decision; `None` to play to the end of the
    /// round only.
    pub then: Option<String>,
    /// The rounds whose decisions are played; empty for all.
    pub rounds: Vec<u32>,
    /// Largest number of assignments played for one decision.
    pub limit: u64,
    /// Version and source of the program.
    pub program: [String; 2],
}

/// Settings from the command line.
#[derive(Debug, Clone)]
pub struct Choices {
    /// See [`Study::then`].
    pub then: Option<String>,
    /// See [`Study::rounds`].
    pub rounds: Vec<u32>,
    /// See [`Study::limit`].
    pub limit: u64,
}

/// One trial and its decisions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlayedTrial {
    /// Number of the trial, from 1.
    pub trial: u32,
    /// Its seed.
    pub seed: u64,
    /// The policy that decided in this trial.
    pub driver: String,
    /// Its decisions.
    pub decisions: Vec<PlayedDecision>,
}

impl Study {
    /// The study that a sweep file asks for.
    ///
    /// # Errors
    /// The sweep has axes, or a policy that cannot be judged.
    pub fn of(experiment: &Experiment, choices: &Choices) -> Result<Self, Failure> {
        if experiment.cases.len() > 1 {
            return Err(Failure::input(format!(
                "{}: a study of regret is of one scenario, and this sweep has {} cases",
                experiment.name,
                experiment.cases.len()
            )));
        }
        if let Some(oracle) = experiment.policies.iter().find(|spec| !spec.is_of_question()) {
            return Err(Failure::input(format!(
                "policies: {} is what the others are measured against; leave it out",
                oracle.label
            )));
        }
        let then = choices.then.as_deref().map(|then| PolicySpec::parse(then, &experiment.registry));
        let then = then.transpose().map_err(Failure::input)?;
        let specs: Vec<PolicySpec> = experiment.policies.iter().cloned().chain(then).collect();
        let Digest { version, source } = Program::running(&specs)?.digest();
        Ok(Self {
            name: experiment.name.clone(),
            tasks: task_names(&experiment.base),
            scenario: experiment.cases[0].scenario.resolved(),
            policies: experiment.policies.iter().map(|spec| spec.written().to_owned()).collect(),
            seeds: (1..=experiment.trials).map(|trial| experiment.seed(trial)).collect(),
            then: choices.then.clone(),
            rounds: choices.rounds.clone(),
            limit: choices.limit,
            program: [version, source],
        })
    }

    /// The policies.
    ///
    /// # Errors
    /// A policy that this program does not know.
    pub fn specs(&self, registry: &Registry) -> Result<Vec<PolicySpec>, Failure> {
        let parse = |text: &String| PolicySpec::parse(text, registry).map_err(Failure::input);
        self.policies.iter().map(parse).collect()
    }

    /// Whether another study gives the same numbers for the trials that both have.
    fn is_as(&self, other: &Self) -> bool {
        let without_seeds = |study: &Self| Self { seeds: Vec::new(), name: String::new(), ..study.clone() };
        let shared = self.seeds.len().min(other.seeds.len());
        without_seeds(self) == without_seeds(other) && self.seeds[..shared] == other.seeds[..shared]
    }
}

/// The folder of a study.
pub struct StudyFolder {
    path: PathBuf,
    /// The study in the folder.
    pub study: Study,
    /// The finished trials, by number.
    pub trials: Vec<PlayedTrial>,
}

impl StudyFolder {
    /// Opens the folder of a study to resume it, or begins it.
    ///
    /// # Errors
    /// The folder holds another study, or a study of another program.
    pub fn open(path: &Path, study: Study) -> Result<Self, Failure> {
        let trouble = |error| Failure::storage(format!("{}: {error}", path.display()));
        fs::create_dir_all(path).map_err(trouble)?;
        if path.join(MANIFEST).exists() {
            let found = Self::read(path)?;
            if !found.study.is_as(&study) {
                return Err(Failure::input(format!(
                    "{}: has another study (scenario, policies, rounds, seeds, limit or program differ); \
                     --out names another folder",
                    path.display()
                )));
            }
            let more = if study.seeds.len() > found.study.seeds.len() { study } else { found.study };
            write_manifest(path, &more)?;
            return Ok(Self { study: more, ..found });
        }
        write_manifest(path, &study)?;
        Ok(Self { path: path.to_owned(), study, trials: Vec::new() })
    }

    /// Reads the folder of a study. The program that made it may be another one.
    ///
    /// # Errors
    /// It is not the folder of a study.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let bad = |error: &dyn std::fmt::Display| {
            Failure::input(format!("{}: is not the folder of a study of regret: {error}", path.display()))
        };
        let manifest = files::read(&path.join(MANIFEST)).map_err(|error| bad(&error))?;
        let study: Study = serde_json::from_slice(&manifest).map_err(|error| bad(&error))?;
        let mut trials: Vec<PlayedTrial> = Vec::new();
        if let Ok(journal) = files::open(&path.join(JOURNAL)) {
            for line in BufReader::new(journal).lines() {
                let line = line.map_err(|error| bad(&error))?;
                // An incomplete line counts as a missing trial.
                let Ok(trial) = serde_json::from_str::<PlayedTrial>(&line) else { continue };
                let place = trial.trial.checked_sub(1).map(|place| place as usize);
                let is_ours = place.and_then(|place| study.seeds.get(place)) == Some(&trial.seed);
                if is_ours && !trials.iter().any(|known| known.trial == trial.trial) {
                    trials.push(trial);
                }
            }
        }
        trials.sort_by_key(|trial| trial.trial);
        Ok(Self { path: path.to_owned(), study, trials })
    }

    /// Numbers of the missing trials.
    #[must_use]
    pub fn missing(&self) -> Vec<u32> {
        let is_there = |number: &u32| self.trials.iter().any(|trial| trial.trial == *number);
        (1..=self.study.seeds.len() as u32).filter(|number| !is_there(number)).collect()
    }

    /// Plays the missing trials on the threads of the current pool, and calls `done` after each.
    ///
    /// # Errors
    /// A trial fails, the folder cannot be written, or the study is halted. Finished trials are kept.
    pub fn play_missing(
        &mut self,
        experiment: &Experiment,
        halt: &AtomicBool,
        done: impl Fn() + Sync,
    ) -> Result<(), Failure> {
        let path = self.path.join(JOURNAL);
        let trouble = |error| Failure::storage(format!("{}: {error}", path.display()));
        files::check_is_file(&path).map_err(trouble)?;
        let mut journal = File::options().create(true).append(true).open(&path).map_err(trouble)?;
        // Ends an incomplete last line.
        if journal.metadata().map_err(trouble)?.len() > 0 {
            journal.write_all(b"\n").map_err(trouble)?;
        }
        let specs = self.study.specs(&experiment.registry)?;
        let (missing, study) = (self.missing(), &self.study);
        let shared = Mutex::new((journal, Vec::new()));
        missing.into_par_iter().try_for_each(|number| {
            let trial = play_trial(study, experiment, &specs, number, halt)?;
            let mut line = serde_json::to_vec(&trial).map_err(Failure::run)?;
            line.push(b'\n');
            let mut shared = shared.lock().map_err(|_| Failure::run("a thread panicked"))?;
            shared.0.write_all(&line).map_err(trouble)?;
            shared.1.push(trial);
            done();
            Ok::<(), Failure>(())
        })?;
        let (_, played) = shared.into_inner().map_err(|_| Failure::run("a thread panicked"))?;
        self.trials.extend(played);
        self.trials.sort_by_key(|trial| trial.trial);
        Ok(())
    }

    /// Path of the folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}

fn write_manifest(path: &Path, study: &Study) -> Result<(), Failure> {
    let text = serde_json::to_vec_pretty(study).map_err(Failure::run)?;
    NewFile::write(path, MANIFEST, &text).map(drop)
}

fn play_trial(
    study: &Study,
    experiment: &Experiment,
    specs: &[PolicySpec],
    number: u32,
    halt: &AtomicBool,
) -> Result<PlayedTrial, Failure> {
    let seed = study.seeds[number as usize - 1];
    let driver = &specs[(number as usize - 1) % specs.len()];
    let opened = |spec: &PolicySpec| {
        spec.made().open().map_err(|error| Failure::run(format!("policy {}: {error}", spec.label)))
    };
    let named = specs.iter().map(opened).collect::<Result<Vec<_>, _>>()?;
    let parse = |then| PolicySpec::parse(then, &experiment.registry);
    let then = study.then.as_deref().map(parse).transpose().map_err(Failure::input)?;
    let objective = Objective::parse("rescuees", &study.tasks).map_err(Failure::run)?;
    let mut plan = Plan {
        objective: &objective,
        limit: study.limit,
        onwards: then.as_ref().map(opened).transpose()?,
        named,
        rounds: &study.rounds,
        halt: Deadline::when(halt),
    };
    let trial = Simulation::new(&experiment.cases[0].scenario, seed)
        .map_err(|error| Failure::run(format!("trial {number}: seed {seed}: {error}")))?;
    let decisions = play_decisions(trial, &mut *opened(driver)?, &mut plan);
    let decisions = decisions.map_err(|error| match error {
        BranchError::Halted => Failure::Interrupted("stopped; the same command goes on".to_owned()),
        error => Failure::run(format!("trial {number}: {error}")),
    })?;
    Ok(PlayedTrial { trial: number, seed, driver: driver.label.clone(), decisions })
}
