//! Fixed pieces of work whose instructions are counted: `just instructions`.
//!
//! `work NAME`; without a name, the names.

use std::process::ExitCode;

use scenario::Scenario;
use teaming::{Asked, Session};
use usar_sim::simulation::Simulation;
use xtask::{density, team};

/// Steps of a trial that count: what each of these names stands for.
const TRIALS: [(&str, u32); 7] = [
    ("trial", 1_500),
    ("leak", 1_500),
    ("crowded", 1_500),
    ("density-12", 1_500),
    ("density-100", 300),
    ("density-1000", 60),
    ("work-1000", 60),
];

pub fn run(arguments: &[String]) -> ExitCode {
    let name = arguments.first().map_or("", String::as_str);
    match TRIALS.iter().find(|(trial, _)| *trial == name) {
        Some((_, steps)) => trial(name, *steps),
        None if name == "grouping" => grouping(),
        None => TRIALS.iter().for_each(|(trial, _)| println!("{trial}")),
    }
    ExitCode::SUCCESS
}

/// The first steps of a trial of RNE; ENG in worlds with many robots.
fn trial(name: &str, steps: u32) {
    let scenario = match name {
        "trial" => of_file("paper"),
        "density-12" => density::mission(12, 60.0, None),
        "density-100" => density::mission(100, 60.0, None),
        "density-1000" => density::mission(1_000, 60.0, None),
        "work-1000" => density::mission(1_000, 60.0, Some(10.0)),
        file => of_file(file),
    };
    let mut policy = session(if name.contains('-') { "ENG" } else { "RNE" });
    let mut trial = Simulation::new(&scenario, 1).expect("drawn");
    (0..steps).for_each(|_| assert_eq!(trial.step(&mut *policy), None));
    let [all, engine] = trial.world().physics.steps();
    println!("the engine ran in {:.1} % of the steps", 100.0 * engine as f64 / all as f64);
}

fn of_file(name: &str) -> Scenario {
    let path = format!("scenarios/{name}.ron");
    Scenario::load(path.as_ref()).unwrap_or_else(|error| panic!("run from the project's root: {error}")).0
}

fn session(policy: &str) -> Box<dyn Session> {
    policies::standard().open(policy).expect("known")
}

/// Searches for the best split of a role: 20 robots, the largest number that is exact, and 60 robots by
/// local search.
fn grouping() {
    let mut rne = session("RNE");
    for carriers in [20, 60] {
        let decision = rne.decide(&Asked::of(&team::question([carriers, 0, 0], 2)));
        println!("{:?}", decision.expect("a decision").assignment);
    }
}
