//! The paper's rule (Section V and Algorithm 6).
//!
//! Robots whose next moves would bring them into each other's safety distance form a conflict set. The head
//! of the set moves and passes the others at a tangent. Members in conflict with a moving member ahead of
//! them yield. The head keeps the right of way until it leaves the set; then the next member is the head. A
//! set in which no robot moves, or whose head moves but comes no nearer to its goal, is deadlocked. The
//! resolver then tries, in this order: the robot in the way of the head makes room (`retreat`); another
//! member becomes the head; once every member has been the head without success, the whole set backs off
//! sideways.

use std::collections::BTreeMap;

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use super::deadlock::{ConflictSet, NextTurn, Observation, Progress};
use super::passing::{Surroundings, nearest_in_the_way, passing_direction};
use super::retreat::{Crowd, Retreats};
use super::{Directive, Mover, Scratch, Step, wait_cycles};
use crate::event::Event;
use crate::ids::RobotId;
use crate::model::SetsModel;

/// Margin at which robots squeeze past if nothing is free at the full margin, in metres.
const SQUEEZE_MARGIN_M: f32 = 0.03;

/// Share of the wished speed at which robots squeeze past.
const SQUEEZE_SPEED: f32 = 0.4;

/// The state of the paper's rule from step to step.
#[derive(Default, Serialize, Deserialize)]
pub(super) struct Sets {
    sets: Vec<ConflictSet>,
    retreats: Retreats,
    /// For each robot, the direction of its last directive; zero if it stood.
    headings: Vec<Vector>,
    /// For each robot, the number of successive steps in which it was blocked.
    blocked_steps: Vec<u32>,
}

impl Sets {
    /// The sets of the last step.
    pub(super) fn sets(&self) -> &[ConflictSet] {
        &self.sets
    }
}

impl Step<'_, '_, SetsModel, Sets> {
    /// One directive for each mover.
    pub(super) fn resolve(&mut self) {
        let Self { rules, state, scratch, movers, .. } = self;
        let (margin, horizon) = (rules.retreats.margin, rules.horizon);
        state.blocked_steps.resize(movers.len(), 0);
        state.headings.resize(movers.len(), Vector::ZERO);
        scratch.neighbours.sort(movers);
        state.retreats.follow(&rules.retreats, movers, &scratch.neighbours);
        scratch.neighbours.pair(movers, margin, horizon);
        scratch.conflicts.find(movers, &scratch.neighbours, margin, horizon);
        self.carry_over();
        let progress: Vec<Progress> = (0..self.state.sets.len()).map(|set| self.judge(set)).collect();
        self.direct(&progress);
        for (heading, directive) in self.state.headings.iter_mut().zip(self.directives.iter()) {
            *heading = directive.velocity().normalize_or_zero();
        }
        self.ask_for_room();
    }

    fn make_room(&mut self, i: usize, blocker: usize) -> bool {
        let (rules, neighbours) = (&self.rules.retreats, &self.scratch.neighbours);
        self.state.retreats.make_room(i, blocker, &Crowd { rules, movers: self.movers, neighbours }, self.log)
    }

    /// Carries the sets of the last step over to this step. A set continues the earlier set with which it
    /// shares the most members and keeps its order: the head stays the head until it leaves the set or a
    /// member makes room. A set that shares no member with an earlier one is new.
    fn carry_over(&mut self) {
        let Self { state: Sets { sets, retreats, .. }, scratch, movers, log, .. } = self;
        if sets.is_empty() && scratch.conflicts.is_empty() {
            note_sets(&mut scratch.set_of, movers.len(), [].iter());
            return;
        }
        let mut before: Vec<Option<ConflictSet>> = std::mem::take(sets).into_iter().map(Some).collect();
        note_sets(&mut scratch.set_of, movers.len(), before.iter().flatten());
        let priority = |i: usize| movers[i].priority;
        for members in scratch.conflicts.components() {
            let mut set = if let Some(at) = most_shared(&members, &scratch.set_of, &before)
                && let Some(mut set) = before[at].take()
            {
                set.regroup(&members, |i| scratch.set_of[i] == Some(at), priority);
                set
            } else {
                log.push(Event::ConflictStarted { robots: robots(&members, movers) });
                ConflictSet::new(&members, priority)
            };
            set.promote(|i| retreats.depth(i));
            sets.push(set);
        }
        note_sets(&mut scratch.set_of, movers.len(), sets.iter());
    }

