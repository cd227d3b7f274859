//! The priority key: one comparable value that decides which robot goes first.

use std::cmp::Ordering;

use scenario::PriorityRule;

use crate::ids::RobotId;

/// A claim to the right of way. The smaller key goes first; no two robots have the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PriorityKey {
    /// Decides first: 0 for all robots, or the rank of their task.
    pub class: u8,
    /// Decides among equals: a level in percent, negative where the highest goes first.
    pub level: f64,
    /// Decides among equals: the lowest id goes first.
    pub robot: RobotId,
}

impl PriorityKey {
    /// The key of a robot with these levels, in percent. `class` is the rank of the task of its group: 0 for
    /// the hardest task. The class of a robot without a group is higher than that of any task.
    ///
    /// - `LowestEnergyFirst`: the robot with the least energy left can least afford to wait.
    /// - `TaskThenEnergy`: robots of the hardest task first, because they have the farthest to go; then those
    ///   of the next task, and last robots without a group. Within a class, the lowest energy goes first.
    /// - `HighestEnergyFirst`: the opposite of `LowestEnergyFirst`. The difference between the two shows what
    ///   the order is worth.
    /// - `LowestHpFirst`: the robot that can bear the least radiation should stand in it for the shortest
    ///   time.
    pub fn new(rule: PriorityRule, robot: RobotId, class: u8, [energy, hp]: [f64; 2]) -> Self {
        let (class, level) = match rule {
            PriorityRule::LowestEnergyFirst => (0, energy),
            PriorityRule::TaskThenEnergy => (class, energy),
            PriorityRule::HighestEnergyFirst => (0, -energy),
            PriorityRule::LowestHpFirst => (0, hp),
        };
        Self { class, level, robot }
    }

    /// Compares two keys. `Less` means that `self` goes first.
    pub(crate) fn precedence(&self, other: &Self) -> Ordering {
        let level = || self.level.total_cmp(&other.level);
        self.class.cmp(&other.class).then_with(level).then(self.robot.cmp(&other.robot))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_rule_has_its_first() {
        let first = |rule| {
            let robots = [(1, [20.0, 90.0]), (0, [50.0, 80.0]), (2, [70.0, 60.0])];
            let keys = robots
                .iter()
                .zip(0..)
                .map(|((class, levels), id)| PriorityKey::new(rule, RobotId(id), *class, *levels));
            keys.min_by(PriorityKey::precedence).unwrap().robot.0
        };
        assert_eq!(first(PriorityRule::LowestEnergyFirst), 0);
        assert_eq!(first(PriorityRule::TaskThenEnergy), 1);
        assert_eq!(first(PriorityRule::HighestEnergyFirst), 2);
        assert_eq!(first(PriorityRule::LowestHpFirst), 2);
    }

    #[test]
    fn the_lowest_id_settles_ties() {
        let key = |id| PriorityKey::new(PriorityRule::LowestEnergyFirst, RobotId(id), 0, [50.0, 50.0]);
        assert_eq!(key(1).precedence(&key(2)), Ordering::Less);
    }
}
