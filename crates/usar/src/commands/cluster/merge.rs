//! `usar cluster merge`: merges the shards of a sweep into one folder with the bytes of a single run.

use experiments::sweep::merge::Merge;
use experiments::sweep::names::{is_sweeps, sweeps_in};

use crate::commands::sweep::told;
use crate::input::check_trials;
use crate::prelude::*;

/// Join the shards of a sweep into what a single run would have written, byte for byte
#[derive(Debug, Args)]
#[command(after_help = "\
Refuses shards of different sweeps or programs, shards that disagree about a trial, and a sum of shards that \
lacks a trial: then it says which shards are missing, and the commands that run them.

Example:
  usar sweep scenarios/sweeps/energy.ron --shard 1/2     (on one machine)
  usar sweep scenarios/sweeps/energy.ron --shard 2/2     (on another)
  usar cluster merge results/energy-1-of-2 results/energy-2-of-2 --out results/energy
  usar cluster merge results/energy-shards --out results/energy  (a folder that contains the shards)")]
pub(crate) struct Arguments {
    /// Shard folders, or folders that contain them
    #[arg(required = true)]
    folders: Vec<PathBuf>,
    /// File or folder to write
    #[arg(long)]
    out: PathBuf,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        stop_on_signals();
        let whole =
            Merge::of(&shards_in(&self.folders), registry)?.write_to(&self.out, &STOP, &mut |note| {
                tell(format_args!("note: {note}"));
            })?;
        told(&whole).print()?;
        check_trials([&whole]).map(|()| Report::default())
    }
}

/// The given folders. A folder that does not hold a sweep is replaced by the sweeps inside it.
fn shards_in(folders: &[PathBuf]) -> Vec<PathBuf> {
    let shards = |folder: &PathBuf| {
        let inside = if is_sweeps(folder) { Vec::new() } else { sweeps_in(folder) };
        if inside.is_empty() { vec![folder.clone()] } else { inside }
    };
    folders.iter().flat_map(shards).collect()
}
