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
use super::retreat::Retreats;
use super::{Directive, Mover, Scratch, Step, wait_cycles};
use crate::event::Event;
use crate::ids::RobotId;

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

    /// One directive for each mover.
    pub(super) fn resolve(&mut self, step: &mut Step) {
        let Step { model, scratch, movers, .. } = step;
        let rules = &model.sets;
        let (margin, horizon) = (rules.retreats.margin, rules.horizon);
        self.blocked_steps.resize(movers.len(), 0);
        self.headings.resize(movers.len(), Vector::ZERO);
        scratch.neighbours.sort(movers);
        self.retreats.follow(&rules.retreats, movers, &scratch.neighbours);
        scratch.neighbours.pair(movers, margin, horizon);
        scratch.conflicts.find(movers, &scratch.neighbours, margin, horizon);
        self.carry_over(step);
        let progress: Vec<Progress> = (0..self.sets.len()).map(|set| self.judge(step, set)).collect();
        self.direct(step, &progress);
        for (heading, directive) in self.headings.iter_mut().zip(step.directives.iter()) {
            *heading = directive.velocity().normalize_or_zero();
        }
        self.ask_for_room(step);
    }

    /// Carries the sets of the last step over to this step. A set continues the earlier set with which it
    /// shares the most members and keeps its order: the head stays the head until it leaves the set or a
    /// member makes room. A set that shares no member with an earlier one is new.
    fn carry_over(&mut self, step: &mut Step) {
        let (Self { sets, retreats, .. }, Step { scratch, movers, log, .. }) = (self, step);
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
    fn judge(&mut self, step: &mut Step, at: usize) -> Progress {
        let (rules, movers) = (&step.model.sets, &*step.movers);
        let set = &mut self.sets[at];
        let speeds = set.order.iter().map(|i| movers[*i].velocity.length());
        let seen = Observation {
            fastest: speeds.fold(0.0, f32::max),
            head_way_left: movers[set.order[0]].way_left(),
        };
        if self.retreats.is_served(set.order[0]) {
            set.wait_for_room();
        }
        let progress = set.observe(seen, rules.patience);
        if progress != Progress::Stuck {
            return progress;
        }
        let (head, order) = (set.order[0], robots(&set.order, movers));
        step.log.push(Event::Deadlocked { robots: order });
        if let Some(blocker) = who_stops(step, head)
            && step.make_room(&mut self.retreats, &rules.retreats, head, blocker)
        {
            self.sets[at].wait_for_room();
            return Progress::Flowing;
        }
        self.retreats.give_up(head, rules.retreats.respite);
        let set = &mut self.sets[at];
        let turn = set.give_turn(rules);
        let robots = robots(&set.order, step.movers);
        match turn {
            NextTurn::OfNextHead => {
                step.log.push(Event::TurnPassed { robots });
                Progress::Flowing
            }
            NextTurn::OfNobody => {
                step.log.push(Event::BackedOff { robots });
                Progress::BackingOff
            }
        }
    }

    /// Notes which robots stop. A robot stops if it has nowhere to go, or if it is in conflict with a robot
    /// ahead of it in the set's order that is moving.
    fn note_who_stands(&self, step: &mut Step) {
        let (Scratch { conflicts, set_of, stands, .. }, movers) = (&mut *step.scratch, &*step.movers);
        stands.clear();
        let is_alone = |i: usize| set_of[i].is_none();
        stands.extend((0..movers.len()).map(|i| !is_alone(i) || !movers[i].wishes_to_move()));
        for i in self.sets.iter().flat_map(|set| &set.order) {
            let goes_before = |j: &usize| set_of[*j] == set_of[*i] && !stands[*j];
            stands[*i] = conflicts.of(*i).iter().any(goes_before);
        }
    }

    /// Directs all robots. Heads, robots without conflicts and members that need not stop pass the robots
    /// that stand. The others yield, or back off.
    fn direct(&self, step: &mut Step, progress: &[Progress]) {
        self.note_who_stands(step);
        for i in 0..step.movers.len() {
            let me = &step.movers[i];
            let goes = me.wishes_to_move() && !step.scratch.stands[i];
            step.directives[i] = if goes { self.pass(step, i, me.preferred) } else { Directive::Stand };
        }
        for (set, progress) in self.sets.iter().zip(progress) {
            let backs_off = *progress == Progress::BackingOff;
            let middle =
                set.order.iter().map(|i| step.movers[*i].position).sum::<Vector>() / set.order.len() as f32;
            for i in set.order.iter().filter(|i| backs_off || step.scratch.stands[**i]) {
                step.directives[*i] = if backs_off {
                    let preferred = back_off_velocity(&step.movers[*i], middle);
                    Directive::BackOff(self.pass(step, *i, preferred).velocity())
                } else {
                    Directive::Yield { to: step.movers[set.order[0]].robot }
                };
            }
        }
        for (i, retreat) in self.retreats.iter() {
            let room_for = step.movers[retreat.head].robot;
            let velocity = match step.directives[i] {
                Directive::Proceed(velocity) => velocity,
                Directive::Stand => Vector::ZERO,
                _ => continue,
            };
            step.directives[i] = Directive::Retreat { velocity, room_for };
        }
    }

    /// Lets blocked and stalled robots ask for room. A robot asks if it has been blocked for a while, or if
    /// it moves outside any set and has come no nearer to its goal for a while. A blocker that has nowhere to
    /// go is always asked. A blocker with a goal of its own is asked only by the head of its set, by a robot
    /// that makes room itself, or by the robot with the best claim on a cycle of waiting.
    fn ask_for_room(&mut self, step: &mut Step) {
        let (rules, set_of) = (&step.model.sets, &step.scratch.set_of);
        let mut due = Vec::new();
        for (i, directive) in step.directives.iter().enumerate() {
            match directive {
                Directive::Blocked { by } => {
                    self.blocked_steps[i] += 1;
                    let steps = self.blocked_steps[i];
                    let asks = steps == rules.patience.deadlock || steps.is_multiple_of(rules.ask_again);
                    due.extend(by.filter(|_| asks).map(|by| (i, by.index())));
                }
                Directive::Proceed(_) if set_of[i].is_none() => {
                    self.blocked_steps[i] = 0;
                    let steps = step.movers[i].stalled_steps;
                    if steps >= rules.patience.livelock && steps.is_multiple_of(rules.ask_again) {
                        due.extend(who_stops(step, i).map(|by| (i, by)));
                    }
                }
                _ => self.blocked_steps[i] = 0,
            }
        }
        if due.is_empty() {
            return;
        }
        let waits_for: Vec<Option<usize>> =
            step.directives.iter().map(|directive| directive.waits_for().map(RobotId::index)).collect();
        let cycles = wait_cycles(&waits_for);
        for (i, blocker) in due {
            let is_parked = !step.movers[blocker].wishes_to_move();
            let set_of = &step.scratch.set_of;
            let set = set_of[i].filter(|set| set_of[blocker] == Some(*set));
            let is_head = set.is_some_and(|set| self.sets[set].order[0] == i);
            if is_parked || is_head || self.retreats.depth(i) > 0 || self.leads_cycle(step, i, &cycles) {
                step.make_room(&mut self.retreats, &rules.retreats, i, blocker);
            }
        }
    }

    /// Whether a robot has the best claim among the blocked robots of a wait cycle.
    fn leads_cycle(&self, step: &Step, i: usize, cycles: &[Vec<usize>]) -> bool {
        let movers = &*step.movers;
        let blocked = |k: &&usize| matches!(step.directives[**k], Directive::Blocked { .. });
        cycles.iter().filter(|cycle| cycle.contains(&i)).any(|cycle| {
            let best = cycle.iter().filter(blocked).min_by(|a, b| {
                let depth = |k: usize| std::cmp::Reverse(self.retreats.depth(k));
                depth(**a).cmp(&depth(**b)).then(movers[**a].priority.precedence(&movers[**b].priority))
            });
            best == Some(&i)
        })
    }

    /// The directive of a robot that has the right of way: to pass the robots that stand, at the full margin
    /// or squeezing through, or `Blocked`.
    fn pass(&self, step: &Step, i: usize, preferred: Vector) -> Directive {
        let (me, near, stands) = (&step.movers[i], step.scratch.neighbours.of(i), &step.scratch.stands);
        let blockers = near.iter().filter(|j| stands[**j]).map(|j| me.sees(*j, step.movers));
        if blockers.clone().next().is_none() {
            return Directive::Proceed(preferred.normalize_or_zero() * preferred.length());
        }
        let discs = blockers.clone().map(|(_, center, touch)| (center, touch));
        let mut surroundings = Surroundings {
            preferred,
            discs: discs.collect(),
            margin: step.model.sets.retreats.margin,
            known: me.known,
            heading: self.headings[i],
        };
        if let Some(direction) = passing_direction(me, &surroundings) {
            return Directive::Proceed(direction * preferred.length());
        }
        surroundings.margin = surroundings.margin.min(SQUEEZE_MARGIN_M);
        if let Some(direction) = passing_direction(me, &surroundings) {
            return Directive::Proceed(direction * preferred.length() * SQUEEZE_SPEED);
        }
        let blocker = nearest_in_the_way(preferred, surroundings.margin, blockers);
        Directive::Blocked { by: blocker.map(|other| step.movers[other].robot) }
    }
}

/// The robot in the way of a robot that makes no progress: the robot that blocked it in the last step, or
/// else the nearest slow robot in its way.
fn who_stops(step: &Step, i: usize) -> Option<usize> {
    let movers = &*step.movers;
    if let Directive::Blocked { by } = step.directives[i] {
        return by.map(RobotId::index);
    }
    let me = &movers[i];
    let slow = |j: &&usize| movers[**j].velocity.length() < 0.5 * me.preferred.length();
    let near = step.scratch.neighbours.of(i).iter().filter(slow);
    nearest_in_the_way(me.preferred, step.model.sets.retreats.margin, near.map(|j| me.sees(*j, movers)))
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
