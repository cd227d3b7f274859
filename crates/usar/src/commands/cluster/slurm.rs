//! Slurm's commands: submitting jobs, and asking for their states.

use std::collections::BTreeMap;
use std::process::Command;

use experiments::Failure;

/// Slurm's default limit of the size of arrays.
const MAX_ARRAY_SIZE: usize = 1_001;

/// The output of a Slurm command; `None` if the command does not exist or failed.
fn said(command: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(command).args(arguments).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Largest number of tasks in an array. Their numbers must be below the site's `MaxArraySize`.
pub(super) fn most_tasks() -> usize {
    let config = said("scontrol", &["show", "config"]).unwrap_or_default();
    let line = config.lines().find_map(|line| line.trim().strip_prefix("MaxArraySize"));
    let size = line.and_then(|rest| rest.trim_start_matches([' ', '=']).trim().parse().ok());
    size.unwrap_or(MAX_ARRAY_SIZE).saturating_sub(1).max(1)
}

/// Submits a script; returns the number of the job.
///
/// # Errors
/// There is no `sbatch`, or it refuses the script.
pub(super) fn submit(arguments: &[&str]) -> Result<String, Failure> {
    let output = Command::new("sbatch").arg("--parsable").args(arguments).output().map_err(|error| {
        Failure::run(format!("sbatch: {error}; --dry-run prints the scripts without submitting them"))
    })?;
    if !output.status.success() {
        return Err(Failure::run(format!("sbatch: {}", String::from_utf8_lossy(&output.stderr).trim())));
    }
    let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    // The output is `123;cluster` at sites with several clusters.
    let job = text.split(';').next().unwrap_or_default().to_owned();
    if job.is_empty() { Err(Failure::run("sbatch: said no number of a job")) } else { Ok(job) }
}

/// States of tasks, each as Slurm's word for it, by number.
pub(super) type Tasks = BTreeMap<u32, String>;

/// The queued tasks of arrays with this name, by number; `None` if there is no queue.
pub(super) fn queued(array: &str, name: &str) -> Option<Tasks> {
    let all = ["--noheader", "--array", "--format=%F|%K|%T|%j"];
    let text = said("squeue", &all)?;
    let mut tasks = Tasks::new();
    for line in text.lines() {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        let [job, task, state, of] = cells[..] else { continue };
        // A resubmitted array has another number but the same name.
        if (job == array || of == name)
            && let Ok(task) = task.parse()
        {
            tasks.insert(task, state.to_owned());
        }
    }
    Some(tasks)
}

/// The final states of an array's tasks, by number; empty if Slurm keeps no accounts.
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
