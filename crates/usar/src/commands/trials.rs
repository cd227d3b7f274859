//! Trials to show: from recordings, from scenarios that are simulated first, and from the folders of
//! sweeps.

use std::path::{Path, PathBuf};

use clap::Args;
use experiments::Failure;
use experiments::experiment::{Experiment, PolicySpec, check_cost, defaults, split_list, with_settings};
use experiments::limits::RECORDING_BYTES;
use experiments::run::TrialKey;
use experiments::sweep::disk::experiment_in;
use recording::{Options, Recording};
use rne_core::Registry;
use ron_tree::file::read_start;
use usar_sim::simulation::Simulation;

use super::load;
use crate::recordings::{path_of, recorded, recording_of};
use crate::running::{session_of, tell};

/// The first bytes of a recording.
const MAGIC: &[u8] = b"USREC";

/// Which trials of the files are looked at.
#[derive(Debug, Args)]
pub(crate) struct Asked {
    /// Policies to show, separated by commas, of a scenario or of a sweep [default: the first]
    #[arg(long)]
    policy: Option<String>,
    /// Seed of the trial, of a scenario or of a sweep [default: the first]
    #[arg(long)]
    seed: Option<u64>,
    /// Case of a sweep with axes, from 1
    #[arg(long, default_value_t = 1)]
    case: usize,
    /// Set a field of the scenario, by its path, to a value in RON; can be given several times
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// Simulate even if it takes very long: more bodies x steps than docs/limits.md has
    #[arg(long)]
    allow_expensive: bool,
}

/// A recording, and its name in messages.
pub(crate) struct Shown {
    pub(crate) name: String,
    pub(crate) bytes: Vec<u8>,
}

impl Shown {
    /// Reads the recording; notes if it is truncated.
    pub(crate) fn read(&self) -> Result<Recording, Failure> {
        let recording = Recording::read(&self.bytes)
            .map_err(|error| Failure::input(format!("{}: {error}", self.name)))?;
        if let Some(rest) = recording.cut {
            tell(format_args!("note: {}: was cut short; {rest} bytes at its end were left out", self.name));
        }
        Ok(recording)
    }
}

impl Asked {
    /// The selected trials, file by file.
    pub(crate) fn open(&self, files: &[PathBuf], registry: &Registry) -> Result<Vec<Shown>, Failure> {
        let mut shown = Vec::new();
        files.iter().try_for_each(|file| self.open_file(file, registry, &mut shown))?;
        Ok(shown)
    }

    /// The one selected trial.
    pub(crate) fn open_one(&self, file: &Path, registry: &Registry) -> Result<Recording, Failure> {
        if self.policy.as_deref().is_some_and(|policy| split_list(policy).len() != 1) {
            return Err(Failure::input("--policy: must be one policy here"));
        }
        let shown = self.open(&[file.to_owned()], registry)?;
        let recording = shown.first().map(Shown::read).transpose()?;
        let recording = recording.filter(|recording| recording.frames() > 0);
        recording.ok_or_else(|| Failure::input(format!("{}: has no frames", file.display())))
    }

    fn open_file(&self, file: &Path, registry: &Registry, shown: &mut Vec<Shown>) -> Result<(), Failure> {
        if file.is_dir() {
            return self.open_folder(file, registry, shown);
        }
        let unreadable = |error| Failure::input(format!("{}: {error}", file.display()));
        let most = RECORDING_BYTES.most as u64;
        let (start, _) = read_start(file, MAGIC.len() as u64, most).map_err(unreadable)?;
        if start == MAGIC {
            let bytes = ron_tree::file::read(file, most).map_err(unreadable)?;
            shown.push(Shown { name: file.display().to_string(), bytes });
            return Ok(());
        }
        let (scenario, _) = load(file)?;
        let scenario = with_settings(&scenario, &self.set)?;
        check_cost(&scenario, self.allow_expensive)?;
        let (first_policy, first_seed) = defaults(file)?;
        let seed = self.seed.unwrap_or(first_seed);
        for policy in split_list(self.policy.as_deref().unwrap_or(&first_policy)) {
            let spec = PolicySpec::parse(policy, registry)
                .map_err(|error| Failure::input(format!("--policy: {error}")))?;
            spec.check_allowed(&scenario)?;
            let simulation = Simulation::new(&scenario, seed)
                .map_err(|error| Failure::input(format!("{}: {error}", file.display())))?;
            let bytes = recorded(
                simulation,
                &mut *session_of(&spec, &scenario, seed)?,
                &Options::new(&spec.label, spec.measure(registry)),
            )?;
            shown.push(Shown { name: file.display().to_string(), bytes });
        }
        Ok(())
    }

    fn open_folder(&self, folder: &Path, registry: &Registry, shown: &mut Vec<Shown>) -> Result<(), Failure> {
        let (experiment, _) = experiment_in(folder, registry)?;
        for key in self.keys(&experiment)? {
            let path = path_of(folder, &experiment, &key);
            let bytes = recording_of(folder, &experiment, &key)?;
            shown.push(Shown { name: path.display().to_string(), bytes });
        }
        Ok(())
    }

    /// The selected trials of a sweep.
    fn keys(&self, experiment: &Experiment) -> Result<Vec<TrialKey>, Failure> {
        let labels: Vec<&str> = experiment.policies.iter().map(|spec| spec.label.as_str()).collect();
        let asked = self.policy.as_deref().map_or_else(|| vec![labels[0]], split_list);
        let seed = self.seed.unwrap_or_else(|| experiment.seed(1));
        let find = |label: &str| {
            let mut keys = experiment.keys(None);
            keys.find(|key| key.case + 1 == self.case && key.seed == seed && key.label == label)
        };
        let found = asked.iter().map(|label| {
            find(label).ok_or_else(|| {
                let (last, cases) = (experiment.seed(experiment.trials), experiment.cases.len());
                Failure::input(format!(
                    "no trial of policy {label:?} with seed {seed} in case {}; the sweep has {}, seeds {} to \
                     {last}, {cases} cases",
                    self.case,
                    labels.join(", "),
                    experiment.seed(1),
                ))
            })
        });
        found.collect()
    }
}
