//! Conflict sets over time: their order, and when a set is deadlocked (the paper's Algorithm 6).
//!
//! Two kinds of deadlock are told apart. In a *deadlock* proper, no robot moves. In a *livelock*, the head
//! moves to and fro but comes no nearer to its goal. Both pass the turn to the next robot.

use serde::{Deserialize, Serialize};
use std::cmp::Reverse;

use super::PriorityKey;
use crate::model::{Patience, SetsModel};

/// Slower than this is no motion, in metres per second.
const STILL_MPS: f32 = 0.02;

/// An approach by less than this is no progress, in metres.
const PROGRESS_M: f32 = 0.05;

/// What is seen of a set in this step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observation {
    /// Speed of its fastest member, in metres per second.
    pub(super) fastest: f32,
    /// Distance that the head has left to go, in metres.
    pub(super) head_way_left: f32,
}

/// A conflict set that persists from step to step.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct ConflictSet {
    /// Members in order of precedence; the first is the head.
    pub(super) order: Vec<usize>,
    still_steps: u32,
    head_best: f32,
    head_steps: u32,
    turns: usize,
    backing_off: u32,
}

/// The progress of a set in this step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Progress {
    /// The set makes progress, or may still do so.
    Flowing,
    /// The set is deadlocked.
    Stuck,
    /// The whole set moves apart sideways.
    BackingOff,
}

/// What a stuck set does next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NextTurn {
    /// Another head tries.
    OfNextHead,
    /// Every member was the head without success: all back off.
    OfNobody,
}

impl ConflictSet {
    /// A new set, in order of priority.
    pub(super) fn new(members: &[usize], priority: impl Fn(usize) -> PriorityKey) -> Self {
        let mut set = Self {
            order: Vec::new(),
            still_steps: 0,
            head_best: f32::INFINITY,
            head_steps: 0,
            turns: 0,
            backing_off: 0,
        };
        set.regroup(members, |_| false, priority);
        set
    }

    /// Sets the members, given in ascending order. Members that stay keep their order. Newcomers, for which
    /// `was_in` is false, queue behind them by priority.
    pub(super) fn regroup(
        &mut self,
        members: &[usize],
        was_in: impl Fn(usize) -> bool,
        priority: impl Fn(usize) -> PriorityKey,
    ) {
        let head = self.order.first().copied();
        self.order.retain(|i| members.binary_search(i).is_ok());
        let mut newcomers: Vec<usize> = members.iter().copied().filter(|i| !was_in(*i)).collect();
        newcomers.sort_by(|a, b| priority(*a).precedence(&priority(*b)));
        self.order.extend(newcomers);
        self.note_head(head);
    }

    /// Puts the robots that make room for others first, the deepest of a chain before all: the others cannot
    /// move before it does.
    pub(super) fn promote(&mut self, depth: impl Fn(usize) -> u32) {
        let head = self.order.first().copied();
        self.order.sort_by_key(|i| Reverse(depth(*i)));
        self.note_head(head);
    }

    /// Counts the steps without progress, and judges the set by them.
    pub(super) fn observe(&mut self, seen: Observation, patience: Patience) -> Progress {
        if self.backing_off > 0 {
            self.backing_off -= 1;
            return Progress::BackingOff;
        }
        self.still_steps = if seen.fastest > STILL_MPS { 0 } else { self.still_steps + 1 };
        if seen.head_way_left < self.head_best - PROGRESS_M {
            if self.head_best.is_finite() {
                self.turns = 0;
            }
            self.head_best = seen.head_way_left;
            self.head_steps = 0;
        } else {
            self.head_steps += 1;
        }
        if self.still_steps < patience.deadlock && self.head_steps < patience.livelock {
            Progress::Flowing
        } else {
            Progress::Stuck
        }
    }

    /// Resets the head's patience, because another robot makes room for it.
    pub(super) fn wait_for_room(&mut self) {
        self.next_head();
    }

    /// Makes another member the head. Once every member has been the head, the set backs off.
    pub(super) fn give_turn(&mut self, rules: &SetsModel) -> NextTurn {
        self.turns += 1;
        let cycle_is_over = self.turns >= self.order.len();
        if rules.swaps && !cycle_is_over {
            self.order.swap(0, self.turns);
        } else {
            self.order.rotate_left(1);
        }
        self.next_head();
        if !cycle_is_over {
            return NextTurn::OfNextHead;
        }
        self.turns = 0;
        self.backing_off = rules.patience.back_off;
        NextTurn::OfNobody
    }

