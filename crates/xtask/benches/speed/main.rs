//! The cost of a step, as its ratio to the raw physics measured in the same process, in alternation. Times
//! depend on the machine and its load. Ratios depend on them less, and instruction counts
//! (`just instructions`) hardly.
//!
//! `cargo bench --bench speed [-- CASE...]`

mod grouping;
mod raw;

use std::time::Instant;

use rne_core::{Deadline, Session};
use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;
use usar_sim::stage::Stage;
use xtask::density;

/// Number of alternations between reference and subject.
const TURNS: usize = 5;

fn main() {
    // `cargo test --benches` and `cargo clippy` build this; only `cargo bench` runs it.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    let paper = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/paper.ron");
    let (paper, _) = Scenario::load(paper.as_ref()).unwrap_or_else(|error| panic!("{error}"));
    let cases = [
        ("paper.ron", 12, paper, "RNE", 30_000),
        ("density-12", 12, density::mission(12, 60.0, None), "ENG", 3_000),
        ("density-100", 100, density::mission(100, 60.0, None), "ENG", 3_000),
        ("density-1000", 1000, density::mission(1000, 60.0, None), "ENG", 3_000),
        ("work-1000", 1000, density::mission(1000, 60.0, Some(10.0)), "ENG", 3_000),
    ];
    println!("{TURNS} turns each, medians; us a step; raw: rapier2d alone with as many robots\n");
    println!("{:<14}{:>8}{:>10}{:>8}{:>12}", "", "raw", "full", "ratio", "trials/s");
    let mut shares = Vec::new();
    let mut growth = Vec::new();
    let asked: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    let chosen = cases.iter().filter(|case| asked.is_empty() || asked.iter().any(|name| name == case.0));
    for (name, robots, scenario, policy, steps) in chosen {
        let mut turns: Vec<[f64; 2]> =
            (0..TURNS).map(|_| [raw_us(*robots, *steps), full_us(scenario, policy, *steps)]).collect();
        turns.sort_by(|a, b| (a[1] / a[0]).total_cmp(&(b[1] / b[0])));
        let [raw, full] = turns[TURNS / 2];
        let trials = 1e6 / (full * *steps as f64);
        println!("{name:<14}{raw:>8.1}{full:>10.1}{:>8.2}{trials:>12.2}", full / raw);
        shares.push((name, stages_us(scenario, policy, *steps)));
        if name.starts_with("density") {
            growth.push((f64::from(*robots), full));
        }
    }
    println!("\n{:<14}{}", "", Stage::ALL.map(|stage| format!("{:>10}", stage.name())).concat());
    for (name, stages) in shares {
        println!("{name:<14}{}", stages.map(|us| format!("{us:>10.2}")).concat());
    }
    if let [(few, fast), .., (many, slow)] = growth[..] {
        println!("\ngrowth exponent, {few} to {many} robots: {:.2}", (slow / fast).ln() / (many / few).ln());
    }
    if asked.is_empty() || asked.iter().any(|name| name == "grouping") {
        grouping::print_table();
    }
}

fn raw_us(robots: u32, steps: u64) -> f64 {
    let steps = steps.min(2_000);
    let mut world = raw::Raw::new(robots);
    (0..50).for_each(|_| world.step());
    let start = Instant::now();
    (0..steps).for_each(|_| world.step());
    start.elapsed().as_secs_f64() * 1e6 / steps as f64
}

fn open(policy: &str) -> Box<dyn Session> {
    policies::standard().open(policy).expect("known")
}

fn full_us(scenario: &Scenario, policy: &str, steps: u64) -> f64 {
    let mut policy = open(policy);
    let start = Instant::now();
    let mut trial = Simulation::new(scenario, 1).expect("drawn");
    (0..steps).for_each(|_| assert_eq!(trial.step(&mut *policy), None));
    start.elapsed().as_secs_f64() * 1e6 / steps as f64
}

fn stages_us(scenario: &Scenario, policy: &str, steps: u64) -> [f64; Stage::ALL.len()] {
    let mut policy = open(policy);
    let mut trial = Simulation::new(scenario, 1).expect("drawn");
    let mut spent = [0.0; Stage::ALL.len()];
    for _ in 0..steps {
        let mut last = Instant::now();
        let step = trial.step_watched(&mut *policy, Deadline::NEVER, |stage| {
            let now = Instant::now();
            spent[stage as usize] += (now - last).as_secs_f64();
            last = now;
        });
        assert_eq!(step, None);
    }
    spent.map(|seconds| seconds * 1e6 / steps as f64)
}
