//! What the base knows of robots without a report: their bodies.

use teaming::{Body, Evidence};

use crate::model::{Model, RobotModel};
use crate::robot::{HP, RobotState};

/// What was heard, with what the base knows besides.
pub fn known(model: &Model, heard: Evidence) -> Evidence {
    Evidence { bodies: model.robots.iter().map(|robot| body(robot, model)).collect(), ..heard }
}

fn body(robot: &std::sync::Arc<RobotModel>, model: &Model) -> Body {
    Body {
        robot: robot.id.0,
        top_mps: robot.spec.speed_mps,
        slowed_by: HP,
        floor: robot.health_floor,
        carries: robot.can_carry(),
        guides: robot.spec.guides,
        needs: RobotState::new(robot).level_needs(&model.needs),
    }
}
