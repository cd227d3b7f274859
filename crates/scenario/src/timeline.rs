//! The timeline of a scenario: events, each at its time.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Checker, meant, shown};
use super::deceit::{self, Channel, Lie};
use super::file::{DebrisFile, DebrisShape, Point, ScenarioFile, TaskFile, ZoneFile};
use crate::limits;

/// Something that happens at its time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Moment {
    /// When, in seconds from the start.
    pub at_s: f64,
    /// What happens.
    pub event: Happening,
}

/// What happens at a time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Happening {
    /// A fixed piece of debris falls: `DebrisFalls(shape: Disc(1.5), at: (20, 30))`. It falls once no robot
    /// on the ground is below it.
    DebrisFalls {
        /// Its outline.
        shape: DebrisShape,
        /// Its centre (for a polygon: the origin of its points).
        at: Point,
        /// Rotation, in degrees anticlockwise.
        #[serde(default)]
        rotation_deg: f64,
        /// A name, so that a later event can clear it away.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
    },
    /// A door opens, or a fixed piece of debris is cleared away: `Opens("gate")`.
    Opens(String),
    /// A door closes, or a piece of debris that was cleared away is back: `Closes("gate")`. It closes once no
    /// robot is in it.
    Closes(String),
    /// A radiation source appears: `SourceAppears(at: (30, 30), radius_m: 4)`.
    SourceAppears {
        /// The source.
        at: Point,
        /// Radius, in metres.
        radius_m: f64,
        /// A name, so that a later event can end it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        name: Option<String>,
    },
    /// A radiation source that has a name dies: `SourceDies("leak")`.
    SourceDies(String),
    /// A robot breaks down for good: `RobotFails(3)`, the robot with this id.
    RobotFails(u32),
    /// A robot loses a part of its levels: `RobotLoses(robot: 3, energy: 30, hp: 10)`.
    RobotLoses {
        /// Id of the robot.
        robot: u32,
        /// Battery that it loses, in percent points.
        #[serde(default)]
        energy: f64,
        /// Health that it loses, in percent points.
        #[serde(default)]
        hp: f64,
    },
    /// A robot lies from now on: `RobotLies(robot: 3, lie: Exaggerate(by: 0.5), on: [Energy])`.
    RobotLies {
        /// Id of the robot.
        robot: u32,
        /// The lie.
        lie: Lie,
        /// What it is about.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        on: Vec<Channel>,
    },
    /// A robot tells no more lies: `RobotIsHonest(3)`.
    RobotIsHonest(u32),
    /// A robot goes at most this share of its speed from now on, and its gauge does not show it:
    /// `RobotSlows(robot: 3, factor: 0.5)`.
    RobotSlows {
        /// Id of the robot.
        robot: u32,
        /// The share, above 0; 1 for its full speed.
        factor: f64,
    },
    /// A robot spends so many times the energy from now on: `BatteryFades(robot: 3, factor: 1.5)`.
    BatteryFades {
        /// Id of the robot.
        robot: u32,
        /// The factor.
        factor: f64,
    },
    /// The radio of a robot breaks: it is no longer heard. `RobotDrops(3)`.
    RobotDrops(u32),
    /// Rescuees appear in a task's block, in a grid of their own:
    /// `RescueesAppear(task: "north", grid: (4, 2))`.
    RescueesAppear {
        /// Name of the task.
        task: String,
        /// Rescuees along the width and along the height.
        grid: [u32; 2],
    },
    /// A task begins: `TaskBegins("north")`. Before, it has no rescuees and is given no robots. If it has
    /// ended, it is open again, but its own rescuees do not appear a second time.
    TaskBegins(String),
    /// A task ends: `TaskEnds("north")`. Rescuees that still wait are gone, and it is given no more robots.
    TaskEnds(String),
}

