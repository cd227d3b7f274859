//! Slurm's commands: submitting, and what it says of jobs.

use std::collections::BTreeMap;
use std::process::Command;

use experiments::Failure;

/// The size of arrays that Slurm has where a site says nothing else.
const MAX_ARRAY_SIZE: usize = 1_001;

/// What a command of Slurm printed; nothing where there is no such command, or it failed.
fn said(command: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(command).args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The most tasks of an array: their numbers are below the site's `MaxArraySize`.
pub(super) fn most_tasks() -> usize {
    let config = said("scontrol", &["show", "config"]).unwrap_or_default();
    let line = config.lines().find_map(|line| line.trim().strip_prefix("MaxArraySize"));
    let size = line.and_then(|rest| rest.trim_start_matches([' ', '=']).trim().parse().ok());
    size.unwrap_or(MAX_ARRAY_SIZE).saturating_sub(1).max(1)
}

/// Submits a script; returns the number of the job.
///
/// # Errors
/// There is no `sbatch`, or it refuses.
pub(super) fn submit(arguments: &[&str]) -> Result<String, Failure> {
    let output = Command::new("sbatch").arg("--parsable").args(arguments).output().map_err(|error| {
        Failure::run(format!("sbatch: {error}; --dry-run prints the scripts without submitting them"))
    })?;
    if !output.status.success() {
        return Err(Failure::run(format!("sbatch: {}", String::from_utf8_lossy(&output.stderr).trim())));
    }
    let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    // `123;cluster` where there are several clusters.
    let job = text.split(';').next().unwrap_or_default().to_owned();
    if job.is_empty() { Err(Failure::run("sbatch: said no number of a job")) } else { Ok(job) }
}

/// What Slurm says of a task: its state in one word.
pub(super) type Tasks = BTreeMap<u32, String>;

/// The tasks of arrays of this name in the queue, by number; `None` where there is no queue to ask.
pub(super) fn queued(array: &str, name: &str) -> Option<Tasks> {
    let all = ["--noheader", "--array", "--format=%F|%K|%T|%j"];
    let text = said("squeue", &all)?;
    let mut tasks = Tasks::new();
    for line in text.lines() {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [job, task, state, of] = cells[..] else { continue };
        // What was submitted again has another number, and the same name.
        if (job == array || of == name)
            && let Ok(task) = task.parse()
        {
            tasks.insert(task, state.to_owned());
        }
    }
    Some(tasks)
}

/// How the tasks of an array ended, by number, where accounts are kept.
pub(super) fn ended(array: &str) -> Tasks {
    let arguments = ["--noheader", "--parsable2", "--allocations", "--format=JobID,State", "--jobs", array];
    let text = said("sacct", &arguments).unwrap_or_default();
    let task = |line: &str| {
        let (job, state) = line.split_once('|')?;
        let (_, task) = job.split_once('_')?;
        let state = state.split_whitespace().next()?; // `CANCELLED by 1000`
        Some((task.parse().ok()?, state.to_owned()))
    };
    text.lines().filter_map(task).collect()
}
