//! The sensor of team-mates: where they are and how they move, and which have stopped for good.

use parry2d::math::Vector;

use super::View;
use crate::belief::Belief;
use crate::ids::RobotId;
use crate::report::{Report, Statement, Track};
use crate::world::World;

/// The track of each robot, by id: exact, and of all robots. By them robots keep clear of each other,
/// whatever they say of themselves.
pub(crate) fn tracks(world: &World) -> impl Iterator<Item = Track> + '_ {
    world.robots.iter().map(|robot| Track { position: robot.position, velocity: robot.velocity })
}

/// How fast a robot sees another one go, in metres per second; nothing of one that is out of its range.
pub(crate) fn sighted_mps(world: &World, by: RobotId, of: RobotId) -> Option<f64> {
    let [by, of] = [by, of].map(|robot| &world.robots[robot.index()]);
    let is_seen = (of.position - by.position).length() <= by.sensing_range() as f32;
    is_seen.then(|| f64::from(of.velocity.length()))
}

/// Reports wrecks that the belief has not heard of.
pub(super) fn sense(view: &View, belief: &Belief, sent: &mut Vec<Report>) {
    for number in view.wrecks.iter().filter(|number| belief.wrecks.get(**number).is_none()) {
        let robot = &view.world.robots[*number];
        let (radius, is_aerial) = (robot.radius(), robot.is_aerial());
        let touches = |at: Vector| (at - view.robot.position).length() <= view.touch() + radius;
        let is_noticed = |at: &Vector| view.is_in_range(*at) || touches(*at);
        let Some(at) = robot.wreck_at.filter(is_noticed) else { continue };
        sent.push(view.report(Statement::WreckLies { robot: robot.id, at, radius, is_aerial }));
    }
}
