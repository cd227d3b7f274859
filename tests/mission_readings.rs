//! The readings of the paper's mission that are options: each does what studies/yang2021/docs/readings.md
//! says, with every invariant checked.

use scenario::Scenario;
use teaming::{Asked, Decision, Policy, PolicyError, Question, TaskId};
use usar_sim::event::{Event, Place};
use usar_sim::ids::RobotId;
use usar_sim::mission::Activity;
use usar_sim::record::{DecisionRecord, Status};
use usar_sim::simulation::{Advance, Ask, Simulation};

use crate::support::{paper_with, policy, trial};

/// Robots get low soon, so that a trial has many rests.
const TIRING: (&str, &str) = ("per_step: 0.0045", "per_step: 0.012");

/// Runs a trial of DIS and shows each step to `look`.
fn watch(scenario: &Scenario, mut look: impl FnMut(&Simulation)) {
    let mut simulation = Simulation::new(scenario, 7).unwrap().checked();
    let mut dis = policy("DIS");
    while simulation.step(&mut *dis).is_none() {
        look(&simulation);
    }
}

fn levels(simulation: &Simulation, robot: RobotId) -> [f64; 2] {
    let robot = &simulation.world().robots[robot.index()];
    [robot.energy, robot.hp]
}

#[test]
fn a_rest_that_fills_the_low_level_leaves_the_other_as_it_was() {
    let scenario = paper_with(&[TIRING, ("rest_fills: Both", "rest_fills: Low")]);
    let (mut before, mut rests) = (vec![[0.0; 2]; 12], 0);
    watch(&scenario, |simulation| {
        for event in simulation.events() {
            if let Event::RestEnded { robot } = event {
                let ([energy, hp], now) = (before[robot.index()], levels(simulation, *robot));
                assert!(energy < 30.0 || energy < hp, "{energy} {hp}: only energy gets low here");
                assert_eq!(now.map(f64::to_bits), [100.0, hp].map(f64::to_bits));
                rests += 1;
            }
        }
        before = (0..12).map(|id| levels(simulation, RobotId(id))).collect();
    });
    assert!(rests >= 10, "{rests}");
}

#[test]
fn a_rest_that_fills_energy_then_hp_takes_both_times() {
    let scenario = paper_with(&[TIRING, ("rest_fills: Both", "rest_fills: InTurn")]);
    let (mut began, mut rests) = ([0.0; 12], 0);
    watch(&scenario, |simulation| {
        for event in simulation.events() {
            match event {
                Event::RestStarted { robot } => {
                    let full = levels(simulation, *robot).iter().filter(|level| **level >= 100.0).count();
                    began[robot.index()] = simulation.time_s() - 30.0 * full as f64;
                }
                Event::RestEnded { robot } => {
                    let took = simulation.time_s() - began[robot.index()];
                    assert!((took - 60.0).abs() < 1.0, "{robot:?} rested {took} s");
                    rests += 1;
                }
                _ => {}
            }
        }
    });
    assert!(rests >= 5, "{rests}");
}

