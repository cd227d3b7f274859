//! The calibration of the paper's world, from the design of its readings to the choice: see
//! docs/calibration.md.
//!
//! `calibration [OUT]`, with `usar` built in the same profile. An interrupted calibration resumes.

use std::path::Path;
use std::process::{Command, ExitCode};

use xtask::calibration::{Combination, FACTORS, Run, finalists, screening};

const TARGET: &str = "scenarios/reference/dis_trials.csv";
const START: &str = "docs/calibration/start.ron";

pub fn run(arguments: &[String]) -> ExitCode {
    let out = Path::new(arguments.first().map_or("results/calibration", String::as_str));
    let mut runs: Vec<Run> = Vec::new();
    for (i, combination) in screening().into_iter().enumerate() {
        let name = format!("screening-{:02}", i + 1);
        let folder = out.join(&name);
        if !folder.join("fit.csv").exists() {
            // A coarser step, few trials and few candidates are enough here to find out which readings fit
            // better.
            let quick = "--trials 6 --evaluations 80 --first-step 0.05 --fresh-trials 2 --set dt_s=0.04";
            calibrate(Path::new(START), &folder, &combination, quick);
        }
        runs.push(Run { name, misfit: least_misfit(&folder), combination });
        println!("{}", runs.last().expect("one was pushed"));
    }
    xtask::calibration::write_screening(&out.join("screening.csv"), &runs);
    xtask::calibration::write_effects(&out.join("effects.csv"), &runs);
    let mut folders = Vec::new();
    for (i, (combination, nearest)) in finalists(&runs).into_iter().enumerate() {
        let folder = out.join(format!("final-{}", i + 1));
        if !folder.join("fit.csv").exists() {
            let start = out.join(&nearest.name).join("calibrated.ron");
            let whole = "--trials 10 --evaluations 80 --first-step 0.03 --set dt_s=0.02";
            calibrate(&start, &folder, &combination, whole);
        }
        println!(
            "final-{}, from {}, misfit {:.1}: {combination}",
            i + 1,
            nearest.name,
            least_misfit(&folder)
        );
        folders.push(folder);
    }
    let csv = out.join("choice.csv");
    let status = Command::new(super::usar())
        .args(["study", "yang2021", "calibrate", "--choose"])
        .args(&folders)
        .args(["--target", TARGET, "--quiet", "--out"])
        .arg(&csv)
        .status()
        .expect("usar can be started");
    assert!(status.success(), "--choose: {status}");
    xtask::calibrated::write_worlds(&csv, &folders);
    ExitCode::SUCCESS
}

/// Fits one combination of readings.
fn calibrate(start: &Path, folder: &Path, combination: &Combination, more: &str) {
    let mut command = Command::new(super::usar());
    command
        .args(["study", "yang2021", "calibrate"])
        .arg(start)
        .args(["--target", TARGET, "--quiet", "--out"])
        .arg(folder);
    for free in &combination.free() {
        command.args(["--over", free]);
    }
    for setting in combination.settings() {
        command.args(["--set", &setting]);
    }
    let output = command.args(more.split(' ')).output().expect("usar can be started");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{} of {} readings: {said}", combination, FACTORS.len());
}

/// The least misfit in the log of a calibration.
fn least_misfit(folder: &Path) -> f64 {
    let log = std::fs::read_to_string(folder.join("evaluations.jsonl"));
    let log = log.expect("a finished calibration has a log");
    let entry = |line| serde_json::from_str::<serde_json::Value>(line).expect("JSON")["entry"].take();
    let misfits = log.lines().filter_map(|line| entry(line)["misfit"].as_f64());
    misfits.fold(f64::INFINITY, f64::min)
}
