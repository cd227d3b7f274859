//! Kills a sweep at random moments, a hundred times, and checks that nothing is lost.
//!
//! `kills [KILLS]`, with `usar` built in the same profile.

use std::process::ExitCode;

use xtask::kills;

pub fn run(arguments: &[String]) -> ExitCode {
    let kills = super::number(arguments, 0, 100) as u32;
    let usar = super::usar();
    let scenario = std::env::current_dir().expect("a folder").join("scenarios/paper.ron");
    let scenario = scenario.to_str().expect("a path of text");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let arguments = ["sweep", scenario, "--trials", "25", "--set", "duration_s=120.0"];
    let report = kills::kill_sweeps(&usar, &arguments, folder.path(), kills, 1_500);
    println!(
        "{} kills, {} sweeps came to their end, each with the files of an undisturbed one; {} times a \
         finished trial was found again",
        report.kills, report.sweeps, report.kept
    );
    ExitCode::SUCCESS
}
