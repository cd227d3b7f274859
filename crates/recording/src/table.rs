//! Tidy tables of a recording: one row for each object at each time, one header, units in the names.
//! Undefined values are empty cells.

use std::io::{self, Write};

use scenario::{Measure, NeedFile};
use tables::{About, Cell, Column, Columns, Csv, Kind, abouts, columns};
use teaming::{Member, Question, TaskId};
use usar_sim::conflict::DelayCause;
use usar_sim::robot::{ENERGY, HP};

use crate::error::ReadError;
use crate::frame::{ACTIVITIES, CONDITIONS, Frame, GroupFrame, RescueeFrame, RobotFrame};
use crate::header::{Header, TaskPlace};
use crate::reader::Recording;
use crate::words::ToldEvent;

/// A table of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Table {
    /// Each robot at each time.
    Robots,
    /// Each task's group at each time, with the states of the task's rescuees.
    Groups,
    /// Each event.
    Events,
    /// Each robot at each decision.
    Decisions,
}

/// A row of the table of robots.
struct RobotRow<'a> {
    time_s: f64,
    header: &'a Header,
    id: usize,
    robot: &'a RobotFrame,
    needs: Vec<f64>,
}

/// A row of the table of groups.
struct GroupRow<'a> {
    time_s: f64,
    task: &'a TaskPlace,
    group: &'a GroupFrame,
    members: usize,
    rescuees: &'a [RescueeFrame],
}

impl GroupRow<'_> {
    /// Number of the task's rescuees in a state.
    fn rescuees(&self, state: u8) -> usize {
        self.rescuees.iter().filter(|rescuee| rescuee.state == state).count()
    }
}

/// A row of the table of events.
struct EventRow<'a> {
    header: &'a Header,
    event: ToldEvent,
}

/// A row of the table of decisions.
struct DecisionRow<'a> {
    time_s: f64,
    question: &'a Question,
    task: TaskId,
    member: &'a Member,
}

impl Table {
    /// All tables.
    pub const ALL: [Self; 4] = [Self::Robots, Self::Groups, Self::Events, Self::Decisions];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Robots => "robots",
            Self::Groups => "groups",
            Self::Events => "events",
            Self::Decisions => "decisions",
        }
    }

    /// What a row is.
    pub fn row_is(self) -> &'static str {
        match self {
            Self::Robots => "a robot in a frame",
            Self::Groups => "a task's group in a frame, with the task's rescuees",
            Self::Events => "an event",
            Self::Decisions => "a robot in the group to which a decision assigned it",
        }
    }

    /// Its columns in a world with these needs.
    pub fn columns(self, needs: &[NeedFile]) -> Vec<About> {
        match self {
            Self::Robots => abouts(robots(needs)),
            Self::Groups => abouts(groups()),
            Self::Events => abouts(events()),
            Self::Decisions => abouts(decisions(needs)),
        }
    }

    /// Writes the table as CSV, with every `every`-th frame.
    ///
    /// # Errors
    /// The recording cannot be read, or the table cannot be written.
    pub fn write_csv<W, E>(self, recording: &Recording, every: usize, out: W) -> Result<W, E>
    where
        W: Write,
        E: From<ReadError> + From<io::Error>,
    {
        let (header, needs) = (&recording.header, &recording.header.world.needs);
        let mut csv = Csv::new(out);
        csv.add_names(&self.columns(needs))?;
        match self {
            Self::Robots | Self::Groups => {
                for number in (0..recording.frames()).step_by(every.max(1)) {
                    let (frame, time_s) = (recording.frame(number)?, header.time_s_of(number));
                    if self == Self::Robots {
                        csv.add(&[], &robots(needs), robot_rows(header, &frame, time_s))?;
                    } else {
                        csv.add(&[], &groups(), group_rows(header, &frame, time_s))?;
                    }
                }
            }
            Self::Events => {
                csv.add(&[], &events(), recording.told().map(|event| EventRow { header, event }))?;
            }
            Self::Decisions => csv.add(&[], &decisions(needs), decision_rows(recording))?,
        }
        Ok(csv.finish()?)
    }
}