#[test]
fn points_last_longer_where_a_robot_has_more_of_them() {
    let rates = ("hp: (per_step: 0.0003, per_metre: 0.0, per_second: 0.0)", "hp: (per_second: 0.02)");
    let over_the_way = ("radius_m: 4.5", "radius_m: 20.0");
    let after = |unit: &str| {
        let scenario = paper_with(&[
            ("unit: Percent", unit),
            rates,
            over_the_way,
            ("duration_s: 600.0", "duration_s: 8.0"),
        ]);
        let mut last = Vec::new();
        let mut simulation = Simulation::new(&scenario, 7).unwrap();
        let first: Vec<[f64; 2]> = (0..12).map(|id| levels(&simulation, RobotId(id))).collect();
        let mut dis = policy("DIS");
        while simulation.step(&mut *dis).is_none() {
            last = (0..12).map(|id| levels(&simulation, RobotId(id))).collect();
        }
        let spent: Vec<f64> = simulation.finish().robots.iter().map(|robot| robot.energy_spent).collect();
        let losses: Vec<[f64; 2]> = first
            .iter()
            .zip(&last)
            .map(|(first, last): (&[f64; 2], &[f64; 2])| [first[0] - last[0], first[1] - last[1]])
            .collect();
        (losses, spent)
    };
    let ((percent, spent_percent), (points, spent_points)) = (after("unit: Percent"), after("unit: Points"));
    // Health changes the speed a little, so nothing is quite the same: observers have 100 and 50 points, the
    // others 150 and 100.
    for id in 0..12 {
        let ratio = |level: usize| points[id][level] / percent[id][level];
        let [energy, hp] = if id < 10 { [1.0 / 1.5, 1.0] } else { [1.0, 2.0] };
        assert!((ratio(0) / energy - 1.0).abs() < 0.02, "robot {id}: {} of {energy}", ratio(0));
        assert!(
            percent[id][1] <= 0.0 || (ratio(1) / hp - 1.0).abs() < 0.1,
            "robot {id}: {} of {hp}",
            ratio(1)
        );
        let told = spent_points[id] / spent_percent[id];
        assert!((told - 1.0).abs() < 0.02, "results count in the unit of the costs: robot {id}: {told}");
    }
    assert!((0..12).any(|id| percent[id][1] > 0.05), "somebody is in a zone");
}

#[test]
fn a_group_whose_observer_rests_is_without_one_if_the_reading_says_so() {
    let share = |scenario: &Scenario| {
        let (mut slowed, mut rested) = (0_u32, 0_u32);
        watch(scenario, |simulation| {
            let (mission, world) = (simulation.mission(), simulation.world());
            for group in &mission.crew.groups {
                let activity = |id: &RobotId| mission.crew.agents[id.index()].activity;
                let observer = group.members.iter().find(|id| world.robots[id.index()].spec.guides);
                let Some(observer) = observer.filter(|id| matches!(activity(id), Activity::Resting(_)))
                else {
                    continue;
                };
                for id in group.members.iter().filter(|id| *id != observer && activity(id).is_in_field()) {
                    let robot = &world.robots[id.index()];
                    let full = mission.crew.speed_of(simulation.model(), robot) / robot.speed();
                    rested += 1;
                    slowed += u32::from((full - 0.7).abs() < 1e-9);
                }
            }
        });
        (slowed, rested)
    };
    let (slowed, rested) = share(&paper_with(&[TIRING]));
    assert!(rested > 100 && slowed == 0, "{slowed} of {rested}");
    let (slowed, rested) = share(&paper_with(&[TIRING, ("resting_guides: true", "resting_guides: false")]));
    assert!(rested > 100 && slowed >= rested - 10, "{slowed} of {rested}");
}

/// In each round: who is in a group, of the robots that can act.
fn grouped(scenario: &Scenario) -> Vec<[usize; 2]> {
    let mut rounds = Vec::new();
    watch(scenario, |simulation| {
        for event in simulation.events() {
            if let Event::RoundStarted { groups, .. } = event {
                let able = simulation.world().robots.iter().filter(|robot| robot.is_able()).count();
                rounds.push([groups.iter().map(Vec::len).sum(), able]);
            }
        }
    });
    rounds
}

#[test]
fn a_round_waits_for_robots_that_rest_at_home_if_the_reading_says_so() {
    let tired = ("energy: (mean: 80.0, sd: 20.0)", "energy: (mean: 40.0, sd: 20.0)");
    let during = grouped(&paper_with(&[tired]));
    assert!(
        during[0][0] < during[0][1],
        "some are low at first, and the first round goes on without them: {during:?}"
    );
    let before = grouped(&paper_with(&[tired, ("rest_at_home: DuringRound", "rest_at_home: BeforeRound")]));
    assert!(before.len() >= 2 && before.iter().all(|[grouped, able]| grouped == able), "{before:?}");
}

