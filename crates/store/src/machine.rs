//! This machine: its name, its job, its disks and its clock.

use std::path::Path;

use sysinfo::{DiskRefreshKind, Disks, System};

/// The name of this machine.
pub fn name() -> String {
    System::host_name().unwrap_or_else(|_| "unknown".to_owned())
}

/// The job of this process, in Slurm's notation: `42_3` is the third task of the array 42.
pub fn job() -> Option<String> {
    let task = variable("SLURM_ARRAY_JOB_ID").zip(variable("SLURM_ARRAY_TASK_ID"));
    task.map(|(array, task)| format!("{array}_{task}")).or_else(|| variable("SLURM_JOB_ID"))
}

/// Bytes that are free for a user on the file system of an existing folder; `None` if unknown.
pub fn free_bytes(folder: &Path) -> Option<u64> {
    let folder = folder.canonicalize().ok()?;
    let disks = Disks::new_with_refreshed_list_specifics(DiskRefreshKind::nothing().with_storage()).ok()?;
    let holds = disks.iter().filter(|disk| folder.starts_with(disk.mount_point()));
    let nearest = holds.max_by_key(|disk| disk.mount_point().components().count())?;
    Some(nearest.available_space())
}

/// The value of an environment variable; `None` if it is unset or empty.
pub(crate) fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}

/// The time of day in UTC, to the second.
pub fn now() -> String {
    let now = jiff::Timestamp::now();
    now.round(jiff::Unit::Second).unwrap_or(now).to_string()
}