impl Happening {
    /// The piece of debris that falls in this event, if one falls.
    pub fn falling(&self) -> Option<DebrisFile> {
        let Self::DebrisFalls { shape, at, rotation_deg, name } = self else { return None };
        let (shape, name) = (shape.clone(), name.clone());
        Some(DebrisFile { shape, at: *at, rotation_deg: *rotation_deg, movable: None, name })
    }

    /// The radiation source that appears in this event, if one appears.
    pub fn source(&self) -> Option<ZoneFile> {
        let Self::SourceAppears { at, radius_m, name } = self else { return None };
        Some(ZoneFile { at: *at, radius_m: *radius_m, name: name.clone() })
    }
}

impl ScenarioFile {
    /// The panels of doors that are closed or have a name, and whether each is closed at the start.
    pub fn panels(&self) -> impl Iterator<Item = (DebrisFile, bool)> + '_ {
        self.walls.iter().flat_map(|wall| {
            let moving = wall.doors.iter().filter(|door| door.is_closed || door.name.is_some());
            moving.map(|door| (wall.panel(door), door.is_closed))
        })
    }

    /// The moments in the order of their times. Moments of equal times keep the order of the file.
    pub fn moments(&self) -> Vec<(usize, &Moment)> {
        let mut moments: Vec<(usize, &Moment)> = self.timeline.iter().enumerate().collect();
        moments.sort_by(|a, b| a.1.at_s.total_cmp(&b.1.at_s));
        moments
    }

    /// Whether a task begins with an event of the timeline.
    pub fn begins_later(&self, task: &TaskFile) -> bool {
        let first = self.moments().into_iter().find_map(|(_, moment)| match &moment.event {
            Happening::TaskBegins(name) if *name == task.name => Some(true),
            Happening::TaskEnds(name) if *name == task.name => Some(false),
            _ => None,
        });
        first == Some(true)
    }

    /// The named things that can open and close: pieces of debris and doors.
    fn ways(&self) -> Vec<Named<'_>> {
        let mut ways = Vec::new();
        for (i, piece) in self.debris.iter().enumerate() {
            let is_fixed = piece.movable.is_none();
            ways.extend(Named::new(format!("debris[{i}].name"), piece.name.as_deref(), is_fixed));
        }
        for (i, wall) in self.walls.iter().enumerate() {
            for (k, door) in wall.doors.iter().enumerate() {
                ways.extend(Named::new(format!("walls[{i}].doors[{k}].name"), door.name.as_deref(), true));
            }
        }
        for (i, moment) in self.timeline.iter().enumerate() {
            if let Happening::DebrisFalls { name, .. } = &moment.event {
                ways.extend(Named::new(format!("timeline[{i}].event.name"), name.as_deref(), true));
            }
        }
        ways
    }

    /// Radiation sources that have a name.
    fn sources(&self) -> Vec<Named<'_>> {
        let mut sources = Vec::new();
        for (i, zone) in self.radiation.iter().enumerate() {
            sources.extend(Named::new(format!("radiation[{i}].name"), zone.name.as_deref(), true));
        }
        for (i, moment) in self.timeline.iter().enumerate() {
            if let Happening::SourceAppears { name, .. } = &moment.event {
                sources.extend(Named::new(format!("timeline[{i}].event.name"), name.as_deref(), true));
            }
        }
        sources
    }
}

/// A thing with a name that events use.
struct Named<'f> {
    /// Where the name stands.
    field: String,
    name: &'f str,
    /// Whether nothing can push it.
    is_fixed: bool,
}

impl<'f> Named<'f> {
    fn new(field: String, name: Option<&'f str>, is_fixed: bool) -> Option<Self> {
        Some(Self { field, name: name?, is_fixed })
    }
}

