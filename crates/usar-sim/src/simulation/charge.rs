//! What robots spend, and their end when nothing is left.

use scenario::CostUnit;

use crate::event::Event;
use crate::metrics::Metrics;
use crate::model::MissionModel;
use crate::robot::Condition;
use crate::world::Robot;

/// What a robot can lose of energy and HP, in percent: no more than it has, but for energy where robots go on
/// with an empty battery.
pub(super) fn bearable(robot: &Robot, [energy, hp]: [f64; 2], rules: &MissionModel) -> [f64; 2] {
    [if rules.goes_on_empty { energy } else { energy.min(robot.energy) }, hp.min(robot.hp)]
}

/// Takes energy and HP, in percent, from a robot, and charges them to the robot and to its group.
pub(super) fn spend(robot: &mut Robot, [energy, hp]: [f64; 2], unit: CostUnit, metrics: &mut Metrics) {
    robot.energy -= energy;
    robot.hp -= hp;
    metrics
        .charge(robot.id, [unit.of_percent(energy, robot.spec.energy), unit.of_percent(hp, robot.spec.hp)]);
}

/// The end of a robot that has no HP or, where robots need it, no energy left, as its condition and as an
/// event. Without HP it is disabled, whatever its energy.
pub(super) fn last_event(robot: &mut Robot, rules: &MissionModel) -> Option<Event> {
    if robot.hp <= 0.0 {
        robot.condition = Condition::Disabled;
        Some(Event::Disabled { robot: robot.id })
    } else if robot.energy <= 0.0 && !rules.goes_on_empty {
        robot.condition = Condition::Stranded;
        Some(Event::Stranded { robot: robot.id })
    } else {
        None
    }
}
