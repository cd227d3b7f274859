//! A recording as an MCAP log (<https://mcap.dev>) for Foxglove, Lichtblick and Rerun: Foxglove's messages in
//! Protobuf, and messages of our own in JSON.
//!
//! | topic | message | when |
//! | --- | --- | --- |
//! | `/world` | foxglove.SceneUpdate | at the start: floor, walls, names of the places |
//! | `/debris` | foxglove.SceneUpdate | debris, where it changes |
//! | `/radiation` | foxglove.SceneUpdate | radiation zones, where they change |
//! | `/robots` | foxglove.SceneUpdate | where groups change: a cylinder each, in the frame `robot/ID` |
//! | `/tf` | foxglove.FrameTransforms | each frame: `world` to `robot/ID` |
//! | `/positions` | foxglove.PointCloud | each frame: robots as points, in the colours of their groups |
//! | `/rescuees` | foxglove.PointCloud | where they change: places with a `state`, 0 to 3 |
//! | `/robot/ID` | usar.Robot | each frame: levels, needs, activity |
//! | `/team` | usar.Team | each frame: the round, rescuees by state |
//! | `/events` | foxglove.Log | each event |
//!
//! The states of a rescuee are 0 waiting, 1 claimed, 2 on board, 3 delivered.

mod messages;
mod scene;
mod writer;

use std::io::Write;

use foxglove::messages::{FrameTransform, FrameTransforms, Log, Timestamp, log};
use recording::{Frame, Recording};
use serde_json::{Map, Value, json};

use self::messages::{WORLD, timestamp, turned, vector};
use self::scene::{debris_scene, positions, radiation_scene, rescuees, robots_scene, world_scene};
use self::writer::{Channel, Channels};
use crate::error::ExportError;

/// Names of events that are warnings.
const WARNINGS: [&str; 7] =
    ["stranded", "disabled", "deadlocked", "unreachable", "cut_off", "mission_over", "standstill"];

/// Writes a recording as an MCAP log, with every `every`-th frame.
///
/// # Errors
/// The recording cannot be read, or the log cannot be written.
pub fn write<W: Write>(recording: &Recording, every: usize, out: W) -> Result<W, ExportError> {
    let mut channels = Channels::begin(out, recording)?;
    if recording.frames() > 0 {
        let first = recording.frame(0)?;
        for (id, robot) in first.robots.iter().enumerate() {
            let message = robot_message(recording, id, robot);
            channels.add_json(Channel::Robot(id), &format!("/robot/{id}"), "usar.Robot", &message)?;
        }
        channels.add_json(Channel::Team, "/team", "usar.Team", &team_message(recording, &first))?;
    }
    let mut told = recording.told().peekable();
    let mut before: Option<Frame> = None;
    for number in (0..recording.frames()).step_by(every.max(1)) {
        let (frame, time_s) = (recording.frame(number)?, recording.header.time_s_of(number));
        while let Some(event) = told.next_if(|event| event.time_s <= time_s + 1e-9) {
            write_event(&mut channels, &event)?;
        }
        write_frame(&mut channels, recording, &frame, time_s, before.as_ref())?;
        before = Some(frame);
    }
    told.try_for_each(|event| write_event(&mut channels, &event))?;
    channels.finish()
}

fn write_event<W: Write>(
    channels: &mut Channels<W>,
    event: &recording::ToldEvent,
) -> Result<(), ExportError> {
    let is_warning = WARNINGS.contains(&event.event.as_str());
    let level = if is_warning { log::Level::Warning } else { log::Level::Info };
    let log = Log {
        timestamp: Some(timestamp(event.time_s)),
        level: level.into(),
        message: event.says.clone(),
        name: event.event.clone(),
        ..Log::default()
    };
    channels.write(Channel::Events, event.time_s, &log)
}

