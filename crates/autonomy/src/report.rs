//! Reports: who says what about which thing, as of when, and how sure. Messages bring them to a hearer.
//!
//! Sensors make reports, and a [belief](crate::belief) is a fold over those that were heard, at once or by
//! [radio](crate::telemetry). A report may be late, missing or false.

use parry2d::math::{Pose, Vector};
use parry2d::shape::SharedShape;
use scenario::shapes::RadiationZone;
use serde::{Deserialize, Serialize};
use teaming::{LevelReport, Rating, RobotRound, TaskId};

use crate::ids::{RescueeId, RobotId};

/// A report.
#[derive(Clone, Serialize, Deserialize)]
pub struct Report {
    /// The sender.
    pub from: Speaker,
    /// The thing and the statement about it.
    pub says: Statement,
    /// The step as of which the statement holds.
    pub at_step: u64,
    /// Standard deviation of a stated place, in metres; 0 for an exact one.
    pub sd_m: f32,
}

/// A report on its way to one hearer.
#[derive(Clone, Serialize, Deserialize)]
pub struct Message {
    /// Who sends it. The report may be in the name of another.
    pub sender: RobotId,
    /// Who is to hear it: a robot, or the base.
    pub to: Option<RobotId>,
    /// When it is sent, in seconds.
    pub sent_s: f64,
    /// When it is heard, in seconds.
    pub heard_s: f64,
    /// Whether it goes over the medium.
    pub by_radio: bool,
    /// The report.
    pub report: Report,
}

/// What a robot says of its energy and its HP, in percent, as it lies in the state of a trial.
pub type Levels = LevelReport<[f64; 2]>;

/// Where a team-mate is seen to be, and how it moves. Robots that see each other need not say so.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Track {
    /// Its position, in metres.
    pub position: Vector,
    /// Its velocity, in metres per second.
    pub velocity: Vector,
}

/// How far from each other two places may be to be those of one thing, in metres, when each is known with
/// this standard deviation.
pub fn gate_m(sd_m: [f32; 2]) -> f32 {
    if sd_m[0] + sd_m[1] <= 0.0 {
        return 0.0; // exact places are the same or not
    }
    3.0 * (sd_m[0] * sd_m[0] + sd_m[1] * sd_m[1]).sqrt() + 0.3
}

/// The sender of a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Speaker {
    /// A robot.
    Robot(RobotId),
    /// The base. Its reports are for all.
    Base,
}

/// A statement about one thing. The number is the one under which robots speak of the thing: something that
/// does not exist can have a number, too.
#[derive(Clone, Serialize, Deserialize)]
pub enum Statement {
    /// A piece of debris lies at a place.
    DebrisLies {
        /// The piece.
        debris: u32,
        /// Its shape.
        shape: SharedShape,
        /// Its place.
        pose: Pose,
    },
    /// A radiation zone is on or off.
    ZoneIs {
        /// The zone.
        zone: u32,
        /// Its source and radius.
        disc: RadiationZone,
        /// Whether it radiates.
        on: bool,
    },
    /// A rescuee waits at a place.
    RescueeWaits {
        /// The rescuee.
        rescuee: RescueeId,
        /// Its place.
        at: Vector,
    },
    /// A rescuee no longer waits: a robot took it on board, or its task ended.
    RescueeIsGone {
        /// The rescuee.
        rescuee: RescueeId,
    },
    /// A task is open or closed, and so many rescuees wait there.
    TaskIs {
        /// The task.
        task: TaskId,
        /// Whether it is open: it has begun and not ended.
        open: bool,
        /// Number of rescuees.
        waiting: u32,
    },
    /// A robot has stopped for good.
    WreckLies {
        /// The robot.
        robot: RobotId,
        /// Its place.
        at: Vector,
        /// Its radius, in metres.
        radius: f32,
        /// Whether it is in nobody's way, because it flies.
        is_aerial: bool,
    },
    /// A robot has these levels and needs.
    LevelsAre(Levels),
    /// A robot goes so fast.
    MateGoes(Rating),
    /// What became of the sender in the round that is over.
    RoundWas(RobotRound),
    /// The sender stays out of a round.
    StaysOut {
        /// The number of the round.
        round: u32,
    },
    /// What the sender has heard of all before a round.
    HasHeard(Digest),
    /// What a protocol has the sender say.
    Protocol {
        /// The round about which robots negotiate.
        round: u32,
        /// What, in JSON.
        what: String,
    },
    /// The sender claims a rescuee, or none.
    Claims(Option<Claim>),
    /// The sender gives up on a rescuee, which it cannot reach or load.
    GivesUp {
        /// The rescuee.
        rescuee: RescueeId,
    },
}

/// A claim on a rescuee.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Claim {
    /// The rescuee.
    pub rescuee: RescueeId,
    /// The square of the robot's distance from it, in square metres.
    pub squared_m: f32,
    /// The step since which the robot claims it.
    pub since_step: u64,
}

/// What a robot has heard of all before a round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Digest {
    /// The number of the round.
    pub round: u32,
    /// The newest that each robot said of itself, as far as it was heard.
    pub levels: Vec<Levels>,
    /// The robots that stay out.
    pub out: Vec<RobotId>,
}

impl Statement {
    /// Whether it is about the field. Others are about the team.
    pub fn is_about_the_field(&self) -> bool {
        match self {
            Self::DebrisLies { .. }
            | Self::ZoneIs { .. }
            | Self::RescueeWaits { .. }
            | Self::RescueeIsGone { .. }
            | Self::TaskIs { .. }
            | Self::WreckLies { .. }
            | Self::Claims(_)
            | Self::GivesUp { .. } => true,
            Self::LevelsAre(_)
            | Self::MateGoes(_)
            | Self::RoundWas(_)
            | Self::StaysOut { .. }
            | Self::HasHeard(_)
            | Self::Protocol { .. } => false,
        }
    }
}
