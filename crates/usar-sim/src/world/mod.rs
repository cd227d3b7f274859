//! The world: robots, debris, radiation zones and rescuees.

mod debris;
mod effects;
mod rescuee;
mod robot;
mod zones;

use parry2d::bounding_volume::BoundingVolume;
use parry2d::math::{Pose, Vector};
use parry2d::query::distance;
use scenario::shapes::Places;
use serde::{Deserialize, Serialize};

pub(crate) use debris::AWAY;
pub use debris::Debris;
pub use rescuee::{Rescuee, RescueeState, Rescuees};
pub use robot::Robot;

use crate::ids::{RescueeId, RobotId};
use crate::model::Model;
use crate::physics::{DebrisBody, Physics, RobotBody};
use crate::robot::STANDING_MPS;
use zones::ZoneCounts;

/// Pieces with a smaller gap than this touch, in metres.
const TOUCH_M: f32 = 0.005;

/// The state of everything that is in the arena.
#[derive(Serialize, Deserialize)]
pub struct World {
    /// Rigid bodies.
    pub physics: Physics,
    /// Robots, by id.
    pub robots: Vec<Robot>,
    /// Debris.
    pub debris: Vec<Debris>,
    /// The debris by place. Follows from `debris`.
    #[serde(skip)]
    pub(crate) debris_places: Places,
    /// Whether a piece that can be pushed touches another, if that is known. Follows from `debris`.
    #[serde(skip)]
    touching: Option<bool>,
    /// How often each zone was switched on or off. A zone that is there from the start begins with 1. With an
    /// odd number, the zone is on. Empty in a scenario without a timeline: all zones are on.
    zone_switches: Vec<u8>,
    /// The step of each zone's last switch. Empty in a scenario without a timeline.
    zone_since: Vec<u64>,
    /// The zones in which each robot is. Follows from the other fields.
    #[serde(skip)]
    zone_counts: ZoneCounts,
    /// For each task, whether it has ended, or not begun. Empty in a scenario without a timeline.
    pub closed_tasks: Vec<bool>,
    /// Rescuees, by id.
    pub rescuees: Rescuees,
    /// The robots that are loading, and whom.
    pub(crate) loading: Vec<(RobotId, RescueeId)>,
}

impl World {
    /// A world with everything at its initial place.
    pub fn build(model: &Model) -> Self {
        let robots: Vec<Robot> = model.robots.iter().map(Robot::new).collect();
        let debris: Vec<Debris> = model.debris.iter().map(Debris::new).collect();
        let many = if model.timeline.is_empty() { 0 } else { usize::MAX };
        Self {
            physics: Physics::new(
                model.dt,
                model.arena,
                &robots.iter().map(robot_body).collect::<Vec<_>>(),
                &debris.iter().map(debris_body).collect::<Vec<_>>(),
            ),
            robots,
            debris_places: by_place(&debris),
            debris,
            touching: None,
            zone_switches: model.zones.iter().take(many).map(|zone| u8::from(!zone.is_later)).collect(),
            zone_counts: ZoneCounts::default(),
            zone_since: model.zones.iter().take(many).map(|_| 0).collect(),
            closed_tasks: model.tasks.iter().take(many).map(|task| task.begins_later).collect(),
            rescuees: Rescuees::new(&model.rescuees),
            loading: Vec::new(),
        }
    }

    /// Restores what follows from the other fields and the model, after those were read.
    pub(crate) fn restore(&mut self, model: &Model) {
        self.debris_places = by_place(&self.debris);
        let robots: Vec<RobotBody> = self.robots.iter().map(robot_body).collect();
        self.physics.restore(model.dt, model.arena, &robots);
    }

    /// Advances time by one step and reads back all positions. `step` is the number of steps done then.
    pub(crate) fn integrate(&mut self, step: u64) {
        let Self { physics, debris, debris_places, touching, .. } = self;
        let nearest = |at: Vector, reach: f32, counts: fn(&Debris) -> bool| {
            let near = debris_places.near(at, reach).into_iter().map(|number| &debris[number]);
            near.filter(|piece| counts(piece)).map(|piece| piece.distance_to(at)).fold(reach, f32::min)
        };
        let to_debris = |at: Vector, reach: f32| nearest(at, reach, |_| true);
        let to_pushable = |at: Vector, reach: f32| nearest(at, reach, |piece| piece.masses.is_some());
        physics.integrate(to_debris, to_pushable, |arena| {
            *touching.get_or_insert_with(|| any_touches(debris, debris_places, arena))
        });
        for robot in &mut self.robots {
            (robot.position, robot.velocity) = self.physics.robot_motion(robot.id);
            if !robot.is_able() && robot.wreck_at.is_none() && robot.velocity.length() < STANDING_MPS {
                robot.wreck_at = Some(robot.position);
            }
        }
        for (number, pose) in self.physics.debris_poses() {
            let piece = &mut self.debris[number];
            if piece.pose != pose {
                piece.moved_to(pose, step);
                self.touching = None;
                self.debris_places.put(number, piece.bounds());
            }
        }
    }

