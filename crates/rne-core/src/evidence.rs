//! Evidence: what the base heard of the robots, from whom and when. It is part of the question where reports
//! may be late, lost, wrong or lies; estimators judge by it what is true and whom to believe.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::history::RoundOutcome;

/// Rounds for which ratings are kept.
pub const ROUNDS_OF_RATINGS: u32 = 64;

/// How far what a robot says it spent may lie from what its mates spent until it counts as false, in percent
/// points.
pub const DOUBTED_POINTS: f64 = 10.0;

/// What the base heard, in the order in which it heard it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// The level below which a robot rests, in percent.
    pub energy_threshold: f64,
    /// What robots said of themselves.
    pub reports: Vec<LevelReport>,
    /// What robots saw of their group-mates, in the last [`ROUNDS_OF_RATINGS`] rounds.
    pub ratings: Vec<Rating>,
    /// What the base saw of each robot, round by round.
    pub ledger: Vec<RobotRound>,
    /// For robots that took a new name: the round since which the base knows it. Of the rounds before,
    /// nothing names them. Others are known from the start.
    #[serde(default)]
    pub known_since: BTreeMap<u32, u32>,
}

/// What a robot said of its levels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelReport {
    /// The robot that it is about.
    pub of: u32,
    /// The robot that says so, by its own words.
    pub by: u32,
    /// The round in which it was sent.
    pub round: u32,
    /// When it was sent, in seconds.
    pub sent_s: f64,
    /// When it was heard, in seconds.
    pub heard_s: f64,
    /// Battery level, in percent.
    pub energy_level: f64,
    /// Health level, in percent.
    pub hp_level: f64,
    /// Needs that were said by themselves, by their places in the table; the others follow from the levels.
    #[serde(default)]
    pub needs: BTreeMap<usize, f64>,
    /// Standard deviations of the gauges of energy and health, in percent points.
    pub sd: [f64; 2],
}

/// What a robot says of the speed of a group-mate in a round.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rating {
    /// The robot that looked.
    pub by: u32,
    /// The robot that it looked at.
    pub of: u32,
    /// The round.
    pub round: u32,
    /// How often it looked.
    pub looks: u32,
    /// The highest speed that it saw, in metres per second, set right for what slows the whole group and for
    /// the load.
    pub speed_mps: f64,
    /// The top speed that follows from what the other had said of itself, in metres per second.
    pub said_mps: f64,
}

/// What the base saw of a robot in a round.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RobotRound {
    /// The robot.
    pub robot: u32,
    /// The round.
    pub round: u32,
    /// When it left home, in seconds.
    pub left_s: f64,
    /// When it was home again, in seconds; absent if it was not.
    pub back_s: Option<f64>,
    /// Rescuees that it delivered.
    pub rescued: u32,
    /// Whether it turned back to rest before its group went home.
    pub turned_back: bool,
    /// Whether it rested.
    pub rested: bool,
    /// Whether it was stranded or disabled.
    pub lost: bool,
}

/// How much of the evidence a question had: everything of which these are the numbers.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Extent {
    /// The round of the question.
    pub round: u32,
    /// Number of reports.
    pub reports: usize,
    /// Number of ratings.
    pub ratings: usize,
    /// Number of entries of the ledger.
    pub ledger: usize,
    /// See [`Evidence::known_since`].
    pub known_since: BTreeMap<u32, u32>,
}

impl Evidence {
    /// The extent of all of it in a round, with these robots known since.
    #[must_use]
    pub fn extent(&self, round: u32, known_since: BTreeMap<u32, u32>) -> Extent {
        let Self { reports, ratings, ledger, .. } = self;
        Extent { round, reports: reports.len(), ratings: ratings.len(), ledger: ledger.len(), known_since }
    }

    /// What of the evidence a question of this extent has.
    #[must_use]
    pub fn as_of(&self, extent: &Extent) -> Self {
        let names = |robot: u32, in_round: u32| is_named(&extent.known_since, robot, in_round);
        let reports = self.reports[..extent.reports].iter();
        let ratings = self.ratings[..extent.ratings].iter();
        let is_recent = |rating: &&Rating| rating.round + ROUNDS_OF_RATINGS >= extent.round;
        let both = |rating: &&Rating| names(rating.by, rating.round) && names(rating.of, rating.round);
        let ledger = self.ledger[..extent.ledger].iter();
        Self {
            energy_threshold: self.energy_threshold,
            reports: reports.filter(|report| names(report.of, report.round)).cloned().collect(),
            ratings: ratings.filter(is_recent).filter(both).copied().collect(),
            ledger: ledger.filter(|entry| names(entry.robot, entry.round)).copied().collect(),
            known_since: extent.known_since.clone(),
        }
    }

