//! What exists: robots, debris, radiation zones and rescuees.

mod debris;
mod rescuee;
mod robot;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

pub use debris::Debris;
pub use rescuee::{Rescuee, RescueeState, Rescuees};
pub use robot::{Condition, Robot};

use crate::geometry::{Places, RadiationZone};
use crate::model::{Layout, Model};
use crate::physics::{DebrisBody, Physics, RobotBody};
use crate::scenario::{DebrisFile, ZoneFile};

/// A robot slower than this stands, in metres per second.
pub const STANDING_MPS: f32 = 0.05;

/// The state of everything that is in the arena.
#[derive(Serialize, Deserialize)]
pub struct World {
    /// Rigid bodies.
    pub physics: Physics,
    /// Robots, by id.
    pub robots: Vec<Robot>,
    /// Debris.
    pub debris: Vec<Debris>,
    /// Where the debris is.
    #[serde(skip)]
    pub debris_places: Places,
    /// Radiation zones.
    #[serde(skip)]
    pub zones: Vec<RadiationZone>,
    /// Rescuees, by id.
    pub rescuees: Rescuees,
}

impl World {
    /// Everything at its initial place.
    #[must_use]
    pub fn build(model: &Model) -> Self {
        let layout = &model.layout;
        let starts = model.robots.iter().zip(&layout.robots);
        let robots: Vec<Robot> = starts.map(|(model, start)| Robot::new(model, start)).collect();
        let debris: Vec<Debris> = layout.debris.iter().map(Debris::new).collect();
        let scenario = &model.scenario;
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
            rescuees: Rescuees::new(&model.rescuees),
        }
    }

    /// Moves time on by one step and reads back where everything is.
    pub fn integrate(&mut self) {
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
                piece.moved_to(pose);
                self.debris_places.put(number, piece.bounds());
            }
        }
    }

    /// Makes anew what a snapshot leaves out because it is fixed or follows from the rest.
    pub(crate) fn restore(&mut self, model: &Model) {
        self.robots.iter_mut().zip(&model.robots).for_each(|(robot, model)| robot.model = Arc::clone(model));
        self.debris.iter_mut().zip(&model.layout.debris).for_each(|(piece, file)| piece.restore(file));
        self.zones = zones(&model.layout);
        self.rescuees.restore(&model.rescuees);
        self.debris_places = self.debris.iter().map(Debris::bounds).collect();
    }
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
        mass: movable.map(|m| m.0),
        friction_mass: movable.map_or(0.0, |m| m.1),
    }
}