    /// Judges the progress of a set. A stuck set gets room, another head or a pause: first the robot in the
    /// way of the head is asked to make room. If it makes none, the turn passes to another head, or the whole
    /// set backs off.
    fn judge(&mut self, at: usize) -> Progress {
        let Self { rules, state: Sets { sets, retreats, .. }, movers, log, .. } = self;
        let set = &mut sets[at];
        let speeds = set.order.iter().map(|i| movers[*i].velocity.length());
        let seen = Observation {
            fastest: speeds.fold(0.0, f32::max),
            head_way_left: movers[set.order[0]].way_left(),
        };
        if retreats.is_served(set.order[0]) {
            set.wait_for_room();
        }
        let progress = set.observe(seen, rules.patience);
        if progress != Progress::Stuck {
            return progress;
        }
        let (head, order) = (set.order[0], robots(&set.order, movers));
        log.push(Event::Deadlocked { robots: order });
        if let Some(blocker) = self.who_stops(head)
            && self.make_room(head, blocker)
        {
            self.state.sets[at].wait_for_room();
            return Progress::Flowing;
        }
        self.state.retreats.give_up(head, self.rules.retreats.respite);
        let set = &mut self.state.sets[at];
        let turn = set.give_turn(self.rules);
        let robots = robots(&set.order, self.movers);
        match turn {
            NextTurn::OfNextHead => {
                self.log.push(Event::TurnPassed { robots });
                Progress::Flowing
            }
            NextTurn::OfNobody => {
                self.log.push(Event::BackedOff { robots });
                Progress::BackingOff
            }
        }
    }

    /// Notes which robots stop. A robot stops if it has nowhere to go, or if it is in conflict with a robot
    /// ahead of it in the set's order that is moving.
    fn note_who_stands(&mut self) {
        let (Scratch { conflicts, set_of, stands, .. }, movers) = (&mut *self.scratch, &*self.movers);
        stands.clear();
        let is_alone = |i: usize| set_of[i].is_none();
        stands.extend((0..movers.len()).map(|i| !is_alone(i) || !movers[i].wishes_to_move()));
        for i in self.state.sets.iter().flat_map(|set| &set.order) {
            let goes_before = |j: &usize| set_of[*j] == set_of[*i] && !stands[*j];
            stands[*i] = conflicts.of(*i).iter().any(goes_before);
        }
    }

    /// The robot in the way of a robot that makes no progress: the robot that blocked it in the last step, or
    /// else the nearest slow robot in its way.
    fn who_stops(&self, i: usize) -> Option<usize> {
        let movers = &*self.movers;
        if let Directive::Blocked { by } = self.directives[i] {
            return by.map(RobotId::index);
        }
        let me = &movers[i];
        let slow = |j: &&usize| movers[**j].velocity.length() < 0.5 * me.preferred.length();
        let near = self.scratch.neighbours.of(i).iter().filter(slow);
        nearest_in_the_way(me.preferred, self.rules.retreats.margin, near.map(|j| me.sees(*j, movers)))
    }

    /// Directs all robots. Heads, robots without conflicts and members that need not stop pass the robots
    /// that stand. The others yield, or back off.
    fn direct(&mut self, progress: &[Progress]) {
        self.note_who_stands();
        for i in 0..self.movers.len() {
            let goes = self.movers[i].wishes_to_move() && !self.scratch.stands[i];
            self.directives[i] = if goes { self.pass(i, self.movers[i].preferred) } else { Directive::Stand };
        }
        let movers = &*self.movers;
        for (set, progress) in self.state.sets.iter().zip(progress) {
            let backs_off = *progress == Progress::BackingOff;
            let middle =
                set.order.iter().map(|i| movers[*i].position).sum::<Vector>() / set.order.len() as f32;
            for i in set.order.iter().filter(|i| backs_off || self.scratch.stands[**i]) {
                self.directives[*i] = if backs_off {
                    let preferred = back_off_velocity(&movers[*i], middle);
                    Directive::BackOff(self.pass(*i, preferred).velocity())
                } else {
                    Directive::Yield { to: movers[set.order[0]].robot }
                };
            }
        }
        for (i, retreat) in self.state.retreats.iter() {
            let room_for = movers[retreat.head].robot;
            let velocity = match self.directives[i] {
                Directive::Proceed(velocity) => velocity,
                Directive::Stand => Vector::ZERO,
                _ => continue,
            };
            self.directives[i] = Directive::Retreat { velocity, room_for };
        }
    }