    /// How far the base believes what each robot said of the energy that it spent, round by round: 1 if it is
    /// what its group-mates spent (the median of those that came back with their group), 0 from
    /// [`DOUBTED_POINTS`] away on. A round in which a robot rested says nothing; one in which it turned back
    /// or was lost says something only if it had said that it was far from tired.
    #[must_use]
    pub fn energy_outcomes(&self, history: &[RoundOutcome]) -> Vec<EnergyOutcome> {
        let mut outcomes = Vec::new();
        for round in history {
            for group in &round.groups {
                let ids: Vec<u32> = group.members.iter().map(|member| member.id).collect();
                outcomes.extend(ids.iter().filter_map(|id| self.energy_outcome(*id, &ids, round.round)));
            }
        }
        outcomes
    }

    fn energy_outcome(&self, robot: u32, group: &[u32], round: u32) -> Option<EnergyOutcome> {
        let is_fit = |id: &u32| *id != robot && self.entry(*id, round).is_some_and(RobotRound::is_sound);
        let mut used: Vec<f64> =
            group.iter().filter(|id| is_fit(id)).filter_map(|id| self.said_drop(*id, round)).collect();
        used.sort_by(f64::total_cmp);
        let used = median(&used)?;
        let entry = self.entry(robot, round)?;
        let outcome = if entry.turned_back || entry.lost {
            let said = self.first_said(robot, round)?;
            if said - used <= self.energy_threshold + DOUBTED_POINTS {
                return None;
            }
            0.0
        } else if entry.rested {
            return None;
        } else {
            1.0 - ((self.said_drop(robot, round)? - used).abs() / DOUBTED_POINTS).min(1.0)
        };
        Some(EnergyOutcome { robot, round, outcome })
    }

    fn entry(&self, robot: u32, round: u32) -> Option<&RobotRound> {
        self.ledger.iter().rev().find(|entry| entry.robot == robot && entry.round == round)
    }

    /// The energy level that a robot first said in a round, in percent.
    fn first_said(&self, robot: u32, round: u32) -> Option<f64> {
        let first = self.reports.iter().find(|report| report.of == robot && report.round == round);
        first.map(|report| report.energy_level)
    }

    /// By how much the energy of a robot fell in a round, as it said, in percent points.
    fn said_drop(&self, robot: u32, round: u32) -> Option<f64> {
        Some(self.first_said(robot, round)? - self.first_said(robot, round + 1)?)
    }
}

/// How far the base believes what a robot said of its energy in a round.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyOutcome {
    /// The robot.
    pub robot: u32,
    /// The round.
    pub round: u32,
    /// From 0 (false) to 1 (true).
    pub outcome: f64,
}

impl RobotRound {
    /// Whether the robot came back with its group, and without a rest.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        !self.turned_back && !self.rested && !self.lost
    }
}

impl Rating {
    /// How well the speed seen agrees with the speed that was said: 1 if they are equal, 0 from `tolerance` of
    /// the rated robot's top speed at full health (metres per second) away on.
    #[must_use]
    pub fn outcome(&self, tolerance: f64, top_mps: f64) -> f64 {
        1.0 - ((self.speed_mps - self.said_mps).abs() / (tolerance * top_mps)).min(1.0)
    }

    /// The health level that the speed seen speaks for, in percent: a robot of this top speed at full health
    /// is as slow as `floor` times it at 0 %. `None` if health does not slow robots.
    #[must_use]
    pub fn measured_hp(&self, top_mps: f64, floor: f64) -> Option<f64> {
        let level = 100.0 * (self.speed_mps / top_mps - floor) / (1.0 - floor);
        (floor < 1.0).then(|| level.clamp(0.0, 100.0))
    }
}

/// Whether what happened in a round may name a robot.
#[must_use]
pub fn is_named(known_since: &BTreeMap<u32, u32>, robot: u32, round: u32) -> bool {
    known_since.get(&robot).is_none_or(|since| round >= *since)
}