#[test]
fn a_round_begins_without_robots_that_rest_if_the_reading_says_so() {
    let waits = grouped(&paper_with(&[TIRING]));
    assert!(waits.iter().all(|[grouped, able]| grouped == able), "{waits:?}");
    let goes_on = grouped(&paper_with(&[TIRING, ("round_end: EverybodyHome", "round_end: WithoutResting")]));
    assert!(goes_on.iter().any(|[grouped, able]| grouped < able), "{goes_on:?}");
    assert!(goes_on.len() > waits.len(), "rounds are shorter: {} {}", goes_on.len(), waits.len());
}

/// Robots that left the field for rest, robots that ended without energy, and the least final energy in
/// percent.
fn tired(changes: &[(&str, &str)]) -> (usize, usize, f64) {
    let scenario = paper_with(changes);
    let (mut turned_back, mut were_in_field) = (0, vec![false; 12]);
    watch(&scenario, |simulation| {
        let turns =
            |event: &&Event| matches!(event, Event::TurnedBack { robot, .. } if were_in_field[robot.index()]);
        turned_back += simulation.events().iter().filter(turns).count();
        let agents = &simulation.mission().crew.agents;
        were_in_field = agents.iter().map(|agent| agent.activity.is_in_field()).collect();
    });
    let record = trial(&scenario, "DIS", 7);
    let least = record.robots.iter().map(|robot| robot.final_energy).fold(f64::INFINITY, f64::min);
    for decided in &record.decisions {
        let eng = |member: &teaming::Member| member.needs.values()[3];
        assert!(decided.question.members.iter().all(|member| eng(member) >= 0.0));
    }
    (turned_back, record.stranded(), least)
}

/// A round costs a robot about 60 % of its energy here, so that some begin one that they cannot end.
#[test]
fn a_robot_finishes_its_round_and_goes_on_with_an_empty_battery_if_the_readings_say_so() {
    let costly = ("per_step: 0.0045", "per_step: 0.018");
    let rule = |rule: &'static str| ("energy_turn_back: AtOnce", rule);
    let (turned_back, ..) = tired(&[costly]);
    assert!(turned_back > 5, "{turned_back}");
    let (_, stranded, least) = tired(&[costly, rule("energy_turn_back: AfterRound")]);
    assert!(stranded > 3 && least >= 0.0, "no reserve keeps {stranded} robots from stopping, {least}");
    let goes_on = rule("energy_turn_back: AfterRound, empty_battery: GoesOn");
    let (turned_back, stranded, least) = tired(&[costly, goes_on]);
    assert_eq!((turned_back, stranded), (0, 0));
    assert!(least < 0.0, "{least}");
}

#[test]
fn a_load_is_kept_through_a_rest_if_the_reading_says_so() {
    let places = |scenario: &Scenario| {
        let mut places = [0, 0];
        watch(scenario, |simulation| {
            for event in simulation.events() {
                if let Event::Delivered { place, .. } = event {
                    places[usize::from(*place == Place::Rest)] += 1;
                }
            }
        });
        places
    };
    let [_, at_rest] = places(&paper_with(&[TIRING]));
    assert!(at_rest > 10, "{at_rest}");
    let [home, at_rest] = places(&paper_with(&[TIRING, ("load_at_rest: Delivered", "load_at_rest: Kept")]));
    assert!(home > 10 && at_rest == 0, "{home} {at_rest}");
}

#[test]
fn work_costs_energy_hp_and_speed_if_the_reading_says_so() {
    let costly = paper_with(&[
        (
            "work: (energy_per_second: 0.0, hp_per_second: 0.0)",
            "work: (energy_per_second: 1.0, hp_per_second: 0.2)",
        ),
        ("load_speed_loss: 0.0", "load_speed_loss: 0.5"),
        ("loading_s: 2.0", "loading_s: 4.0"),
    ]);
    let (mut loading, mut laden, mut before) = (0, 0, vec![[100.0; 2]; 12]);
    watch(&costly, |simulation| {
        let now: Vec<[f64; 2]> = (0..12).map(|id| levels(simulation, RobotId(id))).collect();
        for robot in &simulation.world().robots {
            let (id, agent) = (robot.id.index(), &simulation.mission().crew.agents[robot.id.index()]);
            let lost = |level: usize| before[id][level] - now[id][level];
            if matches!(agent.activity, Activity::Loading(..)) && simulation.time_s() > 1.0 {
                loading += usize::from(lost(0) >= 0.02 - 1e-9 && lost(1) >= 0.004 - 1e-9);
            }
            if robot.load.len() == 3 && robot.spec.capacity == 6 {
                let speed = simulation.mission().crew.speed_of(simulation.model(), robot);
                laden += usize::from((speed / robot.speed() - 0.75).abs() < 1e-9);
            }
        }
        before = now;
    });
    assert!(loading > 1000 && laden > 100, "{loading} {laden}");
}

