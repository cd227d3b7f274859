//! The scenario file as it is written: a serde mirror of the RON text, with its defaults. What a value may be
//! is in `validate`.
//!
//! SI units; points are `(x, y)` in metres from the arena's lower left corner; levels are percent of a
//! robot's own maximum.

use std::collections::BTreeMap;

use rne_core::hierarchy::NeedLevel;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use super::debris::{DebrisFile, DebrisShape, Movable, ZoneFile};
pub use super::deceit::{Channel, Deceit, Lie, Mates, Who};
pub use super::distribution::{Amount, Distribution};
pub use super::draws::Draws;
pub use super::rules::*;
pub use super::scatter::{Placement, Scatter, Scattered};
pub use super::steps::Fidelity;
pub use super::telemetry::*;
pub use super::timeline::{Happening, Moment};
use super::words::Words;

/// A point `(x, y)` or an extent `(width, height)`, in metres.
pub type Point = [f64; 2];

/// A whole scenario.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScenarioFile {
    /// Number of the format that the file is written in; this program reads format 2.
    #[serde(default = "super::defaults::format")]
    pub format: u32,
    /// Short name: letters, digits, `-`, `_` and `.`; names the folder of results.
    pub name: String,
    /// What the scenario is for.
    #[serde(default)]
    pub description: String,
    /// The one policy that may run here, by name; empty for any. A candidate of a calibration names the
    /// policy that it is fitted with, so that no other can be tried before a candidate is chosen.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub only_policy: String,
    /// Simulated time of a trial, in seconds.
    pub duration_s: f64,
    /// Length of a simulation step, in seconds.
    pub dt_s: f64,
    /// Robots look around and choose their velocities once in this time, in seconds, rounded down to whole
    /// steps, at least one; a team in which a robot would go farther than 0.25 m in it does so more often.
    #[serde(default = "super::defaults::control_period_s")]
    pub control_period_s: f64,
    /// Of older files: without effect if `AsWritten`, and refused if `Coarse`.
    #[serde(default, skip_serializing)]
    #[schemars(skip)]
    pub fidelity: Option<Fidelity>,
    /// Width and height of the walled arena, in metres.
    pub arena_m: Point,
    /// The team, row by row: ids are given in this order, from 0. Each robot's place in its row is its home.
    pub team: Vec<Row>,
    /// What a robot of each role is and can do. Policies merge roles in this order.
    #[serde(default = "super::defaults::roles")]
    pub roles: Vec<RoleFile>,
    /// The needs that robots report and policies compare.
    #[serde(default = "super::defaults::needs")]
    pub needs: Vec<NeedFile>,
    /// Distribution of the initial levels.
    #[serde(default)]
    pub initial_levels: InitialLevels,
    /// The tasks. A mission has at least one.
    #[serde(default)]
    pub tasks: Vec<TaskFile>,
    /// Places that robots are to go to: when there are any, they take the place of the mission, and the trial
    /// is over when all are done. Robots without an errand stand at home.
    #[serde(default)]
    pub errands: Vec<Errand>,
    /// Debris at known places.
    #[serde(default)]
    pub debris: Vec<DebrisFile>,
    /// Walls inside the arena.
    #[serde(default)]
    pub walls: Vec<WallFile>,
    /// Radiation zones at known places.
    #[serde(default)]
    pub radiation: Vec<ZoneFile>,
    /// What the debris and radiation zones are like that tasks ask for.
    #[serde(default)]
    pub sampled: Sampled,
    /// Debris and radiation zones that are placed anew in every trial.
    #[serde(default)]
    pub scatter: Vec<Scatter>,
    /// What happens at which time.
    #[serde(default)]
    pub timeline: Vec<Moment>,
    /// What moving and radiation cost.
    #[serde(default)]
    pub costs: Costs,
    /// Rules of the mission.
    #[serde(default)]
    pub mission: MissionRules,
    /// Rules of route planning.
    #[serde(default)]
    pub planning: PlanningRules,
    /// Rules of right of way.
    #[serde(default)]
    pub conflicts: ConflictRules,
    /// How robots report their levels. Without it, and without `medium` and `deceit`, everybody knows how
    /// every robot is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reports: Option<ReportRules>,
    /// The medium that carries reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub medium: Option<MediumRules>,
    /// Who lies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub deceit: Vec<Deceit>,
    /// What the scenario calls its things.
    #[serde(default)]
    pub words: Words,
    /// Distributions that stand in the place of values; written there, and not as a field.
    #[serde(skip)]
    pub draws: Draws,
}

