//! Sensing: robots notice debris, radiation and wrecks within their sensing range, and rescuees within their
//! observing range. Ranges are discs that shrink with health; nothing occludes. A whole group knows at once
//! what one member notices.

use parry2d::math::Vector;
use smallvec::SmallVec;

use super::Knowledge;
use crate::event::{Event, EventLog};
use crate::ids::RescueeId;
use crate::model::TaskModel;
use crate::world::{RescueeState, Robot, World};

/// Robots look around once in this many steps (0.1 s at the usual step).
pub const SENSING_PERIOD_STEPS: u64 = 5;

/// Adds to the shared knowledge what one robot notices: debris, zones, rescuees and `wrecks` (numbers of
/// robots that have stopped for good).
pub fn look_around(
    world: &World,
    (tasks, wrecks): (&[TaskModel], &[usize]),
    robot: &Robot,
    knowledge: &mut Knowledge,
    log: &mut EventLog,
) {
    let sensing = robot.sensing_range() as f32;
    let is_news = |number: &usize| knowledge.debris[*number] < world.debris[*number].sightings.len() as u32;
    let mut near: SmallVec<[usize; 64]> =
        world.debris_places.near(robot.position, sensing).into_iter().filter(is_news).collect();
    near.sort_unstable();
    for number in near {
        if world.debris[number].outline.distance_to(robot.position) <= sensing {
            knowledge.learn_debris(world, number);
            log.push(Event::DebrisDiscovered { robot: robot.id, debris: number as u32 });
        }
    }
    for number in &world.gates {
        // A robot notices that a piece was taken away where the piece was seen last.
        let seen = knowledge.debris[*number] as usize;
        let sightings = &world.debris[*number].sightings;
        if seen > 0 && seen < sightings.len() && sightings[seen - 1].distance_to(robot.position) <= sensing {
            knowledge.learn_debris(world, *number);
            log.push(Event::DebrisDiscovered { robot: robot.id, debris: *number as u32 });
        }
    }
    for (number, zone) in world.zones.iter().enumerate() {
        if knowledge.zones[number] < world.switches_of(number)
            && (zone.center - robot.position).length() <= sensing + zone.radius
        {
            knowledge.learn_zone(world, number);
            log.push(Event::ZoneDiscovered { robot: robot.id, zone: number as u32 });
        }
    }
    let in_range = |at: Vector| (robot.position - at).length() <= sensing;
    for wreck in wrecks {
        if !knowledge.wrecks[*wreck] && world.robots[*wreck].wreck_at.is_some_and(in_range) {
            knowledge.learn_wreck(world, *wreck);
        }
    }
    let observing = robot.observing_range() as f32;
    for task in tasks.iter().filter(|task| is_near(task, observing, robot.position)) {
        for id in task.rescuees.clone() {
            let rescuee = &world.rescuees[id];
            if !knowledge.rescuees[id]
                && rescuee.state == RescueeState::Waiting
                && (rescuee.position - robot.position).length_squared() <= observing * observing
            {
                knowledge.rescuees[id] = true;
                log.push(Event::Sighted { robot: robot.id, rescuee: RescueeId(id as u32) });
            }
        }
    }
}

/// Whether a task may have rescuees within `range` metres of a point.
fn is_near(task: &TaskModel, range: f32, of: Vector) -> bool {
    let [min, max] = task.bounds;
    !task.rescuees.is_empty() && (of - of.clamp(min, max)).length_squared() <= range * range
}
