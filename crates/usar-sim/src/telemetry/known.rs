//! What the base knows of robots without a report: their bodies, and what it expects of their levels.

use scenario::RestFills;
use teaming::{Body, Evidence, Member, TrueLevels};

use crate::model::{Model, RobotModel};
use crate::robot::Robot;

/// What was heard, with what the base knows besides.
pub(crate) fn known(model: &Model, heard: Evidence) -> Evidence {
    Evidence {
        hp_threshold: model.mission.low_hp.threshold,
        rest_fills_one: model.mission.rest_fills == RestFills::Low,
        bodies: model.robots.iter().map(|robot| body(robot, model)).collect(),
        initial: model.telemetry.as_ref().map(|rules| rules.initial),
        ..heard
    }
}

fn body(robot: &std::sync::Arc<RobotModel>, model: &Model) -> Body {
    Body {
        robot: robot.id.0,
        top_mps: robot.spec.speed_mps,
        floor: robot.health_floor,
        carries: robot.can_carry(),
        guides: robot.spec.guides,
        needs: Robot::new(robot).level_needs(&model.needs),
    }
}

/// The levels of members as they really are, which have both.
pub(crate) fn true_levels(team: &[Member]) -> Vec<TrueLevels> {
    let of = |member: &Member| {
        let (energy_level, hp_level) = member.energy_level.zip(member.hp_level)?;
        Some(TrueLevels { robot: member.id, energy_level, hp_level })
    };
    team.iter().filter_map(of).collect()
}
