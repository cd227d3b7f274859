//! Protocols: how robots that decide for themselves come to their decisions. A robot says things, hears
//! things, wakes up, and at last joins a group.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::decision::Assignment;
use crate::error::PolicyError;
use crate::ids::TaskId;
use crate::question::Question;

/// A protocol among robots, as a function of one robot's turn: what it keeps in mind travels with the turn,
/// so that no robot can know what it was not told.
///
/// ```
/// use teaming::protocol::{Act, Protocol, Turn};
/// use teaming::PolicyError;
///
/// /// Waits a second, then decides as the rule says.
/// struct Hesitate;
///
/// impl Protocol for Hesitate {
///     fn turn(&self, turn: &Turn) -> Result<Act, PolicyError> {
///         Ok(match &turn.rule {
///             Some(groups) => Act::joins(groups.clone()),
///             None if turn.since_s < 1.0 => Act::waits(1.0 - turn.since_s),
///             None => Act::asks(),
///         })
///     }
/// }
/// ```
pub trait Protocol: Send + Sync {
    /// What a robot does in its turn: the first of a negotiation, when it has heard something, and when it
    /// wakes up.
    ///
    /// # Errors
    /// The protocol cannot go on.
    fn turn(&self, turn: &Turn) -> Result<Act, PolicyError>;
}

/// A turn of one robot in a negotiation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Turn {
    /// The robot.
    pub robot: u32,
    /// How long ago the negotiation began, in seconds.
    pub since_s: f64,
    /// What it was told since its last turn, in the order in which it heard it.
    pub told: Vec<Told>,
    /// What it kept in mind at its last turn; null in its first.
    pub state: Value,
    /// The groups as the rule before `by` sees them, if the robot has just asked for them.
    pub rule: Option<Assignment>,
    /// The team as the robot knows it now.
    pub question: Question,
    /// What is to become of a robot that is out of time; none before.
    #[serde(skip)]
    pub late: Option<Undecided>,
}

impl Turn {
    /// Whether it is the robot's first turn.
    #[must_use]
    pub fn is_first(&self) -> bool {
        self.state.is_null()
    }

    /// What the robot kept in mind, see [`Act::keeping`].
    #[must_use]
    pub fn mind<M: DeserializeOwned + Default>(&self) -> M {
        M::deserialize(&self.state).unwrap_or_default()
    }

    /// What the robot was told, and by whom. What has another form is no message of the protocol.
    pub fn heard<T: DeserializeOwned>(&self) -> impl Iterator<Item = (u32, T)> {
        self.told.iter().filter_map(|told| Some((told.from, T::deserialize(&told.what).ok()?)))
    }

    /// The same for whoever must not know the seed of the question, see [`Question::sealed`].
    #[must_use]
    pub fn sealed(&self) -> Self {
        Self { question: self.question.sealed(), ..self.clone() }
    }
}

/// Something that a robot was told.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Told {
    /// Who said it.
    pub from: u32,
    /// What was said.
    pub what: Value,
    /// How long ago it was said, in seconds.
    pub age_s: f64,
}

/// What a robot does in its turn.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Act {
    /// What it says.
    pub says: Vec<Say>,
    /// Whether it says to all how the others are, as far as it has heard.
    pub shares: bool,
    /// Whether it asks how the rule before `by` groups the team as it knows it. It gets another turn at once,
    /// with the [answer](Turn::rule).
    pub asks: bool,
    /// Where it goes; none as long as it has not decided. What it decides later counts instead.
    pub joins: Option<Choice>,
    /// When it wakes up, in seconds from now; 0 for once more in this step, after all have been heard.
    pub wake_in_s: Option<f64>,
    /// What it keeps in mind: up to [`MOST_STATE`] bytes of JSON.
    pub state: Value,
}

/// Most bytes of JSON that a robot keeps in mind, or says at once.
pub const MOST_STATE: usize = 16 << 10;

/// Something that a robot says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Say {
    /// To whom; none for all.
    #[serde(default)]
    pub to: Option<u32>,
    /// What.
    pub what: Value,
}

/// Where a robot goes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "joins must be the number of a task, {\"groups\": [..]} or \"stays\"")]
pub enum Choice {
    /// To its own group of these, as it sees all groups. It may leave out others, but not itself.
    Groups(Assignment),
    /// To the group of this task. Of the other groups it says nothing.
    Group(TaskId),
    /// Nowhere.
    Stays(Stays),
}

/// The choice of a robot that goes nowhere, in JSON `"stays"`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stays {
    /// It stays at home.
    #[serde(rename = "stays")]
    AtHome,
}

/// What becomes of a robot that has not decided when the time of a negotiation is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub enum Undecided {
    /// It goes where the rule sends it, by what it knows. The default.
    #[default]
    OwnView,
    /// It goes where the base sends it.
    Base,
    /// It stays at home.
    Stays,
}

impl Act {
    /// Joins its own group of these.
    #[must_use]
    pub fn joins(groups: Assignment) -> Self {
        Self { joins: Some(Choice::Groups(groups)), ..Self::default() }
    }

    /// Asks the rule.
    #[must_use]
    pub fn asks() -> Self {
        Self { asks: true, ..Self::default() }
    }

    /// Waits so long, in seconds.
    #[must_use]
    pub fn waits(seconds: f64) -> Self {
        Self { wake_in_s: Some(seconds.max(0.0)), ..Self::default() }
    }

    /// The same, and says this to all.
    #[must_use]
    pub fn saying(mut self, what: &impl Serialize) -> Self {
        let what = serde_json::to_value(what).unwrap_or_default();
        self.says.push(Say { to: None, what });
        self
    }

    /// The same, and keeps this in mind.
    #[must_use]
    pub fn keeping(self, mind: &impl Serialize) -> Self {
        Self { state: serde_json::to_value(mind).unwrap_or_default(), ..self }
    }
}

impl Choice {
    /// The groups as a robot sees them that chooses this; `None` if there is no such task.
    #[must_use]
    pub fn seen_by(self, robot: u32, tasks: usize) -> Option<Assignment> {
        let mut seen = Assignment::new(vec![Vec::new(); tasks]);
        match self {
            Self::Groups(groups) => return Some(groups.sorted()),
            Self::Group(task) => seen.groups.get_mut(task.index())?.push(robot),
            Self::Stays(_) => seen.idle.push(robot),
        }
        Some(seen)
    }
}