/// Checks the rules of the timeline and of the names that it uses.
pub(super) fn timeline(check: &mut Checker, file: &ScenarioFile) {
    let ways = file.ways();
    let names: Vec<&str> = ways.iter().map(|way| way.name).collect();
    let sources = file.sources();
    let source_names: Vec<&str> = sources.iter().map(|source| source.name).collect();
    unique(check, &ways);
    unique(check, &sources);
    for (i, moment) in file.timeline.iter().enumerate() {
        let field = format!("timeline[{i}].event");
        match &moment.event {
            Happening::DebrisFalls { .. } => {}
            Happening::Opens(name) | Happening::Closes(name) => {
                let rule = "must name a door or a piece of debris that has a name";
                named(check, &field, name, &names, rule);
                if ways.iter().any(|way| way.name == name && !way.is_fixed) {
                    check.fail(&field, "must name fixed debris", format!("{name:?}, which can be pushed"));
                }
            }
            Happening::SourceAppears { at, .. } => check.inside(format!("{field}.at"), *at, 0.0),
            Happening::SourceDies(name) => {
                let rule = "must name a radiation source that has a name";
                named(check, &field, name, &source_names, rule);
            }
            Happening::RobotFails(robot) | Happening::RobotIsHonest(robot) | Happening::RobotDrops(robot) => {
                self::robot(check, &field, *robot, file);
            }
            Happening::RobotLies { robot, lie, on } => {
                self::robot(check, &format!("{field}.robot"), *robot, file);
                deceit::told(check, &field, lie, on, file);
            }
            Happening::RobotSlows { robot, .. }
            | Happening::BatteryFades { robot, .. }
            | Happening::RobotLoses { robot, .. } => {
                self::robot(check, &format!("{field}.robot"), *robot, file);
            }
            Happening::RescueesAppear { task, .. } => {
                self::task(check, &format!("{field}.task"), task, file);
            }
            Happening::TaskBegins(name) | Happening::TaskEnds(name) => self::task(check, &field, name, file),
        }
    }
    let goes_on = |task: &TaskFile| {
        file.timeline.iter().all(|moment| match &moment.event {
            Happening::TaskBegins(name) | Happening::TaskEnds(name) => *name != task.name,
            _ => true,
        })
    };
    if !file.tasks.is_empty() && !file.timeline.is_empty() && !file.tasks.iter().any(goes_on) {
        check.fail("timeline", "must leave one task that neither begins nor ends", "all tasks");
    }
}

fn unique(check: &mut Checker, all: &[Named]) {
    let mut sorted: Vec<&Named> = all.iter().collect();
    sorted.sort_by_key(|named| named.name);
    for Named { field, name, .. } in &sorted {
        if !limits::NAME_BYTES.allows(name.len()) || name.chars().any(char::is_control) {
            check.fail(field, "must be text of 1 to 64 bytes without line breaks", shown(name));
        }
    }
    for pair in sorted.windows(2).filter(|pair| pair[0].name == pair[1].name) {
        let rule = format!("must not be the name of {} too", pair[0].field.trim_end_matches(".name"));
        check.fail(&pair[1].field, rule, shown(pair[1].name));
    }
}

fn named(check: &mut Checker, field: &str, name: &str, known: &[&str], rule: &str) {
    if !known.contains(&name) {
        let there =
            if known.is_empty() { "; there is none".to_owned() } else { format!(" ({})", known.join(", ")) };
        let hint = meant(name, known.iter().copied());
        check.fail_with(field, format!("{rule}{there}"), hint, shown(name));
    }
}

fn robot(check: &mut Checker, field: &str, robot: u32, file: &ScenarioFile) {
    let robots: u32 = file.team.iter().map(|row| row.count).sum();
    if robot >= robots {
        check.fail(field, format!("must be the id of one of the {robots} robots, from 0"), robot);
    }
}

fn task(check: &mut Checker, field: &str, name: &str, file: &ScenarioFile) {
    let known: Vec<&str> = file.tasks.iter().map(|task| task.name.as_str()).collect();
    if file.errands.is_empty() {
        named(check, field, name, &known, "must name a task");
    } else {
        check.fail(field, "must be absent where there are errands: there are no tasks to do", shown(name));
    }
}
