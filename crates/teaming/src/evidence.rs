//! Evidence: what the base heard of the robots, from whom and when. It is part of the question where reports
//! may be late, lost, wrong or lies; estimators judge by it what is true and whom to believe.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::QuestionError;
use crate::ids::{LevelId, NeedId, place_of};

/// Rounds for which ratings are kept.
pub const ROUNDS_OF_RATINGS: u32 = 64;

/// How far what a robot says it spent may lie from what its mates spent until it counts as false, in percent
/// points.
pub const DOUBTED_POINTS: f64 = 10.0;

/// What the base heard, in the order in which it heard it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
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
    /// What follows from the levels of each robot, by id.
    #[serde(default)]
    pub bodies: Vec<Body>,
}

/// What the base knows of a robot's body, whatever the robot says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// The robot.
    pub robot: u32,
    /// Top speed, in metres per second.
    pub top_mps: f64,
    /// The level that slows it when it falls.
    pub slowed_by: LevelId,
    /// Share of its top speed that it has where that level is 0 %.
    pub floor: f64,
    /// Whether it can carry rescuees.
    pub carries: bool,
    /// Whether it guides its group.
    pub guides: bool,
    /// The needs that follow from a level. The other needs do not change with the levels.
    pub needs: Vec<LevelNeed>,
}

impl Body {
    /// The rule that the body breaks, if any, with what was found.
    fn fault(&self, needs: usize, levels: usize) -> Option<String> {
        let Self { top_mps, floor, .. } = self;
        if !(top_mps.is_finite() && *top_mps > 0.0) {
            return Some(format!("top_mps must be a number above 0, found {top_mps}"));
        }
        if !(0.0..=1.0).contains(floor) {
            return Some(format!("floor must be from 0 to 1, found {floor}"));
        }
        let unknown = self.needs.iter().map(|need| need.need.index()).find(|need| *need >= needs);
        if let Some(found) = unknown {
            return Some(format!("need must be a row of the table of {needs} needs (from 0), found {found}"));
        }
        let mut used = self.needs.iter().map(|need| need.level).chain([self.slowed_by]);
        if let Some(LevelId(found)) = used.find(|level| level.index() >= levels) {
            return Some(format!(
                "a level must be a row of the table of {levels} levels (from 0), found {found}"
            ));
        }
        let values = self.needs.iter().flat_map(|need| [need.at_0, need.at_100]);
        let bad = values.into_iter().find(|value| !(value.is_finite() && *value >= 0.0));
        bad.map(|found| format!("at_0 and at_100 must be numbers >= 0, found {found}"))
    }
}

/// A need that follows from a level, in a straight line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelNeed {
    /// The need.
    pub need: NeedId,
    /// The level that it follows from.
    pub level: LevelId,
    /// Its value at 0 %.
    pub at_0: f64,
    /// Its value at 100 %.
    pub at_100: f64,
}

impl LevelNeed {
    /// Its value at these levels, in percent. Levels outside 0 to 100 % count as the nearer end.
    #[must_use]
    pub fn at(&self, levels: &[f64]) -> f64 {
        self.at_0 + (self.at_100 - self.at_0) * (levels[self.level.index()] / 100.0).clamp(0.0, 1.0)
    }
}

/// What a robot said of its levels.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelReport<Levels = Vec<f64>> {
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
    /// Its levels, in the order of the table of levels.
    pub levels: Levels,
    /// Needs that were said by themselves, by their places in the table; the others follow from the levels.
    #[serde(default)]
    pub needs: BTreeMap<usize, f64>,
    /// Standard deviations of the gauges of the levels, in percent points.
    pub sd: Levels,
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
            reports: reports.filter(|report| names(report.of, report.round)).cloned().collect(),
            ratings: ratings.filter(is_recent).filter(both).copied().collect(),
            ledger: ledger.filter(|entry| names(entry.robot, entry.round)).copied().collect(),
            known_since: extent.known_since.clone(),
            bodies: self.bodies.clone(),
        }
    }

    /// Sorts the bodies by their ids, and checks them and the lengths of the reports.
    pub(crate) fn check(&mut self, needs: usize, levels: usize) -> Result<(), QuestionError> {
        self.bodies.sort_by_key(|body| body.robot);
        let mut bodies =
            self.bodies.iter().filter_map(|body| Some(("the body", body.robot, body.fault(needs, levels)?)));
        let mut reports = self.reports.iter().filter_map(|report| {
            let found = [report.levels.len(), report.sd.len()].into_iter().find(|found| *found != levels)?;
            Some(("a report", report.of, format!("levels and sd must have {levels} entries, found {found}")))
        });
        match bodies.next().or_else(|| reports.next()) {
            Some((what, robot, reason)) => Err(QuestionError::Evidence { what, robot, reason }),
            None => Ok(()),
        }
    }

    /// The body of a robot, if it is known.
    #[must_use]
    pub fn body(&self, robot: u32) -> Option<&Body> {
        place_of(&self.bodies, robot, |body| body.robot).map(|place| &self.bodies[place])
    }
}

