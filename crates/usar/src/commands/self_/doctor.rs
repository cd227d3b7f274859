//! `usar self doctor`: shows the program and the machine, and tests whether results can be written.

use experiments::provenance::COMMIT;
use experiments::sweep::host::{HostRun, free_bytes};
use serde::Serialize;

use crate::arguments::{JsonArgument, default_jobs};
use crate::builds::features;
use crate::prelude::*;

/// Number of bytes in the write test.
const TEST_BYTES: usize = 1 << 12;

const GIB: f64 = 1_073_741_824.0;

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

/// Writes a temporary file and deletes it.
fn write_test(folder: &Path) -> std::io::Result<()> {
    let mut file = tempfile::Builder::new().prefix(".usar-doctor").tempfile_in(folder)?;
    file.write_all(&[0; TEST_BYTES])?;
    file.as_file().sync_all()?;
    file.close()
}

/// What is found, each with its words and its value, and why results cannot be written.
fn findings(folder: &Path) -> (Table, Option<String>) {
    let host = HostRun::of_part(String::new(), default_jobs());
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let there = folder.ancestors().find(|folder| folder.exists()).unwrap_or(&folder);
    let trouble = write_test(there).err().map(|error| format!("{}: {error}", there.display()));
    let is = if folder.exists() { "exists" } else { "is made by the first sweep" };
    let can = trouble.as_ref().map_or("yes".to_owned(), |trouble| format!("no: {trouble}"));
    let (free, gib) = (free_bytes(there), |bytes| format!("{:.1} GiB", bytes as f64 / GIB));
    let works_in = std::env::current_dir().unwrap_or_default();
    let table = Table::of(
        ["what", "found"],
        [
            ["version", env!("CARGO_PKG_VERSION")].map(Entry::from),
            ["commit", COMMIT].map(Entry::from),
            ["compiler", &host.compiler].map(Entry::from),
            ["features", &features()].map(Entry::from),
            ["system", &format!("{}, kernel {}", host.system, host.kernel)].map(Entry::from),
            ["processor", &format!("{}, {} logical cores", host.cpu, host.cpus)].map(Entry::from),
            ["threads".into(), number(host.threads, format!("{}; --jobs sets another number", host.threads))],
            ["memory".into(), number(host.memory_gib, format!("{} GiB", host.memory_gib))],
            ["works in", &works_in.display().to_string()].map(Entry::from),
            ["results", &format!("{}, which {is}", folder.display())].map(Entry::from),
            ["writable".into(), number(trouble.is_none(), can)],
            ["free".into(), number(free, free.map_or("unknown".to_owned(), gib))],
        ],
    );
    (table, trouble)
}

/// Words for people, and the value for programs.
fn number(value: impl Serialize, words: String) -> Entry {
    Entry::from(words).with(value)
}

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry) -> Result<Report, Failure> {
        let (table, trouble) = findings(&self.out);
        let mut out = Report::default();
        out.show("findings", table);
        out.print()?;
        match trouble {
            None => Ok(Report::default()),
            Some(trouble) => Err(Failure::storage(format!("results cannot be written: {trouble}"))),
        }
    }
}