/// The median of sorted numbers.
fn median(sorted: &[f64]) -> Option<f64> {
    let middle = sorted.len() / 2;
    let upper = *sorted.get(middle)?;
    Some(if sorted.len() % 2 == 1 { upper } else { f64::midpoint(sorted[middle - 1], upper) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::history::{GroupOutcome, MemberOutcome};
    use crate::ids::TaskId;

    fn report(of: u32, round: u32, energy_level: f64) -> LevelReport {
        let (sent_s, heard_s) = (f64::from(round), f64::from(round));
        LevelReport {
            of,
            by: of,
            round,
            sent_s,
            heard_s,
            energy_level,
            hp_level: 90.0,
            needs: BTreeMap::new(),
            sd: [0.0; 2],
        }
    }

    fn entry(robot: u32, turned_back: bool) -> RobotRound {
        let (left_s, back_s) = (0.0, Some(60.0));
        RobotRound { robot, round: 1, left_s, back_s, rescued: 0, turned_back, rested: false, lost: false }
    }

    fn rounds(ids: &[u32]) -> Vec<RoundOutcome> {
        let members = ids.iter().map(|id| MemberOutcome { id: *id, ..MemberOutcome::default() }).collect();
        let group = GroupOutcome { task: TaskId(0), rescued: 0, energy: 0.0, hp: 0.0, members };
        vec![RoundOutcome { round: 1, duration_s: 60.0, groups: vec![group] }]
    }

    /// Robots 0 to 3 said that they spent 12, 10, 14 and 25 points; the mates of the last spent 12.
    #[test]
    fn the_base_compares_what_robots_say_they_spent() {
        let said = [(0, 80.0, 68.0), (1, 70.0, 60.0), (2, 90.0, 76.0), (3, 60.0, 35.0)];
        let reports = [1, 2].into_iter().flat_map(|round| {
            said.iter()
                .map(move |(id, first, then)| report(*id, round, if round == 1 { *first } else { *then }))
        });
        let ledger = (0..4).map(|id| entry(id, false)).collect();
        let evidence =
            Evidence { energy_threshold: 30.0, reports: reports.collect(), ledger, ..Evidence::default() };
        let outcomes: Vec<f64> =
            evidence.energy_outcomes(&rounds(&[0, 1, 2, 3])).iter().map(|found| found.outcome).collect();
        // used: median of {10, 14, 25} = 14, {12, 14, 25} = 14, {12, 10, 25} = 12, {12, 10, 14} = 12
        assert_eq!(outcomes, [0.8, 0.6, 0.8, 0.0]);
        let mut caught = evidence.clone();
        caught.ledger[0].turned_back = true;
        let of = |evidence: &Evidence| evidence.energy_outcomes(&rounds(&[0, 1, 2, 3]))[0];
        assert_eq!(of(&caught), EnergyOutcome { robot: 0, round: 1, outcome: 0.0 }, "80 - 14 > 40");
        caught.reports[0].energy_level = 50.0;
        assert_eq!(of(&caught).robot, 1, "50 - 14 <= 40: it may have been tired");
    }

    #[test]
    fn a_rating_compares_speeds() {
        let rating = Rating { by: 0, of: 1, round: 1, looks: 30, speed_mps: 1.6, said_mps: 1.9 };
        assert!((rating.outcome(0.2, 2.0) - 0.25).abs() < 1e-12);
        assert!((rating.measured_hp(2.0, 0.5).unwrap() - 60.0).abs() < 1e-12);
        assert_eq!(rating.measured_hp(2.0, 1.0), None);
        assert!(rating.outcome(0.2, 1.0).abs() < 1e-12);
    }

    #[test]
    fn evidence_is_cut_to_what_was_heard_and_to_the_names_that_are_known() {
        let rating = |by, of, round| Rating { by, of, round, looks: 30, speed_mps: 1.0, said_mps: 1.0 };
        let evidence = Evidence {
            reports: vec![report(0, 1, 80.0), report(1, 1, 70.0), report(0, 2, 60.0)],
            ratings: vec![rating(0, 1, 1), rating(1, 0, 1), rating(1, 2, 1)],
            ledger: vec![entry(0, false), entry(1, false)],
            ..Evidence::default()
        };
        let all = evidence.extent(2, BTreeMap::new());
        assert_eq!(evidence.as_of(&all), evidence);
        let late = evidence.extent(66, BTreeMap::new());
        assert!(evidence.as_of(&late).ratings.is_empty(), "older than 64 rounds");
        let renamed = Extent { reports: 2, known_since: BTreeMap::from([(0, 2)]), ..all };
        let found = evidence.as_of(&renamed);
        assert_eq!((found.reports.len(), found.ratings.len(), found.ledger.len()), (1, 1, 1));
    }
}
