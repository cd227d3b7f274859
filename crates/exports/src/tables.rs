//! Tidy tables of a recording: one row for each object at each time, one header, units in the names.
//! Undefined values are empty cells.

use std::io::Write;

use recording::{Frame, Names, Recording, ToldEvent, World};
use usar_sim::scenario::{Measure, NeedFile};

use crate::error::ExportError;
use crate::parquet::Kind;

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

impl Table {
    /// All tables.
    pub const ALL: [Self; 4] = [Self::Robots, Self::Groups, Self::Events, Self::Decisions];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Robots => "robots",
            Self::Groups => "groups",
            Self::Events => "events",
            Self::Decisions => "decisions",
        }
    }

    /// The names of its columns.
    #[must_use]
    pub fn columns(self, world: &World) -> Vec<String> {
        let first: &[&str] = match self {
            Self::Robots => &[
                "time_s",
                "robot",
                "role",
                "task",
                "activity",
                "delay",
                "waits_for",
                "condition",
                "x_m",
                "y_m",
                "vx_mps",
                "vy_mps",
                "energy_percent",
                "hp_percent",
                "resources",
                "on_board",
            ],
            Self::Groups => &[
                "time_s",
                "task",
                "is_at_work",
                "members",
                "waiting",
                "claimed",
                "on_board",
                "delivered",
                "debris_known",
                "zones_known",
            ],
            Self::Events => &["time_s", "step", "event", "robots", "task", "rescuee", "words"],
            Self::Decisions => &["time_s", "round", "robot", "role", "task", "energy_percent", "hp_percent"],
        };
        let mut columns: Vec<String> = first.iter().map(|name| (*name).to_owned()).collect();
        if matches!(self, Self::Robots | Self::Decisions) {
            columns.extend(world.needs.iter().map(need_column));
        }
        columns
    }

    /// The type of a column, by its name.
    #[must_use]
    pub fn kind(column: &str) -> Kind {
        match column {
            "robot" | "waits_for" | "resources" | "on_board" | "waiting" | "claimed" | "delivered"
            | "members" | "debris_known" | "zones_known" | "step" | "rescuee" | "round" => Kind::Natural,
            "is_at_work" => Kind::Truth,
            "role" | "task" | "activity" | "delay" | "condition" | "event" | "robots" | "words" => Kind::Text,
            _ => Kind::Number,
        }
    }

    /// Writes the table as CSV, with every `every`-th frame.
    ///
    /// # Errors
    /// The recording cannot be read, or the table cannot be written.
    pub fn write_csv<W: Write>(self, recording: &Recording, every: usize, out: W) -> Result<W, ExportError> {
        let mut writer = csv::Writer::from_writer(out);
        writer.write_record(self.columns(&recording.header.world))?;
        match self {
            Self::Robots | Self::Groups => {
                for number in (0..recording.frames()).step_by(every.max(1)) {
                    let frame = recording.frame(number)?;
                    let time_s = time(recording.header.time_s_of(number));
                    let rows = if self == Self::Robots { robot_rows } else { group_rows };
                    rows(recording, &frame, &time_s).iter().try_for_each(|row| writer.write_record(row))?;
                }
            }
            Self::Events => {
                events(recording).try_for_each(|event| writer.write_record(event_row(recording, &event)))?;
            }
            Self::Decisions => decision_rows(recording).try_for_each(|row| writer.write_record(row))?,
        }
        writer.into_inner().map_err(|error| ExportError::Write(error.into_error()))
    }
}

/// The events of a recording in words.
pub(crate) fn events(recording: &Recording) -> impl Iterator<Item = ToldEvent> + '_ {
    let header = &recording.header;
    let tasks: Vec<&str> = header.world.tasks.iter().map(|task| task.name.as_str()).collect();
    recording.events.iter().map(move |(step, event)| {
        let names = Names { tasks: &tasks, debris: &header.world.debris, zones: &header.world.zones };
        ToldEvent::new(*step, header.dt_s, event, names)
    })
}

