//! Evidence for questions about teams of any size.

use std::collections::BTreeMap;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use teaming::{
    Body, Evidence, Expected, GroupOutcome, Level, LevelId, LevelNeed, LevelReport, Member, MemberOutcome,
    Need, NeedId, Question, Rating, RobotRound, RoundOutcome, TaskId,
};

/// Reports of a robot in a round: one every ten seconds of 150.
const REPORTS: u32 = 15;

/// Length of a round, in seconds.
const ROUND_S: f64 = 150.0;

/// Mates that each robot rates in a round at most.
const MATES: usize = 10;

/// The question with seven rounds of evidence, asked in the eighth. Robots report every ten seconds and rate
/// up to ten mates a round.
#[must_use]
pub fn with_evidence(question: Question) -> Question {
    let mut draws = ChaCha8Rng::seed_from_u64(11);
    let ids: Vec<u32> = question.members.iter().map(|member| member.id).collect();
    let tasks = question.tasks.len();
    let dealt = |task: usize| ids.iter().skip(task).step_by(tasks).copied().collect();
    let groups: Vec<Vec<u32>> = (0..tasks).map(dealt).collect();
    let mut evidence = Evidence {
        bodies: question.members.iter().map(|member| body(member, &question.needs)).collect(),
        ..Evidence::default()
    };
    for round in 1..8 {
        for number in 0..REPORTS {
            let reports = question.members.iter().map(|member| report(member, round, number, &mut draws));
            evidence.reports.extend(reports);
        }
        for group in &groups {
            for (place, by) in group.iter().enumerate() {
                let mates = (1..group.len().min(MATES + 1)).map(|step| group[(place + step) % group.len()]);
                evidence.ratings.extend(mates.map(|of| rating(*by, of, round, &mut draws)));
            }
        }
        evidence.ledger.extend(ids.iter().map(|robot| trip(*robot, round)));
    }
    evidence.reports.extend(question.members.iter().map(|member| report(member, 8, 0, &mut draws)));
    let history = (1..8).map(|round| outcome(round, &groups)).collect();
    let expected = [Expected { mean: 80.0, sd: 20.0 }, Expected { mean: 90.0, sd: 10.0 }];
    let levels = question.levels.into_iter().zip(expected);
    let levels = levels.map(|(level, of)| Level { threshold: 20.0, expected: Some(of), ..level }).collect();
    Question { round: 8, levels, history, evidence: Some(evidence), may_idle: true, ..question }
}

/// What follows from a level, by the name of the need, and its value at 100 %.
const OF_LEVELS: [(&str, LevelId, f64); 4] =
    [("hp", LevelId(1), 100.0), ("v", LevelId(1), 2.0), ("sen", LevelId(1), 5.0), ("eng", LevelId(0), 100.0)];

fn body(member: &Member, needs: &[Need]) -> Body {
    let follows = |(need, of): (u16, &Need)| {
        let (_, level, at_100) = OF_LEVELS.into_iter().find(|(name, ..)| *name == of.name)?;
        Some(LevelNeed { need: NeedId(need), level, at_0: 0.0, at_100 })
    };
    let needs = (0..).zip(needs).filter_map(follows).collect();
    let (robot, slowed_by) = (member.id, LevelId(1));
    let (carries, guides) = (member.role.index() == 0, member.role.index() == 2);
    Body { robot, top_mps: 2.0, slowed_by, floor: 0.5, carries, guides, needs }
}

fn report(member: &Member, round: u32, number: u32, draws: &mut ChaCha8Rng) -> LevelReport {
    let sent_s = ROUND_S * f64::from(round) + 10.0 * f64::from(number);
    let spent = 6.0 * ((f64::from(round) - 8.0) + f64::from(number) / f64::from(REPORTS));
    let [energy, hp] = [0, 1].map(|level| member.level(LevelId(level)).unwrap_or_default());
    let noise: f64 = draws.random_range(-2.0..2.0);
    LevelReport {
        of: member.id,
        by: member.id,
        round,
        sent_s,
        heard_s: sent_s,
        levels: [energy - spent + noise, hp + noise].map(|level| level.clamp(0.0, 100.0)).to_vec(),
        needs: BTreeMap::new(),
        sd: vec![2.0; 2],
    }
}

fn rating(by: u32, of: u32, round: u32, draws: &mut ChaCha8Rng) -> Rating {
    Rating { by, of, round, looks: 30, speed_mps: draws.random_range(1.2..2.0), said_mps: 1.8 }
}

fn trip(robot: u32, round: u32) -> RobotRound {
    let left_s = ROUND_S * f64::from(round);
    let back_s = Some(left_s + ROUND_S - 10.0);
    RobotRound { robot, round, left_s, back_s, rescued: 1, turned_back: false, rested: false, lost: false }
}

fn outcome(round: u32, groups: &[Vec<u32>]) -> RoundOutcome {
    let of = |(task, ids): (u16, &Vec<u32>)| GroupOutcome {
        task: TaskId(task),
        rescued: ids.len() as u32,
        energy: 6.0 * ids.len() as f64,
        hp: 0.0,
        members: ids.iter().map(|id| MemberOutcome { id: *id, ..MemberOutcome::default() }).collect(),
    };
    RoundOutcome { round, duration_s: ROUND_S - 10.0, groups: (0..).zip(groups).map(of).collect() }
}
