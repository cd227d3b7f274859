//! Protocols among robots, without a world: what each robot hears is said by a table, and time goes in steps
//! of a tenth of a second.

use std::collections::BTreeMap;

use proptest::prelude::*;
use rne_core::NeedVector;
use serde_json::Value;
use teaming::{
    Asked, Assignment, GroupSizes, Level, Member, Need, Question, Quota, RoleId, Say, Task, Told, Turn,
};

/// Robots of one role with these energies. The first task is harder, and gets `hard` of them.
fn question(energies: &[f64], hard: usize) -> Question {
    let member = |(id, energy): (usize, &f64)| Member {
        id: id as u32,
        role: RoleId(0),
        home: [0.0; 2],
        needs: NeedVector::new(vec![*energy + 1.0]).unwrap(),
        levels: vec![Some(*energy), Some(100.0)],
    };
    Question {
        roles: vec!["robot".to_owned()],
        needs: vec![Need { name: "eng".to_owned(), weight: 1.0 }],
        levels: Level::energy_and_hp(),
        tasks: vec![Task::new("hard", 2), Task::new("easy", 1)],
        quotas: vec![Quota { members: vec![hard, energies.len() - hard], sizes: GroupSizes::Binding }],
        members: energies.iter().enumerate().map(member).collect(),
        ..Question::default()
    }
}

/// A robot in a negotiation.
struct Robot {
    question: Question,
    told: Vec<Told>,
    state: Value,
    wakes_at: Option<f64>,
    joins: Option<Assignment>,
    /// How often it said how the others are.
    shares: u32,
}

/// What comes of a negotiation in which robot `i` sees the team as in `sees[i]`.
fn negotiate(policy: &str, sees: Vec<Question>, hears: impl Fn(u32, u32) -> bool) -> Vec<Robot> {
    let mut session = policies::standard().parse(policy).unwrap().open().unwrap();
    let base = sees[0].clone();
    let robot = |(id, question): (usize, Question)| Robot {
        question: Question { asker: Some(id as u32), ..question },
        told: Vec::new(),
        state: Value::Null,
        wakes_at: Some(0.0),
        joins: None,
        shares: 0,
    };
    let mut robots: Vec<Robot> = sees.into_iter().enumerate().map(robot).collect();
    for step in 0..1000 {
        let now_s = f64::from(step) / 10.0;
        let is_due =
            |robot: &Robot| !robot.told.is_empty() || robot.wakes_at.is_some_and(|at| at <= now_s + 1e-9);
        let due: Vec<u32> = (0..).zip(&robots).filter(|(_, robot)| is_due(robot)).map(|(id, _)| id).collect();
        let turn = |id: &u32| {
            let robot = &robots[*id as usize];
            let (told, state, question) = (robot.told.clone(), robot.state.clone(), robot.question.clone());
            Turn { robot: *id, since_s: now_s, told, state, rule: None, question, late: None }
        };
        let turns: Vec<Turn> = due.iter().map(turn).collect();
        let acts = session.act(&turns, &Asked::of(&base)).unwrap();
        let mut said: BTreeMap<u32, Vec<Say>> = BTreeMap::new();
        for (id, act) in due.into_iter().zip(acts) {
            let robot = &mut robots[id as usize];
            robot.told.clear();
            (robot.state, robot.wakes_at) =
                (act.state, act.wake_in_s.map(|seconds| now_s + seconds.max(0.1)));
            robot.shares += u32::from(act.shares);
            let tasks = robot.question.tasks.len();
            robot.joins = act.joins.map(|choice| choice.seen_by(id, tasks).unwrap()).or(robot.joins.take());
            said.insert(id, act.says);
        }
        for (from, Say { to, what }) in
            said.into_iter().flat_map(|(from, says)| says.into_iter().map(move |say| (from, say)))
        {
            for (id, robot) in (0..).zip(&mut robots) {
                if id != from && to.is_none_or(|to| to == id) && hears(id, from) {
                    robot.told.push(Told { from, what: what.clone(), age_s: 0.1 });
                }
            }
        }
        if robots.iter().all(|robot| robot.joins.is_some()) {
            return robots;
        }
    }
    panic!("{policy}: no end after 100 s");
}

