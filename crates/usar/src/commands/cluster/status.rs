//! `usar cluster status`: shows the progress of a sharded sweep, and how to resume its missing shards.

mod shards;

use std::cmp::Reverse;

use experiments::experiment::Shard;
use experiments::sweep::disk::manifest_in;
use experiments::sweep::names::{is_sweeps, sweeps_in};
use experiments::sweep::shards::Shards;
use serde::Serialize;

use super::estimate::duration;
use super::slurm;
use super::submit::{LOGS, Submission, line, quoted};
use crate::arguments::JsonArgument;
use crate::prelude::*;
use shards::{OneShard, Said, State, ranges, seconds_each};

/// Largest number of shards that are listed one by one.
const MOST_LISTED: usize = 20;

/// Progress of a sharded sweep, and the command that resubmits what is missing
#[derive(Debug, Args)]
#[command(after_help = "\
Looks at the folder of each shard (its manifest, its journal and its lock) and, where there are `squeue` \
and `sacct`, asks Slurm. A shard is done; running; waiting in the queue; failed, with what Slurm says of \
its task; lost: nothing is at work in it and no queue has it; or refused: its folder is damaged or holds \
something else, and the line says what `usar cluster merge` would. For a folder that `usar cluster submit` \
made, the last line submits what is failed or lost, and nothing else; each of these goes on where it was.

Examples:
  usar cluster status results/energy-shards        a folder of `usar cluster submit`, or of shards
  usar cluster status results/energy               one sweep or shard
  usar cluster status results/energy-shards --json")]
pub(crate) struct Arguments {
    /// Folder of shards, or of one
    folder: PathBuf,
    #[command(flatten)]
    json: JsonArgument,
}

#[derive(Serialize)]
struct Output {
    shards: Vec<OneShard>,
    finished: usize,
    trials: usize,
    /// Estimated time left, if the number of running shards stays the same.
    seconds_left: Option<f64>,
    /// The command that submits the missing shards.
    submit: Option<String>,
    /// The command that merges the shards, if all are done and the merged folder is not beside them.
    merge: Option<String>,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let output = match Submission::read(&self.folder)? {
            Some(submission) => submitted(&std::path::absolute(&self.folder)?, &submission, registry)?,
            None => by_hand(&self.folder, registry)?,
        };
        if self.json.json {
            return print_json(&output);
        }
        output.print(out)
    }
}

/// The state of the shards of a submission: of the shards that its plan names, and of no other folder.
fn submitted(folder: &Path, submission: &Submission, registry: &Registry) -> Result<Output, Failure> {
    let Submission { array, plan, name, out, .. } = submission;
    let array = array.as_deref().unwrap_or_default();
    let said = Said { queued: slurm::queued(array, name), ended: slurm::ended(array) };
    let of = plan.shards() as u32;
    let place = |number: u32| folder.join(number.to_string());
    // The first folder that is what its name says tells which sweep it is.
    let is_planned = |number: &u32| {
        let planned = Some(Shard { number: *number, of });
        manifest_in(&place(*number)).is_ok_and(|there| there.name == *name && there.shard == planned)
    };
    let first = (1..=of).find(is_planned);
    let sweep = first.map(|number| Shards::like(&place(number), registry)).transpose()?;
    let shard = |(number, trials): (u32, &usize)| match &sweep {
        Some(sweep) if is_sweeps(&place(number)) => {
            OneShard::of(sweep, Some(Shard { number, of }), place(number), *trials, &said)
        }
        None if is_sweeps(&place(number)) => {
            let rule = "is not a shard of this submission";
            let refusal = Failure::input(format!("{}: {rule}", place(number).display()));
            OneShard::refused(number, &refusal, *trials, place(number))
        }
        _ => OneShard::not_begun(number, place(number), *trials, &said),
    };
    let shards = (1..).zip(&plan.trials).map(shard).collect();
    let mut output = Output::of(shards, plan.at_once, plan.seconds_per_trial / f64::from(plan.cpus));
    let missing: Vec<u32> = output.missing().map(|shard| shard.number).collect();
    let tasks = format!("{}%{}", ranges(&missing), plan.at_once);
    let is_under_way = |shard: &OneShard| matches!(shard.state, State::Running | State::Waiting);
    let other = output.shards.iter().any(is_under_way).then_some(array);
    output.submit = (!missing.is_empty()).then(|| line(folder, Some(&tasks), other));
    output.merge = merge_line(&output.shards, folder, out);
    Ok(output)
}

/// The state of shards that were run without `usar cluster submit`, or of a single sweep. The first folder
/// tells which sweep it is, and how many shards it has.
fn by_hand(folder: &Path, registry: &Registry) -> Result<Output, Failure> {
    let is_one = is_sweeps(folder);
    let folders = if is_one { vec![folder.to_owned()] } else { sweeps_in(folder) };
    let [first, ..] = &folders[..] else {
        refuse!("{}: has neither shards nor a sweep in it", folder.display());
    };
    let sweep = Shards::like(first, registry)?;
    let (experiment, is_checked) = (sweep.experiment(), sweep.manifest().is_checked);
    let said = Said { queued: None, ended: slurm::Tasks::new() };
    let of = sweep.manifest().shard.map(|shard| shard.of);
    let one = |place: &PathBuf| {
        let shard = match of_plan(place, first, of) {
            Ok(shard) => shard,
            Err(refusal) => return OneShard::refused(0, &refusal, 0, place.clone()),
        };
        let mut one = OneShard::of(&sweep, shard, place.clone(), experiment.count(shard), &said);
        if one.state == State::Lost
            && let Some(shard) = shard
        {
            let command = one.command(&one.folder, is_checked, shard);
            one.why = format!("nothing is at work in its folder; to go on: {command}");
        }
        one
    };
    let mut shards = each_once(folders.iter().map(one).collect());
    if let Some(of) = of.filter(|_| !is_one) {
        let is_there = |number: &u32| shards.iter().any(|shard| shard.number == *number);
        let absent: Vec<u32> = (1..=of).filter(|number| !is_there(number)).collect();
        shards.extend(absent.into_iter().map(|number| {
            let shard = Shard { number, of };
            let trials = experiment.count(Some(shard));
            OneShard::absent(shard, folder.join(number.to_string()), trials, first, is_checked)
        }));
        shards.sort_by_key(|shard| shard.number);
    }
    let whole = (!is_one).then(|| whole_of(folder));
    Ok(Output {
        merge: whole.and_then(|whole| merge_line(&shards, folder, &whole)),
        ..Output::of(shards, 1, 0.0)
    })
}

