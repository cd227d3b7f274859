//! Events: what happened, in order. Mechanics publish them; metrics and recorders only listen.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use teaming::TaskId;

use crate::hash::part;
use crate::ids::{RescueeId, RobotId};
use crate::report::{Report, Speaker, Statement};

/// Why a robot turned back to its rest place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum TurnBackCause {
    /// Its energy is below the threshold, or would not last for the way.
    Energy,
    /// Its HP is below the threshold.
    Hp,
}

ron_tree::named! {
    /// Why a group went home.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
    pub enum ReturnCause {
        /// No member in the field has room left.
        CapacityUsed = "capacity used",
        /// No member in the field has a resource left.
        ResourcesUsed = "resources used",
        /// All members searched the whole area and know of nobody who is left, or know no way there.
        NothingLeft = "nothing left",
        /// No robot that can carry is left in the field.
        NobodyCanCarry = "nobody can carry",
    }
}

ron_tree::named! {
    /// Why the team no longer waits for a robot.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
    pub enum CutOffCause {
        /// It knows no way to the place.
        NoWay = "knows no way",
        /// It came no nearer for `mission.cut_off_s`, nor did those for which it waits.
        NoProgress = "comes no nearer",
    }
}

/// Where a rescuee was delivered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Place {
    /// Home.
    Home,
    /// A rest place.
    Rest,
}

/// Something that happened.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum Event {
    /// The team was grouped and a round began. The trial's record has the whole decision.
    RoundStarted {
        /// Number of the round, from 1.
        round: u32,
        /// For each task, the members of its group.
        groups: Vec<Vec<RobotId>>,
    },
    /// Every robot that can still move is home again.
    RoundEnded {
        /// Number of the round.
        round: u32,
    },
    /// A group went home.
    GroupReturned {
        /// Its task.
        task: TaskId,
        /// Why: `CapacityUsed`, `ResourcesUsed`, `NothingLeft` (nobody is left to whom it knows a way), or
        /// `NobodyCanCarry`.
        cause: ReturnCause,
    },
    /// A robot filled up its resources at home.
    Restocked {
        /// The robot.
        robot: RobotId,
        /// Resources that it has now.
        resources: u32,
    },
    /// Debris was noticed, or noticed to have moved.
    DebrisDiscovered {
        /// Who noticed it.
        robot: RobotId,
        /// Its number.
        debris: u32,
    },
    /// A radiation zone was noticed.
    ZoneDiscovered {
        /// Who noticed it.
        robot: RobotId,
        /// Its number.
        zone: u32,
    },
    /// A rescuee was seen.
    Sighted {
        /// Who saw it.
        robot: RobotId,
        /// The rescuee.
        rescuee: RescueeId,
    },
    /// A rescuee was taken on board: one unit of the robot's capacity and one resource were used.
    Loaded {
        /// The robot.
        robot: RobotId,
        /// The rescuee.
        rescuee: RescueeId,
        /// The member whose resource was used.
        resource_of: RobotId,
    },
    /// A rescuee was delivered: it is rescued.
    Delivered {
        /// The robot.
        robot: RobotId,
        /// The rescuee.
        rescuee: RescueeId,
        /// Where.
        place: Place,
    },
    /// A robot left for its rest place.
    TurnedBack {
        /// The robot.
        robot: RobotId,
        /// Why: `Energy` or `Hp`.
        cause: TurnBackCause,
    },
    /// A robot began to rest.
    RestStarted {
        /// The robot.
        robot: RobotId,
    },
    /// A robot is full again.
    RestEnded {
        /// The robot.
        robot: RobotId,
    },
    /// A robot's energy is 0.
    Stranded {
        /// The robot.
        robot: RobotId,
    },
    /// A robot's HP is 0.
    Disabled {
        /// The robot.
        robot: RobotId,
    },
    /// Robots came into conflict.
    ConflictStarted {
        /// The conflict set.
        robots: Vec<RobotId>,
    },
    /// A conflict set came to nothing: nobody moved, or its head came no nearer. One of the next three solves
    /// it.
    Deadlocked {
        /// The conflict set, in order of precedence.
        robots: Vec<RobotId>,
    },
    /// A robot in the way of one with the right of way goes to where that one can pass.
    MadeRoom {
        /// The robot that makes room.
        robot: RobotId,
        /// The robot for which it makes room.
        room_for: RobotId,
    },
    /// Another member of a deadlocked set has the right of way.
    TurnPassed {
        /// The conflict set, in its new order of precedence.
        robots: Vec<RobotId>,
    },
    /// A deadlocked set backs off sideways: each of its members was head in vain.
    BackedOff {
        /// The conflict set.
        robots: Vec<RobotId>,
    },
    /// A robot was where its errand led it.
    ErrandDone {
        /// The robot.
        robot: RobotId,
    },
    /// A robot gave up on a place to which it knows no way: the rescuee, the errand or the rest place there.
    Unreachable {
        /// The robot.
        robot: RobotId,
        /// The place, in metres.
        place: [f32; 2],
    },
    /// The team no longer waits for a robot that does not get home or to rest, until it comes nearer; or a
    /// robot gave up on a rescuee or an errand to which it came no nearer.
    CutOff {
        /// The robot.
        robot: RobotId,
        /// Where it does not get, in metres.
        place: [f32; 2],
        /// Why: `NoWay` or `NoProgress`.
        cause: CutOffCause,
    },
    /// Nobody is left to bring home; or all errands are done or given up.
    Finished,
    /// No robot that can carry is left.
    MissionOver,
    /// Debris fell.
    DebrisFell {
        /// Its number.
        debris: u32,
    },
    /// A way closed: a door, or debris that was away is back.
    WayClosed {
        /// Number of the piece that closes it.
        debris: u32,
    },
    /// A way opened: a door, or debris was cleared away.
    WayOpened {
        /// Number of the piece that closed it.
        debris: u32,
    },
    /// A radiation source appeared.
    SourceAppeared {
        /// Its number.
        zone: u32,
    },
    /// A radiation source died.
    SourceDied {
        /// Its number.
        zone: u32,
    },
    /// A robot lost a part of its levels by an event of the scenario.
    Damaged {
        /// The robot.
        robot: RobotId,
        /// Energy that it lost, in percent points.
        energy: f64,
        /// HP that it lost, in percent points.
        hp: f64,
    },
    /// Rescuees appeared.
    RescueesAppeared {
        /// Their task.
        task: TaskId,
        /// The lowest of their ids, which follow one another.
        first: u32,
        /// How many.
        count: u32,
    },
    /// A task began.
    TaskBegan {
        /// The task.
        task: TaskId,
    },
    /// A task ended: its rescuees that still waited are gone.
    TaskEnded {
        /// The task.
        task: TaskId,
    },
    /// Debris that was to fall, or a way that was to close, waited until its place was free. Now that the way
    /// is to be open, it no longer waits.
    CalledOff {
        /// Number of the piece that stays away.
        debris: u32,
    },
    /// No round can begin, no event is to come, and every robot that can act is at home or cut off: the trial
    /// ends.
    Standstill,
    /// A message that the medium delayed was heard.
    Heard {
        /// The sender.
        robot: RobotId,
        /// Who heard it; the base if it is no robot.
        to: Option<RobotId>,
        /// When it was sent, in seconds.
        sent_s: f64,
    },
    /// A message was lost.
    Lost {
        /// The sender.
        robot: RobotId,
        /// Who was to hear it; the base if it is no robot.
        to: Option<RobotId>,
    },
    /// A robot began to lie by an event of the scenario.
    BeganToLie {
        /// The robot.
        robot: RobotId,
    },
    /// A robot stopped lying by an event of the scenario.
    BecameHonest {
        /// The robot.
        robot: RobotId,
    },
    /// A robot became slower by an event of the scenario, and its gauge does not show it.
    Slowed {
        /// The robot.
        robot: RobotId,
        /// The share of its speed that it has left.
        factor: f64,
    },
    /// A robot's battery faded by an event of the scenario.
    Faded {
        /// The robot.
        robot: RobotId,
        /// The factor on what it spends.
        factor: f64,
    },
    /// A robot's radio broke by an event of the scenario.
    Muted {
        /// The robot.
        robot: RobotId,
    },
}

