//! The scene of a decision: the trial as the robots know it in one step.

use parry2d::math::Vector;
use teaming::TaskId;

use super::GIVE_UP_S;
use crate::belief::{Beliefs, Holder, KnownRescuee, KnownRobot};
use crate::conflict::Directive;
use crate::event::EventLog;
use crate::ids::{RescueeId, RobotId};
use crate::intent::Sought;
use crate::model::Model;
use crate::navigation::{Goal, Navigator};
use crate::report::Report;
use crate::telemetry::Telemetry;

/// The parts of a trial that decisions look at and change.
pub struct Scene<'s> {
    /// The fixed part of the trial.
    pub model: &'s Model,
    /// The beliefs of the groups and of the team at home, and the robots as they said they are.
    pub beliefs: &'s mut Beliefs,
    /// The reports that are under way.
    pub sent: &'s mut Vec<Report>,
    /// The journeys of the robots.
    pub navigator: &'s mut Navigator,
    /// What each robot did last, and for which robot it waits; none before the first step.
    pub directives: &'s [Directive],
    /// The log of the step's events.
    pub log: &'s mut EventLog,
    /// What robots say of themselves, where the base does not know how they are.
    pub telemetry: Option<&'s mut Telemetry>,
    /// Steps done.
    pub step: u64,
    /// Whether an event of the timeline is to come.
    pub awaits_event: bool,
    /// Whether an event that may open a way is to come, or was just now.
    pub awaits_opening: bool,
}

impl Scene<'_> {
    /// Where a rescuee waits, as a robot in the group of a task believes.
    pub(super) fn place_of(&self, robot: RobotId, task: TaskId, rescuee: RescueeId) -> Option<Vector> {
        self.known_of(robot, task, rescuee)?.waits_at
    }

    /// The rescuee that a robot in the group of a task is after, as it believes.
    pub(super) fn sought(&self, robot: RobotId, task: TaskId, rescuee: RescueeId) -> Option<Sought> {
        let known = self.known_of(robot, task, rescuee)?;
        Some(Sought { rescuee, at: known.waits_at?, sd_m: known.sd_m })
    }

    /// Whether a robot in the group of a task has heard that a rescuee waits no longer.
    pub(super) fn is_known_gone(&self, robot: RobotId, task: TaskId, rescuee: RescueeId) -> bool {
        self.known_of(robot, task, rescuee).is_some_and(|known| known.waits_at.is_none())
    }

    fn known_of(&self, robot: RobotId, task: TaskId, rescuee: RescueeId) -> Option<&KnownRescuee> {
        let holder = Holder::of(self.model.mission.belief_sharing, robot, task);
        self.beliefs.of(Some(holder)).rescuees.get(rescuee.index())
    }

    /// Where a robot is, as its mates know.
    pub(super) fn place_said(&self, robot: RobotId) -> Vector {
        let known = &self.beliefs.team[robot.index()];
        let said = |telemetry: &Telemetry| telemetry.place_said(known, self.model, self.step);
        self.telemetry.as_deref().map_or(known.position, said)
    }

    /// Whether a robot has known no route to its goal for so long that it gives up on the goal.
    pub(super) fn gives_up(&self, robot: RobotId) -> bool {
        let lost_steps = self.navigator.traveller(robot).lost_steps();
        lost_steps > 0 && lost_steps >= self.model.control_steps_in(GIVE_UP_S)
    }

    /// Whether a robot has arrived and is really at its goal. The route may end beside a place that debris
    /// covers.
    pub(super) fn is_at_place(&self, robot: &KnownRobot) -> bool {
        let traveller = self.navigator.traveller(robot.id);
        let covers = |goal: Goal| (goal.point - robot.position).length() <= robot.radius().max(goal.within);
        traveller.has_arrived(robot.position) && traveller.goal().is_some_and(covers)
    }

    /// Energy that a path of this length costs a robot, in percent points.
    pub(super) fn way_cost(&self, robot: &KnownRobot, metres: f64, speed: f64) -> f64 {
        let costs = &self.model.costs;
        costs.unit.to_percent(costs.of_way(metres, speed), robot.spec.energy)
    }
}
