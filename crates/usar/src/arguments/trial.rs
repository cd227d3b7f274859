//! The trials that a command looks at: of a scenario, of a sweep's folder, or recorded.

use experiments::experiment::{Experiment, PolicySpec, check_cost, defaults, split_list, with_settings};
use experiments::limits::RECORDING_BYTES;
use experiments::metric::task_names;
use experiments::run::TrialKey;
use experiments::sweep::disk::experiment_in;
use recording::{Options, Recording};
use ron_tree::file::{read, read_start};
use scenario::Scenario;
use teaming::Session;
use usar_sim::simulation::Simulation;

use super::{CaseArgument, SetArguments, one_seed, parse_policy};
use crate::prelude::*;
use crate::recordings::{Shown, path_of, recorded, recording_of, replay_of};

/// The first bytes of a recording.
const MAGIC: &[u8] = b"USREC";

/// Which trial of a scenario or of a sweep.
#[derive(Debug, Args)]
pub(crate) struct TrialArguments {
    /// Policy that decides, with its options in brackets [default: the first of the sweep]
    #[arg(long)]
    pub(crate) policy: Option<String>,
    /// Seed of the trial, or of what is generated [default: the first of the sweep]
    #[arg(long, value_parser = one_seed)]
    seed: Option<u64>,
    #[command(flatten)]
    pub(crate) case: CaseArgument,
    #[command(flatten)]
    set: SetArguments,
    /// Simulate even if it takes very long: more bodies x steps than docs/limits.md has
    #[arg(long, hide_short_help = true)]
    allow_expensive: bool,
}

/// A trial, defined by everything that decides its numbers.
pub(crate) struct Trial {
    /// The scenario file or the folder that was named.
    pub(crate) file: PathBuf,
    pub(crate) scenario: Scenario,
    /// The policy that decides in it.
    pub(crate) spec: PolicySpec,
    pub(crate) seed: u64,
    /// The policies of the sweep to which the trial belongs; empty for a scenario.
    pub(crate) policies: Vec<PolicySpec>,
    /// The policies that there are.
    pub(crate) registry: Registry,
}

/// What a file has trials of: a scenario, and the sweep to which it belongs.
struct Source {
    scenario: Scenario,
    experiment: Option<Experiment>,
    first_policy: String,
    first_seed: u64,
}

impl TrialArguments {
    fn source(&self, file: &Path, registry: &Registry) -> Result<Source, Failure> {
        if !file.is_dir() {
            let scenario = self.set.load(file)?;
            check_cost(&scenario, self.allow_expensive)?;
            let (first_policy, first_seed) = defaults(file)?;
            return Ok(Source { scenario, experiment: None, first_policy, first_seed });
        }
        let (experiment, _) = experiment_in(file, registry)?;
        let case = self.case.index(&experiment)?;
        Ok(Source {
            scenario: with_settings(&experiment.cases[case].scenario, &self.set.set)?,
            first_policy: experiment.policies[0].label.clone(),
            first_seed: experiment.seed(1),
            experiment: Some(experiment),
        })
    }

    fn trial(
        &self,
        file: &Path,
        source: &Source,
        policy: &str,
        registry: &Registry,
    ) -> Result<Trial, Failure> {
        let of_sweep = source.experiment.as_ref();
        let policies = of_sweep.map_or_else(Vec::new, |experiment| experiment.policies.clone());
        let labelled = policies.iter().find(|spec| spec.label == policy).cloned();
        let spec = labelled.map_or_else(|| parse_policy("--policy", policy, registry), Ok)?;
        spec.check_allowed(&source.scenario)?;
        Ok(Trial {
            file: file.to_owned(),
            scenario: source.scenario.clone(),
            spec,
            seed: self.seed.unwrap_or(source.first_seed),
            policies,
            registry: of_sweep.map_or(registry, |experiment| &experiment.registry).clone(),
        })
    }

    /// The one trial that is meant. Without `--policy`, the policy `otherwise` decides, or the first one.
    pub(crate) fn open(
        &self,
        file: &Path,
        otherwise: Option<&str>,
        registry: &Registry,
    ) -> Result<Trial, Failure> {
        let source = self.source(file, registry)?;
        let policy = self.policy.as_deref().or(otherwise).unwrap_or(&source.first_policy);
        let trial = self.trial(file, &source, policy, registry)?;
        for doubt in trial.spec.doubts(&trial.scenario) {
            tell(format_args!("note: {}: {doubt}", file.display()));
        }
        Ok(trial)
    }

    /// The same, where another decision is to be tried. A candidate of a calibration is refused: before it is
    /// chosen, no other policy may decide in it.
    pub(crate) fn open_to_all(&self, file: &Path, registry: &Registry) -> Result<Trial, Failure> {
        let trial = self.open(file, None, registry)?;
        let (only_policy, name) = (&trial.scenario.only_policy, &trial.scenario.name);
        if only_policy.is_empty() {
            return Ok(trial);
        }
        let rule = format!("only_policy allows {only_policy} alone: no decision can be tried otherwise");
        Err(Failure::input(format!("{name}: {rule}")))
    }