fn write_frame<W: Write>(
    channels: &mut Channels<W>,
    recording: &Recording,
    frame: &Frame,
    time_s: f64,
    before: Option<&Frame>,
) -> Result<(), ExportError> {
    let (world, time) = (&recording.header.world, timestamp(time_s));
    if before.is_none() {
        channels.write(Channel::World, time_s, &world_scene(world, time))?;
    }
    let tasks = |frame: &Frame| frame.robots.iter().map(|robot| robot.state.task).collect::<Vec<_>>();
    if before.is_none_or(|before| tasks(before) != tasks(frame)) {
        channels.write(Channel::Robots, time_s, &robots_scene(world, frame, time))?;
    }
    if let Some(scene) = debris_scene(world, frame, before, time) {
        channels.write(Channel::Debris, time_s, &scene)?;
    }
    let (on, were_on) =
        (recording.zones_on(frame.step), before.map(|before| recording.zones_on(before.step)));
    if let Some(scene) = radiation_scene(world, &on, were_on.as_deref(), time) {
        channels.write(Channel::Radiation, time_s, &scene)?;
    }
    if !world.rescuees.is_empty() && before.is_none_or(|before| before.rescuees != frame.rescuees) {
        channels.write(Channel::Rescuees, time_s, &rescuees(world, frame, time))?;
    }
    channels.write(Channel::Transforms, time_s, &transforms(frame, time))?;
    channels.write(Channel::Positions, time_s, &positions(world, frame, time))?;
    for (id, robot) in frame.robots.iter().enumerate() {
        channels.write_json(Channel::Robot(id), time_s, &robot_message(recording, id, robot))?;
    }
    channels.write_json(Channel::Team, time_s, &team_message(recording, frame))
}

fn transforms(frame: &Frame, time: Timestamp) -> FrameTransforms {
    let transform = |(id, robot): (usize, &recording::RobotFrame)| {
        let [x, y] = robot.motion.position_mm.map(|mm| f64::from(mm) / 1000.0);
        FrameTransform {
            timestamp: Some(time),
            parent_frame_id: WORLD.to_owned(),
            child_frame_id: format!("robot/{id}"),
            translation: Some(vector([x, y, 0.0])),
            rotation: Some(turned(0.0)),
        }
    };
    FrameTransforms { transforms: frame.robots.iter().enumerate().map(transform).collect() }
}

/// The message with the levels, needs and activity of a robot.
fn robot_message(recording: &Recording, id: usize, robot: &recording::RobotFrame) -> Value {
    let (world, codes) = (&recording.header.world, &recording.header.codes);
    let (motion, state) = (&robot.motion, &robot.state);
    let [vx, vy] = motion.velocity_mm_s.map(|speed| f64::from(speed) / 1000.0);
    let needs: Map<String, Value> = world
        .needs
        .iter()
        .zip(world.needs_of(id, robot))
        .map(|(need, value)| (need.name.clone(), json!(value)))
        .collect();
    let task = state.task.and_then(|task| world.tasks.get(task as usize));
    json!({
        "energy_percent": f64::from(motion.energy_millipercent) / 1000.0,
        "hp_percent": f64::from(motion.hp_millipercent) / 1000.0,
        "speed_mps": (vx.hypot(vy) * 1000.0).round() / 1000.0,
        "resources": state.resources,
        "on_board": state.load,
        "activity": codes.activities[usize::from(state.activity)],
        "delay": codes.delays[usize::from(state.delay)],
        "waits_for": state.waits_for.map_or(-1, i64::from),
        "task": task.map_or("", |task| task.name.as_str()),
        "needs": needs,
    })
}

/// The message with the round, and the number of rescuees in each state.
fn team_message(recording: &Recording, frame: &Frame) -> Value {
    let with = |state: u8| frame.rescuees.iter().filter(|rescuee| rescuee.state == state).count();
    let round = recording.decisions.iter().filter(|decided| decided.step <= frame.step).count();
    json!({
        "round": round,
        "waiting": with(0),
        "claimed": with(1),
        "on_board": with(2),
        "delivered": with(3),
    })
}
