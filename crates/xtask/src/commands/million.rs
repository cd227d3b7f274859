//! A million trials: the time and memory that shards, merge, compare and report take.
//!
//! `million [TRIALS] [trials|rounds] [SHARDS]` makes trials from a fast fake: a real trial of each policy,
//! whose numbers the seed changes. The program `usar` beside this one merges, compares and reports.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use experiments::experiment::{Experiment, Keep, Overrides, Shard};
use experiments::run::{Outcome, Sessions, Trial, TrialKey};
use experiments::sweep::folder::{Folder, Opening};

use super::scale::peak_memory;
use super::usar;

/// The compared policies.
const POLICIES: [&str; 4] = ["RNE", "DIS", "ENG", "HP_DIS"];
/// Number of cases of the sweep.
const CASES: usize = 5;
/// Number of trials that are written together.
const AT_A_TIME: usize = 2_000;
/// Limits of each command: seconds, and memory in kB.
const MOST: (f64, u64) = (300.0, 1_000_000);

pub fn run(arguments: &[String]) -> ExitCode {
    let number = |place: usize, default: u32| {
        arguments.get(place).map_or(default, |text| text.parse().expect("a whole number"))
    };
    let keep: Keep = arguments.get(1).map_or(Keep::Trials, |text| text.parse().expect("what to keep"));
    let (trials, shards) = (number(0, 1_000_000), number(2, 50));
    let place = tempfile::tempdir().expect("a temporary folder");
    let start = Instant::now();
    let experiment = Arc::new(experiment(place.path(), trials, keep));
    let count = experiment.count(None);
    let fakes = fakes(&experiment);
    for number in 1..=shards {
        write_shard(&experiment, &fakes, Shard { number, of: shards }, place.path());
    }
    let seconds = start.elapsed().as_secs_f64();
    let memory = peak_memory().unwrap_or_default();
    println!("{count} trials in {shards} shards: written in {seconds:.0} s, peak memory {memory}");
    println!("on disk: shards {:.0} MB", megabytes(&place.path().join("shards")));
    let commands: [&[&str]; 4] = [
        &["cluster", "merge", "shards", "--out", "whole"],
        &["compare", "whole", "--baseline", "DIS"],
        &["report", "whole"],
        &["status", "shards"],
    ];
    let is_well = commands.map(|command| measure(place.path(), command));
    println!("on disk: whole {:.0} MB", megabytes(&place.path().join("whole")));
    if is_well == [true; 4] { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn experiment(place: &Path, trials: u32, keep: Keep) -> Experiment {
    let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/paper.ron");
    let scenario = scenario.canonicalize().expect("the scenario is there");
    let speeds: Vec<String> = (0..CASES).map(|case| format!("{}.5", case + 1)).collect();
    let sweep = format!(
        "(name: \"million\", scenario: \"{}\", set: {{\"duration_s\": 120.0}}, policies: {POLICIES:?}, \
         trials: {}, axes: {{\"roles.carrier.speed_mps\": [{}]}})",
        scenario.display(),
        trials as usize / POLICIES.len() / CASES,
        speeds.join(", ")
    );
    let path = place.join("million.ron");
    std::fs::write(&path, sweep).expect("it can be written");
    let overrides = Overrides { keep: Some(keep), ..Overrides::default() };
    Experiment::load(&path, &overrides, &policies::standard()).expect("a sweep")
}

/// A real trial of each case and policy.
fn fakes(experiment: &Experiment) -> Vec<Vec<Trial>> {
    let halt = AtomicBool::new(false);
    let trial = |case, policy| {
        experiment
            .run_alone(&experiment.key((case, policy, 1)), &mut Sessions::default(), &halt)
            .expect("it runs")
    };
    let of_case = |case| (0..POLICIES.len()).map(|policy| trial(case, policy)).collect();
    (0..CASES).map(of_case).collect()
}

/// The trial with other numbers, chosen by its seed.
fn faked(trial: &Trial, key: &TrialKey) -> Trial {
    let mut trial = trial.clone();
    let noise = |salt: u64| {
        let mixed = (key.seed ^ salt << 32 ^ (key.policy as u64) << 40).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 40
    };
    trial.record.seed = key.seed;
    trial.record.counts.conflicts = (noise(1) % 400) as u32;
    trial.record.completed_rounds = (noise(2) % 7) as u32;
    for (salt, robot) in (3..).zip(&mut trial.record.robots) {
        robot.distance_m += noise(salt) as f64 / 1e5;
        robot.waiting_s += noise(salt + 100) as f64 / 1e6;
    }
    trial.record.state_hash = format!("{:032x}", u128::from(noise(200)) << 64 | u128::from(key.seed));
    trial
}

fn write_shard(experiment: &Arc<Experiment>, fakes: &[Vec<Trial>], shard: Shard, place: &Path) {
    let path = place.join("shards").join(shard.number.to_string());
    let opening = Opening { shard: Some(shard), is_fresh: false };
    let mut folder =
        Folder::open(&path, Arc::clone(experiment), opening, &mut |_| {}).expect("it can be opened");
    let mut keys = experiment.keys(Some(shard)).peekable();
    while keys.peek().is_some() {
        let outcome = |key: TrialKey| {
            let trial = faked(&fakes[key.case][key.policy], &key);
            Outcome { key, result: Ok(trial) }
        };
        let outcomes: Vec<Outcome> = keys.by_ref().take(AT_A_TIME).map(outcome).collect();
        folder.add(&outcomes).expect("the disk takes them");
    }
    folder.finish(&AtomicBool::new(false)).expect("the disk takes the tables");
}

/// Runs a command of `usar` and prints its time and memory; returns whether they are within the limits.
fn measure(place: &Path, arguments: &[&str]) -> bool {
    let start = Instant::now();
    let mut command = Command::new(usar());
    command.args(arguments).current_dir(place).stdout(Stdio::null());
    let mut child = command.spawn().expect("usar is beside this program");
    let status = PathBuf::from(format!("/proc/{}/status", child.id()));
    let mut peak = 0;
    let ended = loop {
        let text = std::fs::read_to_string(&status).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kilobytes = line.and_then(|rest| rest.split_whitespace().next()?.parse().ok());
        peak = kilobytes.unwrap_or(0).max(peak);
        if let Some(ended) = child.try_wait().expect("it is our child") {
            break ended;
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    let seconds = start.elapsed().as_secs_f64();
    println!("usar {}: {seconds:.1} s, peak memory {} MB", arguments.join(" "), peak / 1_000);
    ended.success() && seconds < MOST.0 && peak < MOST.1
}

fn megabytes(folder: &Path) -> f64 {
    let of = |entry: std::fs::DirEntry| {
        let path = entry.path();
        if path.is_dir() {
            megabytes(&path)
        } else {
            entry.metadata().map_or(0.0, |file| file.len() as f64 / 1e6)
        }
    };
    std::fs::read_dir(folder).into_iter().flatten().flatten().map(of).sum()
}
