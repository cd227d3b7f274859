//! The cost of a step, as its ratio to the raw physics measured in the same process, in alternation. Times
//! depend on the machine and its load. Ratios depend on them less, and instruction counts
//! (`just instructions`) hardly.
//!
//! `cargo bench --bench speed [-- CASE...]`

mod estimating;
mod grouping;
mod raw;

use std::time::Instant;

use scenario::Scenario;
use teaming::Session;
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
    let cases = [
        ("paper.ron", 12, of_file("paper.ron"), "RNE", 30_000),
        ("leak.ron", 12, of_file("leak.ron"), "RNE", 30_000),
        ("crowded.ron", 36, of_file("crowded.ron"), "RNE", 10_000),
        ("density-12", 12, density::mission(12, 60.0, None), "ENG", 3_000),
        ("density-100", 100, density::mission(100, 60.0, None), "ENG", 3_000),
        ("density-1000", 1000, density::mission(1000, 60.0, None), "ENG", 3_000),
        ("work-1000", 1000, density::mission(1000, 60.0, Some(10.0)), "ENG", 3_000),
    ];
    println!("{TURNS} turns each, medians; us a step; raw: rapier2d alone with as many robots");
    println!("engine: share of the steps in which it ran\n");
    println!("{:<14}{:>8}{:>10}{:>8}{:>12}{:>10}", "", "raw", "full", "ratio", "trials/s", "engine");
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
        let (stages, engine) = stages_us(scenario, policy, *steps);
        println!("{name:<14}{raw:>8.1}{full:>10.1}{:>8.2}{trials:>12.2}{engine:>8.1} %", full / raw);
        shares.push((name, stages));
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
    if asked.is_empty() || asked.iter().any(|name| name == "estimating") {
        estimating::print_table();
    }
}

fn of_file(name: &str) -> Scenario {
    let path = format!("{}/../../scenarios/{name}", env!("CARGO_MANIFEST_DIR"));
    Scenario::load(path.as_ref()).unwrap_or_else(|error| panic!("{error}")).0
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

/// The time of each stage, and the share of steps in which the engine ran, in percent.
fn stages_us(scenario: &Scenario, policy: &str, steps: u64) -> ([f64; Stage::ALL.len()], f64) {
    let mut policy = open(policy);
    let mut trial = Simulation::new(scenario, 1).expect("drawn");
    let mut spent = [0.0; Stage::ALL.len()];
    for _ in 0..steps {
        let mut last = Instant::now();
        let step = trial.watch(&mut *policy, |stage| {
            let now = Instant::now();
            spent[stage as usize] += (now - last).as_secs_f64();
            last = now;
        });
        assert_eq!(step, None);
    }
    let [all, engine] = trial.world().physics.steps();
    (spent.map(|seconds| seconds * 1e6 / steps as f64), 100.0 * engine as f64 / all as f64)
}
