//! What the base heard, and each robot where robots decide: the last that was said of each robot, and all
//! evidence.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use teaming::evidence::is_named;
use teaming::{Evidence, Extent, MemberOutcome, Rating, RobotRound, RoundOutcome};

use crate::belief::KnownRobot;
use crate::ids::RobotId;
use crate::model::Model;
use crate::report::{Levels, Message, Statement};

/// What the base or a robot heard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Heard {
    /// What was said of each robot last.
    last: Vec<Option<Said>>,
    /// All reports, ratings and rounds, in the order in which they were heard. What the base knows without
    /// them is in the model.
    pub log: Log,
    /// The rounds that are over, with the costs as they were said.
    pub history: Vec<RoundOutcome>,
    /// How much of the evidence each question had, in their order.
    pub extents: Vec<Extent>,
    /// The rounds since which robots have their present names.
    pub known_since: BTreeMap<u32, u32>,
    /// All falls of the levels that each robot said, in percent.
    spent: Vec<[f64; 2]>,
    /// The same when the last round began.
    spent_at_start: Vec<[f64; 2]>,
}

/// Evidence as it changes in a trial, without what is fixed.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Log {
    /// It stays as it is. The hash of a trial has counted it from the start.
    energy_threshold: f64,
    reports: Vec<Levels>,
    ratings: Vec<Rating>,
    ledger: Vec<RobotRound>,
    /// It stays empty, for the same reason.
    known_since: BTreeMap<u32, u32>,
}

impl Log {
    /// How much there is of it in a round, with these robots known since.
    pub fn extent(&self, round: u32, known_since: BTreeMap<u32, u32>) -> Extent {
        let Self { reports, ratings, ledger, .. } = self;
        Extent { round, reports: reports.len(), ratings: ratings.len(), ledger: ledger.len(), known_since }
    }

    /// What became of a robot in a round, if that was noted.
    pub(super) fn trip(&self, robot: u32, round: u32) -> Option<RobotRound> {
        self.ledger.iter().rev().find(|trip| trip.robot == robot && trip.round == round).copied()
    }

    /// All of it, as questions have it.
    pub fn evidence(&self) -> Evidence {
        Evidence {
            reports: self.reports.iter().map(Levels::listed).collect(),
            ratings: self.ratings.clone(),
            ledger: self.ledger.clone(),
            ..Evidence::default()
        }
    }
}

/// What was said of a robot.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Said {
    /// When it was sent, in seconds.
    sent_s: f64,
    levels: [f64; 2],
    needs: BTreeMap<usize, f64>,
}

impl Heard {
    pub(super) fn nothing(robots: usize, energy_threshold: f64) -> Self {
        Self {
            last: vec![None; robots],
            log: Log { energy_threshold, ..Log::default() },
            history: Vec::new(),
            extents: Vec::new(),
            known_since: BTreeMap::new(),
            spent: vec![[0.0; 2]; robots],
            spent_at_start: vec![[0.0; 2]; robots],
        }
    }

    /// Hears a message. Of the field, of who stays out and of what others heard, robots speak among
    /// themselves.
    pub(super) fn hear(&mut self, message: Message) {
        if let Statement::LevelsAre(levels) = message.report.says {
            self.hear_levels(Levels { heard_s: message.heard_s, ..levels });
        } else if let Statement::MateGoes(rating) = message.report.says {
            self.log.ratings.push(rating);
        }
    }

    /// Whether this report was heard before, at second hand.
    pub(super) fn has_heard(&self, report: &Levels) -> bool {
        self.last[report.of as usize].as_ref().is_some_and(|said| {
            said.sent_s.total_cmp(&report.sent_s).is_eq()
                && said.levels.map(f64::to_bits) == report.levels.map(f64::to_bits)
                && said.needs == report.needs
        })
    }

    /// When the last that was heard of a robot was sent, in seconds.
    pub(super) fn said_at_s(&self, robot: usize) -> Option<f64> {
        self.last[robot].as_ref().map(|said| said.sent_s)
    }

    /// The newest report of each robot that was heard.
    pub(super) fn newest(&self) -> impl Iterator<Item = &Levels> {
        let of = |(robot, last): (u32, &Option<Said>)| {
            let sent_s = last.as_ref()?.sent_s;
            let is_it = |report: &&Levels| report.of == robot && report.sent_s.total_cmp(&sent_s).is_eq();
            self.log.reports.iter().rev().find(is_it)
        };
        (0..).zip(&self.last).filter_map(of)
    }

    /// Hears what was said of a robot. What was sent before the last that was heard is evidence only.
    pub(super) fn hear_levels(&mut self, report: Levels) {
        let said = Said { sent_s: report.sent_s, levels: report.levels, needs: report.needs.clone() };
        let of = report.of as usize;
        self.log.reports.push(report);
        if let Some(before) = &self.last[of] {
            if said.sent_s < before.sent_s {
                return;
            }
            for ((spent, before), now) in self.spent[of].iter_mut().zip(before.levels).zip(said.levels) {
                *spent += (before - now).max(0.0);
            }
        }
        self.last[of] = Some(said);
    }

