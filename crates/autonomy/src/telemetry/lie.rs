//! Lies: what a robot says in the place of what it read, or of what it saw.

use rand::RngExt;
use scenario::seed::{Purpose, stream_at};
use scenario::{Lie, Mates};
use serde::{Deserialize, Serialize};
use teaming::Rating;

use crate::ids::RobotId;
use crate::model::{LieModel, TelemetryModel};

/// Mates that flip their ratings take a speed that is so far from the one said, as a share of top speed, for
/// the end of the scale. It is the default tolerance of the estimators.
const FLIP_TOLERANCE: f64 = 0.2;

/// A lie that a robot tells.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Told {
    /// Its number among the lies of the trial.
    pub lie: u32,
    /// What the robot would have said when it first told the lie: energy, health, then the lie's needs.
    pub at_onset: Vec<f64>,
}

/// What a lie is told of.
#[derive(Debug, Clone, Copy)]
pub struct Topic {
    /// Seed of the trial.
    pub seed: u64,
    /// The robot and the level or need, as one number.
    pub of: u64,
    /// The step.
    pub step: u64,
    /// The time, in seconds.
    pub time_s: f64,
    /// What it was when the lie began.
    pub at_onset: f64,
    /// What the others of the role said on average, if any was heard.
    pub others: Option<f64>,
}

impl Told {
    /// The lie of this number, which was not told yet.
    pub(super) fn new(lie: usize) -> Self {
        Self { lie: lie as u32, at_onset: Vec::new() }
    }
}

impl LieModel {
    /// Whether the lie is told at a time.
    pub fn is_told_at(&self, time_s: f64) -> bool {
        self.window_s[0] <= time_s && time_s < self.window_s[1]
    }

    /// What is said of a level, in percent, at a time within the window. `most` is the most that can be said.
    pub fn said(&self, level: f64, topic: &Topic, most: f64) -> f64 {
        match turned(&self.lie, level, topic, self.window_s[0]) {
            Some(said) => said.max(self.floor).clamp(0.0, most),
            None => level,
        }
    }
}

/// What a lie makes of a level; `None` at times at which it is not told, and for lies about others.
fn turned(lie: &Lie, x: f64, topic: &Topic, since_s: f64) -> Option<f64> {
    Some(match lie {
        Lie::Exaggerate { by } => x + by * (100.0 - x),
        Lie::Understate { by } => x * (1.0 - by),
        Lie::Offset { points } => x + points,
        Lie::Scale { factor } => x * factor,
        Lie::Stuck => topic.at_onset,
        Lie::Complement => 100.0 - x,
        Lie::Uniform { low, high } => {
            let draw: f64 = stream_at(topic.seed, Purpose::Lie, topic.of, topic.step).random();
            low + draw * (high - low)
        }
        Lie::Copycat => topic.others?,
        Lie::OnOff { period_s, duty, lie } => {
            let into = libm::fmod(topic.time_s - since_s, *period_s);
            return if into < duty * period_s { turned(lie, x, topic, since_s) } else { None };
        }
        Lie::BadMouth { .. }
        | Lie::BallotStuff { .. }
        | Lie::Flip
        | Lie::Silent
        | Lie::Collude
        | Lie::Whitewash { .. }
        | Lie::Impersonate { .. }
        | Lie::HideRadiation
        | Lie::HideMate
        | Lie::Misplace { .. }
        | Lie::PhantomRescuee { .. } => return None,
    })
}

/// What a liar says of a mate; `None` if it keeps silent. `top_mps` is the mate's top speed at full health.
pub fn said_of_mate(lie: &Lie, rating: Rating, top_mps: f64, rules: &TelemetryModel) -> Option<Rating> {
    let still = Rating { speed_mps: 0.0, ..rating };
    let praised = Rating { speed_mps: rating.said_mps, ..rating };
    let is_of = |mates: Mates| rules.is_of(mates, RobotId(rating.of));
    Some(match lie {
        Lie::BadMouth { of } if is_of(*of) => still,
        Lie::BallotStuff { of } if is_of(*of) => praised,
        Lie::Collude => {
            if is_of(Mates::Liars) {
                praised
            } else {
                still
            }
        }
        Lie::Flip => {
            let furthest = FLIP_TOLERANCE * top_mps;
            let off = (rating.speed_mps - rating.said_mps).abs().min(furthest);
            Rating { speed_mps: (rating.said_mps - (furthest - off)).max(0.0), ..rating }
        }
        Lie::Silent => return None,
        Lie::BadMouth { .. }
        | Lie::BallotStuff { .. }
        | Lie::Exaggerate { .. }
        | Lie::Understate { .. }
        | Lie::Offset { .. }
        | Lie::Scale { .. }
        | Lie::Stuck
        | Lie::Complement
        | Lie::Uniform { .. }
        | Lie::Copycat
        | Lie::OnOff { .. }
        | Lie::Whitewash { .. }
        | Lie::Impersonate { .. }
        | Lie::HideRadiation
        | Lie::HideMate
        | Lie::Misplace { .. }
        | Lie::PhantomRescuee { .. } => rating,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(lie: Lie, level: f64, time_s: f64, floor: f64) -> f64 {
        let window_s = [0.0, f64::INFINITY];
        let model = LieModel { lie, on_levels: [true; 2], on_needs: Vec::new(), window_s, floor };
        let topic = Topic { seed: 1, of: 0, step: 7, time_s, at_onset: 44.0, others: Some(77.0) };
        model.said(level, &topic, 100.0)
    }

    /// Computed independently, in Python.
    #[test]
    fn lies_are_as_computed_elsewhere() {
        let is = |lie, level, time_s, floor, expected: f64| {
            let found = said(lie, level, time_s, floor);
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        };
        is(Lie::Exaggerate { by: 0.5 }, 60.0, 10.0, 0.0, 80.0);
        is(Lie::Understate { by: 0.5 }, 60.0, 10.0, 0.0, 30.0);
        is(Lie::Understate { by: 0.5 }, 50.0, 0.0, 31.0, 31.0);
        for (time_s, expected) in [(130.0, 100.0), (150.0, 60.0)] {
            let lie = Box::new(Lie::Exaggerate { by: 1.0 });
            is(Lie::OnOff { period_s: 120.0, duty: 0.25, lie }, 60.0, time_s, 0.0, expected);
        }
        is(Lie::Offset { points: 30.0 }, 90.0, 100.0, 0.0, 100.0);
        is(Lie::Complement, 90.0, 100.0, 0.0, 10.0);
        is(Lie::Scale { factor: 0.5 }, 90.0, 100.0, 0.0, 45.0);
        is(Lie::Stuck, 90.0, 100.0, 0.0, 44.0);
        is(Lie::Copycat, 90.0, 100.0, 0.0, 77.0);
        let drawn = said(Lie::Uniform { low: 10.0, high: 20.0 }, 90.0, 100.0, 0.0);
        assert!(drawn > 10.0 && drawn < 20.0);
    }

    #[test]
    fn a_lie_is_told_from_its_beginning_and_before_its_end() {
        let lie = Lie::Offset { points: 30.0 };
        let window_s = [100.0, 200.0];
        let model = LieModel { lie, on_levels: [true; 2], on_needs: Vec::new(), window_s, floor: 0.0 };
        assert_eq!([99.9, 100.0, 199.9, 200.0].map(|t| model.is_told_at(t)), [false, true, true, false]);
    }
}