    fn note_head(&mut self, before: Option<usize>) {
        if self.order.first().copied() != before {
            self.next_head();
        }
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
    use crate::conflict::testing::rules_of_right_of_way;
    use crate::ids::RobotId;

    const PATIENCE: Patience = Patience { deadlock: 4, livelock: 20, back_off: 2 };

    fn priority(i: usize) -> PriorityKey {
        let energy = [50.0, 20.0, 80.0, 10.0];
        PriorityKey { class: 0, level: energy[i], robot: RobotId(i as u32) }
    }

    fn set() -> ConflictSet {
        ConflictSet::new(&[0, 1, 2], priority)
    }

    fn rules(swaps: bool) -> SetsModel {
        SetsModel { patience: PATIENCE, swaps, ..rules_of_right_of_way().sets }
    }

    fn stand_still(set: &mut ConflictSet, rules: &SetsModel) -> Option<NextTurn> {
        match set.observe(Observation { fastest: 0.0, head_way_left: 5.0 }, rules.patience) {
            Progress::Stuck => Some(set.give_turn(rules)),
            _ => None,
        }
    }

    #[test]
    fn the_lowest_energy_is_the_head_and_newcomers_queue() {
        let mut set = set();
        assert_eq!(set.order, [1, 0, 2]);
        set.regroup(&[0, 2, 3], |i| i < 3, priority);
        assert_eq!(set.order, [0, 2, 3]);
    }

    #[test]
    fn a_still_set_gives_everybody_a_turn_and_then_backs_off() {
        for rules in [rules(false), rules(true)] {
            let mut set = set();
            let turns: Vec<_> = (0..12).map(|_| (stand_still(&mut set, &rules), set.order[0])).collect();
            let solved: Vec<_> = turns.iter().enumerate().filter(|(_, (turn, _))| turn.is_some()).collect();
            let found: Vec<_> =
                solved.iter().map(|(step, (turn, head))| (*step, turn.unwrap(), *head)).collect();
            assert_eq!(found[..2], [(3, NextTurn::OfNextHead, 0), (7, NextTurn::OfNextHead, 2)]);
            assert_eq!((found[2].0, found[2].1), (11, NextTurn::OfNobody));
            let seen = Observation { fastest: 0.0, head_way_left: 5.0 };
            let after: Vec<_> = (0..3).map(|_| set.observe(seen, PATIENCE)).collect();
            assert_eq!(after, [Progress::BackingOff, Progress::BackingOff, Progress::Flowing]);
        }
    }

    #[test]
    fn rotation_sends_the_head_to_the_tail_and_the_swap_exchanges_it() {
        let (mut rotated, mut swapped) = (set(), set());
        rotated.give_turn(&rules(false));
        swapped.give_turn(&rules(true));
        assert_eq!((rotated.order, swapped.order.clone()), (vec![0, 2, 1], vec![0, 1, 2]));
        swapped.give_turn(&rules(true));
        assert_eq!(swapped.order, [2, 1, 0]);
    }

    #[test]
    fn who_makes_room_goes_first() {
        let mut set = set();
        set.promote(|i| [0, 0, 1][i]);
        assert_eq!(set.order, [2, 1, 0]);
    }

    #[test]
    fn a_head_that_comes_on_keeps_its_turn() {
        let mut set = set();
        for i in 0..100_u8 {
            let seen = Observation { fastest: 1.0, head_way_left: 100.0 - f32::from(i) };
            assert_eq!(set.observe(seen, PATIENCE), Progress::Flowing);
        }
        assert_eq!(set.order, [1, 0, 2]);
    }

    #[test]
    fn a_head_that_moves_to_and_fro_is_stuck() {
        let mut set = set();
        let mut to_and_fro = |i: u8| {
            set.observe(Observation { fastest: 2.0, head_way_left: 3.0 + 0.1 * f32::from(i % 2) }, PATIENCE)
        };
        assert_eq!((0..30).position(|i| to_and_fro(i) == Progress::Stuck), Some(20));
    }
}
