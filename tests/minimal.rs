//! The small worlds: each tells a story, ends in time under every priority, and has a golden summary.

use std::fmt::Write;

use parry2d::math::Vector;
use scenario::{PriorityRule, Scenario, ScenarioFile};
use usar_sim::belief::Belief;
use usar_sim::planning::Query;
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::Simulation;

use crate::support::{lies, policy, root};

const NAMES: [&str; 12] = [
    "closed_road",
    "crossing",
    "dead_end",
    "detour",
    "doorway",
    "head_on",
    "parked",
    "pushed",
    "ring",
    "row",
    "rubble",
    "stranded",
];

fn load(name: &str) -> ScenarioFile {
    let path = root().join(format!("scenarios/minimal/{name}.ron"));
    let (scenario, _) = Scenario::load(&path).unwrap_or_else(|error| panic!("{error}"));
    (*scenario).clone()
}

fn run(file: ScenarioFile) -> (TrialRecord, f64) {
    let scenario = Scenario::try_from(file).unwrap();
    let mut policy = policy("RNE");
    let mut trial = Simulation::new(&scenario, 1).unwrap().checked();
    let free_path_s = free_path_s(&scenario, &trial);
    while trial.ending().is_none() {
        if let Some(Status::Failed(reason)) = trial.step(&mut *policy) {
            panic!("{}: {reason}", scenario.name);
        }
    }
    (trial.finish(), free_path_s)
}

/// The longest time that a robot would need for its errands if it were alone and knew everything, at full
/// speed.
fn free_path_s(scenario: &Scenario, trial: &Simulation) -> f64 {
    let world = trial.world();
    let mut known = Belief::nothing(&trial.model().inflation);
    (0..world.debris.len()).filter(|i| world.debris[*i].is_fixed()).for_each(|i| {
        known.hear(&lies(i, &world.debris[i].outline(), 0));
    });
    let time = |errand: &scenario::Errand| {
        let robot = &world.robots[errand.robot as usize];
        let mut from = robot.home;
        let mut length = 0.0;
        for [x, y] in &errand.to {
            let to = Vector::new(*x as f32, *y as f32);
            let query = Query {
                from,
                to,
                aerial: robot.is_aerial(),
                speed: 1.0,
                radius: robot.radius(),
                obstacles: known.obstacles(robot.radius()),
                in_the_way: &[],
                zones: &[],
            };
            length += trial.model().planner.route(&query).map_or(0.0, |route| route.length(from));
            from = to;
        }
        f64::from(length) / robot.speed()
    };
    scenario.errands.iter().map(time).fold(0.0, f64::max)
}

fn summary(record: &TrialRecord) -> String {
    let mut text = String::new();
    let done = record.counts.errands_done;
    writeln!(text, "{} at {:.1} s, {done} errands done", record.status.name(), record.time_s).unwrap();
    writeln!(text, "{} given up, {} stranded", record.counts.unreachable, record.stranded()).unwrap();
    writeln!(
        text,
        "{} conflicts, {} deadlocks: {} made room, {} turns passed, {} backed off",
        record.counts.conflicts,
        record.counts.deadlocks,
        record.counts.retreats,
        record.counts.rotations,
        record.counts.back_offs
    )
    .unwrap();
    for robot in &record.robots {
        let cause = robot.stall.cause.name();
        let (id, stall) = (robot.robot, robot.longest_stall_s);
        writeln!(text, "robot {id}: {:.1} m, longest stall {stall:.1} s {cause}", robot.distance_m).unwrap();
    }
    text
}

#[test]
fn every_small_world_has_its_golden_summary() {
    for name in NAMES {
        insta::assert_snapshot!(name, summary(&run(load(name)).0));
    }
}

#[test]
fn every_small_world_is_among_them() {
    let mut files: Vec<String> = std::fs::read_dir(root().join("scenarios/minimal"))
        .unwrap()
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    files.sort();
    assert_eq!(files, NAMES);
}

#[test]
fn every_small_world_ends_in_time_under_every_priority() {
    for name in NAMES {
        for priority in [
            PriorityRule::LowestEnergyFirst,
            PriorityRule::TaskThenEnergy,
            PriorityRule::HighestEnergyFirst,
            PriorityRule::LowestHpFirst,
        ] {
            let mut file = load(name);
            file.conflicts.priority = priority;
            let (record, free_path_s) = run(file);
            let limit = 3.0 * free_path_s + 30.0;
            assert_eq!(record.status, Status::Finished, "{name}, {priority:?}");
            assert!(record.time_s <= limit, "{name}, {priority:?}: {} s, limit {limit} s", record.time_s);
        }
    }
}

#[test]
fn rings_of_2_to_30_robots_swap_sides_in_time() {
    for robots in [2, 3, 4, 7, 12, 20, 29] {
        let mut file = load("ring");
        let all = file.team.len();
        let (row, [middle, _]) = (file.team[0].clone(), file.arena_m.map(|size| size / 2.0));
        file.team.clear();
        file.errands.clear();
        for i in 0..robots {
            let angle = f64::from(i) * std::f64::consts::TAU / f64::from(robots);
            let (x, y) = (9.0 * angle.cos(), 9.0 * angle.sin());
            let mut robot = row.clone();
            robot.center = [middle + x, middle + y];
            file.team.push(robot);
            let to = vec![[middle - x, middle - y]];
            file.errands.push(scenario::Errand { robot: i, to });
        }
        assert!(file.team.len() < all);
        let (record, free_path_s) = run(file);
        let limit = 3.0 * free_path_s + 30.0;
        assert_eq!(record.counts.errands_done, robots);
        assert!(record.time_s <= limit, "{robots} robots: {} s, limit {limit} s", record.time_s);
    }
}