impl Event {
    /// The event that a report is news to those who share the sender's belief, if there is one of its kind.
    pub fn of_report(report: &Report) -> Option<Self> {
        let Speaker::Robot(robot) = report.from else { return None };
        match report.says {
            Statement::DebrisLies { debris, .. } => Some(Self::DebrisDiscovered { robot, debris }),
            Statement::ZoneIs { zone, .. } => Some(Self::ZoneDiscovered { robot, zone }),
            Statement::RescueeWaits { rescuee, .. } => Some(Self::Sighted { robot, rescuee }),
            Statement::RescueeIsGone { .. }
            | Statement::TaskIs { .. }
            | Statement::WreckLies { .. }
            | Statement::LevelsAre(_)
            | Statement::MateGoes(_)
            | Statement::RoundWas(_)
            | Statement::StaysOut { .. }
            | Statement::HasHeard(_)
            | Statement::Protocol { .. }
            | Statement::Claims(_)
            | Statement::GivesUp { .. } => None,
        }
    }
}

/// The JSON Schema of an event.
pub fn event_schema() -> serde_json::Value {
    schemars::schema_for!(Event).into()
}

/// The events of the current step, in order, and a hash over all before.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct EventLog {
    events: Vec<Event>,
    past: u128,
}

impl EventLog {
    /// Publishes an event.
    pub fn push(&mut self, event: Event) {
        self.events.push(event);
    }

    /// Publishes several events, or none.
    pub fn extend(&mut self, events: impl IntoIterator<Item = Event>) {
        self.events.extend(events);
    }

    /// The events since the last [`EventLog::clear`].
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Begins a new step: of the events so far only their hash is kept.
    pub fn clear(&mut self) {
        if !self.events.is_empty() {
            self.past = part(&(self.past, &self.events));
            self.events.clear();
        }
    }
}
