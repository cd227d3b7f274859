//! The header: what is recorded, and everything that stays the same.

use scenario::{DebrisFile, NeedFile, Point, RoleFile, Words, ZoneFile};
use serde::{Deserialize, Serialize};
use usar_sim::conflict::DelayCause;
use usar_sim::simulation::Simulation;
use xxhash_rust::xxh3::xxh3_128;

use crate::frame::{ACTIVITIES, CONDITIONS, Motion, RESCUEE_STATES, Stored};
use crate::rows::STREAMS;

/// Version of the format.
pub const VERSION: u32 = 1;

/// The header: what is recorded, and everything that stays the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Version of the format: [`VERSION`].
    pub version: u32,
    /// The program that wrote the recording.
    pub program: String,
    /// Number of its bits: see [`usar_sim::BITS`]; 0 in recordings of programs without one.
    #[serde(default)]
    pub bits: u32,
    /// The scenario.
    pub scenario: ScenarioText,
    /// Label of the policy.
    pub policy: String,
    /// Seed of the trial. It is a string in the file, because not every JSON reader has whole numbers of 64
    /// bits.
    #[serde(with = "as_text")]
    pub seed: u64,
    /// Length of a step, in seconds.
    pub dt_s: f64,
    /// Latest simulated time at which the trial ends, in seconds.
    pub duration_s: f64,
    /// Number of steps done before the recording began.
    pub first_step: u64,
    /// Number of steps between two frames.
    pub steps_per_frame: u64,
    /// Number of frames in a segment; the last segment may have fewer.
    pub frames_per_segment: usize,
    /// Names of each robot's numbers in every frame.
    pub motion_fields: Vec<String>,
    /// Names of the streams whose rows are stored only when they change, in order, with their numbers of
    /// rows.
    pub streams: Vec<(String, usize)>,
    /// Names for the numbers of states.
    pub codes: Codes,
    /// The part of the world that stays the same.
    pub world: World,
}

/// The scenario of a trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScenarioText {
    /// Its name.
    pub name: String,
    /// Purpose of the scenario.
    pub description: String,
    /// The whole scenario with every value, in RON.
    pub resolved: String,
    /// XXH3-128 of `resolved`, in hexadecimal digits.
    pub xxh3_128: String,
}

/// Names of states; a state's number is its place in the list.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Codes {
    /// Names of activities of robots.
    pub activities: Vec<String>,
    /// Names of delay causes of robots.
    pub delays: Vec<String>,
    /// Names of conditions of robots.
    pub conditions: Vec<String>,
    /// Names of states of rescuees.
    pub rescuees: Vec<String>,
}

/// The part of the world that stays the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct World {
    /// Width and height of the arena, in metres.
    pub arena_m: Point,
    /// The roles.
    pub roles: Vec<RoleFile>,
    /// The needs that robots report.
    pub needs: Vec<NeedFile>,
    /// Factor on speed and ranges at 0 % health.
    pub health_floor: f64,
    /// The tasks.
    pub tasks: Vec<TaskPlace>,
    /// The robots, by id.
    pub robots: Vec<RobotPlace>,
    /// Places of the rescuees, in metres: task by task, in the order of the table of tasks.
    pub rescuees: Vec<Point>,
    /// The debris of the scenario and the sampled debris, as it lies at the start.
    pub debris: Vec<DebrisFile>,
    /// The radiation zones of the scenario and the sampled zones.
    pub zones: Vec<ZoneFile>,
    /// Numbers of the pieces of debris that appear after the start.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub debris_later: Vec<usize>,
    /// Numbers of the radiation zones that appear after the start.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub zones_later: Vec<usize>,
    /// Numbers of the rescuees that appear after the start.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rescuees_later: Vec<usize>,
    /// What the scenario calls its things.
    #[serde(default)]
    pub words: Words,
}

/// A task's place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TaskPlace {
    /// Its name.
    pub name: String,
    /// Its rank: the harder the task, the higher.
    pub difficulty: u32,
    /// Centre of its block of rescuees, in metres.
    pub center: Point,
    /// Width and height of the block, in metres.
    pub size_m: Point,
    /// Centre of its rest place, in metres.
    pub rest: Point,
    /// Number of its first rescuee.
    pub first_rescuee: usize,
    /// Number of its rescuees.
    pub rescuees: usize,
}

/// The part of a robot that stays the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RobotPlace {
    /// Index of its role in the table of roles.
    pub role: usize,
    /// Its place at home, in metres.
    pub home: Point,
    /// Its place at the rest place of each task, in metres.
    pub rest: Vec<Point>,
    /// Its properties, if they differ from its role's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<RoleFile>,
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// Serializes a whole number as a string.
mod as_text {
    use serde::{Deserialize, Deserializer, Serializer, de};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
    pub(super) fn serialize<S: Serializer>(number: &u64, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(number)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<u64, D::Error> {
        String::deserialize(from)?.parse().map_err(de::Error::custom)
    }
}

/// Number of rescuee states in recordings made before rescuees could be absent.
const FORMER_RESCUEE_STATES: usize = 4;

impl Codes {
    /// Whether the numbers of states have the same meaning in this version.
    pub(crate) fn are_known(&self) -> bool {
        let mut known = Self::of_this_version();
        if self.rescuees.len() == FORMER_RESCUEE_STATES {
            known.rescuees.truncate(FORMER_RESCUEE_STATES);
        }
        *self == known
    }

