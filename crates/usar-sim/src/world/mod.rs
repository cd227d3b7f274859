//! What exists: robots, debris, radiation zones and rescuees.

mod debris;
mod places;
mod radiation;
mod rescuee;
mod robot;

pub use debris::{Debris, Outline, debris_outline};
pub use places::Places;
pub use radiation::RadiationZone;
pub use rescuee::{Rescuee, RescueeState, Rescuees, rescuee_positions};
pub use robot::{Condition, Robot, rest_slot, row_positions};

use crate::layout::Layout;
use crate::physics::Physics;
use crate::scenario::Scenario;
use serde::{Deserialize, Serialize};

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
    pub zones: Vec<RadiationZone>,
    /// Rescuees, by id.
    pub rescuees: Rescuees,
}

impl World {
    /// Everything at its initial place.
    #[must_use]
    pub fn build(scenario: &Scenario, layout: &Layout) -> Self {
        let robots: Vec<Robot> = layout.robots.iter().map(|start| Robot::new(scenario, start)).collect();
        let debris: Vec<Debris> = layout.debris.iter().map(Debris::new).collect();
        Self {
            physics: Physics::new(scenario, &robots, &layout.debris, &debris),
            robots,
            debris_places: debris.iter().map(Debris::bounds).collect(),
            debris,
            zones: layout.zones.iter().map(RadiationZone::new).collect(),
            rescuees: Rescuees::new(rescuee_positions(scenario)),
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

    /// Makes anew what a snapshot leaves out because it follows from the rest.
    pub(crate) fn restore(&mut self) {
        self.debris_places = self.debris.iter().map(Debris::bounds).collect();
    }
}
