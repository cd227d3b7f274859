//! The calibration of the paper's world, from the starts of its readings to the choice: see
//! docs/calibration.md.
//!
//! `calibration [OUT]`, with `usar` built in the same profile. An interrupted calibration resumes.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use xtask::calibration::{Details, READINGS, Reading, Run, STARTS, text_of_start, write_starts};

const TARGET: &str = "scenarios/reference/dis_trials.csv";
const START: &str = "docs/calibration/start.ron";

/// Few trials and few candidates are enough to find out where a start leads.
const QUICK: &str = "--trials 4 --evaluations 48 --first-step 0.1 --fresh-trials 2";

/// The best starts of each reading are fitted further.
const FINALISTS: usize = 2;
const WHOLE: &str = "--trials 10 --evaluations 80 --first-step 0.03";

/// Seeds that no earlier fit, choice or claim has used.
const FRESH_SEED: &str = "400001";

pub fn run(arguments: &[String]) -> ExitCode {
    let out = Path::new(arguments.first().map_or("results/calibration", String::as_str));
    let start = std::fs::read_to_string(START).expect("run from the project's root");
    let mut runs: Vec<Run> = Vec::new();
    for start_number in 0..STARTS {
        for (place, reading) in READINGS.iter().enumerate() {
            let folder = out.join("starts").join(format!("{}-{:02}", reading.name, start_number + 1));
            let text = text_of_start(&start, start_number);
            calibrate(&text, &folder, reading, start_number, QUICK);
            let misfit = least_misfit(&folder);
            runs.push(Run { reading: place, start: start_number, misfit });
            println!("{}: {misfit:.1}", folder.display());
        }
        write_starts(&out.join("starts.csv"), &runs);
    }
    let folders = finals(out, &runs);
    choose(out, &folders);
    ExitCode::SUCCESS
}

/// Fits the best starts of each reading further.
fn finals(out: &Path, runs: &[Run]) -> Vec<PathBuf> {
    let mut folders = Vec::new();
    for (place, reading) in READINGS.iter().enumerate() {
        let mut best: Vec<&Run> = runs.iter().filter(|run| run.reading == place).collect();
        best.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
        for (rank, run) in best.into_iter().take(FINALISTS).enumerate() {
            let name = format!("{}-{:02}", reading.name, run.start + 1);
            let text = std::fs::read_to_string(out.join("starts").join(name).join("calibrated.ron"));
            let text = text.expect("a finished calibration");
            let folder = out.join("finals").join(format!("{}-{}", reading.name, rank + 1));
            calibrate(&text, &folder, reading, run.start, WHOLE);
            println!("{}, from start {}: {:.1}", folder.display(), run.start + 1, least_misfit(&folder));
            folders.push(folder);
        }
    }
    folders
}

fn choose(out: &Path, folders: &[PathBuf]) {
    let csv = out.join("choice.csv");
    let status = Command::new(super::usar())
        .args(["study", "yang2021", "calibrate", "--choose"])
        .args(folders)
        .args(["--target", TARGET, "--first-seed", FRESH_SEED, "--quiet", "--out"])
        .arg(&csv)
        .status()
        .expect("usar can be started");
    assert!(status.success(), "--choose: {status}");
    let mut table = csv::Reader::from_path(&csv).expect("the choice has a table");
    let ranking: Vec<String> = table.records().map(|row| row.expect("a table")[0].to_owned()).collect();
    let best: Vec<PathBuf> = READINGS.iter().map(|reading| best_of(reading, &ranking, folders)).collect();
    xtask::calibrated::write_worlds(out, &folder_of(&ranking[0], folders), &best);
}

/// The finalist of a reading with the least misfit over the fresh trials.
fn best_of(reading: &Reading, ranking: &[String], folders: &[PathBuf]) -> PathBuf {
    let is_of = |name: &&String| {
        let rank = name.strip_prefix(reading.name).and_then(|rest| rest.strip_prefix('-'));
        rank.is_some_and(|rank| rank.parse::<usize>().is_ok())
    };
    folder_of(ranking.iter().find(is_of).expect("each reading has finalists"), folders)
}

fn folder_of(name: &str, folders: &[PathBuf]) -> PathBuf {
    folders.iter().find(|folder| folder.ends_with(name)).expect("a finalist's folder").clone()
}

/// Fits a start under a reading, unless the folder has the result.
fn calibrate(text: &str, folder: &Path, reading: &Reading, start: usize, how: &str) {
    if folder.join("fit.csv").exists() {
        return;
    }
    let file = folder.with_extension("ron");
    std::fs::create_dir_all(folder).expect("the folder can be made");
    std::fs::write(&file, text).expect("the folder takes a file");
    let details = Details::of_start(start);
    let mut command = Command::new(super::usar());
    command.args(["study", "yang2021", "calibrate"]).arg(&file);
    command.args(["--target", TARGET, "--quiet", "--out"]).arg(folder);
    for free in details.free() {
        command.args(["--over", free]);
    }
    for (path, value) in details.settings(reading) {
        command.args(["--set", &format!("{path}={value}")]);
    }
    let output = command.args(how.split(' ')).output().expect("usar can be started");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {said}", folder.display());
}

/// The least misfit in the log of a calibration.
fn least_misfit(folder: &Path) -> f64 {
    let log = std::fs::read_to_string(folder.join("evaluations.jsonl"));
    let log = log.expect("a finished calibration has a log");
    let entry = |line| serde_json::from_str::<serde_json::Value>(line).expect("JSON")["entry"].take();
    let misfits = log.lines().filter_map(|line| entry(line)["misfit"].as_f64());
    misfits.fold(f64::INFINITY, f64::min)
}