    /// The levels of a robot as they were said last, in percent.
    pub(super) fn levels(&self, robot: RobotId, never_heard: [f64; 2]) -> [f64; 2] {
        self.last[robot.index()].as_ref().map_or(never_heard, |said| said.levels)
    }

    /// What the others of a robot's role said of a level on average; `None` if nobody was heard.
    pub(super) fn mean_of_others(
        &self,
        robot: &KnownRobot,
        team: &[KnownRobot],
        level: usize,
    ) -> Option<f64> {
        let others = team.iter().filter(|other| other.role == robot.role && other.id != robot.id);
        let said: Vec<f64> =
            others.filter_map(|other| Some(self.last[other.id.index()].as_ref()?.levels[level])).collect();
        (!said.is_empty()).then(|| said.iter().sum::<f64>() / said.len() as f64)
    }

    /// The needs of a robot as they were said by themselves.
    pub(super) fn said_needs(&self, robot: RobotId) -> Option<&BTreeMap<usize, f64>> {
        self.last[robot.index()].as_ref().map(|said| &said.needs)
    }

    pub(super) fn begin_round(&mut self) {
        self.spent_at_start.clone_from(&self.spent);
    }

    /// How many rounds, and trips of them, were noted.
    pub(super) fn closed(&self) -> [usize; 2] {
        [self.history.len(), self.log.ledger.len()]
    }

    /// Forgets the rounds that were noted since there were so many.
    pub(super) fn reopen(&mut self, [rounds, trips]: [usize; 2]) {
        self.history.truncate(rounds);
        self.log.ledger.truncate(trips);
    }

    /// Notes a round that is over, as far as is known what became of its robots, with the costs that were
    /// said.
    pub(super) fn end_round(
        &mut self,
        witnessed: &RoundOutcome,
        known: impl Fn(&MemberOutcome) -> Option<RobotRound>,
        model: &Model,
    ) {
        let mut round = witnessed.clone();
        let unit = model.costs.unit;
        for group in &mut round.groups {
            let all = group.members.len();
            group.members.retain_mut(|member| {
                let Some(trip) = known(member) else { return false };
                let (id, spec) = (member.id as usize, &model.robots[member.id as usize].spec);
                let [energy, hp] = [0, 1].map(|level| self.spent[id][level] - self.spent_at_start[id][level]);
                member.energy = unit.of_percent(energy, spec.energy);
                member.hp = unit.of_percent(hp, spec.hp);
                (member.rescued, member.turned_back, member.lost) =
                    (trip.rescued, trip.turned_back, trip.lost);
                self.log.ledger.push(trip);
                true
            });
            if group.members.len() < all {
                group.rescued = group.members.iter().map(|member| member.rescued).sum();
            }
            group.energy = group.members.iter().map(|member| member.energy).sum();
            group.hp = group.members.iter().map(|member| member.hp).sum();
        }
        self.history.push(round);
    }
}

/// Rounds without robots that have taken a new name since.
pub fn named(rounds: &[RoundOutcome], known_since: &BTreeMap<u32, u32>) -> Vec<RoundOutcome> {
    let mut rounds = rounds.to_vec();
    for round in &mut rounds {
        for group in &mut round.groups {
            group.members.retain(|member| is_named(known_since, member.id, round.round));
        }
    }
    rounds
}

impl Trip {
    /// What became of a member of a group in a round that ends now.
    pub(super) fn ended(&self, member: &MemberOutcome, round: &RoundOutcome, time_s: f64) -> RobotRound {
        RobotRound {
            robot: member.id,
            round: round.round,
            left_s: time_s - round.duration_s,
            back_s: self.back_s,
            rescued: member.rescued,
            turned_back: member.turned_back,
            rested: self.rested,
            lost: member.lost,
        }
    }
}

/// What the base saw of a robot in this round.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Trip {
    /// When it was home again, in seconds.
    pub(super) back_s: Option<f64>,
    /// Whether it rested.
    pub(super) rested: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_sent_earlier_and_is_heard_later_is_evidence_only() {
        let report = |sent_s: f64, energy: f64| Levels {
            of: 0,
            by: 0,
            round: 1,
            sent_s,
            heard_s: sent_s,
            levels: [energy, 90.0],
            needs: BTreeMap::new(),
            sd: [0.0; 2],
        };
        let mut heard = Heard::nothing(1, 30.0);
        for (sent_s, energy) in [(10.0, 80.0), (30.0, 60.0), (20.0, 70.0)] {
            heard.hear_levels(report(sent_s, energy));
        }
        assert_eq!(heard.levels(RobotId(0), [0.0; 2]).map(f64::to_bits), [60.0, 90.0].map(f64::to_bits));
        assert_eq!((heard.log.reports.len(), heard.spent[0][0].to_bits()), (3, 20.0_f64.to_bits()));
        heard.hear_levels(report(30.0, 50.0)); // under another's name: after the true one
        assert_eq!(heard.levels(RobotId(0), [0.0; 2])[0].to_bits(), 50.0_f64.to_bits());
    }
}
