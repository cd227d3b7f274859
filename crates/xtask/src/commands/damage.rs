//! Damages the folder of a finished sweep with a thousand flipped bits and a hundred forged numbers, and
//! checks that each damage is found.
//!
//! `damage [FLIPS [FORGERIES]]`, with `usar` built in the same profile.

use std::process::{Command, ExitCode};

use xtask::damage::{Report, Sound};

use super::number;

pub fn run(arguments: &[String]) -> ExitCode {
    let (flips, forgeries) = (number(arguments, 0, 1000) as u32, number(arguments, 1, 100) as u32);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let results = folder.path().join("results");
    let mut sweep = Command::new(super::usar());
    sweep.args(["sweep", "scenarios/paper.ron", "--policies", "RNE,DIS", "--trials", "2"]);
    sweep.args(["--set", "duration_s=30.0", "--quiet", "--out"]).arg(&results);
    assert!(sweep.stdout(std::process::Stdio::null()).status().expect("usar runs").success());
    let sound = Sound::of(&results);
    let Report { damaged, found, refused, mended } = sound.flip(flips, 1);
    println!(
        "{damaged} flipped bits: {found} found by verify, {refused} refused by the others, {mended} mended \
         or refused by sweep"
    );
    let all_flips = found == flips && mended == flips;
    let Report { damaged, found, .. } = sound.forge(forgeries, 1);
    println!("{damaged} forged numbers, every checksum computed anew: {found} found by verify");
    if all_flips && found == forgeries { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
