//! Witnesses: how fast robots see their group-mates go.

use scenario::seed::{Purpose, normal, stream_at};
use serde::{Deserialize, Serialize};
use teaming::Rating;

use crate::ids::RobotId;
use crate::model::TelemetryModel;
use crate::robot::STANDING_MPS;

/// A mate that was never seen faster than this stood, in metres per second: how fast it can go was not seen.
const LEAST_MPS: f64 = STANDING_MPS as f64;

/// What a robot saw of a mate in this round.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Look {
    of: RobotId,
    looks: u32,
    speed_mps: f64,
    said_mps: f64,
}

/// What each robot saw of its mates in this round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Witnesses(Vec<Vec<Look>>);

impl Witnesses {
    pub(super) fn of_nobody(robots: usize) -> Self {
        Self(vec![Vec::new(); robots])
    }

    /// Begins a round with these groups.
    pub(super) fn begin_round(&mut self, groups: &[Vec<RobotId>]) {
        self.0.iter_mut().for_each(Vec::clear);
        let look = |of: &RobotId| Look { of: *of, looks: 0, speed_mps: 0.0, said_mps: 0.0 };
        for (group, robot) in groups.iter().flat_map(|group| group.iter().map(move |robot| (group, robot))) {
            self.0[robot.index()] = group.iter().filter(|mate| *mate != robot).map(look).collect();
        }
    }

    /// Lets a robot look at its mates. `speed_of` gives the speed of a mate that can be seen, set right for
    /// what is known to slow it, and the top speed that follows from what it said.
    pub(super) fn look(&mut self, robot: RobotId, speed_of: impl Fn(RobotId) -> Option<[f64; 2]>) {
        for look in &mut self.0[robot.index()] {
            let Some([speed, said]) = speed_of(look.of) else { continue };
            look.looks += 1;
            if speed > look.speed_mps {
                (look.speed_mps, look.said_mps) = (speed, said);
            }
        }
    }

    /// What a robot has to say of its mates at the end of a round: nothing of one that it never saw move.
    pub(super) fn ratings(&self, rules: &TelemetryModel, by: RobotId, round: u32) -> Vec<Rating> {
        let tells = |look: &&Look| look.looks >= rules.witness.least_looks && look.speed_mps > LEAST_MPS;
        let looks = self.0[by.index()].iter().filter(tells);
        let rating = |look: &Look| {
            let pair = u64::from(by.0) << 32 | u64::from(look.of.0);
            let mut draws = stream_at(rules.seed, Purpose::Witness, pair, u64::from(round));
            let error = normal(&mut draws, 0.0, rules.witness.sd);
            Rating {
                by: by.0,
                of: look.of.0,
                round,
                looks: look.looks,
                speed_mps: (look.speed_mps * (1.0 + error)).max(0.0),
                said_mps: look.said_mps,
            }
        };
        looks.map(rating).collect()
    }
}
