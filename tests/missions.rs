//! Missions unlike the paper's: three tasks, one role, two roles that fly, eight needs, quotas. All policies
//! manage them, with every invariant checked at every step, and rescue exactly as many. A change of a number
//! is a change of what people get: it must be meant, and told in the changelog.

use rayon::prelude::*;
use scenario::{RoleKind, Scenario};
use teaming::{Account, Asked, RoleId, TaskId};
use usar_sim::ids::RobotId;
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::{Advance, Simulation};

use crate::support::{policy, root, trial};

const POLICIES: [&str; 5] = ["RNE", "DIS", "ENG", "HP_DIS", "RANDOM"];

const NAMES: [&str; 4] = ["three-tasks", "ground-only", "two-aerial-roles", "eight-needs"];

fn text(name: &str) -> String {
    std::fs::read_to_string(root().join(format!("scenarios/{name}.ron"))).unwrap()
}

fn load(name: &str) -> Scenario {
    with(name, &[])
}

/// A mission with this text replaced by that; the text must be there.
#[track_caller]
fn with(name: &str, replacements: &[(&str, &str)]) -> Scenario {
    let mut text = text(name);
    for (from, to) in replacements {
        assert!(text.contains(from), "{from:?} is not in {name}.ron");
        text = text.replacen(from, to, 1);
    }
    Scenario::parse(&text, format!("{name}.ron").as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

/// Policy, rescuees of each task with seed 1, and with seed 2.
type Expected<const TASKS: usize> = [(&'static str, [u32; TASKS], [u32; TASKS]); 5];

/// Runs all policies on two seeds and compares how many they rescue; returns the records.
#[track_caller]
fn rescues_exactly<const TASKS: usize>(scenario: &Scenario, expected: Expected<TASKS>) -> Vec<TrialRecord> {
    let trials: Vec<(&str, u64)> =
        POLICIES.into_iter().flat_map(|policy| [(policy, 1), (policy, 2)]).collect();
    let run = |(policy, seed): &(&str, u64)| checked_trial(scenario, policy, *seed);
    let records: Vec<TrialRecord> = trials.par_iter().map(run).collect();
    let rescued = |record: &TrialRecord| {
        assert_eq!(record.tasks.len(), TASKS);
        std::array::from_fn(|task| record.tasks[task].totals.rescued)
    };
    let pairs = POLICIES.into_iter().zip(records.chunks(2));
    let found: Vec<_> = pairs.map(|(policy, pair)| (policy, rescued(&pair[0]), rescued(&pair[1]))).collect();
    assert_eq!(found, expected);
    records
}

/// The role of each robot.
fn roles(scenario: &Scenario) -> Vec<RoleId> {
    let row = |row| vec![scenario.role_of(row); row.count as usize];
    scenario.team.iter().flat_map(row).collect()
}

/// A trial that runs to its end, in which every task that got a group that can carry rescued somebody.
fn checked_trial(scenario: &Scenario, policy: &str, seed: u64) -> TrialRecord {
    let record = trial(scenario, policy, seed);
    let name = format!("{}, {policy}, seed {seed}", scenario.name);
    assert_eq!(record.status, Status::Completed, "{name}");
    assert!(record.completed_rounds >= 1, "{name}");
    let roles = roles(scenario);
    let can_carry = |robot: u32| scenario.roles[roles[robot as usize].index()].capacity > 0;
    for (number, task) in (0..).map(TaskId).zip(&record.tasks) {
        let of_task = || record.rounds.iter().filter(|round| round.task == number);
        let got_carriers = of_task().any(|round| round.members.iter().any(|member| can_carry(member.id)));
        assert_eq!(got_carriers, task.totals.rescued > 0, "{name}: {}", task.task);
        assert_eq!(of_task().map(|round| round.rescued).sum::<u32>(), task.totals.rescued, "{name}");
    }
    for round in &record.rounds {
        let delivered: u32 = round.members.iter().map(|member| member.rescued).sum();
        let energy: f64 = round.members.iter().map(|member| member.energy).sum();
        assert_eq!(delivered, round.rescued, "{name}, round {}", round.round);
        assert!((energy - round.energy).abs() < 1e-9, "{name}, round {}", round.round);
    }
    for decision in &record.decisions {
        let question = record.question(decision);
        assert!(question.clone().checked().is_ok_and(|checked| checked == question), "{name}");
        decision.decision.assignment.check(&question).unwrap();
    }
    record
}

/// How many robots of a role each group of a decision has.
fn shares(record: &TrialRecord, decision: usize, role: u16) -> Vec<usize> {
    let asked = &record.decisions[decision];
    let is_of_role = |id: &&u32| {
        asked.question.members.iter().any(|member| member.id == **id && member.role == RoleId(role))
    };
    let groups = &asked.decision.assignment.groups;
    groups.iter().map(|group| group.iter().filter(is_of_role).count()).collect()
}

#[test]
fn three_tasks_are_served_by_thirds_of_the_team() {
    let scenario = load("three-tasks");
    let records = rescues_exactly(
        &scenario,
        [
            ("RNE", [60, 60, 52], [60, 60, 54]),
            ("DIS", [60, 60, 60], [54, 60, 60]),
            ("ENG", [60, 60, 48], [60, 60, 54]),
            ("HP_DIS", [54, 60, 60], [54, 60, 60]),
            ("RANDOM", [58, 60, 60], [60, 60, 54]),
        ],
    );
    for record in records {
        let first: Vec<Vec<usize>> = (0..3).map(|role| shares(&record, 0, role)).collect();
        assert_eq!(first, [[3, 3, 3], [2, 2, 2], [1, 1, 1]]);
        assert!(record.tasks.iter().map(|task| task.task.as_str()).eq(["hard", "medium", "easy"]));
    }
}

#[test]
fn quotas_are_kept_under_every_policy() {
    let quota = "rest: (12.0, 18.0), quota: {\"carrier\": 4, \"supplier\": 1}";
    let scenario = with("three-tasks", &[("rest: (12.0, 18.0)", quota)]);
    let records = rescues_exactly(
        &scenario,
        [
            ("RNE", [42, 63, 36], [42, 63, 36]),
            ("DIS", [42, 63, 42], [41, 63, 42]),
            ("ENG", [42, 63, 40], [42, 63, 36]),
            ("HP_DIS", [41, 63, 42], [41, 63, 42]),
            ("RANDOM", [42, 63, 42], [42, 63, 36]),
        ],
    );
    for record in records {
        let first: Vec<Vec<usize>> = (0..3).map(|role| shares(&record, 0, role)).collect();
        assert_eq!(first, [[4, 3, 2], [1, 3, 2], [1, 1, 1]]);
        for (i, asked) in record.decisions.iter().enumerate() {
            let [carriers, suppliers, observers] = &asked.question.quotas[..] else { panic!("three roles") };
            assert!(carriers.binds() && suppliers.binds() && !observers.binds());
            assert_eq!(shares(&record, i, 0), carriers.members);
            assert_eq!(shares(&record, i, 1), suppliers.members);
            let fit = |role| asked.question.of_role(RoleId(role)).count();
            assert_eq!(carriers.members[0], fit(0).min(4));
            assert_eq!(suppliers.members[0], fit(1).min(1));
        }
    }
}

#[test]
fn one_role_on_the_ground_rescues_without_anybody_who_flies() {
    let scenario = load("ground-only");
    let records = rescues_exactly(
        &scenario,
        [
            ("RNE", [48, 48], [42, 47]),
            ("DIS", [60, 54], [43, 48]),
            ("ENG", [48, 45], [48, 42]),
            ("HP_DIS", [45, 48], [36, 39]),
            ("RANDOM", [48, 48], [48, 42]),
        ],
    );
    for record in records {
        assert_eq!(shares(&record, 0, 0), [4, 4]);
        assert!(record.robots.iter().all(|robot| robot.role == "rescuer"));
        let has_delivered = |robot: u32| {
            let parts = record.rounds.iter().flat_map(|round| &round.members);
            parts.filter(|member| member.id == robot).any(|member| member.rescued > 0)
        };
        assert!((0..8).all(has_delivered));
    }
}

#[test]
fn two_roles_that_fly_share_the_air() {
    let scenario = load("two-aerial-roles");
    let records = rescues_exactly(
        &scenario,
        [
            ("RNE", [68, 68], [64, 60]),
            ("DIS", [64, 60], [56, 64]),
            ("ENG", [68, 60], [64, 60]),
            ("HP_DIS", [56, 64], [63, 60]),
            ("RANDOM", [60, 64], [64, 60]),
        ],
    );
    let [carrier, drone, scout] = &scenario.roles[..] else { panic!("three roles") };
    assert_eq!(
        [carrier.kind, drone.kind, scout.kind],
        [RoleKind::Ground, RoleKind::Aerial, RoleKind::Aerial]
    );
    for record in records {
        let delivered_by = |role: &str| -> u32 {
            let is_of_role = |robot: u32| record.robots[robot as usize].role == role;
            let parts = record.rounds.iter().flat_map(|round| &round.members);
            parts.filter(|member| is_of_role(member.id)).map(|member| member.rescued).sum()
        };
        assert!(delivered_by("drone") > 0 && delivered_by("carrier") > delivered_by("drone"));
        assert_eq!(delivered_by("scout"), 0);
        assert_eq!(delivered_by("drone") + delivered_by("carrier"), record.rescued());
    }
}

#[test]
fn eight_needs_are_reported_and_compared() {
    let scenario = load("eight-needs");
    let records = rescues_exactly(
        &scenario,
        [
            ("RNE", [80, 68], [80, 66]),
            ("DIS", [74, 74], [68, 80]),
            ("ENG", [80, 68], [80, 66]),
            ("HP_DIS", [74, 74], [74, 72]),
            ("RANDOM", [68, 72], [74, 74]),
        ],
    );
    for record in &records {
        for asked in &record.decisions {
            assert_eq!(asked.question.needs[7].name, "payload");
            assert_eq!(asked.question.weights()[..], [2.0, 1.0, 1.0, 4.0, 1.0, 1.0, 1.0, 0.5]);
            for member in &asked.question.members {
                assert_eq!(member.needs.values()[7..], [[120.0], [80.0], [0.5]][member.role.index()]);
            }
        }
    }
    let Account::Rne(account) = &records[0].decisions[0].decision.account else { panic!("RNE gives one") };
    assert_eq!(account.weights[7..], [0.5 / 120.0], "scaled by the team's maximum");
}

#[test]
fn a_mission_restored_from_snapshots_ends_as_if_it_had_not_been() {
    for name in NAMES {
        let scenario = load(name);
        let mut policy = policy("RNE");
        let whole = Simulation::new(&scenario, 1).unwrap().checked().run(&mut *policy, |_, _, _| {});
        let mut trial = Simulation::new(&scenario, 1).unwrap().checked();
        loop {
            let answer = match trial.advance() {
                Advance::Running => None,
                Advance::Asks(_) => trial.question().map(|it| policy.decide(&Asked::of(it)).unwrap()),
                Advance::Over(_) => break,
            };
            if answer.is_some() || trial.steps().is_multiple_of(997) {
                trial = Simulation::restore(&scenario, &trial.snapshot("RNE")).unwrap().checked();
            }
            answer.into_iter().for_each(|decision| trial.assign(decision).unwrap());
        }
        // Overlaps are counted from the last restoration on.
        let pieces = TrialRecord { overlaps: whole.overlaps, ..trial.finish() };
        assert_eq!(pieces, whole, "{name}");
    }
}

#[test]
fn a_team_of_one_serves_one_task_at_a_time() {
    let scenario = with(
        "ground-only",
        &[("count: 8, center: (24.0, 4.0), width_m: 14.0", "count: 1, center: (24.0, 4.0), width_m: 0.0")],
    );
    for policy in POLICIES {
        let record = checked_trial(&scenario, policy, 1);
        assert!(record.rescued() > 0, "{policy}");
    }
}

/// Robots that fly are wider than those on the ground, of which there are none, and more than fit in one row
/// over the block.
#[test]
fn a_team_that_only_flies_waits_apart_and_shares_its_resources() {
    let row = |count: u32, y: f64| {
        format!("(role: \"drone\", count: {count}, center: (27.0, {y:.1}), width_m: 38.5)")
    };
    let team = format!("team: [{}, {}],\n    former: [", row(12, 3.0), row(12, 7.0));
    let text = text("two-aerial-roles").replace("team: [", &team);
    let (start, end) = (text.find("    former: [").unwrap(), text.find("    roles: [").unwrap());
    let text = format!("{}{}", &text[..start], &text[end..]);
    let text = text.replace("radius_m: 0.5, mass_kg: 12.0", "radius_m: 0.7, mass_kg: 12.0, guides: true");
    let scenario = Scenario::parse(&text, "drones.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"));
    for name in POLICIES {
        checked_trial(&scenario, name, 1);
    }
    let mut simulation = Simulation::new(&scenario, 1).unwrap();
    assert_eq!(simulation.step(&mut *policy("RNE")), None);
    let areas: Vec<_> = simulation.model().tasks.iter().map(|task| task.area).collect();
    let mission = simulation.mission();
    for (area, group) in areas.iter().zip(&mission.crew.groups) {
        let muster = |robot: &RobotId| mission.crew.agents[robot.index()].muster;
        let places: Vec<_> = group.members.iter().map(muster).collect();
        for (i, place) in places.iter().enumerate() {
            assert!(area.contains(*place));
            assert!(places[..i].iter().all(|other| (*other - *place).length() >= 1.4), "{place}");
        }
    }
}
