//! A team of twelve, seven rounds of what it said, and two robots that do not say what is true.

use std::collections::BTreeMap;

use rne_core::NeedVector;
use teaming::question::hardest_first;
use teaming::{
    Body, Estimate, Evidence, Expected, GroupOutcome, Level, LevelId, LevelNeed, LevelReport, Member,
    MemberOutcome, Need, NeedId, Question, Quota, RandomSeed, Rating, RobotRound, RoleId, RoundOutcome, Task,
    TaskId, Truth,
};

/// Says its health is 100 %, whatever it is.
pub const BRAGGER: u32 = 2;

/// Says 40 points more energy than it has from the fourth round on.
pub const CHEAT: u32 = 5;

/// The round of the question.
pub const ROUND: u32 = 8;

/// What a robot spends in a round, in percent points.
const USED: [f64; 2] = [6.0, 1.0];

/// Half the speed at full health at 0 %.
const FLOOR: f64 = 0.5;

const TOP_MPS: f64 = 2.0;

const ENERGY: LevelId = LevelId(0);

const HP: LevelId = LevelId(1);

fn true_levels(robot: u32, round: u32) -> [f64; 2] {
    let before = f64::from(round - 1);
    let first = [90.0 - f64::from(robot), if robot == BRAGGER { 30.0 } else { 95.0 - f64::from(robot) }];
    [first[0] - USED[0] * before, first[1] - USED[1] * before]
}

pub fn said_levels(robot: u32, round: u32) -> [f64; 2] {
    let [energy, hp] = true_levels(robot, round);
    let energy = if robot == CHEAT && round >= 4 { energy + 40.0 } else { energy };
    [energy, if robot == BRAGGER { 100.0 } else { hp }]
}

fn speed(hp: f64) -> f64 {
    TOP_MPS * (FLOOR + (1.0 - FLOOR) * hp / 100.0)
}

/// The group of a robot: half of each role in each.
fn group(robot: u32) -> u32 {
    robot % 2
}

fn role(robot: u32) -> RoleId {
    RoleId(u16::from(robot >= 6))
}

fn needs([energy, hp]: [f64; 2], robot: u32) -> NeedVector {
    let carries = f64::from(u8::from(role(robot) == RoleId(0)));
    NeedVector::new(vec![hp, speed(hp), 1.5 * energy, 5.0 * carries]).unwrap()
}

fn member(robot: u32) -> Member {
    let levels = said_levels(robot, ROUND);
    Member {
        id: robot,
        role: role(robot),
        home: [f64::from(robot), 0.0],
        needs: needs(levels, robot),
        levels: levels.map(Some).to_vec(),
    }
}

fn body(robot: u32) -> Body {
    let follows = |need, level, at_0, at_100| LevelNeed { need: NeedId(need), level, at_0, at_100 };
    Body {
        robot,
        top_mps: TOP_MPS,
        slowed_by: HP,
        floor: FLOOR,
        carries: robot < 6,
        guides: robot == 11,
        needs: vec![
            follows(0, HP, 0.0, 100.0),
            follows(1, HP, FLOOR * TOP_MPS, TOP_MPS),
            follows(2, ENERGY, 0.0, 150.0),
        ],
    }
}

fn report(robot: u32, round: u32) -> LevelReport {
    let sent_s = 100.0 * f64::from(round);
    let levels = said_levels(robot, round).to_vec();
    let (of, by, heard_s, needs) = (robot, robot, sent_s, BTreeMap::new());
    LevelReport { of, by, round, sent_s, heard_s, levels, needs, sd: vec![2.0, 1.0] }
}

fn rating(by: u32, of: u32, round: u32) -> Rating {
    let error = 0.01 * (f64::from(by) - 5.5) / 5.5;
    let speed_mps = speed(true_levels(of, round)[1]) * (1.0 + error);
    Rating { by, of, round, looks: 30, speed_mps, said_mps: speed(said_levels(of, round)[1]) }
}

fn trip(robot: u32, round: u32) -> RobotRound {
    let left_s = 100.0 * f64::from(round);
    let (back_s, rescued) = (Some(left_s + 90.0), 1);
    RobotRound { robot, round, left_s, back_s, rescued, turned_back: false, rested: false, lost: false }
}

fn outcome(round: u32) -> RoundOutcome {
    let member = |id| MemberOutcome { id, ..MemberOutcome::default() };
    let of = |task: u16| {
        let members = (0..12).filter(|robot| group(*robot) == u32::from(task)).map(member).collect();
        GroupOutcome { task: TaskId(task), rescued: 6, energy: 36.0, hp: 6.0, members }
    };
    RoundOutcome { round, duration_s: 90.0, groups: vec![of(0), of(1)] }
}

fn evidence() -> Evidence {
    let rounds = 1..ROUND;
    let pairs = |round: u32| {
        let mates = move |by: u32| {
            (0..12).filter(move |of| *of != by && group(*of) == group(by)).map(move |of| (by, of))
        };
        (0..12).flat_map(mates).map(move |(by, of)| rating(by, of, round))
    };
    Evidence {
        reports: (1..=ROUND).flat_map(|round| (0..12).map(move |robot| report(robot, round))).collect(),
        ratings: rounds.clone().flat_map(pairs).collect(),
        ledger: rounds.flat_map(|round| (0..12).map(move |robot| trip(robot, round))).collect(),
        bodies: (0..12).map(body).collect(),
        ..Evidence::default()
    }
}

/// The question of the eighth round.
pub fn question() -> Question {
    let tasks = vec![Task::new("near", 1), Task::new("far", 2)];
    let order = hardest_first(tasks.iter().map(|task| task.difficulty));
    let expected = [Expected { mean: 80.0, sd: 20.0 }, Expected { mean: 90.0, sd: 10.0 }];
    let level = |(level, of)| Level { threshold: 20.0, expected: Some(of), ..level };
    let need = |name: &str| Need { name: name.to_owned(), weight: 1.0 };
    let question = Question {
        round: ROUND,
        roles: vec!["mover".to_owned(), "scout".to_owned()],
        needs: ["hp", "v", "eng", "cap"].map(need).to_vec(),
        tasks,
        quotas: Quota::equal(&[6, 6], &order),
        members: (0..12).map(member).collect(),
        may_idle: true,
        history: (1..ROUND).map(outcome).collect(),
        levels: Level::energy_and_hp().into_iter().zip(expected).map(level).collect(),
        random_seed: RandomSeed::from(1),
        evidence: Some(evidence()),
        ..Question::default()
    };
    question.checked().unwrap()
}

/// The members as they really are.
pub fn team() -> Vec<Member> {
    let is = |robot| Member { levels: true_levels(robot, ROUND).map(Some).to_vec(), ..member(robot) };
    (0..12).map(is).collect()
}

/// What an estimator thinks of the members of a question.
pub fn estimates(estimator: &str, question: &Question) -> Vec<Estimate> {
    estimates_where(estimator, question, &team())
}

/// The same where the members really are like this.
pub fn estimates_where(estimator: &str, question: &Question, team: &[Member]) -> Vec<Estimate> {
    let made = policies::standard().estimator(estimator).unwrap_or_else(|error| panic!("{error}"));
    made.estimate(question, Some(Truth(team))).unwrap_or_else(|error| panic!("{estimator}: {error}"))
}

/// The names of all estimators.
pub fn names() -> Vec<String> {
    policies::standard().estimators().iter().map(|kind| kind.name.clone()).collect()
}
