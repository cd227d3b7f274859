//! What robots notice: debris, radiation and wrecks within their sensing range, rescuees within their observing range. Ranges are discs that
//! shrink with health; nothing occludes. What one member notices, its whole group knows at once.

use serde::{Deserialize, Serialize};
use std::ops::Range;

use parry2d::math::Vector;
use rne_core::Difficulty;
use smallvec::SmallVec;

use crate::event::{Event, EventLog};
use crate::ids::RescueeId;
use crate::planning::Knowledge;
use crate::world::{RescueeState, Robot, World};

/// Robots look around once in this many steps (0.1 s at the usual step).
pub const SENSING_PERIOD_STEPS: u64 = 5;

/// Where the rescuees of a task are, to pass over those that are out of range.
#[derive(Serialize, Deserialize)]
pub struct RescueeBlock {
    task: Difficulty,
    ids: Range<usize>,
    min: Vector,
    max: Vector,
}

impl RescueeBlock {
    /// The blocks of both tasks.
    #[must_use]
    pub fn of(world: &World) -> Vec<Self> {
        Difficulty::ALL.into_iter().filter_map(|task| Self::of_task(world, task)).collect()
    }

    fn of_task(world: &World, task: Difficulty) -> Option<Self> {
        let of_task = || world.rescuees.iter().filter(|rescuee| rescuee.task == task);
        let first = of_task().next()?.id.index();
        let (min, max) = of_task().fold((Vector::INFINITY, Vector::NEG_INFINITY), |(min, max), r| {
            (min.min(r.position), max.max(r.position))
        });
        Some(Self { task, ids: first..first + of_task().count(), min, max })
    }

    /// The task.
    #[must_use]
    pub fn task(&self) -> Difficulty {
        self.task
    }

    /// Numbers of the rescuees.
    #[must_use]
    pub fn ids(&self) -> Range<usize> {
        self.ids.clone()
    }

    fn is_within(&self, range: f32, of: Vector) -> bool {
        (of - of.clamp(self.min, self.max)).length_squared() <= range * range
    }
}

/// Lets one robot look around, for the knowledge that it shares: for debris, zones, `wrecks` (robots that stand for good, by number) and
/// rescuees.
pub fn look_around(
    world: &World,
    (blocks, wrecks): (&[RescueeBlock], &[usize]),
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
    for (number, zone) in world.zones.iter().enumerate() {
        if !knowledge.zones[number] && (zone.center - robot.position).length() <= sensing + zone.radius {
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
    for block in blocks.iter().filter(|block| block.is_within(observing, robot.position)) {
        for id in block.ids.clone() {
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