    pub(crate) fn of_this_version() -> Self {
        Self {
            activities: names(&ACTIVITIES),
            delays: DelayCause::ALL.iter().map(|cause| cause.name().to_owned()).collect(),
            conditions: names(&CONDITIONS),
            rescuees: names(&RESCUEE_STATES),
        }
    }
}

impl Header {
    /// The header of a recording that begins now.
    pub(crate) fn of(
        simulation: &Simulation,
        policy: &str,
        steps_per_frame: u64,
        frames_per_segment: usize,
    ) -> Self {
        let scenario = simulation.scenario();
        let resolved = simulation.given().resolved();
        let world = World::of(simulation);
        let rows = world.rows();
        Self {
            version: VERSION,
            program: format!("usar {}", env!("CARGO_PKG_VERSION")),
            bits: usar_sim::BITS,
            scenario: ScenarioText {
                name: scenario.name.clone(),
                description: scenario.description.clone(),
                xxh3_128: format!("{:032x}", xxh3_128(resolved.as_bytes())),
                resolved,
            },
            policy: policy.to_owned(),
            seed: simulation.seed(),
            dt_s: scenario.dt_s,
            duration_s: scenario.duration_s,
            first_step: simulation.steps(),
            steps_per_frame,
            frames_per_segment,
            motion_fields: names(Motion::NAMES),
            streams: STREAMS.iter().map(|name| (*name).to_owned()).zip(rows).collect(),
            codes: Codes::of_this_version(),
            world,
        }
    }

    /// The step of a frame.
    pub fn step_of(&self, frame: usize) -> u64 {
        self.first_step + frame as u64 * self.steps_per_frame
    }

    /// The simulated time of a frame, in seconds.
    pub fn time_s_of(&self, frame: usize) -> f64 {
        self.step_of(frame) as f64 * self.dt_s
    }
}

impl World {
    /// The properties of a robot: its own body, or that of its role.
    ///
    /// # Panics
    /// There is no such robot.
    pub fn body_of(&self, robot: usize) -> &RoleFile {
        let RobotPlace { role, body, .. } = &self.robots[robot];
        body.as_ref().unwrap_or(&self.roles[*role])
    }

    /// The world of a trial.
    pub fn of(simulation: &Simulation) -> Self {
        let (model, scenario, layout) = (simulation.model(), simulation.scenario(), simulation.layout());
        let task = |(task, model): (&scenario::TaskFile, &usar_sim::model::TaskModel)| TaskPlace {
            name: task.name.clone(),
            difficulty: task.difficulty,
            center: task.center,
            size_m: task.size_m,
            rest: task.rest,
            first_rescuee: model.rescuees.start,
            rescuees: model.rescuees.len(),
        };
        let metres = |x: f32, y: f32| [x, y].map(|value| (f64::from(value) * 1000.0).round() / 1000.0);
        let bodies = scenario.bodies().flat_map(|(body, count)| std::iter::repeat_n(body, count as usize));
        let robots = model.robots.iter().zip(bodies).map(|(robot, body)| RobotPlace {
            role: robot.role.index(),
            home: metres(robot.home.x, robot.home.y),
            rest: robot.rest.iter().map(|at| metres(at.x, at.y)).collect(),
            body: (body != scenario.roles[robot.role.index()]).then_some(body),
        });
        let absent = layout.gates.iter().filter(|(_, is_there)| !**is_there);
        let later = model.rescuees.iter().filter(|rescuee| rescuee.is_later);
        Self {
            arena_m: scenario.arena_m,
            roles: scenario.roles.clone(),
            needs: scenario.needs.clone(),
            health_floor: scenario.mission.health_floor,
            tasks: scenario.tasks.iter().zip(&model.tasks).map(task).collect(),
            robots: robots.collect(),
            rescuees: model
                .rescuees
                .iter()
                .map(|rescuee| metres(rescuee.position.x, rescuee.position.y))
                .collect(),
            debris: layout.debris.clone(),
            zones: layout.zones.clone(),
            debris_later: absent.map(|(number, _)| *number).collect(),
            zones_later: layout.zones_later.iter().copied().collect(),
            rescuees_later: later.map(|rescuee| rescuee.id.index()).collect(),
            words: scenario.words.clone(),
        }
    }

    /// Numbers of rows of the streams, in their order.
    pub(crate) fn rows(&self) -> [usize; STREAMS.len()] {
        let robots = self.robots.len();
        // The groups of the tasks, then the team at home; one row for all conflict sets.
        [robots, robots, self.rescuees.len(), self.debris.len(), self.tasks.len() + 1, 1]
    }
}