/// A time in seconds, rounded to microseconds.
fn time(time_s: f64) -> String {
    ((time_s * 1e6).round() / 1e6).to_string()
}

fn need_column(need: &NeedFile) -> String {
    let unit = match need.measures {
        Measure::Speed => "_mps",
        Measure::Sensing | Measure::Observing => "_m",
        _ => "",
    };
    format!("need_{}{unit}", need.name)
}

fn thousandth(value: i32) -> String {
    (f64::from(value) / 1000.0).to_string()
}

fn or_nothing(value: Option<impl ToString>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

fn robot_rows(recording: &Recording, frame: &Frame, time_s: &str) -> Vec<Vec<String>> {
    let (world, codes) = (&recording.header.world, &recording.header.codes);
    let row = |(id, robot): (usize, &recording::RobotFrame)| {
        let (motion, state) = (&robot.motion, &robot.state);
        let task = state.task.and_then(|task| world.tasks.get(task as usize));
        let mut row = vec![time_s.to_owned(), id.to_string()];
        row.push(world.roles[world.robots[id].role].name.clone());
        row.push(or_nothing(task.map(|task| &task.name)));
        row.push(codes.activities[usize::from(state.activity)].clone());
        row.push(codes.delays[usize::from(state.delay)].clone());
        row.push(or_nothing(state.waits_for));
        row.push(codes.conditions[usize::from(state.condition)].clone());
        row.extend(motion.position_mm.map(thousandth));
        row.extend(motion.velocity_mm_s.map(thousandth));
        row.extend([motion.energy_millipercent, motion.hp_millipercent].map(thousandth));
        row.extend([state.resources, state.load].map(|count| count.to_string()));
        row.extend(world.needs_of(id, robot).iter().map(f64::to_string));
        row
    };
    frame.robots.iter().enumerate().map(row).collect()
}

fn group_rows(recording: &Recording, frame: &Frame, time_s: &str) -> Vec<Vec<String>> {
    let row = |(number, task): (usize, &recording::TaskPlace)| {
        let known = &frame.groups[number];
        let members = frame.robots.iter().filter(|robot| robot.state.task == Some(number as u32)).count();
        let own = &frame.rescuees[task.first_rescuee..task.first_rescuee + task.rescuees];
        let with = |state: u8| own.iter().filter(|rescuee| rescuee.state == state).count();
        let counts = [members, with(0), with(1), with(2), with(3), known.debris.len(), known.zones.len()];
        let mut row = vec![time_s.to_owned(), task.name.clone(), known.is_at_work.to_string()];
        row.extend(counts.map(|count| count.to_string()));
        row
    };
    recording.header.world.tasks.iter().enumerate().map(row).collect()
}

fn event_row(recording: &Recording, event: &ToldEvent) -> Vec<String> {
    let robots: Vec<String> = event.robots().iter().map(u64::to_string).collect();
    let task = event.number("task").and_then(|task| recording.header.world.tasks.get(task as usize));
    vec![
        time(event.time_s),
        event.step.to_string(),
        event.event.clone(),
        robots.join(" "),
        or_nothing(task.map(|task| &task.name)),
        or_nothing(event.number("rescuee")),
        event.says.clone(),
    ]
}

fn decision_rows(recording: &Recording) -> impl Iterator<Item = Vec<String>> + '_ {
    recording.decisions.iter().flat_map(move |decided| {
        let question = &decided.question;
        let groups = question.task_ids().zip(&decided.decision.assignment.groups);
        groups.flat_map(move |(task, group)| {
            let members = decided.team().iter().filter(move |member| group.contains(&member.id));
            members.map(move |member| {
                let mut row =
                    vec![time(decided.step as f64 * recording.header.dt_s), question.round.to_string()];
                row.push(member.id.to_string());
                row.push(question.roles[member.role.index()].clone());
                row.push(question.tasks[task.index()].name.clone());
                row.extend([or_nothing(member.energy_level), or_nothing(member.hp_level)]);
                row.extend(member.needs.values().iter().map(f64::to_string));
                row
            })
        })
    })
}
