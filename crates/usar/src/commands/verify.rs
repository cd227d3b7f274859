//! `usar verify`: checks whether the numbers of a finished sweep are reproduced.

use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::Duration;

use experiments::experiment::{Experiment, PolicySpec, Program};
use experiments::provenance::{COMMIT, Manifest};
use experiments::run::{Run, TrialKey, run_all};
use experiments::sweep::audit::{difference, strange_files};
use experiments::sweep::folder::Folder;
use serde_json::json;
use teaming::Basis;

use crate::arguments::{JsonArgument, ProgressArguments, count};
#[cfg(feature = "exports")]
use crate::parquets::strange_parquets;
use crate::prelude::*;

/// Run a finished sweep again: do the numbers come out again?
#[derive(Debug, Args)]
#[command(after_help = "\
Compares every state, every number and every table. Exit status 0 only when every trial that was run again \
has the same hash chain and the same line in the journal, byte for byte, and every table is what the \
journal gives. Otherwise the first trial, step and part of the state that differ are named (bodies, robots, \
debris, rescuees, beliefs, mission, routes, resolver or events), or the number, or the file.

A policy that is a program is asked again only if this user has allowed its command. Its trials are left out \
otherwise, and the exit status is 1, or 0 with --without-programs.

Examples:
  usar verify results/paper
  usar verify results/paper --sample 10
  usar verify results/mine --without-programs")]
pub(crate) struct Arguments {
    /// Folder of a finished sweep
    folder: PathBuf,
    /// Run only this many trials, spread evenly over the sweep
    #[arg(long, value_parser = count(1..))]
    sample: Option<u32>,
    /// Leave out the trials of policies that are programs
    #[arg(long, conflicts_with = "run_programs")]
    pub(super) without_programs: bool,
    #[command(flatten)]
    progress: ProgressArguments,
    #[command(flatten)]
    json: JsonArgument,
}