impl<const N: usize> LevelReport<[f64; N]> {
    /// The same with lists of any length.
    #[must_use]
    pub fn listed(&self) -> LevelReport {
        let Self { of, by, round, sent_s, heard_s, levels, needs, sd } = self.clone();
        LevelReport { of, by, round, sent_s, heard_s, levels: levels.to_vec(), needs, sd: sd.to_vec() }
    }
}

impl RobotRound {
    /// Whether the robot came back with its group, and without a rest.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        !self.turned_back && !self.rested && !self.lost
    }
}

impl Rating {
    /// How well the speed seen agrees with the speed that was said: 1 if they are equal, 0 from `tolerance`
    /// of the rated robot's top speed (metres per second) away on.
    #[must_use]
    pub fn outcome(&self, tolerance: f64, top_mps: f64) -> f64 {
        1.0 - ((self.speed_mps - self.said_mps).abs() / (tolerance * top_mps)).min(1.0)
    }

    /// The level that the speed seen speaks for, in percent: a robot of this top speed at a full level is as
    /// slow as `floor` times it at 0 %. `None` if no level slows the robot.
    #[must_use]
    pub fn measured_level(&self, top_mps: f64, floor: f64) -> Option<f64> {
        let level = 100.0 * (self.speed_mps / top_mps - floor) / (1.0 - floor);
        (floor < 1.0).then(|| level.clamp(0.0, 100.0))
    }
}

/// Whether what happened in a round may name a robot.
#[must_use]
pub fn is_named(known_since: &BTreeMap<u32, u32>, robot: u32, round: u32) -> bool {
    known_since.get(&robot).is_none_or(|since| round >= *since)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(of: u32, round: u32, energy: f64) -> LevelReport {
        let (sent_s, heard_s) = (f64::from(round), f64::from(round));
        LevelReport {
            of,
            by: of,
            round,
            sent_s,
            heard_s,
            levels: vec![energy, 90.0],
            needs: BTreeMap::new(),
            sd: vec![0.0; 2],
        }
    }

    fn entry(robot: u32, turned_back: bool) -> RobotRound {
        let (left_s, back_s) = (0.0, Some(60.0));
        RobotRound { robot, round: 1, left_s, back_s, rescued: 0, turned_back, rested: false, lost: false }
    }

    #[test]
    fn a_rating_compares_speeds() {
        let rating = Rating { by: 0, of: 1, round: 1, looks: 30, speed_mps: 1.6, said_mps: 1.9 };
        assert!((rating.outcome(0.2, 2.0) - 0.25).abs() < 1e-12);
        assert!((rating.measured_level(2.0, 0.5).unwrap() - 60.0).abs() < 1e-12);
        assert_eq!(rating.measured_level(2.0, 1.0), None);
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
        let all = Extent { round: 2, reports: 3, ratings: 3, ledger: 2, known_since: BTreeMap::new() };
        assert_eq!(evidence.as_of(&all), evidence);
        let late = Extent { round: 66, ..all.clone() };
        assert!(evidence.as_of(&late).ratings.is_empty(), "older than 64 rounds");
        let renamed = Extent { reports: 2, known_since: BTreeMap::from([(0, 2)]), ..all };
        let found = evidence.as_of(&renamed);
        assert_eq!((found.reports.len(), found.ratings.len(), found.ledger.len()), (1, 1, 1));
    }
}
