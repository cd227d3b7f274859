//! Sweeps.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use experiments::Failure;
use experiments::experiment::{Experiment, Overrides};
use experiments::run::Limits;
use experiments::sweep::folder::{Folder, Opening};
use experiments::sweep::{missing, run_trials};
use pyo3::prelude::*;

use crate::errors::raised;
use crate::policy::{Given, Policies};
use crate::scenario::Scenario;
use crate::waiting::{Call, on_threads};

/// What is run.
#[derive(FromPyObject)]
pub enum File<'py> {
    /// A scenario.
    Scenario(PyRef<'py, Scenario>),
    /// A scenario or a sweep file, by its path or by the name of a carried one.
    Path(PathBuf),
}

/// Runs the missing trials of a sweep into the folder `out`. `progress` is called with the numbers of trials
/// that are done and that there are. See `usar.sweep`.
#[pyfunction]
#[pyo3(signature = (file, policies, trials, first_seed, settings, out, jobs, progress, allow_programs))]
#[expect(clippy::too_many_arguments, reason = "they are named in Python")]
pub fn sweep(
    py: Python<'_>,
    file: File<'_>,
    policies: Option<Vec<Given>>,
    trials: Option<u32>,
    first_seed: Option<u64>,
    settings: Vec<String>,
    out: PathBuf,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
    allow_programs: bool,
) -> PyResult<()> {
    let call = Call::new();
    let stop = Arc::clone(&call.stop);
    let has_policies = policies.is_some();
    let policies = Policies::of(py, policies.unwrap_or_default(), &call, allow_programs)?;
    let written = has_policies.then(|| policies.written.clone());
    let overrides =
        Overrides { policies: written, trials, first_seed, set: settings, ..Overrides::default() };
    let (path, text) = match file {
        File::Path(path) => {
            (usar::scenario_path(&path.to_string_lossy()).unwrap_or_else(|never| match never {}), None)
        }
        File::Scenario(scenario) => {
            (PathBuf::from(format!("{}.ron", scenario.it.name)), Some(scenario.it.resolved()))
        }
    };
    let (done, all) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let tell = |py: Python<'_>| {
        let [done, all] = [&done, &all].map(|count| count.load(Ordering::Relaxed));
        progress.as_ref().filter(|_| all > 0).map_or(Ok(()), |told| told.call1(py, (done, all)).map(|_| ()))
    };
    let jobs = jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    let seeds = OnceLock::<Vec<u64>>::new();
    let work = || -> Result<(), Failure> {
        let registry = &policies.registry;
        let experiment = match text {
            None => Experiment::load(&path, &overrides, registry)?,
            Some(text) => Experiment::parse(text, &path, &overrides, registry)?,
        };
        experiment.check(false)?;
        experiment.check_start(&out)?;
        let _ = seeds.set((1..=experiment.trials).map(|trial| experiment.seed(trial)).collect());
        let mut folder = Folder::open(&out, Arc::new(experiment), Opening::default(), &mut |_| ())?;
        let left = missing(&folder, None);
        let there = folder.experiment().count(None) - left.len();
        done.store(there, Ordering::Relaxed);
        all.store(there + left.len(), Ordering::Relaxed);
        let limits = Limits { jobs, trial: None };
        run_trials(&mut folder, left, limits, &stop, |_| {
            done.fetch_add(1, Ordering::Relaxed);
        })?;
        folder.finish(&stop)
    };
    let ran = call.wait_for(py, tell, || on_threads(jobs, work));
    policies.raised.check(py, seeds.into_inner().unwrap_or_default())?;
    ran??.map_err(|failure| raised(py, failure))?;
    tell(py)
}