    /// Whether a radiation zone is on.
    pub fn is_on(&self, zone: usize) -> bool {
        self.switches_of(zone) % 2 == 1
    }

    /// The robots, each with the number of zones that are on at its place.
    pub(crate) fn robots_in_zones(&mut self, model: &Model) -> impl Iterator<Item = (&mut Robot, usize)> {
        let Self { robots, zone_switches, zone_counts, .. } = self;
        let is_on = |number: usize| zone_switches.get(number).is_none_or(|switches| switches % 2 == 1);
        let zones = model.zones.iter().enumerate().map(|(number, zone)| (&zone.disc, is_on(number)));
        zone_counts.update(robots, &zones);
        robots.iter_mut().zip(zone_counts.iter())
    }

    /// How often a radiation zone was switched on or off; 1 if it was always on.
    pub(crate) fn switches_of(&self, zone: usize) -> u8 {
        self.zone_switches.get(zone).copied().unwrap_or(1)
    }

    /// The step since which a radiation zone is as it is; none if it never was on.
    pub(crate) fn zone_since(&self, zone: usize) -> Option<u64> {
        (self.switches_of(zone) > 0).then(|| self.zone_since.get(zone).copied().unwrap_or(0))
    }

    /// The places of the debris, now and as they could be seen: a part of the hash chain.
    pub(crate) fn lying_debris(&self) -> impl Serialize + '_ {
        self.debris.iter().map(|piece| (&piece.pose, &piece.sightings)).collect::<Vec<_>>()
    }

    /// The steps since which debris and zones are as they are: a part of the hash chain.
    pub(crate) fn changes(&self) -> impl Serialize + '_ {
        (self.debris.iter().map(|piece| &piece.since).collect::<Vec<_>>(), &self.zone_since)
    }

    /// The part of the world that the timeline changes and no other part of the hash chain covers.
    pub(crate) fn changed_by_events(&self) -> impl Serialize + '_ {
        (&self.zone_switches, &self.closed_tasks, self.physics.gates())
    }

    /// Switches a radiation zone. Returns false if it is in this state already.
    pub(crate) fn switch_zone(&mut self, zone: usize, on: bool, step: u64) -> bool {
        let changes = self.is_on(zone) != on;
        if changes {
            self.zone_switches[zone] += 1;
            self.zone_counts.forget();
            self.zone_since[zone] = step;
        }
        changes
    }

    /// Puts a piece that events place or remove to a place, or away.
    pub(crate) fn put_debris(&mut self, number: usize, pose: Option<Pose>, step: u64) {
        let piece = &mut self.debris[number];
        piece.put(pose, step);
        self.physics.put_debris(number, piece.pose);
        self.touching = None;
        self.debris_places.put(number, piece.bounds());
    }
}

fn by_place(debris: &[Debris]) -> Places {
    debris.iter().map(Debris::bounds).collect()
}

/// Whether a piece that can be pushed touches another or the border of the arena.
fn any_touches(debris: &[Debris], places: &Places, arena: Vector) -> bool {
    let touches = |one: usize, other: usize| {
        let [a, b] = [one, other].map(|number| debris[number].outline());
        let apart = distance(&a.pose, &*a.shape, &b.pose, &*b.shape);
        one != other && apart.is_ok_and(|apart| apart.distance <= TOUCH_M)
    };
    let movable = (0..debris.len()).filter(|number| debris[*number].masses.is_some());
    movable.into_iter().any(|number| {
        let bounds = debris[number].bounds().loosened(TOUCH_M);
        let outside = bounds.mins.min_element() < 0.0 || (arena - bounds.maxs).min_element() < 0.0;
        let near = places.near(bounds.center(), bounds.half_extents().max_element());
        outside || near.into_iter().any(|other| touches(number, other))
    })
}

fn robot_body(robot: &Robot) -> RobotBody {
    RobotBody {
        position: robot.position,
        is_aerial: robot.is_aerial(),
        radius: robot.radius(),
        mass: robot.spec.mass,
        top_speed: robot.spec.top_speed,
    }
}

fn debris_body(piece: &Debris) -> DebrisBody {
    DebrisBody { outline: piece.outline(), is_gate: piece.is_gate(), masses: piece.masses }
}