/// The hard task has six rescuees, which are soon rescued.
const SIX: (&str, &str) = ("size_m: (11.0, 5.7), grid: (20, 10)", "size_m: (11.0, 5.7), grid: (3, 2)");

/// For each round, the rescuees of the hard task as the question has them, and its robots.
fn hard_task(scenario: &Scenario) -> Vec<(Option<u32>, usize)> {
    let record = trial(scenario, "DIS", 7);
    let of_round = |asked: &DecisionRecord| {
        (asked.question.tasks[0].rescuees, asked.decision.assignment.groups[0].len())
    };
    record.decisions.iter().map(of_round).collect()
}

#[test]
fn a_task_where_nobody_waits_gets_no_robots_unless_the_scenario_asks_for_it() {
    let groups = hard_task(&paper_with(&[SIX]));
    assert_eq!(groups[0], (Some(6), 6));
    assert!(groups.contains(&(Some(0), 6)), "{groups:?}");
    let nobody = hard_task(&paper_with(&[SIX, ("empty_tasks: GetGroups", "empty_tasks: GetNobody")]));
    assert_eq!(nobody[0], (Some(6), 6));
    let emptied = nobody.iter().position(|(waiting, _)| *waiting == Some(0)).unwrap();
    assert!(nobody[emptied..].iter().all(|round| *round == (Some(0), 0)), "{nobody:?}");
    assert!(nobody[..emptied].iter().all(|(_, robots)| *robots > 0), "{nobody:?}");
}

#[test]
fn an_answer_that_sends_all_robots_to_one_task_is_for_scenarios_with_free_sizes() {
    struct AllToTheFirst;
    impl Policy for AllToTheFirst {
        fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
            let all = question.members.iter().map(|member| member.id).collect();
            Ok(Decision::unscored(vec![all, Vec::new()]))
        }
    }
    let run = |scenario: &Scenario| {
        Simulation::new(scenario, 7).unwrap().checked().run(&AllToTheFirst, |_, _, _| {})
    };
    let Status::Failed(reason) = run(&paper_with(&[])).status else { panic!("it is refused") };
    assert_eq!(
        reason,
        "the policy failed: role \"carrier\" must be split into parts of [3, 3] members, found [0, 6]"
    );
    let record = run(&paper_with(&[("group_sizes: Parts", "group_sizes: Free")]));
    assert_eq!(record.status, Status::Completed);
    assert!(record.task("hard").unwrap().rescued > 0 && record.task("easy").unwrap().rescued == 0);
    let empty_gets_nobody = ("empty_tasks: GetGroups", "empty_tasks: GetNobody");
    let record = run(&paper_with(&[("group_sizes: Parts", "group_sizes: Free"), SIX, empty_gets_nobody]));
    let last = record.decisions.last().map(|asked| asked.question.tasks[0].rescuees);
    assert!(last == Some(Some(0)) && record.status == Status::Completed, "free sizes stay free");
}

