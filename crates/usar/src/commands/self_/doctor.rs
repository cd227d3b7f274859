//! `usar self doctor`: shows the program and the machine, and tests whether results can be written.

use experiments::provenance::COMMIT;
use experiments::sweep::host::{HostRun, free_bytes};
use serde::Serialize;

use crate::arguments::{JsonArgument, default_jobs};
use crate::builds::features;
use crate::prelude::*;

/// Number of bytes in the write test.
const TEST_BYTES: usize = 1 << 12;

/// Show version, machine and threads, and whether results can be written
#[derive(Debug, Args)]
#[command(after_help = "\
The write test leaves nothing behind. Where the folder does not exist yet, it tests the folder that it would \
be made in.

Exit status: 0 when results can be written, 3 when they cannot.

Examples:
  usar self doctor
  usar self doctor --out /scratch/me/results
  usar self doctor --json")]
pub(crate) struct Arguments {
    /// File or folder to write
    #[arg(long, default_value = "results")]
    out: PathBuf,
    #[command(flatten)]
    json: JsonArgument,
}

#[derive(Serialize)]
struct Findings {
    version: &'static str,
    commit: &'static str,
    compiler: String,
    features: String,
    system: String,
    kernel: String,
    cpu: String,
    logical_cpus: usize,
    threads: usize,
    memory_gib: f64,
    working_folder: PathBuf,
    results: Results,
}

/// Whether results can be written to a folder.
#[derive(Serialize)]
struct Results {
    folder: PathBuf,
    exists: bool,
    is_writable: bool,
    trouble: Option<String>,
    free_bytes: Option<u64>,
}

impl Results {
    fn of(folder: &Path) -> Self {
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        let there = folder.ancestors().find(|folder| folder.exists()).unwrap_or(&folder);
        let trouble = write_test(there).err().map(|error| format!("{}: {error}", there.display()));
        Self {
            exists: folder.exists(),
            is_writable: trouble.is_none(),
            trouble,
            free_bytes: free_bytes(there),
            folder,
        }
    }
}

/// Writes a temporary file and deletes it.
fn write_test(folder: &Path) -> std::io::Result<()> {
    let mut file = tempfile::Builder::new().prefix(".usar-doctor").tempfile_in(folder)?;
    file.write_all(&[0; TEST_BYTES])?;
    file.as_file().sync_all()?;
    file.close()
}

impl Findings {
    fn of(folder: &Path) -> Self {
        let host = HostRun::of_part(String::new(), default_jobs());
        Self {
            version: env!("CARGO_PKG_VERSION"),
            commit: COMMIT,
            compiler: host.compiler,
            features: features(),
            system: host.system,
            kernel: host.kernel,
            cpu: host.cpu,
            logical_cpus: host.cpus,
            threads: host.threads,
            memory_gib: host.memory_gib,
            working_folder: std::env::current_dir().unwrap_or_default(),
            results: Results::of(folder),
        }
    }

    fn told(&self) -> Report {
        let results = &self.results;
        let is = if results.exists { "exists" } else { "is made by the first sweep" };
        let can = if results.is_writable { "yes" } else { "no" };
        let trouble = results.trouble.as_ref();
        let gib = |bytes: u64| format!("{:.1} GiB", bytes as f64 / f64::from(1_u32 << 30));
        let lines = [
            ("program", format!("usar {}, commit {}", self.version, self.commit)),
            ("compiler", self.compiler.clone()),
            ("features", self.features.clone()),
            ("system", format!("{}, kernel {}", self.system, self.kernel)),
            ("processor", format!("{}, {} logical cores", self.cpu, self.logical_cpus)),
            ("threads", format!("{}; --jobs sets another number", self.threads)),
            ("memory", format!("{} GiB", self.memory_gib)),
            ("works in", self.working_folder.display().to_string()),
            ("results", format!("{}, which {is}", results.folder.display())),
            ("writable", trouble.map_or(can.to_owned(), |trouble| format!("{can}: {trouble}"))),
            ("free", results.free_bytes.map_or("unknown".to_owned(), gib)),
        ];
        Report::of(lines.map(|(what, told)| format!("{what:<10} {told}")))
    }
}

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry) -> Result<Report, Failure> {
        let findings = Findings::of(&self.out);
        let mut out = findings.told();
        out.rows("findings", [&findings])?;
        out.print()?;
        match findings.results.trouble {
            None => Ok(Report::default()),
            Some(trouble) => Err(Failure::storage(format!("results cannot be written: {trouble}"))),
        }
    }
}
