//! The requirements on every trial of the random worlds, and how violations are counted.

use scenario::{LayoutError, Scenario};
use thiserror::Error;
use usar_sim::conflict::DelayCause;
use usar_sim::record::{RobotRecord, Status, TrialRecord};
use usar_sim::robot::STANDING_MPS;
use usar_sim::simulation::Simulation;

/// A robot with a goal is counted if it comes no nearer for longer than this, in seconds.
pub const STALL_S: f64 = 30.0;

/// A fleet that stands for longer than this although some robot has a goal is a fault, in seconds.
pub const STANDSTILL_S: f64 = 60.0;

/// One world's trial.
pub struct Journeys {
    /// Its record.
    pub record: TrialRecord,
    /// The longest time without motion of any robot although some robot had a goal and a route, in seconds.
    pub standstill_s: f64,
}

/// Why a world's trial has no record.
#[derive(Debug, Error)]
pub enum JourneysError {
    /// The world has no room for something that is sampled.
    #[error(transparent)]
    Layout(#[from] LayoutError),
    /// The trial failed.
    #[error("{reason}")]
    Failed {
        /// The reason in words.
        reason: String,
    },
    /// The trial panicked.
    #[error("internal error")]
    Panicked,
}

impl Journeys {
    /// Runs a world under a policy with every check enabled.
    ///
    /// # Errors
    /// The trial cannot begin, fails, or gives a number that is not defined.
    pub fn run(scenario: &Scenario, policy: &str, seed: u64) -> Result<Self, JourneysError> {
        let mut policy = policies::standard().open(policy).expect("a policy's name");
        let mut trial = Simulation::new(scenario, seed)?.checked();
        let (mut still, mut longest) = (0_u64, 0_u64);
        while trial.ending().is_none() {
            if let Some(Status::Failed(reason)) = trial.step(&mut *policy) {
                return Err(JourneysError::Failed { reason });
            }
            let moves = trial.world().robots.iter().any(|robot| robot.velocity.length() > STANDING_MPS);
            let holds_up = |cause| !matches!(cause, DelayCause::NothingToDo | DelayCause::NoRoute);
            let wants = trial.world().robots.iter().zip(trial.delays()).any(|(robot, delay)| {
                let traveller = trial.navigator().traveller(robot.id);
                traveller.route().is_some()
                    && !traveller.has_arrived(robot.position)
                    && robot.is_able()
                    && holds_up(delay.cause)
            });
            still = if wants && !moves { still + 1 } else { 0 };
            longest = longest.max(still);
        }
        let record = trial.finish();
        let is_defined = |robot: &RobotRecord| {
            let RobotRecord { final_energy, final_hp, energy_spent, hp_lost, distance_m, .. } = robot;
            [final_energy, final_hp, energy_spent, hp_lost, distance_m]
                .iter()
                .all(|number| number.is_finite())
        };
        if !record.robots.iter().all(is_defined) {
            return Err(JourneysError::Failed { reason: "a robot has undefined numbers".to_owned() });
        }
        Ok(Self { record, standstill_s: longest as f64 * scenario.dt_s })
    }

    /// Robots that made no progress, with the cause.
    pub fn stalls(&self) -> impl Iterator<Item = String> + '_ {
        self.record.robots.iter().filter(|robot| robot.longest_stall_s > STALL_S).map(|robot| {
            let waits_for = robot.stall.waits_for.map(|id| format!(" robot {id}")).unwrap_or_default();
            format!(
                "robot {}: {:.1} s, {}{waits_for}",
                robot.robot,
                robot.longest_stall_s,
                robot.stall.cause.name()
            )
        })
    }
}