/// Robots of one role side by side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Name of the role of the whole row.
    pub role: String,
    /// Number of robots.
    pub count: u32,
    /// Centre of the row.
    pub center: Point,
    /// Distance between the first and the last robot, in metres.
    pub width_m: f64,
    /// Initial levels of the robots of the row, instead of `initial_levels`. A distribution is drawn for each
    /// robot.
    #[serde(default)]
    pub levels: Option<Levels>,
    /// What is different in this row from the robots of its role.
    #[serde(default)]
    pub body: Option<Body>,
}

/// Values of a row's robots in the place of their role's; what is left out is as in the role.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Body {
    /// Radius of the disc, in metres.
    pub radius_m: Option<f64>,
    /// Mass, in kilograms.
    pub mass_kg: Option<f64>,
    /// Health points at 100 %.
    pub hp: Option<f64>,
    /// Battery capacity at 100 %.
    pub energy: Option<f64>,
    /// Top speed, in metres per second.
    pub speed_mps: Option<f64>,
    /// Greatest acceleration and braking of the drive, in metres per second squared.
    pub acceleration_mps2: Option<f64>,
    /// Range within which debris and radiation are noticed, in metres.
    pub sensing_m: Option<f64>,
    /// Range within which rescuees are seen, in metres.
    pub observing_m: Option<f64>,
    /// Rescuees that it can have on board.
    pub capacity: Option<u32>,
    /// Rescuing resources that it takes along each round.
    pub resources: Option<u32>,
    /// Whether it guides its group.
    pub guides: Option<bool>,
}

/// Levels of a robot, in percent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Levels {
    /// Battery.
    pub energy: Amount,
    /// Health.
    pub hp: Amount,
}

/// Places that one robot is to go to, one after the other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Errand {
    /// Id of the robot.
    pub robot: u32,
    /// The places, in order. It waits at the last.
    pub to: Vec<Point>,
}

/// What a robot of a role is and can do, at full health.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RoleFile {
    /// Name of the role.
    pub name: String,
    /// Whether robots of this role drive or fly.
    pub kind: RoleKind,
    /// Radius of the disc, in metres.
    pub radius_m: f64,
    /// Mass, in kilograms.
    pub mass_kg: f64,
    /// Health points at 100 %.
    pub hp: f64,
    /// Battery capacity at 100 %.
    pub energy: f64,
    /// Top speed, in metres per second.
    pub speed_mps: f64,
    /// Greatest acceleration and braking of the drive, in metres per second squared.
    pub acceleration_mps2: f64,
    /// Range within which debris and radiation are noticed, in metres.
    pub sensing_m: f64,
    /// Range within which rescuees are seen, in metres.
    pub observing_m: f64,
    /// What it sees wrong of rescuees. Without this, it sees all within range where they are.
    #[serde(skip_serializing_if = "Sight::is_exact")]
    pub sight: Sight,
    /// Rescuees that it can have on board.
    pub capacity: u32,
    /// Rescuing resources that it takes along each round.
    pub resources: u32,
    /// Whether it guides its group: a group without a guide that can act is slower, by
    /// `mission.blind_speed_loss`.
    pub guides: bool,
    /// Values of the needs that measure a constant of the role, by the name of the need.
    pub constants: BTreeMap<String, f64>,
}

/// Errors of the sight of rescuees.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sight {
    /// Standard deviation of each coordinate of a rescuee's place, in metres, at the end of the observing
    /// range; nearer by, in proportion less. The error of a robot's sight of a rescuee is drawn anew every
    /// 10 s.
    pub noise_m: f64,
    /// Probability that a robot overlooks a rescuee; drawn anew every 10 s.
    pub miss: f64,
    /// Times a minute, on average, that a robot near a task takes something for a rescuee. Its place is drawn
    /// in the square round the observing range; outside the range or the task's area it is dismissed.
    pub false_alarms_per_min: f64,
}

impl Sight {
    /// Whether it has no errors.
    pub fn is_exact(&self) -> bool {
        *self == Self::default()
    }
}

/// Where robots of a role move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum RoleKind {
    /// On the ground: walls, debris and other ground robots are in the way. The default.
    #[default]
    Ground,
    /// In the air, over debris and ground robots; walls and other aerial robots are in the way.
    Aerial,
}

