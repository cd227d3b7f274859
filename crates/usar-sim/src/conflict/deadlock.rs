//! Conflict sets over time: their order, and what happens when nobody comes on (the paper's Algorithm 6, read as a rotation).
//!
//! Two ways to come to nothing are told apart: a *deadlock*, in which nobody moves, and a *livelock*, in which the head moves to and
//! fro but comes no nearer to its goal. Both give the next robot its turn.

use super::PriorityKey;

/// Slower than this is no motion, in metres per second.
const STILL_MPS: f32 = 0.02;

/// Coming nearer by less than this is no progress, in metres.
const PROGRESS_M: f32 = 0.05;

/// What a set looks like in this step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observation {
    /// Speed of its fastest member, in metres per second.
    pub(super) fastest: f32,
    /// Way that its head has left, in metres.
    pub(super) head_way_left: f32,
}

/// When a set is given up on, in steps.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patience {
    /// Without motion.
    pub(super) deadlock: u32,
    /// Without the head coming nearer.
    pub(super) livelock: u32,
    /// How long a set backs off.
    pub(super) back_off: u32,
}

/// A conflict set that persists from step to step.
pub(super) struct ConflictSet {
    /// Members in order of precedence; the first is the head.
    pub(super) order: Vec<usize>,
    still_steps: u32,
    head_best: f32,
    head_steps: u32,
    rotations: usize,
    backing_off: u32,
}

/// What a set does in this step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The head goes, the others yield.
    Ordered,
    /// It came to nothing: the head went to the tail just now.
    Rotated,
    /// Every member was head in vain: from now on it backs off.
    BacksOff,
    /// It goes on backing off.
    BackingOff,
}

impl ConflictSet {
    /// A new set, in order of priority.
    pub(super) fn new(members: &[usize], priority: impl Fn(usize) -> PriorityKey) -> Self {
        let mut set = Self {
            order: Vec::new(),
            still_steps: 0,
            head_best: f32::INFINITY,
            head_steps: 0,
            rotations: 0,
            backing_off: 0,
        };
        set.regroup(members, priority);
        set
    }

    /// How many of these members it has.
    pub(super) fn shared(&self, members: &[usize]) -> usize {
        self.order.iter().filter(|i| members.contains(i)).count()
    }

    /// Takes new members: those who stay keep their order, newcomers queue behind them by priority.
    pub(super) fn regroup(&mut self, members: &[usize], priority: impl Fn(usize) -> PriorityKey) {
        let head = self.order.first().copied();
        self.order.retain(|i| members.contains(i));
        let mut newcomers: Vec<usize> = members.iter().copied().filter(|i| !self.order.contains(i)).collect();
        newcomers.sort_by(|a, b| priority(*a).precedence(&priority(*b)));
        self.order.extend(newcomers);
        if self.order.first().copied() != head {
            self.next_head();
        }
    }

    /// Counts the steps that come to nothing: rotates when patience ends, and backs off once all have been head in vain.
    pub(super) fn observe(&mut self, seen: Observation, patience: Patience) -> Verdict {
        if self.backing_off > 0 {
            self.backing_off -= 1;
            return Verdict::BackingOff;
        }
        self.still_steps = if seen.fastest > STILL_MPS { 0 } else { self.still_steps + 1 };
        if seen.head_way_left < self.head_best - PROGRESS_M {
            if self.head_best.is_finite() {
                self.rotations = 0;
            }
            self.head_best = seen.head_way_left;
            self.head_steps = 0;
        } else {
            self.head_steps += 1;
        }
        if self.still_steps < patience.deadlock && self.head_steps < patience.livelock {
            return Verdict::Ordered;
        }
        self.order.rotate_left(1);
        self.next_head();
        self.rotations += 1;
        if self.rotations < self.order.len() {
            return Verdict::Rotated;
        }
        self.rotations = 0;
        self.backing_off = patience.back_off;
        Verdict::BacksOff
    }

    fn next_head(&mut self) {
        self.still_steps = 0;
        self.head_best = f32::INFINITY;
        self.head_steps = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::RobotId;

    const PATIENCE: Patience = Patience { deadlock: 4, livelock: 20, back_off: 2 };

    fn priority(i: usize) -> PriorityKey {
        let energy = [50.0, 20.0, 80.0, 10.0];
        PriorityKey { energy: energy[i], robot: RobotId(i as u32) }
    }

    fn set() -> ConflictSet {
        ConflictSet::new(&[0, 1, 2], priority)
    }

    fn still(set: &mut ConflictSet) -> Verdict {
        set.observe(Observation { fastest: 0.0, head_way_left: 5.0 }, PATIENCE)
    }

    #[test]
    fn the_lowest_energy_is_the_head_and_newcomers_queue() {
        let mut set = set();
        assert_eq!(set.order, [1, 0, 2]);
        set.regroup(&[0, 2, 3], priority);
        assert_eq!(set.order, [0, 2, 3]);
    }

    #[test]
    fn a_still_set_rotates_and_after_a_full_cycle_backs_off() {
        let mut set = set();
        let verdicts: Vec<Verdict> = (0..12).map(|_| still(&mut set)).collect();
        let at = |verdict| verdicts.iter().enumerate().filter(move |(_, v)| **v == verdict).map(|(i, _)| i);
        assert_eq!(at(Verdict::Rotated).collect::<Vec<_>>(), [3, 7]);
        assert_eq!(at(Verdict::BacksOff).collect::<Vec<_>>(), [11]);
        assert_eq!([still(&mut set), still(&mut set)], [Verdict::BackingOff; 2]);
        assert_eq!(still(&mut set), Verdict::Ordered);
    }

    #[test]
    fn a_head_that_comes_on_keeps_its_turn() {
        let mut set = set();
        for i in 0..100_u8 {
            let seen = Observation { fastest: 1.0, head_way_left: 100.0 - f32::from(i) };
            assert_eq!(set.observe(seen, PATIENCE), Verdict::Ordered);
        }
        assert_eq!(set.order, [1, 0, 2]);
    }

    #[test]
    fn a_head_that_moves_to_and_fro_loses_its_turn() {
        let mut set = set();
        let mut to_and_fro = |i: u8| {
            set.observe(Observation { fastest: 2.0, head_way_left: 3.0 + 0.1 * f32::from(i % 2) }, PATIENCE)
        };
        let first = (0..30).position(|i| to_and_fro(i) == Verdict::Rotated);
        assert_eq!(first, Some(20));
    }
}
