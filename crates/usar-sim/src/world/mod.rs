//! The world: robots, debris, radiation zones and rescuees.

mod debris;
mod effects;
mod rescuee;

use std::sync::Arc;

use parry2d::math::{Pose, Vector};
use serde::{Deserialize, Serialize};

pub use debris::Debris;
pub use rescuee::{Rescuee, RescueeState, Rescuees};

use crate::geometry::{Places, RadiationZone};
use crate::model::{Layout, Model};
use crate::physics::{DebrisBody, Physics, RobotBody};
use crate::robot::{Robot, STANDING_MPS};
use crate::scenario::{DebrisFile, ZoneFile};

/// The state of everything that is in the arena.
#[derive(Serialize, Deserialize)]
pub struct World {
    /// Rigid bodies.
    pub physics: Physics,
    /// Robots, by id.
    pub robots: Vec<Robot>,
    /// Debris.
    pub debris: Vec<Debris>,
    /// The debris by place.
    #[serde(skip)]
    pub debris_places: Places,
    /// Numbers of the debris that events place or remove.
    #[serde(skip)]
    pub gates: Vec<usize>,
    /// Radiation zones, including zones that are off.
    #[serde(skip)]
    pub zones: Vec<RadiationZone>,
    /// How often each zone was switched on or off. A zone that is there from the start begins with 1. With an
    /// odd number, the zone is on. Empty in a scenario without a timeline: all zones are on.
    zone_switches: Vec<u8>,
    /// The step of each zone's last switch. Empty in a scenario without a timeline.
    zone_since: Vec<u64>,
    /// For each task, whether it has ended, or not begun. Empty in a scenario without a timeline.
    pub closed_tasks: Vec<bool>,
    /// Rescuees, by id.
    pub rescuees: Rescuees,
}

impl World {
    /// A world with everything at its initial place.
    #[must_use]
    pub fn build(model: &Model) -> Self {
        let layout = &model.layout;
        let starts = model.robots.iter().zip(&layout.robots);
        let robots: Vec<Robot> = starts.map(|(model, start)| Robot::new(model, start)).collect();
        let debris: Vec<Debris> =
            layout.debris.iter().enumerate().map(|(i, file)| piece(layout, i, file)).collect();
        let scenario = &model.scenario;
        let many = if model.timeline.is_empty() { 0 } else { usize::MAX };
        Self {
            physics: Physics::new(
                scenario.dt_s as f32,
                scenario.arena_m.map(|size| size as f32),
                &robots.iter().map(robot_body).collect::<Vec<_>>(),
                &layout.debris.iter().zip(&debris).map(debris_body).collect::<Vec<_>>(),
            ),
            robots,
            debris_places: debris.iter().map(Debris::bounds).collect(),
            debris,
            zones: zones(layout),
            gates: layout.gates.keys().copied().collect(),
            zone_switches: (0..layout.zones.len())
                .take(many)
                .map(|i| u8::from(!layout.zones_later.contains(&i)))
                .collect(),
            zone_since: layout.zones.iter().take(many).map(|_| 0).collect(),
            closed_tasks: scenario.tasks.iter().take(many).map(|task| scenario.begins_later(task)).collect(),
            rescuees: Rescuees::new(&model.rescuees, &model.rescuees_later),
        }
    }

    /// Advances time by one step and reads back all positions. `step` is the number of steps done then.
    pub fn integrate(&mut self, step: u64) {
        self.physics.integrate();
        for robot in &mut self.robots {
            (robot.position, robot.velocity) = self.physics.robot_motion(robot.id);
            if !robot.is_able() && robot.wreck_at.is_none() && robot.velocity.length() < STANDING_MPS {
                robot.wreck_at = Some(robot.position);
            }
        }
        for (number, pose) in self.physics.debris_poses() {
            let piece = &mut self.debris[number];
            if piece.outline.pose != pose {
                piece.moved_to(pose, step);
                self.debris_places.put(number, piece.bounds());
            }
        }
    }

