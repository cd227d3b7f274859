//! The state at one time of a recording, as JSON.

use experiments::Failure;
use recording::{Frame, Recording};
use serde::Serialize;

use crate::prelude::*;

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

/// A robot, with names instead of numbers.
#[derive(Serialize)]
struct Robot<'a> {
    id: usize,
    role: &'a str,
    task: Option<&'a str>,
    x_m: f64,
    y_m: f64,
    activity: &'a str,
    delay: &'a str,
    energy: f64,
    hp: f64,
    needs: Vec<(&'a str, f64)>,
}

/// Prints the state of each recording as a JSON object on its own line.
pub(super) fn print(recordings: &[Recording], time_s: f64) -> Result<Report, Failure> {
    for recording in recordings {
        let number = recording.frame_at(time_s);
        let frame = recording.frame(number).map_err(Failure::input)?;
        Report::document(&output(recording, number, frame))?.print()?;
    }
    Ok(Report::default())
}

fn output(recording: &Recording, number: usize, frame: Frame) -> Output<'_> {
    let (header, world) = (&recording.header, &recording.header.world);
    let robots = frame.robots.iter().enumerate().map(|(id, robot)| {
        let role = world.body_of(id);
        let levels = [robot.motion.energy_millipercent, robot.motion.hp_millipercent];
        let [energy, hp] = levels.map(|level| f64::from(level) / 1000.0);
        let [x_m, y_m] = robot.motion.position_mm.map(|mm| f64::from(mm) / 1000.0);
        let needs = world.needs.iter().map(|need| need.name.as_str()).zip(world.needs_of(id, robot));
        Robot {
            id,
            role: &role.name,
            task: robot.state.task.and_then(|task| Some(world.tasks.get(task as usize)?.name.as_str())),
            x_m,
            y_m,
            activity: &header.codes.activities[usize::from(robot.state.activity)],
            delay: &header.codes.delays[usize::from(robot.state.delay)],
            energy,
            hp,
            needs: needs.collect(),
        }
    });
    let count = |state: usize| {
        let rescuees = frame.rescuees.iter();
        rescuees.filter(|rescuee| usize::from(rescuee.state) == state).count()
    };
    let states = header.codes.rescuees.iter().enumerate();
    Output {
        schema_version: 1,
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
