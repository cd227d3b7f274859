//! The robots of a role, and the slots at tasks that they bid for.

use std::cmp::Ordering;

use teaming::ids::TaskId;

/// Robots and tasks by number: robots by id, tasks from the hardest to the easiest.
pub(super) struct Market {
    /// For each robot, its bid for a slot at each task.
    pub(super) bids: Vec<Vec<f64>>,
    /// Places at each task.
    pub(super) open: Vec<usize>,
}

impl Market {
    /// The market of these members, whose bids are in a table by the order of the question.
    pub(super) fn of(quota: &[usize], tasks: &[TaskId], members: &[usize], table: &[Vec<f64>]) -> Self {
        let bids = |member: &usize| tasks.iter().map(|task| table[*member][task.index()]).collect();
        Self {
            bids: members.iter().map(bids).collect(),
            open: tasks.iter().map(|task| quota[task.index()]).collect(),
        }
    }
}

/// A robot's bid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bid {
    /// The utility.
    pub(super) value: f64,
    /// The robot.
    pub(super) robot: usize,
}

impl Bid {
    /// `Less` for the bid that wins: the larger one; of equal ones, that of the lower id.
    pub(super) fn winner_first(&self, other: &Self) -> Ordering {
        other.value.total_cmp(&self.value).then(self.robot.cmp(&other.robot))
    }

    /// Whether this bid wins.
    pub(super) fn beats(&self, other: Option<Self>) -> bool {
        other.is_none_or(|other| self.winner_first(&other) == Ordering::Less)
    }
}