const TIME: &str = "Simulated time.";
const ROBOT: &str = "Number of the robot, from 0, in the order of the scenario's team.";
const ROLE: &str = "Role of the robot.";

/// A time in seconds, rounded to microseconds.
fn time(time_s: f64) -> Cell {
    Cell::short((time_s * 1e6).round() / 1e6)
}

fn thousandth(value: i32) -> Cell {
    Cell::short(f64::from(value) / 1000.0)
}

/// The columns of the needs, of which `read` gives the values of a row.
fn of_needs<R>(
    needs: &[NeedFile],
    read: impl Fn(&R) -> &[f64] + Copy + 'static,
) -> impl Iterator<Item = Column<R>> {
    needs.iter().enumerate().map(move |(place, need)| {
        let (ending, unit) = match need.measures {
            Measure::Speed => ("_mps", "m/s"),
            Measure::Sensing | Measure::Observing => ("_m", "m"),
            _ => ("", ""),
        };
        let meaning = format!("The need {:?} as it really was, in the units of the scenario.", need.name);
        let about = About::new(format!("need_{}{ending}", need.name), Kind::Number, unit, meaning);
        Column::new(about, move |row: &R| Cell::short(read(row).get(place).copied()))
    })
}

fn robots<'a>(needs: &[NeedFile]) -> Columns<RobotRow<'a>> {
    let activity = format!("What the robot does: {}.", ACTIVITIES.join(", "));
    let delay = format!("Why it does not move on: {}.", DelayCause::ALL.map(DelayCause::name).join(", "));
    let condition = format!("Whether it can still act: {}.", CONDITIONS.join(", "));
    let mut columns = columns! { RobotRow:
        "time_s", Number, "s", TIME, |row| time(row.time_s);
        "robot", Natural, "", ROBOT, |row| row.id;
        "role", Text, "", ROLE, |row| {
            let world = &row.header.world;
            world.roles[world.robots[row.id].role].name.clone()
        };
        "task", Text, "", "Task of its group; empty for none.", |row| {
            let task = row.robot.state.task.and_then(|task| row.header.world.tasks.get(task as usize));
            task.map(|task| task.name.clone())
        };
        "activity", Text, "", &activity,
            |row| row.header.codes.activities[usize::from(row.robot.state.activity)].clone();
        "delay", Text, "", &delay, |row| row.header.codes.delays[usize::from(row.robot.state.delay)].clone();
        "waits_for", Natural, "", "The robot that it waits for; empty for none.",
            |row| row.robot.state.waits_for;
        "condition", Text, "", &condition,
            |row| row.header.codes.conditions[usize::from(row.robot.state.condition)].clone();
        "x_m", Number, "m", "x of its centre.", |row| thousandth(row.robot.motion.position_mm[0]);
        "y_m", Number, "m", "y of its centre.", |row| thousandth(row.robot.motion.position_mm[1]);
        "vx_mps", Number, "m/s", "x of its velocity.", |row| thousandth(row.robot.motion.velocity_mm_s[0]);
        "vy_mps", Number, "m/s", "y of its velocity.", |row| thousandth(row.robot.motion.velocity_mm_s[1]);
        "energy_percent", Number, "%", "Its battery level.",
            |row| thousandth(row.robot.motion.energy_millipercent);
        "hp_percent", Number, "%", "Its health level.", |row| thousandth(row.robot.motion.hp_millipercent);
        "resources", Natural, "", "Rescuing resources that it has left.", |row| row.robot.state.resources;
        "on_board", Natural, "rescuees", "Rescuees that it has on board.", |row| row.robot.state.load;
    };
    columns.extend(of_needs(needs, |row: &RobotRow| &row.needs));
    columns
}

fn robot_rows<'a>(header: &'a Header, frame: &'a Frame, time_s: f64) -> impl Iterator<Item = RobotRow<'a>> {
    frame.robots.iter().enumerate().map(move |(id, robot)| {
        let needs = header.world.needs_of(id, robot);
        RobotRow { time_s, header, id, robot, needs }
    })
}

