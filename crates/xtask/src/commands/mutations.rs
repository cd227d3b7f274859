//! Loads damaged files with all loaders and checks that none panics or takes long.
//!
//! `mutations [COUNT]`

use std::process::ExitCode;
use std::time::Duration;

use xtask::mutations;

/// Longest time that a loader may take.
const LONGEST: Duration = Duration::from_secs(1);

pub fn run(arguments: &[String]) -> ExitCode {
    let count = super::number(arguments, 0, 100_000);
    let folder = tempfile::tempdir().expect("a folder");
    let outcome = mutations::run(count, 0, folder.path());
    let mutations::Outcome { loaded, refused, panics, longest } = &outcome;
    println!(
        "{count} damaged files: {loaded} loaded, {refused} refused, {} panics, the longest {longest:.1?}",
        panics.len()
    );
    if let Some(peak) = super::scale::peak_memory() {
        println!("peak memory: {peak}");
    }
    panics.iter().take(20).for_each(|panic| println!("panic: {panic:?}"));
    if panics.is_empty() && *longest < LONGEST { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
