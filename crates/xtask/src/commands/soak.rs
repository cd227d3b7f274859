//! Soak: many seeds of a scenario under every policy. It fails if a trial fails, a number is undefined, an
//! invariant is violated, or a robot with a goal does not come nearer to it for more than 30 s.
//!
//! `soak [SCENARIO] [SEEDS]`

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use experiments::experiment::{Experiment, Overrides};
use experiments::run::{Limits, Outcome, run_all};
use usar_sim::invariant::Overlaps;
use usar_sim::record::TrialRecord;

const LONGEST_STALL_S: f64 = 30.0;

pub fn run(arguments: &[String]) -> ExitCode {
    let path = arguments.first().map_or("scenarios/paper.ron", String::as_str);
    let seeds = arguments.get(1).and_then(|seeds| seeds.parse().ok()).unwrap_or(100);
    let overrides = Overrides {
        policies: Some(policies::standard().names().into_iter().map(str::to_owned).collect()),
        trials: Some(seeds),
        is_checked: true,
        ..Overrides::default()
    };
    let experiment = match Experiment::load(path.as_ref(), &overrides, &policies::standard()) {
        Ok(experiment) => Arc::new(experiment),
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::from(2);
        }
    };
    let jobs = std::thread::available_parallelism().map_or(1, usize::from);
    let keys: Vec<_> = experiment.keys(None).collect();
    let mut outcomes = Vec::new();
    let ran = run_all(
        keys,
        Limits { jobs, trial: None },
        Arc::new(move |key, sessions, halt| experiment.run(key, sessions, halt)),
        &AtomicBool::new(false),
        |outcome| {
            outcomes.push(outcome);
            Ok(())
        },
    );
    assert!(ran.expect("threads start"));
    outcomes.sort_by(|a, b| a.key.cmp(&b.key));
    let faults: Vec<String> = outcomes.iter().flat_map(faults).collect();
    faults.iter().for_each(|fault| println!("{fault}"));
    summarise(&outcomes);
    println!("{} trials, {} faults", outcomes.len(), faults.len());
    ExitCode::from(u8::from(!faults.is_empty()))
}

fn faults(outcome: &Outcome) -> Vec<String> {
    let Some(record) = outcome.record() else { return outcome.failure().into_iter().collect() };
    let name = format!("{} seed {}", outcome.key.label, outcome.key.seed);
    let mut faults = Vec::new();
    for robot in &record.robots {
        if robot.longest_stall_s > LONGEST_STALL_S {
            faults.push(format!(
                "{name}: robot {} did not come nearer for {:.1} s",
                robot.robot, robot.longest_stall_s
            ));
        }
        let numbers =
            [robot.final_energy, robot.final_hp, robot.energy_spent, robot.hp_lost, robot.distance_m];
        if !numbers.iter().all(|number| number.is_finite()) {
            faults.push(format!("{name}: robot {} has undefined numbers {numbers:?}", robot.robot));
        }
    }
    faults
}

/// Prints the numbers of `docs/model.md` for the scenario, over all policies together.
fn summarise(outcomes: &[Outcome]) {
    let records: Vec<&TrialRecord> = outcomes.iter().filter_map(Outcome::record).collect();
    let each =
        |value: &dyn Fn(&TrialRecord) -> f64| records.iter().map(|record| value(record)).collect::<Vec<_>>();
    let line = |name: &str, values: Vec<f64>| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let (least, most) =
            values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
        println!("{name:<42} mean {mean:8.2}  least {least:8.2}  most {most:8.2}");
    };
    let groups = |record: &TrialRecord| {
        record.rounds.iter().filter(|round| round.end_s.is_some()).count().max(1) as f64
    };
    line("complete rounds", each(&|r| f64::from(r.completed_rounds)));
    for task in records.first().map_or(&[][..], |record| &record.tasks) {
        let rescued = |r: &TrialRecord| r.task(&task.task).map_or(f64::NAN, |totals| totals.rescued.into());
        line(&format!("rescued, {} task", task.task), each(&rescued));
    }
    line(
        "share of complete group rounds that deliver",
        each(&|r| {
            r.rounds.iter().filter(|round| round.end_s.is_some() && round.rescued > 0).count() as f64
                / groups(r)
        }),
    );
    line(
        "secured per complete group round",
        each(&|r| {
            r.rounds
                .iter()
                .filter(|round| round.end_s.is_some())
                .map(|round| f64::from(round.secured))
                .sum::<f64>()
                / groups(r)
        }),
    );
    line("turned back, per trial", each(&|r| f64::from(r.counts.turned_back)));
    line("stranded or disabled, per trial", each(&|r| (r.stranded() + r.disabled()) as f64));
    line("energy spent per robot, percent points", each(&|r| r.energy() / r.robots.len() as f64));
    line("HP lost per robot, percent points", each(&|r| r.hp() / r.robots.len() as f64));
    line(
        "waited per robot, s",
        each(&|r| r.robots.iter().map(|x| x.waiting_s).sum::<f64>() / r.robots.len() as f64),
    );
    line("longest stall, s", each(&|r| r.robots.iter().map(|x| x.longest_stall_s).fold(0.0, f64::max)));
    let overlaps = || records.iter().filter_map(|record| record.overlaps);
    let total = Overlaps {
        contacts: overlaps().map(|o| o.contacts).sum(),
        rare: overlaps().map(|o| o.rare).sum(),
        deepest_m: overlaps().map(|o| o.deepest_m).fold(0.0, f32::max),
    };
    println!("overlaps: {total}");
    line("conflicts", each(&|r| f64::from(r.counts.conflicts)));
    line("deadlocks", each(&|r| f64::from(r.counts.deadlocks)));
}