fn groups<'a>() -> Columns<GroupRow<'a>> {
    columns! { GroupRow:
        "time_s", Number, "s", TIME, |row| time(row.time_s);
        "task", Text, "", "Task of the group.", |row| row.task.name.clone();
        "is_at_work", Truth, "", "Whether the group has work to do.", |row| row.group.is_at_work;
        "members", Natural, "robots", "Members of the group.", |row| row.members;
        "waiting", Natural, "rescuees", "Rescuees of the task that wait, unclaimed.", |row| row.rescuees(0);
        "claimed", Natural, "rescuees", "Rescuees of the task that wait for a robot that has claimed them.",
            |row| row.rescuees(1);
        "on_board", Natural, "rescuees", "Rescuees of the task on board of a robot.", |row| row.rescuees(2);
        "delivered", Natural, "rescuees", "Rescuees of the task that were delivered.", |row| row.rescuees(3);
        "debris_known", Natural, "", "Pieces of debris that the group knows.", |row| row.group.debris.len();
        "zones_known", Natural, "", "Radiation zones that the group knows.", |row| row.group.zones.len();
    }
}

fn group_rows<'a>(header: &'a Header, frame: &'a Frame, time_s: f64) -> impl Iterator<Item = GroupRow<'a>> {
    header.world.tasks.iter().zip(&frame.groups).zip(0..).map(move |((task, group), number)| {
        let members = frame.robots.iter().filter(|robot| robot.state.task == Some(number)).count();
        let rescuees = &frame.rescuees[task.first_rescuee..task.first_rescuee + task.rescuees];
        GroupRow { time_s, task, group, members, rescuees }
    })
}

fn events<'a>() -> Columns<EventRow<'a>> {
    let robots = "Numbers of the robots that it is about, with blanks between them.";
    columns! { EventRow:
        "time_s", Number, "s", TIME, |row| time(row.event.time_s);
        "step", Natural, "steps", "The step at whose end it had happened.", |row| row.event.step;
        "event", Text, "", "Its kind; docs/events.md lists the kinds.", |row| row.event.event.clone();
        "robots", Text, "", robots,
            |row| row.event.robots().iter().map(u64::to_string).collect::<Vec<_>>().join(" ");
        "task", Text, "", "The task that it is about; empty for none.", |row| {
            let task = row.event.number("task").and_then(|task| row.header.world.tasks.get(task as usize));
            task.map(|task| task.name.clone())
        };
        "rescuee", Natural, "", "The rescuee that it is about; empty for none.",
            |row| row.event.number("rescuee");
        "words", Text, "", "It in a sentence.", |row| row.event.says.clone();
    }
}

fn decisions<'a>(needs: &[NeedFile]) -> Columns<DecisionRow<'a>> {
    let mut columns = columns! { DecisionRow:
        "time_s", Number, "s", TIME, |row| time(row.time_s);
        "round", Natural, "", "Number of the round, from 1.", |row| row.question.round;
        "robot", Natural, "", ROBOT, |row| row.member.id;
        "role", Text, "", ROLE, |row| row.question.roles[row.member.role.index()].clone();
        "task", Text, "", "Task to which it was assigned.",
            |row| row.question.tasks[row.task.index()].name.clone();
        "energy_percent", Number, "%", "Its battery level.", |row| Cell::short(row.member.level(ENERGY));
        "hp_percent", Number, "%", "Its health level.", |row| Cell::short(row.member.level(HP));
    };
    columns.extend(of_needs(needs, |row: &DecisionRow| row.member.needs.values()));
    columns
}

fn decision_rows(recording: &Recording) -> impl Iterator<Item = DecisionRow<'_>> {
    recording.decisions.iter().flat_map(move |decided| {
        let (question, time_s) = (&decided.question, decided.step as f64 * recording.header.dt_s);
        let groups = question.task_ids().zip(&decided.decision.assignment.groups);
        groups.flat_map(move |(task, group)| {
            let members = decided.team().iter().filter(move |member| group.contains(&member.id));
            members.map(move |member| DecisionRow { time_s, question, task, member })
        })
    })
}
