//! The study of regret: trials in which every assignment is played at every decision, in a folder that
//! survives interruptions.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use ron_tree::without_types;
use serde::{Deserialize, Serialize};
use store::{Failure, refuse};
use teaming::{Deadline, Registry};
use usar_sim::simulation::Simulation;

use super::decision::{Plan, PlayedDecision, play_decisions};
use crate::experiment::{Experiment, PolicySpec, Program};
use crate::job::{Job, JobFolder};
use crate::metric::task_names;
use crate::oracle::{BranchError, Objective};

/// Name of the table of decisions.
pub const TABLE: &str = "regret.csv";
/// Name of the file with the analyses.
pub const SUMMARY: &str = "summary.json";
const JOB: Job =
    Job { noun: "study of regret", origin: "study.json", log: "decisions.jsonl", results: &[TABLE, SUMMARY] };

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
    pub program: String,
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
            refuse!(
                "{}: a study of regret is of one scenario, and this sweep has {} cases",
                experiment.name,
                experiment.cases.len()
            );
        }
        if let Some(oracle) = experiment.policies.iter().find(|spec| !spec.is_of_question()) {
            refuse!("policies: {} is what the others are measured against; leave it out", oracle.label);
        }
        let then = choices.then.as_deref().map(|then| PolicySpec::parse(then, &experiment.registry));
        let then = then.transpose().map_err(Failure::input)?;
        let specs: Vec<PolicySpec> = experiment.policies.iter().cloned().chain(then).collect();
        Ok(Self {
            name: experiment.name.clone(),
            tasks: task_names(&experiment.base),
            scenario: experiment.cases[0].scenario.resolved(),
            policies: experiment.policies.iter().map(|spec| spec.written().to_owned()).collect(),
            seeds: (1..=experiment.trials).map(|trial| experiment.seed(trial)).collect(),
            then: choices.then.clone(),
            rounds: choices.rounds.clone(),
            limit: choices.limit,
            program: Program::running(&specs)?.digest().to_string(),
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
}

/// The folder of a study.
pub struct StudyFolder {
    /// The folder, with the finished trials by number.
    pub folder: JobFolder<PlayedTrial>,
    /// The study in the folder.
    pub study: Study,
}

impl StudyFolder {
    /// Opens the folder of a study to resume it, or begins it.
    ///
    /// # Errors
    /// The folder holds something else, another study, or a study of another program.
    pub fn open(path: &Path, study: &Study) -> Result<Self, Failure> {
        let origin = serde_json::to_value(study).map_err(Failure::run)?;
        Self::of(JOB.open(path, origin, false)?)
    }

    /// Reads the folder of a study. The program that made it may be another one.
    ///
    /// # Errors
    /// It is not the folder of a study, or its log was changed.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        Self::of(JOB.read(path)?)
    }

    fn of(mut folder: JobFolder<PlayedTrial>) -> Result<Self, Failure> {
        let study = serde_json::from_value(folder.origin.clone());
        let study = study.map_err(|error| JOB.is_none(&folder.path, without_types(&error)))?;
        folder.entries.sort_by_key(|trial| trial.trial);
        Ok(Self { folder, study })
    }

    /// Numbers of the missing trials.
    pub fn missing(&self) -> Vec<u32> {
        let is_there = |number: &u32| self.folder.entries.iter().any(|trial| trial.trial == *number);
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
        let specs = self.study.specs(&experiment.registry)?;
        let (missing, study, folder) = (self.missing(), &self.study, Mutex::new(&mut self.folder));
        missing.into_par_iter().try_for_each(|number| {
            let trial = play_trial(study, experiment, &specs, number, halt)?;
            folder.lock().map_err(|_| Failure::run("a thread panicked"))?.add(vec![trial])?;
            done();
            Ok::<(), Failure>(())
        })?;
        self.folder.entries.sort_by_key(|trial| trial.trial);
        Ok(())
    }
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
