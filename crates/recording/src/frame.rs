//! The state at one moment, as a recording stores it: whole numbers and ids.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;
use teaming::TaskId;
use usar_sim::belief::Belief;
use usar_sim::conflict::DelayCause;
use usar_sim::mission::Activity;
use usar_sim::robot::Condition;
use usar_sim::simulation::Simulation;
use usar_sim::world::RescueeState;
use usar_sim::world::Robot;

use crate::numbers::NotNumbers;

/// Names of the activities of robots, in the order of their numbers.
pub(crate) const ACTIVITIES: [&str; 9] = [
    "home",
    "searching",
    "approaching",
    "loading",
    "standby",
    "on_errand",
    "returning",
    "to_rest",
    "resting",
];

/// Names of the conditions of robots, in the order of their numbers.
pub(crate) const CONDITIONS: [&str; 3] = ["able", "stranded", "disabled"];

/// Names of the states of rescuees, in the order of their numbers.
pub(crate) const RESCUEE_STATES: [&str; 5] = ["waiting", "claimed", "on_board", "delivered", "absent"];

/// What is stored as whole numbers, always the same count of them.
pub(crate) trait Stored: Sized {
    /// Names of its numbers, if the header lists them.
    const NAMES: &'static [&'static str] = &[];

    /// Appends its numbers.
    fn write(self, out: &mut Vec<i32>);

    /// Reads its numbers from a row.
    fn next(row: &mut Row) -> Result<Self, NotNumbers>;

    /// Reads the numbers of a whole row.
    fn read(numbers: &[i32]) -> Result<Self, NotNumbers> {
        row(numbers, Self::next)
    }
}

/// Reads the numbers of a row, one after the other.
pub(crate) struct Row<'r>(std::slice::Iter<'r, i32>);

impl Row<'_> {
    fn next<T: Stored>(&mut self) -> Result<T, NotNumbers> {
        T::next(self)
    }

    fn is_over(&self) -> bool {
        self.0.len() == 0
    }
}

fn row<T>(numbers: &[i32], read: impl FnOnce(&mut Row) -> Result<T, NotNumbers>) -> Result<T, NotNumbers> {
    let mut row = Row(numbers.iter());
    let value = read(&mut row)?;
    if row.is_over() { Ok(value) } else { Err(NotNumbers) }
}

/// Types of one number each.
macro_rules! numbers {
    ($($type:ty: $write:expr, $read:expr;)+) => {
        $(impl Stored for $type {
            fn write(self, out: &mut Vec<i32>) {
                out.push($write(self));
            }

            fn next(row: &mut Row) -> Result<Self, NotNumbers> {
                row.0.next().and_then(|number| $read(*number)).ok_or(NotNumbers)
            }
        })+
    };
}

numbers! {
    i32: std::convert::identity, Some;
    u32: u32::cast_signed, |number| u32::try_from(number).ok();
    u8: i32::from, |number| u8::try_from(number).ok();
    bool: i32::from, |number| [false, true].get(usize::try_from(number).ok()?).copied();
    // 0 for none, otherwise the id plus 1.
    Option<u32>: |id: Self| id.map_or(0, |id| id.cast_signed().wrapping_add(1)),
        |number| u32::try_from(number).ok().map(|number| number.checked_sub(1));
}

impl Stored for [i32; 2] {
    fn write(self, out: &mut Vec<i32>) {
        out.extend(self);
    }

    fn next(row: &mut Row) -> Result<Self, NotNumbers> {
        Ok([row.next()?, row.next()?])
    }
}

