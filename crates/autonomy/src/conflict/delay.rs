//! Why robots stand still, and for which robots they wait.

use serde::{Deserialize, Serialize};

use crate::ids::RobotId;

ron_tree::named! {
    /// Why a robot does not move on.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    pub enum DelayCause {
        /// Nothing holds it up: it moves.
        #[default]
        UnderWay = "under_way",
        /// It is at its goal, or has none, and has nothing to do.
        NothingToDo = "nothing_to_do",
        /// It takes a rescuee on board.
        Loading = "loading",
        /// It rests.
        Resting = "resting",
        /// It yields to a robot with the right of way.
        RightOfWay = "right_of_way",
        /// Its route is blocked by debris or by a robot that stands or queues.
        Blocked = "blocked",
        /// It makes room for a robot with the right of way, or gives way while it has nowhere to go.
        MakingRoom = "making_room",
        /// Its whole conflict set was deadlocked and backs off.
        BackingOff = "backing_off",
        /// It knows no route to its goal.
        NoRoute = "no_route",
        /// Its energy is 0.
        Stranded = "stranded",
        /// Its HP is 0.
        Disabled = "disabled",
    }
}

impl DelayCause {
    /// Whether the robot would move if other robots let it.
    pub fn is_waiting(self) -> bool {
        matches!(self, Self::RightOfWay | Self::Blocked)
    }
}

/// Why a robot does not move on, and the robot for which it waits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Delay {
    /// The cause of the delay.
    pub cause: DelayCause,
    /// The robot that it waits for, if there is one.
    pub waits_for: Option<RobotId>,
}

/// The cycles of a wait-for graph. `waits_for[i]` is the robot for which robot `i` waits. Each robot waits
/// for at most one other, so following every chain of waits once finds every cycle. O(robots).
///
/// ```
/// use autonomy::conflict::wait_cycles;
///
/// assert_eq!(wait_cycles(&[Some(1), Some(2), Some(1), None]), [vec![1, 2]]);
/// ```
pub fn wait_cycles(waits_for: &[Option<usize>]) -> Vec<Vec<usize>> {
    let mut visited_from = vec![usize::MAX; waits_for.len()];
    let mut cycles = Vec::new();
    for start in 0..waits_for.len() {
        let mut at = Some(start);
        while let Some(i) = at.filter(|i| visited_from[*i] == usize::MAX) {
            visited_from[i] = start;
            at = waits_for[i];
        }
        let Some(first) = at.filter(|i| visited_from[*i] == start) else { continue };
        let mut cycle = vec![first];
        let mut next = waits_for[first];
        while let Some(i) = next.filter(|i| *i != first) {
            cycle.push(i);
            next = waits_for[i];
        }
        cycles.push(cycle);
    }
    cycles
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn causes_stand_in_their_order() {
        assert!(DelayCause::ALL.iter().enumerate().all(|(i, cause)| *cause as usize == i));
    }

    #[test]
    fn cycles_are_found_once_and_chains_are_none() {
        assert!(wait_cycles(&[Some(1), Some(2), None]).is_empty());
        assert_eq!(wait_cycles(&[Some(1), Some(0), Some(0)]), [vec![0, 1]]);
        assert_eq!(wait_cycles(&[Some(0), Some(3), Some(1), Some(2)]), [vec![0], vec![1, 3, 2]]);
    }
}