#[test]
fn idle_robots_stay_at_home() {
    struct FirstIsIdle;
    impl Policy for FirstIsIdle {
        fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
            let mut decision = policy("DIS").decide(&Asked::of(question))?;
            let groups = &mut decision.assignment.groups;
            groups.iter_mut().for_each(|group| group.retain(|id| *id != 0));
            decision.assignment.idle = vec![0];
            Ok(decision)
        }
    }
    let first_second = |scenario: &Scenario| {
        let mut trial = Simulation::new(scenario, 7).unwrap().checked();
        let status = (0..500).find_map(|_| trial.step(&FirstIsIdle));
        (status, trial)
    };
    let (refused, _) = first_second(&paper_with(&[]));
    let reason = "the policy failed: robot 0 is left idle, and this question does not allow that";
    assert_eq!(refused, Some(Status::Failed(reason.to_owned())));
    let (status, trial) = first_second(&paper_with(&[("may_idle: false", "may_idle: true")]));
    assert_eq!(status, None);
    let [home, away] = [0, 1].map(|id| {
        let robot = &trial.world().robots[id];
        (robot.position - robot.home).length()
    });
    assert!(home < 0.5 && away > 5.0, "{home} {away}");
    assert_eq!(trial.mission().crew.agents[0].activity, Activity::Home);
}

#[test]
fn an_answer_that_keeps_all_who_can_carry_at_home_is_refused() {
    struct OnlyObservers;
    impl Policy for OnlyObservers {
        fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
            let mut decision = Decision::unscored(vec![vec![10], vec![11]]);
            let others = question.members.iter().map(|member| member.id).filter(|id| *id < 10);
            decision.assignment.idle = others.collect();
            Ok(decision)
        }
    }
    let mut trial = Simulation::new(&paper_with(&[("may_idle: false", "may_idle: true")]), 7).unwrap();
    let reason = "the policy failed: an assignment must send out a robot that can carry, if there is one";
    assert_eq!(trial.step(&OnlyObservers), Some(Status::Failed(reason.to_owned())));
}

#[test]
fn policies_are_told_what_the_scenario_says_of_its_tasks() {
    let facts = "grid: (3, 2), value: 2.5, requires: {\"sen\": 20}, duration_s: 300, after: [\"easy\"]";
    let scenario =
        paper_with(&[("size_m: (11.0, 5.7), grid: (20, 10)", &format!("size_m: (11.0, 5.7), {facts}"))]);
    let mut trial = Simulation::new(&scenario, 1).unwrap();
    let Advance::Asks(Ask::Grouping(question)) = trial.advance() else { panic!("it asks first") };
    let [hard, easy] = &question.tasks[..] else { panic!("two tasks") };
    let told = (hard.rescuees, hard.value, hard.duration_s, &hard.after[..]);
    assert_eq!(told, (Some(6), Some(2.5), Some(300.0), &[TaskId(1)][..]));
    assert_eq!(hard.requires, [("sen".to_owned(), 20.0)].into());
    assert_eq!((easy.rescuees, easy.value, easy.duration_s), (Some(200), None, None));
    assert!(easy.requires.is_empty() && easy.after.is_empty());
}

#[test]
fn a_mission_may_have_64_tasks() {
    let task = |i: u32| {
        let [x, y] = [10 * (i % 8) + 5, 10 * (i / 8) + 15];
        format!(
            "(name: \"t{i}\", difficulty: {i}, center: ({x}, {y}), size_m: (1, 1), grid: (1, 1), \
             rest: ({x}, {y}))"
        )
    };
    let tasks: Vec<String> = (0..64).map(task).collect();
    let text = format!(
        "(name: \"many\", duration_s: 20, dt_s: 0.02, arena_m: (80, 100), tasks: [{}],
            team: [(role: \"robot\", count: 64, center: (40, 4), width_m: 78)])",
        tasks.join(",")
    );
    let scenario = Scenario::parse(&text, "many.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"));
    let record = trial(&scenario, "DIS", 1);
    assert_eq!(record.status, Status::Completed);
    assert!(record.decisions[0].decision.assignment.groups.iter().all(|group| group.len() == 1));
    let one_more = text.replace("tasks: [", &format!("tasks: [{},", task(63).replace("t63", "t64")));
    let error = Scenario::parse(&one_more, "many.ron".as_ref()).unwrap_err().to_string();
    assert!(error.contains("tasks must have at most 64 entries, found 65"), "{error}");
}
