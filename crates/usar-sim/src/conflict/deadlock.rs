//! Conflict sets over time: their order, and what happens when nobody moves (the paper's Algorithm 6, read as a rotation).

use parry2d::math::Vector;

use super::{Mover, PriorityKey};

/// Slower than this is no motion, in metres per second.
pub(super) const STILL_MPS: f32 = 0.02;

/// A conflict set that persists from step to step.
pub(super) struct ConflictSet {
    members: Vec<usize>,
    /// Members in order of precedence; the first is the head.
    pub(super) order: Vec<usize>,
    still_steps: u32,
    rotations: usize,
    backing_off: u32,
}

/// What a set does in this step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The head goes, the others yield.
    Ordered,
    /// It stood still: the head went to the tail just now.
    Rotated,
    /// Every member was head and nobody moved: from now on it backs off.
    BacksOff,
    /// It goes on backing off.
    BackingOff,
}

impl ConflictSet {
    /// A new set, in order of priority.
    pub(super) fn new(members: &[usize], priority: impl Fn(usize) -> PriorityKey) -> Self {
        let mut order = members.to_vec();
        order.sort_by(|a, b| priority(*a).precedence(&priority(*b)));
        Self { members: members.to_vec(), order, still_steps: 0, rotations: 0, backing_off: 0 }
    }

    pub(super) fn has_members(&self, members: &[usize]) -> bool {
        self.members == members
    }

    /// Counts steps without motion; rotates after `deadlock_steps`, and backs off once all have been head in vain.
    pub(super) fn observe(&mut self, moving: bool, deadlock_steps: u32, back_off_steps: u32) -> Verdict {
        if self.backing_off > 0 {
            self.backing_off -= 1;
            return Verdict::BackingOff;
        }
        if moving {
            self.still_steps = 0;
            return Verdict::Ordered;
        }
        self.still_steps += 1;
        if self.still_steps < deadlock_steps {
            return Verdict::Ordered;
        }
        self.still_steps = 0;
        self.order.rotate_left(1);
        self.rotations += 1;
        if self.rotations < self.order.len() {
            return Verdict::Rotated;
        }
        self.rotations = 0;
        self.backing_off = back_off_steps;
        Verdict::BacksOff
    }
}

/// Sideways and away from the middle of the set, at half the wished speed.
pub(super) fn back_off_velocity(i: usize, order: &[usize], movers: &[Mover]) -> Vector {
    let middle = order.iter().map(|j| movers[*j].position).sum::<Vector>() / order.len() as f32;
    let me = &movers[i];
    let away = (me.position - middle).normalize_or_zero();
    let aside = me.wish.perp().normalize_or_zero() * -1.0; // to the right
    (away + aside).normalize_or(aside) * (0.5 * me.wish.length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::RobotId;

    fn set() -> ConflictSet {
        let energy = [50.0, 20.0, 80.0];
        ConflictSet::new(&[0, 1, 2], |i| PriorityKey { energy: energy[i], robot: RobotId(i as u32) })
    }

    #[test]
    fn the_lowest_energy_is_the_head() {
        assert_eq!(set().order, [1, 0, 2]);
    }

    #[test]
    fn a_still_set_rotates_and_after_a_full_cycle_backs_off() {
        let mut set = set();
        let verdicts: Vec<Verdict> = (0..12).map(|_| set.observe(false, 4, 2)).collect();
        let at = |verdict| verdicts.iter().enumerate().filter(move |(_, v)| **v == verdict).map(|(i, _)| i);
        assert_eq!(at(Verdict::Rotated).collect::<Vec<_>>(), [3, 7]);
        assert_eq!(at(Verdict::BacksOff).collect::<Vec<_>>(), [11]);
        assert_eq!([set.observe(false, 4, 2), set.observe(false, 4, 2)], [Verdict::BackingOff; 2]);
        assert_eq!(set.observe(false, 4, 2), Verdict::Ordered);
    }

    #[test]
    fn motion_keeps_the_order() {
        let mut set = set();
        for i in 0..100 {
            assert_eq!(set.observe(i % 9 == 0, 10, 2), Verdict::Ordered);
        }
        assert_eq!(set.order, [1, 0, 2]);
    }
}