    /// Recordings of the trials that are meant, file by file. `--policy` can be a list here.
    pub(crate) fn recordings(&self, files: &[PathBuf], registry: &Registry) -> Result<Vec<Shown>, Failure> {
        let of = |file: &PathBuf| self.recordings_of(file, registry);
        let shown = files.iter().map(of).collect::<Result<Vec<_>, _>>()?;
        Ok(shown.into_iter().flatten().collect())
    }

    /// Recordings of many trials of a sweep, seed by seed.
    pub(crate) fn replays(&self, files: &[PathBuf], registry: &Registry) -> Result<Vec<Shown>, Failure> {
        let [folder] = files else {
            refuse!("--with-replays: takes one folder, found {} files", files.len())
        };
        if !folder.is_dir() {
            refuse!(
                "--with-replays: {} is no folder of a sweep. The page of a file has its recording in it \
                 without this option",
                folder.display()
            );
        }
        let (experiment, _) = experiment_in(folder, registry)?;
        let mut keys = self.replayed(folder, &experiment)?;
        keys.sort_by_key(|key| (key.seed, key.policy));
        keys.iter().map(|key| replay_of(folder, &experiment, key)).collect()
    }

    /// The trials that have recordings, or those with the first seed if none has.
    fn replayed(&self, folder: &Path, experiment: &Experiment) -> Result<Vec<TrialKey>, Failure> {
        let case = self.case.index(experiment)?;
        let labels: Option<Vec<&str>> = self.policy.as_deref().map(split_list);
        let has_label = |key: &TrialKey| labels.as_ref().is_none_or(|all| all.contains(&key.label.as_str()));
        let mut keys: Vec<TrialKey> =
            experiment.keys(None).filter(|key| key.case == case && has_label(key)).collect();
        let is_recorded = |key: &TrialKey| path_of(folder, experiment, key).exists();
        let first = || (!keys.iter().any(is_recorded)).then(|| experiment.seed(1));
        match self.seed.or_else(first) {
            Some(seed) => keys.retain(|key| key.seed == seed),
            None => keys.retain(is_recorded),
        }
        if keys.is_empty() {
            refuse!("--with-replays: the sweep has no trial with this policy and seed");
        }
        Ok(keys)
    }

    /// The recording of the one trial that is meant.
    pub(crate) fn recording(&self, file: &Path, registry: &Registry) -> Result<Recording, Failure> {
        if self.policy.as_deref().is_some_and(|policy| split_list(policy).len() != 1) {
            refuse!("--policy: must be one policy here");
        }
        let shown = self.recordings_of(file, registry)?;
        let recording = shown.first().map(Shown::read).transpose()?;
        let recording = recording.filter(|recording| recording.frames() > 0);
        recording.ok_or_else(|| Failure::input(format!("{}: has no frames", file.display())))
    }

    fn recordings_of(&self, file: &Path, registry: &Registry) -> Result<Vec<Shown>, Failure> {
        if file.is_file() {
            let unreadable = |error| Failure::input(format!("{}: {error}", file.display()));
            let most = RECORDING_BYTES.most as u64;
            let (start, _) = read_start(file, MAGIC.len() as u64, most).map_err(unreadable)?;
            if start == MAGIC {
                let bytes = read(file, most).map_err(unreadable)?;
                return Ok(vec![Shown { name: file.display().to_string(), bytes }]);
            }
        }
        let source = self.source(file, registry)?;
        let policies = split_list(self.policy.as_deref().unwrap_or(&source.first_policy));
        let show = |policy: &str| {
            let trial = self.trial(file, &source, policy, registry)?;
            let of_sweep = source.experiment.as_ref().filter(|_| self.set.set.is_empty());
            let of_sweep =
                of_sweep.map(|experiment| Ok::<_, Failure>((experiment, self.case.index(experiment)?)));
            if let Some((experiment, case)) = of_sweep.transpose()? {
                let is_it = |key: &TrialKey| {
                    (key.case, key.seed, &key.label) == (case, trial.seed, &trial.spec.label)
                };
                if let Some(key) = experiment.keys(None).find(is_it) {
                    return recording_of(file, experiment, &key);
                }
            }
            trial.recorded()
        };
        policies.into_iter().map(show).collect()
    }
}

impl Trial {
    /// The trial before its first step.
    pub(crate) fn begin(&self) -> Result<Simulation, Failure> {
        let Self { file, scenario, seed, .. } = self;
        Simulation::new(scenario, *seed)
            .map_err(|error| Failure::input(format!("{}: seed {seed}: {error}", file.display())))
    }

    /// A session of the policy that decides, at the beginning of the trial.
    pub(crate) fn session(&self) -> Result<Box<dyn Session>, Failure> {
        session_of(&self.spec, &self.scenario, self.seed)
    }

    /// Names of the tasks.
    pub(crate) fn tasks(&self) -> Vec<String> {
        task_names(&self.scenario)
    }

    /// A recording of the trial, which is simulated for it.
    fn recorded(&self) -> Result<Shown, Failure> {
        let options = Options::new(&self.spec.label, self.spec.measure(&self.registry));
        let bytes = recorded(self.begin()?, &mut *self.session()?, &options)?;
        Ok(Shown { name: self.file.display().to_string(), bytes })
    }
}
