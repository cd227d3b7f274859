//! `host.json`: the machines that ran a sweep, and when. It stands beside the manifest and is no part of the hashed
//! results, because it differs between two runs of the same sweep. It has what the STRESS guidelines for
//! reporting simulation studies ask for (Monks et al. 2019): hardware, system, compiler, threads and times.

use std::path::Path;

use serde::{Deserialize, Serialize};
use sysinfo::{
    CpuRefreshKind, DiskRefreshKind, Disks, MemoryRefreshKind, Pid, ProcessesToUpdate, RefreshKind, System,
};

use super::folder::Folder;
use crate::failure::Failure;
use crate::files::{self, NewFile};

/// Name of the file.
pub const FILE: &str = "host.json";
/// Version of its layout.
const SCHEMA_VERSION: u32 = 1;
/// Runs that are kept: the latest.
const MOST_RUNS: usize = 10_000;

/// The file: every run that added trials to the folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hosts {
    schema_version: u32,
    /// The runs, in the order of their beginnings.
    pub runs: Vec<HostRun>,
}

/// One run of the program that added trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HostRun {
    /// Name of the machine.
    pub host: String,
    /// Its processor.
    pub cpu: String,
    /// Its logical processors.
    pub cpus: usize,
    /// Its memory in GiB.
    pub memory_gib: f64,
    /// Its system.
    pub system: String,
    /// Its kernel.
    pub kernel: String,
    /// The compiler of the program.
    pub compiler: String,
    /// Threads that ran trials.
    pub threads: usize,
    /// The job, as Slurm names it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub job: Option<String>,
    /// Which part of the sweep it was.
    pub part: String,
    /// Trials that it added.
    pub trials: usize,
    /// When it began, in UTC.
    pub begun: String,
    /// How long it took, in seconds of wall-clock time.
    pub seconds: f64,
}

impl HostRun {
    /// A run on this machine, of the part of a sweep that a folder holds.
    #[must_use]
    pub fn new(folder: &Folder, threads: usize) -> Self {
        Self::of_part(folder.manifest().part(), threads)
    }

    /// A run on this machine, of a part in words.
    #[must_use]
    pub fn of_part(part: String, threads: usize) -> Self {
        let memory = MemoryRefreshKind::nothing().with_ram();
        let kind = RefreshKind::nothing().with_memory(memory).with_cpu(CpuRefreshKind::nothing());
        let system = System::new_with_specifics(kind).ok();
        let unknown = || "unknown".to_owned();
        let cpus = system.as_ref().map(System::cpus).unwrap_or_default();
        let memory = system.as_ref().map_or(0, System::total_memory);
        Self {
            host: name(),
            cpu: cpus.first().map_or_else(unknown, |cpu| cpu.brand().trim().to_owned()),
            cpus: cpus.len(),
            memory_gib: (memory as f64 / f64::from(1_u32 << 30) * 10.0).round() / 10.0,
            system: System::long_os_version().unwrap_or_else(|_| unknown()),
            kernel: System::kernel_version().unwrap_or_else(|_| unknown()),
            compiler: env!("USAR_COMPILER").to_owned(),
            threads,
            job: job(),
            part,
            trials: 0,
            begun: now(),
            seconds: 0.0,
        }
    }
}

impl Hosts {
    /// Those of a folder; none where there is no such file, or one that cannot be read.
    #[must_use]
    pub fn read(folder: &Path) -> Self {
        let text = files::read(&folder.join(FILE)).unwrap_or_default();
        let none = Self { schema_version: SCHEMA_VERSION, runs: Vec::new() };
        serde_json::from_slice(&text).unwrap_or(none)
    }

    /// Adds runs to the file of a folder.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add(folder: &Path, runs: impl IntoIterator<Item = HostRun>) -> Result<(), Failure> {
        let mut hosts = Self::read(folder);
        hosts.runs.extend(runs);
        hosts.runs.sort_by(|a, b| a.begun.cmp(&b.begun));
        hosts.runs.drain(..hosts.runs.len().saturating_sub(MOST_RUNS));
        let text = serde_json::to_string_pretty(&hosts).map_err(Failure::run)? + "\n";
        NewFile::write(folder, FILE, text.as_bytes()).map(drop)
    }
}

/// The name of this machine.
#[must_use]
pub fn name() -> String {
    System::host_name().unwrap_or_else(|_| "unknown".to_owned())
}

/// The job that this process is of, as Slurm names it: `42_3` is the third task of the array 42.
#[must_use]
pub fn job() -> Option<String> {
    let task = variable("SLURM_ARRAY_JOB_ID").zip(variable("SLURM_ARRAY_TASK_ID"));
    task.map(|(array, task)| format!("{array}_{task}")).or_else(|| variable("SLURM_JOB_ID"))
}

/// Bytes that are free for a user on the file system of a folder that is there; nothing where it cannot be told.
#[must_use]
pub fn free_bytes(folder: &Path) -> Option<u64> {
    let folder = folder.canonicalize().ok()?;
    let disks = Disks::new_with_refreshed_list_specifics(DiskRefreshKind::nothing().with_storage()).ok()?;
    let holds = disks.iter().filter(|disk| folder.starts_with(disk.mount_point()));
    let nearest = holds.max_by_key(|disk| disk.mount_point().components().count())?;
    Some(nearest.available_space())
}

/// A variable of the environment that is set.
pub(super) fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}

/// The time of day in UTC, to the second.
#[must_use]
pub fn now() -> String {
    let now = jiff::Timestamp::now();
    now.round(jiff::Unit::Second).unwrap_or(now).to_string()
}

/// Whether there is a process of this number on this machine.
pub(super) fn is_running(process: u32) -> bool {
    let process = Pid::from_u32(process);
    // Where it cannot be told, it is taken to be running.
    let Ok(mut system) = System::new() else { return true };
    system.refresh_processes(ProcessesToUpdate::Some(&[process]), true);
    system.process(process).is_some()
}
