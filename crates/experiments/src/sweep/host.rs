//! `host.json`: the machines that ran a sweep, and the times of the runs. It lies beside the manifest and
//! is not part of the hashed results, because it differs between two runs of the same sweep. It holds what
//! the STRESS guidelines for reporting simulation studies ask for (Monks et al. 2019): hardware, system,
//! compiler, threads and times.

use std::path::Path;

use serde::{Deserialize, Serialize};
use store::Failure;
use store::files::{self, NewFile};
pub use store::machine::free_bytes;
use store::machine::{job, name, now};
use sysinfo::{CpuRefreshKind, MemoryRefreshKind, RefreshKind, System};

/// Name of the file.
pub const FILE: &str = "host.json";
/// Version of the file's layout.
const SCHEMA_VERSION: u32 = 1;
/// Largest number of runs that are kept; older ones are dropped.
const MOST_RUNS: usize = 10_000;

/// The content of the file: every run that added trials to the folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hosts {
    schema_version: u32,
    /// The runs, in the order of their starts.
    pub runs: Vec<HostRun>,
    /// What stopping rules said in the end, if trials were added by such rules.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rules: Vec<String>,
}

/// One run of the program that added trials.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HostRun {
    /// Name of the machine.
    pub host: String,
    /// Processor of the machine.
    pub cpu: String,
    /// Number of its logical processors.
    pub cpus: usize,
    /// Memory in GiB.
    pub memory_gib: f64,
    /// Operating system.
    pub system: String,
    /// Kernel of the operating system.
    pub kernel: String,
    /// The compiler that built the program.
    pub compiler: String,
    /// Number of threads that ran trials.
    pub threads: usize,
    /// The job, in Slurm's notation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub job: Option<String>,
    /// Which part of the sweep it ran.
    pub part: String,
    /// Number of trials that it added.
    pub trials: usize,
    /// Start time, in UTC.
    pub begun: String,
    /// Duration, in seconds of wall-clock time.
    pub seconds: f64,
}

impl HostRun {
    /// A run on this machine, for a part in words.
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
    /// The runs of a folder; empty if there is no such file or it cannot be read.
    pub fn read(folder: &Path) -> Self {
        let text = files::read(&folder.join(FILE)).unwrap_or_default();
        let none = Self { schema_version: SCHEMA_VERSION, runs: Vec::new(), rules: Vec::new() };
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
        hosts.write(folder)
    }

    /// Notes what a stopping rule says of the trials in a folder, once.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn note_rule(folder: &Path, rule: String) -> Result<(), Failure> {
        let mut hosts = Self::read(folder);
        if hosts.rules.contains(&rule) {
            return Ok(());
        }
        hosts.rules.push(rule);
        hosts.write(folder)
    }

    fn write(&self, folder: &Path) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(self).map_err(Failure::run)? + "\n";
        NewFile::write(folder, FILE, text.as_bytes()).map(drop)
    }
}
