//! A large team at the usual density: whether it runs, how many it rescues, the time of a step, and the
//! memory that it needs.
//!
//! `scale [ROBOTS] [SECONDS] [PATH=VALUE...]` sets fields of the scenario, such as `dt_s=0.05`.

use std::process::ExitCode;
use std::time::Instant;

use scenario::Scenario;
use usar_sim::record::Status;
use usar_sim::simulation::Simulation;
use usar_sim::stage::Stage;
use xtask::density;

use super::number;

pub fn run(arguments: &[String]) -> ExitCode {
    let (robots, seconds) = (number(arguments, 0, 10_000) as u32, number(arguments, 1, 60) as f64);
    let mut scenario = density::mission(robots, seconds, None);
    for (path, value) in arguments.iter().filter_map(|argument| argument.split_once('=')) {
        let mut file = (*scenario).clone();
        file.set(path, value).expect("a field of the scenario");
        scenario = Scenario::try_from(file).expect("a scenario that can be used");
    }
    let mut eng = policies::standard().open("ENG").expect("known");
    let start = Instant::now();
    let mut trial = Simulation::new(&scenario, 1).expect("drawn").in_parallel();
    println!(
        "{robots} robots, {} pieces of debris: built in {:.1} s",
        scenario.debris.len(),
        start.elapsed().as_secs_f64()
    );
    let start = Instant::now();
    let (mut last, mut spent) = (start, [0.0; Stage::ALL.len()]);
    let mut note = |stage: Stage| {
        let now = Instant::now();
        spent[stage as usize] += (now - last).as_secs_f64();
        last = now;
    };
    while trial.watch(&mut *eng, &mut note).is_none() {}
    let steps = trial.steps();
    let stage = |stage: Stage| format!("{} {:.0}", stage.name(), spent[stage as usize] * 1e6 / steps as f64);
    println!("us: {}", Stage::ALL.map(stage).join(", "));
    let us = start.elapsed().as_secs_f64() * 1e6 / steps as f64;
    let record = trial.finish();
    assert!(!matches!(record.status, Status::Failed(_)), "{:?}", record.status);
    println!(
        "{} s simulated, {us:.0} us a step, {} rescued, hash {}",
        record.time_s,
        record.rescued(),
        record.state_hash
    );
    if let Some(peak) = peak_memory() {
        println!("peak memory: {peak}");
    }
    ExitCode::SUCCESS
}

/// The largest resident size so far, if the system reports it.
pub(super) fn peak_memory() -> Option<String> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    Some(status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?.trim().to_owned())
}