    /// The radiation zones that are on, with their numbers.
    pub fn zones_on(&self) -> impl Iterator<Item = (usize, &RadiationZone)> {
        self.zones.iter().enumerate().filter(|(number, _)| self.is_on(*number))
    }

    /// Whether a radiation zone is on.
    #[must_use]
    pub fn is_on(&self, zone: usize) -> bool {
        self.switches_of(zone) % 2 == 1
    }

    /// The robots, and a function that counts the zones that are on at a point.
    pub(crate) fn robots_in_zones(&mut self) -> (&mut [Robot], impl Fn(Vector) -> usize) {
        let Self { robots, zones, zone_switches, .. } = self;
        let is_on = |number: usize| zone_switches.get(number).is_none_or(|switches| switches % 2 == 1);
        let zones = &*zones;
        let count = move |at: Vector| {
            zones.iter().enumerate().filter(|(number, zone)| is_on(*number) && zone.contains(at)).count()
        };
        (robots, count)
    }

    /// How often a radiation zone was switched on or off; 1 if it was always on.
    #[must_use]
    pub fn switches_of(&self, zone: usize) -> u8 {
        self.zone_switches.get(zone).copied().unwrap_or(1)
    }

    /// The step since which a radiation zone is as it is; none if it never was on.
    #[must_use]
    pub fn zone_since(&self, zone: usize) -> Option<u64> {
        (self.switches_of(zone) > 0).then(|| self.zone_since.get(zone).copied().unwrap_or(0))
    }

    /// The outlines of the debris, now and as they could be seen: a part of the hash chain.
    pub(crate) fn lying_debris(&self) -> impl Serialize + '_ {
        self.debris.iter().map(|piece| (&piece.outline, &piece.sightings)).collect::<Vec<_>>()
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
            self.zone_since[zone] = step;
        }
        changes
    }

    /// Puts a piece that events place or remove to a place, or away.
    pub(crate) fn put_debris(&mut self, number: usize, pose: Option<Pose>, step: u64) {
        let piece = &mut self.debris[number];
        piece.put(pose, step);
        self.physics.put_debris(number, piece.outline.pose);
        self.debris_places.put(number, piece.bounds());
    }

    /// Restores everything that a snapshot leaves out because it is fixed or follows from the rest.
    pub(crate) fn restore(&mut self, model: &Model) {
        self.robots.iter_mut().zip(&model.robots).for_each(|(robot, model)| robot.model = Arc::clone(model));
        self.debris.iter_mut().zip(&model.layout.debris).for_each(|(piece, file)| piece.restore(file));
        model.layout.gates.keys().for_each(|number| self.debris[*number].is_gate = true);
        self.zones = zones(&model.layout);
        self.gates = model.layout.gates.keys().copied().collect();
        self.rescuees.restore(&model.rescuees);
        self.debris_places = self.debris.iter().map(Debris::bounds).collect();
    }
}

fn piece(layout: &Layout, number: usize, file: &DebrisFile) -> Debris {
    layout.gates.get(&number).map_or_else(|| Debris::new(file), |is_there| Debris::gate(file, *is_there))
}

fn zones(layout: &Layout) -> Vec<RadiationZone> {
    layout.zones.iter().map(ZoneFile::zone).collect()
}

fn robot_body(robot: &Robot) -> RobotBody {
    RobotBody {
        position: robot.position,
        is_aerial: robot.is_aerial(),
        radius: robot.radius(),
        mass: robot.spec.mass_kg as f32,
        top_speed: robot.spec.speed_mps as f32,
    }
}

fn debris_body<'d>((file, piece): (&DebrisFile, &'d Debris)) -> DebrisBody<'d> {
    let movable =
        file.movable.map(|movable| (movable.mass_kg as f32, (movable.friction * movable.mass_kg) as f32));
    DebrisBody {
        outline: &piece.outline,
        is_gate: piece.is_gate,
        mass: movable.map(|m| m.0),
        friction_mass: movable.map_or(0.0, |m| m.1),
    }
}
