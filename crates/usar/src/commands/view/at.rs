//! The state at one time of a recording, as JSON.

use std::io::Write;

use experiments::Failure;
use recording::{Frame, Recording};
use serde::Serialize;
use usar_sim::scenario::{Measure, NeedFile, RoleFile};
use usar_sim::vitals::health_factor;

use crate::commands::SCHEMA_VERSION;

#[derive(Serialize)]
struct Output<'a> {
    schema_version: u32,
    scenario: &'a str,
    policy: &'a str,
    seed: u64,
    frame: usize,
    time_s: f64,
    robots: Vec<Robot<'a>>,
    rescuees: Vec<(&'a str, usize)>,
    state: Frame,
}

/// A robot in words.
#[derive(Serialize)]
struct Robot<'a> {
    id: usize,
    role: &'a str,
    task: Option<&'a str>,
    activity: &'a str,
    delay: &'a str,
    energy: f64,
    hp: f64,
    needs: Vec<(&'a str, f64)>,
}

/// Prints one JSON object a line, for each recording.
pub(super) fn print(out: &mut dyn Write, recordings: &[Recording], time_s: f64) -> Result<(), Failure> {
    for recording in recordings {
        let number = recording.frame_at(time_s);
        let frame = recording.frame(number).map_err(Failure::input)?;
        writeln!(out, "{}", serde_json::to_string(&output(recording, number, frame)).map_err(Failure::run)?)?;
    }
    Ok(())
}

fn output(recording: &Recording, number: usize, frame: Frame) -> Output<'_> {
    let (header, world) = (&recording.header, &recording.header.world);
    let robots = frame.robots.iter().zip(&world.robots).enumerate().map(|(id, (robot, place))| {
        let role = place.body.as_ref().unwrap_or(&world.roles[place.role]);
        let levels = [robot.motion.energy_millipercent, robot.motion.hp_millipercent];
        let [energy, hp] = levels.map(|level| f64::from(level) / 1000.0);
        let value = |need: &NeedFile| {
            let factor = health_factor(hp, world.health_floor);
            let cargo = [robot.state.resources, role.capacity - robot.state.load.min(role.capacity)];
            measure(need, role, [energy, hp, factor], cargo)
        };
        Robot {
            id,
            role: &role.name,
            task: robot.state.task.and_then(|task| Some(world.tasks.get(task as usize)?.name.as_str())),
            activity: &header.codes.activities[usize::from(robot.state.activity)],
            delay: &header.codes.delays[usize::from(robot.state.delay)],
            energy,
            hp,
            needs: world.needs.iter().map(|need| (need.name.as_str(), value(need))).collect(),
        }
    });
    let count = |state: usize| {
        let rescuees = frame.rescuees.iter();
        rescuees.filter(|rescuee| usize::from(rescuee.state) == state).count()
    };
    let states = header.codes.rescuees.iter().enumerate();
    Output {
        schema_version: SCHEMA_VERSION,
        scenario: &header.scenario.name,
        policy: &header.policy,
        seed: header.seed,
        frame: number,
        time_s: header.time_s_of(number),
        robots: robots.collect(),
        rescuees: states.map(|(state, name)| (name.as_str(), count(state))).collect(),
        state: frame,
    }
}

/// A need of a robot with these levels, as far as they were recorded.
fn measure(
    need: &NeedFile,
    role: &RoleFile,
    [energy, hp, factor]: [f64; 3],
    [resources, room]: [u32; 2],
) -> f64 {
    match need.measures {
        Measure::Health => role.hp * hp / 100.0,
        Measure::Speed => role.speed_mps * factor,
        Measure::Sensing => role.sensing_m * factor,
        Measure::Energy => role.energy * energy / 100.0,
        Measure::Resources => f64::from(resources),
        Measure::Capacity => f64::from(room),
        Measure::Observing => role.observing_m * factor,
        Measure::Constant => role.constants.get(&need.name).copied().unwrap_or(0.0),
    }
}
