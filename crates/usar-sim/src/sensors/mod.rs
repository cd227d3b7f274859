//! Sensors: what a robot notices of the world, as reports. One file a kind.
//!
//! Ranges are discs that shrink with health; nothing occludes. What a robot touches it notices, whatever its
//! range. A robot reports only what changed since the belief that it shares heard of it last.

pub(crate) mod base;
mod debris;
pub(crate) mod oneself;
mod radiation;
mod rescuees;
pub(crate) mod team_mates;

use parry2d::math::Vector;
use smallvec::SmallVec;

use crate::belief::Belief;
use crate::model::Model;
use crate::report::{Report, Speaker, Statement};
use crate::world::{Robot, World};

/// A robot touches what is nearer to its outline than this, in metres.
const TOUCH_M: f32 = 0.02;

/// The surroundings of one robot at one step.
struct View<'v> {
    world: &'v World,
    model: &'v Model,
    robot: &'v Robot,
    /// Numbers of the robots that have stopped for good.
    wrecks: &'v [usize],
    /// Sensing range at present, in metres.
    sensing: f32,
    step: u64,
}

impl View<'_> {
    fn report(&self, says: Statement) -> Report {
        Report { from: Speaker::Robot(self.robot.id), says, at_step: self.step, sd_m: 0.0 }
    }

    /// Distance from its centre up to which a robot touches things, in metres; 0 for a robot that flies over
    /// them.
    fn touch(&self) -> f32 {
        if self.robot.is_aerial() { 0.0 } else { self.robot.radius() + TOUCH_M }
    }

    fn is_in_range(&self, at: Vector) -> bool {
        (self.robot.position - at).length() <= self.sensing
    }
}

/// Lets every robot that can act look around, and appends what it reports. `belief_of` is the belief that a
/// robot shares.
pub(crate) fn look_around<'b>(
    world: &World,
    model: &Model,
    belief_of: impl Fn(&Robot) -> &'b Belief,
    step: u64,
    sent: &mut Vec<Report>,
) {
    let wrecks = world.robots.iter().filter(|robot| robot.wreck_at.is_some());
    let wrecks: SmallVec<[usize; 16]> = wrecks.map(|robot| robot.id.index()).collect();
    for robot in world.robots.iter().filter(|robot| robot.is_able()) {
        let sensing = robot.sensing_range() as f32;
        let view = View { world, model, robot, wrecks: &wrecks, sensing, step };
        let belief = belief_of(robot);
        debris::sense(&view, belief, sent);
        radiation::sense(&view, belief, sent);
        team_mates::sense(&view, belief, sent);
        rescuees::sense(&view, belief, sent);
    }
}