/// The task to which each robot goes.
fn places(robots: &[Robot]) -> Vec<usize> {
    let place = |(id, robot): (u32, &Robot)| robot.joins.as_ref().unwrap().task_of(id).unwrap().index();
    (0..).zip(robots).map(place).collect()
}

const TALKS: [&str; 4] = ["ENG by Gossip", "ENG by Majority", "ENG by Leader", "ENG by Leader(by: Energy)"];

proptest! {
    /// Robots that know the same and hear each other do as the base would.
    #[test]
    fn who_knows_the_same_decides_the_same(
        energies in prop::collection::vec(0.0_f64..100.0, 1..9),
        hard in 0_usize..9,
    ) {
        let question = question(&energies, hard.min(energies.len()));
        let central = policies::standard().parse("ENG").unwrap().decide(&question).unwrap().assignment;
        let ids = question.members.iter().map(|member| member.id);
        let expected: Vec<usize> = ids.map(|id| central.task_of(id).unwrap().index()).collect();
        for policy in TALKS {
            let robots = negotiate(policy, vec![question.clone(); energies.len()], |_, _| true);
            prop_assert_eq!(places(&robots), expected.clone(), "{}", policy);
        }
    }

    /// Whatever is lost, a negotiation ends, and each robot has a place.
    #[test]
    fn a_negotiation_ends_whatever_is_lost(
        energies in prop::collection::vec(0.0_f64..100.0, 8),
        lost in prop::collection::vec(any::<bool>(), 64),
    ) {
        let sees = (0..8).map(|robot| {
            let known = energies.iter().zip(0..).map(|(level, id)| if id == robot { *level } else { 50.0 });
            question(&known.collect::<Vec<f64>>(), 3)
        });
        for policy in TALKS {
            let hears = |to: u32, from: u32| !lost[(8 * to + from) as usize];
            let robots = negotiate(policy, sees.clone().collect(), hears);
            prop_assert_eq!(places(&robots).len(), 8);
        }
    }
}

#[test]
fn gossip_shares_what_was_heard_so_often_as_its_option_says() {
    let sees = vec![question(&[10.0, 20.0, 30.0], 1); 3];
    for (exchanges, every_s) in [(1, 0.0), (3, 0.5), (7, 2.0)] {
        let policy = format!("ENG by Gossip(exchanges: {exchanges}, every_s: {every_s})");
        let robots = negotiate(&policy, sees.clone(), |_, _| true);
        assert!(robots.iter().all(|robot| robot.shares == exchanges), "{policy}");
    }
}

/// The example by hand of its file.
#[test]
fn a_majority_outvotes_a_robot_and_a_tie_leaves_it_where_it_sees_itself() {
    let sees = || {
        vec![
            question(&[90.0, 50.0, 40.0], 1),
            question(&[10.0, 50.0, 40.0], 1),
            question(&[10.0, 50.0, 40.0], 1),
        ]
    };
    assert_eq!(places(&negotiate("ENG by Majority", sees(), |_, _| true)), [1, 0, 1]);
    let deaf = |to: u32, from: u32| (to, from) != (0, 2);
    assert_eq!(places(&negotiate("ENG by Majority", sees(), deaf)), [0, 0, 1]);
}

#[test]
fn all_go_where_the_best_leader_that_they_hear_sees_them() {
    let sees = || {
        vec![
            question(&[10.0, 60.0, 70.0, 80.0], 2),
            question(&[90.0, 20.0, 30.0, 25.0], 2),
            question(&[90.0, 95.0, 30.0, 40.0], 2),
            question(&[90.0, 5.0, 95.0, 96.0], 2),
        ]
    };
    // Robot 0 leads by its number, and robot 3 by its energy of 96.
    assert_eq!(places(&negotiate("ENG by Leader", sees(), |_, _| true)), [1, 1, 0, 0]);
    assert_eq!(places(&negotiate("ENG by Leader(by: Energy)", sees(), |_, _| true)), [1, 1, 0, 0]);
    // Who hears nobody leads itself alone, and goes by its own view.
    assert_eq!(places(&negotiate("ENG by Leader", sees(), |_, _| false)), [1, 1, 1, 0]);
    // Two halves that do not hear each other have two leaders, 0 and 2.
    let halves = |to: u32, from: u32| (to < 2) == (from < 2);
    assert_eq!(places(&negotiate("ENG by Leader", sees(), halves)), [1, 1, 1, 1]);
}
