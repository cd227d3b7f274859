//! The sensor of team-mates: robots within the sensing range that have stopped for good.

use super::View;
use crate::belief::Belief;
use crate::report::{Report, Statement};

/// Reports wrecks that the belief has not heard of.
pub(super) fn sense(view: &View, belief: &Belief, sent: &mut Vec<Report>) {
    for number in view.wrecks.iter().filter(|number| belief.wrecks.get(**number).is_none()) {
        let robot = &view.world.robots[*number];
        let Some(at) = robot.wreck_at.filter(|at| view.is_in_range(*at)) else { continue };
        let (radius, is_aerial) = (robot.radius(), robot.is_aerial());
        sent.push(view.report(Statement::WreckLies { robot: robot.id, at, radius, is_aerial }));
    }
}