/// A need that robots report and policies compare.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NeedFile {
    /// Name of the need.
    pub name: String,
    /// Its level in the hierarchy of needs.
    pub level: NeedLevel,
    /// What it measures.
    pub measures: Measure,
    /// Its weight. Only the ratios of weights matter.
    #[serde(default = "super::defaults::weight")]
    pub weight: f64,
}

/// What a need measures of a robot as it is now.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Measure {
    /// Health points.
    Health,
    /// Top speed at its present health, in metres per second.
    Speed,
    /// Sensing range at its present health, in metres.
    Sensing,
    /// Battery charge.
    Energy,
    /// Rescuing resources left.
    Resources,
    /// Room for rescuees.
    Capacity,
    /// Observing range at its present health, in metres.
    Observing,
    /// The constant of its role that has the need's name.
    Constant,
}

/// Normal distributions of the initial levels, in percent, clamped to [1, 100].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, from = "super::partial::InitialLevels")]
#[schemars(!from, default)]
pub struct InitialLevels {
    /// Battery level.
    pub energy: Normal,
    /// Health level.
    pub hp: Normal,
}

/// A normal distribution.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Normal {
    /// Mean, in percent.
    pub mean: f64,
    /// Standard deviation, in percent points.
    pub sd: f64,
}

/// A block of rescuees and the rest place that belongs to it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TaskFile {
    /// Name of the task.
    pub name: String,
    /// Its rank: the harder the task, the higher. Of two tasks of one rank, the first counts as harder.
    pub difficulty: u32,
    /// Centre of the block of rescuees.
    pub center: Point,
    /// Width and height of the block, in metres.
    pub size_m: Point,
    /// Rescuees along the width and along the height: they stand in a regular grid.
    pub grid: [u32; 2],
    /// Centre of the rest place.
    pub rest: Point,
    /// How many robots of a role its group gets, by the name of the role. Without it, tasks share a role as
    /// equally as possible; which of them gets a robot more is for the policy to decide.
    #[serde(default)]
    pub quota: BTreeMap<String, u32>,
    /// Debris and radiation zones drawn between home and this task, in addition.
    #[serde(default)]
    pub sampled: SampledCounts,
    /// What one of its rescuees is worth. For policies; the mission itself does not use it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// The least that the needs of its group should add up to, by the names of needs. For policies.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub requires: BTreeMap<String, f64>,
    /// How long its work is expected to take, in seconds. For policies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration_s: Option<f64>,
    /// Names of the tasks after which it should be done. For policies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub after: Vec<String>,
}

/// What is drawn where a task asks for sampled debris or radiation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sampled {
    /// Least and greatest radius of a sampled disc of debris, in metres.
    pub debris_radius_m: [f64; 2],
    /// Least and greatest radius of a sampled radiation zone, in metres.
    pub zone_radius_m: [f64; 2],
    /// Least free distance between two pieces of debris, in metres.
    pub gap_m: f64,
    /// Half the width of the strip between home and a task in which they are sampled, in metres.
    pub strip_m: f64,
}

impl Default for Sampled {
    fn default() -> Self {
        Self { debris_radius_m: [0.4, 0.8], zone_radius_m: [2.0, 4.0], gap_m: 2.0, strip_m: 12.0 }
    }
}

/// How many to draw for one task.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SampledCounts {
    /// Pieces of fixed debris.
    pub debris: u32,
    /// Radiation zones.
    pub radiation: u32,
}

/// A straight wall, with doors. Written `(from: (0, 0), to: (10, 0))`, or short `((0, 0), (10, 0))`.
#[derive(Debug, Clone, PartialEq)]
pub struct WallFile {
    /// Where its middle line begins.
    pub from: Point,
    /// Where its middle line ends.
    pub to: Point,
    /// Thickness, in metres; 0.2 where it is left out.
    pub thickness_m: f64,
    /// Its doors, which are gaps.
    pub doors: Vec<Door>,
}

/// A gap in a wall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Door {
    /// Distance of its middle from the wall's beginning, in metres.
    pub at_m: f64,
    /// Width, in metres.
    pub width_m: f64,
    /// A name, by which an event of the timeline can open and close it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Whether it is closed at the start.
    #[serde(default, rename = "closed", skip_serializing_if = "std::ops::Not::not")]
    pub is_closed: bool,
}