/// The shards by number, each counted once: the folder that is the furthest counts. Other folders with the same
/// shard are left out, and those that are refused stay, without trials.
fn each_once(mut shards: Vec<OneShard>) -> Vec<OneShard> {
    shards.sort_by_key(|shard| (shard.number, shard.state == State::Refused, Reverse(shard.finished)));
    let mut last = None;
    shards.retain_mut(|shard| {
        let is_first = last.replace(shard.number) != Some(shard.number);
        let is_refused = shard.state == State::Refused;
        if is_refused && !is_first {
            shard.trials = 0;
        }
        is_first || is_refused
    });
    shards
}

/// The number of the shard in a folder, if it is one of as many as the first is.
fn of_plan(place: &Path, first: &Path, of: Option<u32>) -> Result<Option<Shard>, Failure> {
    let there = manifest_in(place)?;
    if there.shard.map(|shard| shard.of) != of {
        let (place, first, part) = (place.display(), first.display(), there.part());
        let plan = of.map_or_else(
            || "a whole sweep".to_owned(),
            |of| format!("one of {}", counted(of as usize, "shard")),
        );
        refuse!("{place}: is {part}, and {first} is {plan}");
    }
    Ok(there.shard)
}

/// The folder that the shards of a folder are merged into: `results/x` for `results/x-shards`.
fn whole_of(folder: &Path) -> PathBuf {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    if name.is_empty() {
        return folder.join("../merged"); // `.` or `..`
    }
    folder.with_file_name(name.strip_suffix("-shards").map_or(format!("{name}-merged"), str::to_owned))
}

/// The command that merges the shards, if all are done and the merged folder is not there.
fn merge_line(shards: &[OneShard], folder: &Path, whole: &Path) -> Option<String> {
    let is_due = shards.iter().all(|shard| shard.state == State::Done) && !whole.exists();
    is_due.then(|| format!("usar cluster merge {} --out {}", shown(folder), shown(whole)))
}

/// A path as it is typed in a shell.
fn shown(path: &Path) -> String {
    quoted(&path.display().to_string())
}

impl Output {
    fn of(shards: Vec<OneShard>, at_once: u32, estimated: f64) -> Self {
        let sum = |value: fn(&OneShard) -> usize| shards.iter().map(value).sum::<usize>();
        let (finished, trials) = (sum(|shard| shard.finished), sum(|shard| shard.trials));
        let each = seconds_each(shards.iter().map(|shard| &shard.folder)).unwrap_or(estimated);
        let running = shards.iter().filter(|shard| shard.state == State::Running).count();
        let open = shards.iter().filter(|shard| shard.state != State::Done).count();
        let at_a_time = if running > 0 { running } else { at_once as usize }.min(open).max(1);
        let seconds_left = each * (trials - finished) as f64 / at_a_time as f64;
        let seconds_left = (each > 0.0).then_some(seconds_left);
        Self { shards, finished, trials, seconds_left, submit: None, merge: None }
    }

    /// The shards that no process or queued task will finish.
    fn missing(&self) -> impl Iterator<Item = &OneShard> {
        self.shards.iter().filter(|shard| matches!(shard.state, State::Failed | State::Lost))
    }

    fn print(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let of = |state: State| self.shards.iter().filter(|shard| shard.state == state).count();
        let counts = State::ALL.into_iter().map(|state| (state, of(state))).filter(|(_, count)| *count > 0);
        let counts: Vec<String> = counts.map(|(state, count)| format!("{count} {}", state.name())).collect();
        writeln!(out, "shards  {}: {}", self.shards.len(), counts.join(", "))?;
        writeln!(out, "trials  {} of {}", self.finished, self.trials)?;
        if let Some(seconds) = self.seconds_left.filter(|_| self.finished < self.trials) {
            writeln!(out, "time    about {} left", duration(seconds))?;
        }
        let open: Vec<&OneShard> = self.shards.iter().filter(|shard| shard.state != State::Done).collect();
        for shard in open.iter().take(MOST_LISTED) {
            let OneShard { number, state, why, finished, trials, .. } = shard;
            let number = if *number == 0 { "-".to_owned() } else { number.to_string() };
            writeln!(out, "  shard {number:>4}  {:8} {finished} of {trials} trials  {why}", state.name())?;
        }
        if open.len() > MOST_LISTED {
            writeln!(out, "  ... and {} more: --json has all", open.len() - MOST_LISTED)?;
        }
        if let Some(line) = &self.merge {
            writeln!(out, "all shards are done; this merges them:\n{line}")?;
        }
        if let Some(line) = &self.submit {
            writeln!(
                out,
                "what the jobs printed is in {LOGS}/; this submits what is missing, and the merge:\n{line}"
            )?;
        }
        Ok(())
    }
}