    /// Lets blocked and stalled robots ask for room. A robot asks if it has been blocked for a while, or if
    /// it moves outside any set and has come no nearer to its goal for a while. A blocker that has nowhere to
    /// go is always asked. A blocker with a goal of its own is asked only by the head of its set, by a robot
    /// that makes room itself, or by the robot with the best claim on a cycle of waiting.
    fn ask_for_room(&mut self) {
        let (rules, set_of) = (self.rules, &self.scratch.set_of);
        let mut due = Vec::new();
        for (i, directive) in self.directives.iter().enumerate() {
            match directive {
                Directive::Blocked { by } => {
                    self.state.blocked_steps[i] += 1;
                    let steps = self.state.blocked_steps[i];
                    let asks = steps == rules.patience.deadlock || steps.is_multiple_of(rules.ask_again);
                    due.extend(by.filter(|_| asks).map(|by| (i, by.index())));
                }
                Directive::Proceed(_) if set_of[i].is_none() => {
                    self.state.blocked_steps[i] = 0;
                    let steps = self.movers[i].stalled_steps;
                    if steps >= rules.patience.livelock && steps.is_multiple_of(rules.ask_again) {
                        due.extend(self.who_stops(i).map(|by| (i, by)));
                    }
                }
                _ => self.state.blocked_steps[i] = 0,
            }
        }
        if due.is_empty() {
            return;
        }
        let waits_for: Vec<Option<usize>> =
            self.directives.iter().map(|directive| directive.waits_for().map(RobotId::index)).collect();
        let cycles = wait_cycles(&waits_for);
        for (i, blocker) in due {
            let is_parked = !self.movers[blocker].wishes_to_move();
            let set_of = &self.scratch.set_of;
            let set = set_of[i].filter(|set| set_of[blocker] == Some(*set));
            let is_head = set.is_some_and(|set| self.state.sets[set].order[0] == i);
            if is_parked || is_head || self.state.retreats.depth(i) > 0 || self.leads_cycle(i, &cycles) {
                self.make_room(i, blocker);
            }
        }
    }

    /// Whether a robot has the best claim among the blocked robots of a wait cycle.
    fn leads_cycle(&self, i: usize, cycles: &[Vec<usize>]) -> bool {
        let movers = &*self.movers;
        let blocked = |k: &&usize| matches!(self.directives[**k], Directive::Blocked { .. });
        cycles.iter().filter(|cycle| cycle.contains(&i)).any(|cycle| {
            let best = cycle.iter().filter(blocked).min_by(|a, b| {
                let depth = |k: usize| std::cmp::Reverse(self.state.retreats.depth(k));
                depth(**a).cmp(&depth(**b)).then(movers[**a].priority.precedence(&movers[**b].priority))
            });
            best == Some(&i)
        })
    }

    /// The directive of a robot that has the right of way: to pass the robots that stand, at the full margin
    /// or squeezing through, or `Blocked`.
    fn pass(&self, i: usize, preferred: Vector) -> Directive {
        let (me, near, stands) = (&self.movers[i], self.scratch.neighbours.of(i), &self.scratch.stands);
        let blockers = near.iter().filter(|j| stands[**j]).map(|j| me.sees(*j, self.movers));
        if blockers.clone().next().is_none() {
            return Directive::Proceed(preferred.normalize_or_zero() * preferred.length());
        }
        let discs = blockers.clone().map(|(_, center, touch)| (center, touch));
        let mut surroundings = Surroundings {
            preferred,
            discs: discs.collect(),
            margin: self.rules.retreats.margin,
            known: me.known,
            heading: self.state.headings[i],
        };
        if let Some(direction) = passing_direction(me, &surroundings) {
            return Directive::Proceed(direction * preferred.length());
        }
        surroundings.margin = surroundings.margin.min(SQUEEZE_MARGIN_M);
        if let Some(direction) = passing_direction(me, &surroundings) {
            return Directive::Proceed(direction * preferred.length() * SQUEEZE_SPEED);
        }
        let blocker = nearest_in_the_way(preferred, surroundings.margin, blockers);
        Directive::Blocked { by: blocker.map(|other| self.movers[other].robot) }
    }
}

/// Notes for each robot the set of which it is a member.
fn note_sets<'s>(
    set_of: &mut Vec<Option<usize>>,
    robots: usize,
    sets: impl Iterator<Item = &'s ConflictSet>,
) {
    set_of.clear();
    set_of.resize(robots, None);
    for (at, set) in sets.enumerate() {
        set.order.iter().for_each(|i| set_of[*i] = Some(at));
    }
}

/// The remaining set that shares the most of these members; the first of several.
fn most_shared(members: &[usize], set_of: &[Option<usize>], left: &[Option<ConflictSet>]) -> Option<usize> {
    let mut shares = BTreeMap::new();
    for at in members.iter().filter_map(|i| set_of[*i]).filter(|at| left[*at].is_some()) {
        *shares.entry(at).or_insert(0) += 1;
    }
    shares.into_iter().rev().max_by_key(|(_, shared)| *shared).map(|(at, _)| at)
}

/// Sideways and away from the middle of the set, at half the wished speed.
fn back_off_velocity(me: &Mover, middle: Vector) -> Vector {
    let away = (me.position - middle).normalize_or_zero();
    let to_the_right = -me.preferred.perp().normalize_or_zero();
    (away + to_the_right).normalize_or(to_the_right) * (0.5 * me.preferred.length())
}

fn robots(members: &[usize], movers: &[Mover]) -> Vec<RobotId> {
    members.iter().map(|i| movers[*i].robot).collect()
}