/// Types that are stored field by field: `as` names the numbers of a field for the header, and `=` the
/// codes that a field may have.
macro_rules! stored {
    ($(
        $(#[$about:meta])*
        $name:ident {
            $($(#[$meaning:meta])* $field:ident: $type:ty $(as $($number:literal)+)? $(= $codes:expr)?;)+
        }
    )+) => {
        $($(#[$about])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
        pub struct $name {
            $($(#[$meaning])* pub $field: $type,)+
        }

        impl Stored for $name {
            const NAMES: &'static [&'static str] = &[$($($($number,)+)?)+];

            fn write(self, out: &mut Vec<i32>) {
                $(self.$field.write(out);)+
            }

            fn next(row: &mut Row) -> Result<Self, NotNumbers> {
                let read = Self { $($field: row.next()?,)+ };
                let are_known = true $($(&& usize::from(read.$field) < $codes.len())?)+;
                are_known.then_some(read).ok_or(NotNumbers)
            }
        })+
    };
}

stored! {
    /// Position, velocity and levels of a robot.
    Motion {
        /// Centre, in millimetres.
        position_mm: [i32; 2] as "x_mm" "y_mm";
        /// Velocity, in millimetres per second.
        velocity_mm_s: [i32; 2] as "vx_mm_s" "vy_mm_s";
        /// Battery level, in thousandths of a percent.
        energy_millipercent: i32 as "energy_millipercent";
        /// Health level, in thousandths of a percent.
        hp_millipercent: i32 as "hp_millipercent";
    }

    /// The activity of a robot, its delay cause, and other state. Activities, causes and conditions are
    /// numbers; the header's codes name them.
    RobotState {
        /// Its activity.
        activity: u8 = ACTIVITIES;
        /// The rescuee that it approaches or loads.
        rescuee: Option<u32>;
        /// The step until which it loads or rests.
        until_step: Option<u32>;
        /// Its delay cause: why it does not move on.
        delay: u8 = DelayCause::ALL;
        /// The robot that it waits for.
        waits_for: Option<u32>;
        /// The task of its group.
        task: Option<u32>;
        /// Whether it can still act.
        condition: u8 = CONDITIONS;
        /// Rescuing resources left.
        resources: u32;
        /// Rescuees on board.
        load: u32;
    }

    /// A rescuee at one moment.
    RescueeFrame {
        /// Its state, as a number that the header's codes name.
        state: u8 = RESCUEE_STATES;
        /// The robot that has claimed it or has it on board.
        robot: Option<u32>;
    }

    /// The place of a piece of debris.
    MovedDebris {
        /// Its place, in millimetres.
        position_mm: [i32; 2];
        /// Its rotation, in ten-thousandths of a radian anticlockwise.
        angle: i32;
        /// Number of its sightings so far: the places at which it could be noticed.
        sightings: u32;
    }
}

/// The state at one moment.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Frame {
    /// Number of steps done.
    pub step: u64,
    /// The robots, by id.
    pub robots: Vec<RobotFrame>,
    /// The rescuees, by id.
    pub rescuees: Vec<RescueeFrame>,
    /// The debris.
    pub debris: Vec<MovedDebris>,
    /// The knowledge of each task's group, and last the knowledge of the team at home.
    pub groups: Vec<GroupFrame>,
    /// The conflict sets: ids of their members, in order of precedence.
    pub conflict_sets: Vec<Vec<u32>>,
}

/// A robot at one moment.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RobotFrame {
    /// Position, velocity and levels.
    pub motion: Motion,
    /// Activity, delay cause and other state.
    pub state: RobotState,
    /// Goal and waypoints.
    pub route: Route,
}

/// The goal of a robot, and its waypoints.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct Route {
    /// Its goal, in millimetres.
    pub goal_mm: Option<[i32; 2]>,
    /// Waypoints ahead, in millimetres.
    pub ahead_mm: Vec<[i32; 2]>,
}

/// The knowledge of a group.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct GroupFrame {
    /// Whether it has work to do.
    pub is_at_work: bool,
    /// The debris that it knows: the number of each piece, and the number of its sighting.
    pub debris: Vec<(u32, u32)>,
    /// The radiation zones that it knows.
    pub zones: Vec<u32>,
}

/// The nearest whole number; halves are rounded away from zero. Faster than `f64::round` on processors
/// without an instruction for it.
fn nearest(value: f64) -> i32 {
    (value + 0.5_f64.copysign(value)) as i32
}

/// A length in metres as millimetres.
fn milli(value: f32) -> i32 {
    nearest(f64::from(value) * 1000.0)
}

fn percent(value: f64) -> i32 {
    nearest(value * 1000.0)
}

/// A number of things as an `i32`.
fn count(things: usize) -> i32 {
    (things as u32).cast_signed()
}

impl Motion {
    pub(crate) fn of(robot: &Robot) -> Self {
        Self {
            position_mm: [milli(robot.position.x), milli(robot.position.y)],
            velocity_mm_s: [milli(robot.velocity.x), milli(robot.velocity.y)],
            energy_millipercent: percent(robot.energy),
            hp_millipercent: percent(robot.hp),
        }
    }
}

impl RobotState {
    pub(crate) fn of(simulation: &Simulation, id: usize) -> Self {
        let (robot, agent) = (&simulation.world().robots[id], &simulation.mission().crew.agents[id]);
        let delay = simulation.delay(robot.id);
        let exists = |rescuee: &u32| (*rescuee as usize) < simulation.world().rescuees.len();
        let (activity, until) = match agent.activity {
            Activity::Home => (0, None),
            Activity::Searching => (1, None),
            Activity::Approaching(_) => (2, None),
            Activity::Loading(_, until) => (3, Some(until)),
            Activity::Standby => (4, None),
            Activity::OnErrand => (5, None),
            Activity::Returning => (6, None),
            Activity::ToRest => (7, None),
            Activity::Resting(until) => (8, Some(until)),
        };
        Self {
            activity,
            rescuee: agent.activity.claim().map(|rescuee| rescuee.0).filter(exists),
            until_step: until.map(|step| step as u32),
            delay: delay.cause as u8,
            waits_for: delay.waits_for.map(|other| other.0),
            task: agent.task.map(|task| u32::from(task.0)),
            condition: match robot.condition {
                Condition::Able => 0,
                Condition::Stranded => 1,
                Condition::Disabled => 2,
            },
            resources: robot.resources,
            load: robot.load.len() as u32,
        }
    }
}

impl Route {
    /// Appends the numbers of a robot's current route.
    pub(crate) fn write_now(simulation: &Simulation, id: usize, out: &mut Vec<i32>) {
        let robot = &simulation.world().robots[id];
        let traveller = simulation.navigator().traveller(robot.id);
        let goal = traveller.goal();
        out.push(i32::from(goal.is_some()));
        let ahead = traveller.route().map_or(&[][..], |route| route.ahead());
        for at in goal.iter().map(|goal| &goal.point).chain(ahead) {
            out.extend_from_slice(&[milli(at.x), milli(at.y)]);
        }
    }

    pub(crate) fn read(numbers: &[i32]) -> Result<Self, NotNumbers> {
        row(numbers, |row| {
            let goal_mm = if row.next()? { Some(row.next()?) } else { None };
            let mut ahead_mm = Vec::new();
            while !row.is_over() {
                ahead_mm.push(row.next()?);
            }
            Ok(Self { goal_mm, ahead_mm })
        })
    }
}

impl RescueeFrame {
    pub(crate) fn of(simulation: &Simulation, id: usize) -> Self {
        let rescuee = &simulation.world().rescuees[id];
        let (state, robot) = match (rescuee.state, simulation.mission().claims.by(rescuee.id)) {
            (RescueeState::Waiting, None) => (0, None),
            (RescueeState::Waiting, by) => (1, by),
            (RescueeState::OnBoard(robot), _) => (2, Some(robot)),
            (RescueeState::Rescued, _) => (3, None),
            (RescueeState::Absent, _) => (4, None),
        };
        Self { state, robot: robot.map(|robot| robot.0) }
    }
}

impl MovedDebris {
    pub(crate) fn of(simulation: &Simulation, number: usize) -> Self {
        let piece = &simulation.world().debris[number];
        let (at, turn) = (piece.pose.translation, piece.pose.rotation);
        Self {
            position_mm: [milli(at.x), milli(at.y)],
            angle: nearest(f64::from(libm::atan2f(turn.sin(), turn.cos())) * 10_000.0),
            sightings: piece.sightings.len() as u32,
        }
    }
}

impl GroupFrame {
    /// Appends the numbers of a group's current belief.
    pub(crate) fn write_now(simulation: &Simulation, number: usize, out: &mut Vec<i32>) {
        let group = simulation.mission().crew.groups.get(number);
        let beliefs: Vec<&Belief> = simulation.beliefs_of(group.map(|_| TaskId(number as u16))).collect();
        let pieces = &simulation.world().debris;
        out.extend_from_slice(&[i32::from(group.is_some_and(|group| group.at_work)), 0]);
        let before = out.len();
        // A piece that several robots know is where the last of them saw it.
        let mut known = BTreeMap::new();
        for (number, piece) in beliefs.iter().flat_map(|belief| belief.debris.iter()) {
            let at_step = known.entry(number).or_insert(piece.at_step);
            *at_step = piece.at_step.max(*at_step);
        }
        for (number, at_step) in known {
            // Recordings keep places as sightings; a piece that does not exist has none.
            let Some(piece) = pieces.get(number as usize) else { continue };
            out.extend_from_slice(&[number.cast_signed(), count(piece.sightings_until(at_step))]);
        }
        out[before - 1] = count((out.len() - before) / 2);
        let zones_on =
            beliefs.iter().flat_map(|belief| belief.zones_on()).map(|(number, _)| number.cast_signed());
        out.extend(zones_on.collect::<BTreeSet<i32>>());
    }

    pub(crate) fn read(numbers: &[i32]) -> Result<Self, NotNumbers> {
        row(numbers, |row| {
            let (is_at_work, pieces) = (row.next()?, row.next::<u32>()?);
            let debris = (0..pieces).map(|_| Ok((row.next()?, row.next()?))).collect::<Result<_, _>>()?;
            let mut zones = Vec::new();
            while !row.is_over() {
                zones.push(row.next()?);
            }
            Ok(Self { is_at_work, debris, zones })
        })
    }
}

/// Appends the conflict sets: for each set, its number of members and their ids.
pub(crate) fn push_sets(simulation: &Simulation, out: &mut Vec<i32>) {
    for set in simulation.conflict_sets() {
        out.push(count(set.len()));
        out.extend(set.iter().map(|id| count(*id)));
    }
}

pub(crate) fn read_sets(numbers: &[i32]) -> Result<Vec<Vec<u32>>, NotNumbers> {
    row(numbers, |row| {
        let mut sets = Vec::new();
        while !row.is_over() {
            let members = row.next::<u32>()?;
            sets.push((0..members).map(|_| row.next()).collect::<Result<_, _>>()?);
        }
        Ok(sets)
    })
}