/// Time limit of a trial.
const LONGEST_TRIAL: Duration = Duration::from_hours(1);

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let (mut folder, damage) = Folder::read_damaged(&self.folder, registry)?;
        let (experiment, manifest) = (folder.shared_experiment(), folder.manifest().clone());
        let all: Vec<TrialKey> = experiment.keys(manifest.shard).collect();
        if !manifest.is_complete {
            refuse!(
                "{}: its sweep is not finished: it has {} of {} trials; the sweep's command goes on with it",
                self.folder.display(),
                folder.results().len(),
                all.len()
            );
        }
        damage.iter().for_each(tell);
        let of_programs = self.not_allowed(&experiment);
        let (left_out, rest) =
            all.iter().cloned().partition(|key: &TrialKey| of_programs.contains(&key.policy));
        let left_out: Vec<TrialKey> = left_out;
        let chosen = self.choose(&self.repeatable(&experiment, rest));
        if chosen.is_empty() && left_out.is_empty() && !all.is_empty() {
            return Err(Failure::run("no trial can be verified: no policy of it can be asked again"));
        }
        let count = chosen.len();
        self.mention_other_program(&experiment, &manifest, &of_programs)?;
        let mut differences = self.run_again(&mut folder, chosen)?;
        differences.sort();
        let strange = strange_files(&mut folder)?;
        #[cfg(feature = "exports")]
        let strange = [strange, strange_parquets(&folder)?].concat();
        let row = |(key, what): &(TrialKey, String)| {
            let (case, policy, seed) = (key.case + 1, &key.label, key.seed);
            json!({"case": case, "policy": policy, "seed": seed, "difference": what})
        };
        let mut out = Report::default();
        out.rows("differences", &differences.iter().map(row).collect::<Vec<_>>())?;
        out.rows("changed_files", &strange.iter().map(|what| json!({"what": what})).collect::<Vec<_>>())?;
        out.rows("trials", [&json!({"all": all.len(), "run_again": count, "of_programs": left_out.len()})])?;
        let of_all = if count < all.len() { format!(" (of {})", all.len()) } else { String::new() };
        let verdict = match differences.first() {
            None => format!("{count} of {count} trials{of_all} match, step by step and number by number"),
            Some((_, first)) => {
                format!("{} of {count} trials{of_all} do not match\n{first}", differences.len())
            }
        };
        let is_sound = differences.is_empty() && damage.is_none() && strange.is_empty();
        if is_sound && !left_out.is_empty() {
            let verdict = format!(
                "nothing wrong in {count} of {}; {} of programs, not run",
                counted(all.len(), "trial"),
                if left_out.len() == 1 { "1 is".to_owned() } else { format!("{} are", left_out.len()) }
            );
            if self.without_programs {
                out.say(verdict);
                return Ok(out);
            }
            out.print()?;
            return Err(Failure::run(format!(
                "{verdict}: --run-programs starts them, --without-programs leaves them out"
            )));
        }
        if is_sound {
            out.say(format!("{verdict}; every table is what they give"));
            return Ok(out);
        }
        out.print()?;
        Err(Failure::run(if strange.is_empty() {
            verdict
        } else {
            format!("{verdict}; but files were changed\n{}", strange.join("\n"))
        }))
    }

    /// Runs trials again; returns those that differ from the folder's, with the difference.
    fn run_again(
        &self,
        folder: &mut Folder,
        chosen: Vec<TrialKey>,
    ) -> Result<Vec<(TrialKey, String)>, Failure> {
        let bar = self.progress.bar(chosen.len(), "trials");
        let experiment = folder.shared_experiment();
        let run: Arc<Run> = Arc::new(move |key, sessions, halt| experiment.run_alone(key, sessions, halt));
        let mut differences = Vec::new();
        let limits = self.progress.limits(Some(LONGEST_TRIAL));
        let is_whole = run_all(chosen, limits, run, &STOP, |outcome| {
            bar.inc(1);
            differences.extend(difference(folder, &outcome)?.map(|what| (outcome.key, what)));
            Ok(())
        })?;
        bar.finish_and_clear();
        if is_whole {
            Ok(differences)
        } else {
            Err(Failure::Interrupted("stopped; nothing was written".into()))
        }
    }

    /// The policies that are programs, and that this user does not want to be started.
    fn not_allowed(&self, experiment: &Experiment) -> BTreeSet<usize> {
        let is_out = |policy: &PolicySpec| {
            let it = &policy.made().it;
            it.program().filter(|_| self.without_programs || it.permission().is_err())
        };
        let mut out = BTreeSet::new();
        for (number, policy) in experiment.policies.iter().enumerate() {
            let Some(command) = is_out(policy) else { continue };
            self.progress
                .tell(format_args!("note: policy {} is a program, not run: {command}", policy.label));
            out.insert(number);
        }
        out
    }

    /// Leaves out the trials of policies that cannot be asked again: they may answer the same question in
    /// another way, or this program does not have them.
    fn repeatable(&self, experiment: &Experiment, mut keys: Vec<TrialKey>) -> Vec<TrialKey> {
        for (number, policy) in experiment.policies.iter().enumerate() {
            if !keys.iter().any(|key| key.policy == number) {
                continue;
            }
            let why = match policy.made().it.basis() {
                Basis::Question | Basis::Trial => continue,
                Basis::Undetermined => "its answers may differ",
                Basis::Absent => "this program does not have it",
            };
            let before = keys.len();
            keys.retain(|key| key.policy != number);
            self.progress.tell(format_args!(
                "note: {} of policy {} are not run again: {why}",
                counted(before - keys.len(), "trial"),
                policy.label
            ));
        }
        keys
    }

    fn choose(&self, all: &[TrialKey]) -> Vec<TrialKey> {
        let count = self.sample.map_or(all.len(), |sample| (sample as usize).min(all.len()));
        (0..count).map(|i| all[i * all.len() / count].clone()).collect()
    }

    /// Notes that another program made the results, or that a policy has changed since. Identical numbers are
    /// guaranteed only for the same program.
    fn mention_other_program(
        &self,
        experiment: &Experiment,
        manifest: &Manifest,
        left_out: &BTreeSet<usize>,
    ) -> Result<(), Failure> {
        let (this, that) = (Program::running(&experiment.policies)?, manifest.program());
        if that.bits == this.bits {
            let pairs = that.policies.iter().zip(&this.policies).zip(&experiment.policies).enumerate();
            let differ = |(number, ((there, now), _)): &(usize, ((&String, &String), _))| {
                there != now && !left_out.contains(number)
            };
            for (_, (_, policy)) in pairs.filter(differ) {
                self.progress.tell(format_args!("note: policy {} has changed since the sweep", policy.label));
            }
        } else {
            self.progress.tell(format_args!(
                "note: trials of bits {}; the program has {} ({}; this is {COMMIT})",
                that.bits, this.bits, manifest.commit
            ));
        }
        Ok(())
    }
}
