//! Right of way: who moves and who waits when robots would come too close (paper: Section V and Algorithm 6).
//!
//! Robots whose next moves would bring them into each other's safety distance form a conflict set. The head of the set moves,
//! passing the others at a tangent; the others yield until it is out of the set; then the next one is the head. A set in which nobody
//! moves is deadlocked: its order is rotated, and after a full cycle without motion it backs off sideways.
//!
//! Pure: positions and wishes in, directives out; the only state is the order of the sets that persist.

mod deadlock;
mod passing;
mod predict;
mod priority;

use parry2d::math::Vector;

use crate::event::{Event, EventLog};
use crate::ids::RobotId;
use crate::planning::KnownObstacle;
use crate::scenario::ConflictRules;

use deadlock::{ConflictSet, Verdict};
pub use passing::PASSING_RANGE_M;
use passing::{Surroundings, passing_direction};
use predict::{Neighbours, components, will_conflict};
pub use priority::PriorityKey;

/// A robot as the resolver sees it.
#[derive(Debug, Clone, Copy)]
pub struct Mover<'a> {
    /// Identity.
    pub robot: RobotId,
    /// Whether it flies; robots of different layers do not meet.
    pub aerial: bool,
    /// Centre, in metres.
    pub position: Vector,
    /// Velocity, in metres per second.
    pub velocity: Vector,
    /// The velocity that it would like; zero for a robot with nowhere to go.
    pub wish: Vector,
    /// Way that is left to its goal, in metres.
    pub way_left: f32,
    /// Radius, in metres.
    pub radius: f32,
    /// Its claim to the right of way.
    pub priority: PriorityKey,
    /// The obstacles that it knows; none for aerial robots.
    pub obstacles: &'a [KnownObstacle],
}

impl Mover<'_> {
    fn wishes_to_move(&self) -> bool {
        self.wish != Vector::ZERO
    }
}

/// What a robot is to do in this step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Directive {
    /// Move with this velocity.
    Proceed(Vector),
    /// Stop, and let another robot pass.
    Yield {
        /// The robot that it waits for.
        to: RobotId,
    },
    /// Make room with this velocity: the whole set is deadlocked.
    BackOff(Vector),
    /// Stop: no direction is free at the moment.
    Blocked,
    /// Stand: there is nowhere to go.
    Stand,
}

impl Directive {
    /// The velocity that the drive is to reach.
    #[must_use]
    pub fn velocity(self) -> Vector {
        match self {
            Self::Proceed(velocity) | Self::BackOff(velocity) => velocity,
            Self::Yield { .. } | Self::Blocked | Self::Stand => Vector::ZERO,
        }
    }
}

/// The conflict resolver of one trial.
pub struct Resolver {
    rules: ConflictRules,
    back_off_steps: u32,
    sets: Vec<ConflictSet>,
    neighbours: Neighbours,
    directives: Vec<Directive>,
}

/// How long a deadlocked set backs off, in seconds.
const BACK_OFF_S: f64 = 1.0;

impl Resolver {
    /// No conflicts yet.
    #[must_use]
    pub fn new(rules: ConflictRules, dt: f64) -> Self {
        Self {
            rules,
            back_off_steps: (BACK_OFF_S / dt).round() as u32,
            sets: Vec::new(),
            neighbours: Neighbours::default(),
            directives: Vec::new(),
        }
    }

    /// One directive for each mover, in their order.
    pub fn resolve(&mut self, movers: &[Mover], log: &mut EventLog) -> &[Directive] {
        self.neighbours.find(movers, self.rules.horizon_s as f32);
        let (margin, horizon) = (self.rules.margin_m as f32, self.rules.horizon_s as f32);
        let pairs = self
            .neighbours
            .pairs()
            .iter()
            .copied()
            .filter(|(a, b)| will_conflict(&movers[*a], &movers[*b], margin, horizon));
        let members = components(movers.len(), pairs);
        self.carry_over(&members, movers, log);

        self.directives.clear();
        self.directives.resize(movers.len(), Directive::Stand);
        let mut yielding = vec![false; movers.len()];
        for set in &self.sets {
            set.order[1..].iter().for_each(|member| yielding[*member] = true);
        }
        for set in 0..self.sets.len() {
            self.direct_set(set, movers, &yielding, log);
        }
        let in_set: Vec<bool> = flags(movers.len(), self.sets.iter().flat_map(|set| &set.order));
        for (i, mover) in movers.iter().enumerate() {
            if !in_set[i] && mover.wishes_to_move() {
                self.directives[i] = self.passing(i, movers, &yielding);
            }
        }
        &self.directives
    }

    /// Keeps the order of the sets that persist; orders the new ones by priority.
    fn carry_over(&mut self, members: &[Vec<usize>], movers: &[Mover], log: &mut EventLog) {
        let mut before = std::mem::take(&mut self.sets);
        for members in members {
            let known = before.iter().position(|set| set.has_members(members));
            self.sets.push(known.map_or_else(
                || {
                    let robots = members.iter().map(|i| movers[*i].robot).collect();
                    log.push(Event::ConflictStarted { robots });
                    ConflictSet::new(members, |i| movers[i].priority)
                },
                |at| before.swap_remove(at),
            ));
        }
    }

    fn direct_set(&mut self, set: usize, movers: &[Mover], yielding: &[bool], log: &mut EventLog) {
        let moving = self.sets[set].order.iter().any(|i| movers[*i].velocity.length() > deadlock::STILL_MPS);
        let set = &mut self.sets[set];
        let robots = |order: &[usize]| order.iter().map(|i| movers[*i].robot).collect();
        let verdict = set.observe(moving, self.rules.deadlock_steps, self.back_off_steps);
        match verdict {
            Verdict::Rotated => log.push(Event::Deadlocked { robots: robots(&set.order) }),
            Verdict::BacksOff => log.push(Event::BackedOff { robots: robots(&set.order) }),
            Verdict::Ordered | Verdict::BackingOff => {}
        }
        let order = set.order.clone();
        if matches!(verdict, Verdict::BacksOff | Verdict::BackingOff) {
            for i in &order {
                let velocity = deadlock::back_off_velocity(*i, &order, movers);
                self.directives[*i] = Directive::BackOff(velocity);
            }
            return;
        }
        let head = order[0];
        for i in &order[1..] {
            self.directives[*i] = Directive::Yield { to: movers[head].robot };
        }
        let mut others_yield = yielding.to_vec();
        others_yield[head] = false;
        self.directives[head] = self.passing(head, movers, &others_yield);
    }

    /// The way of a robot that has the right of way, past those that stand or yield.
    fn passing(&self, i: usize, movers: &[Mover], yielding: &[bool]) -> Directive {
        let me = &movers[i];
        let margin = self.rules.margin_m as f32;
        let blockers = self
            .neighbours
            .of(i)
            .iter()
            .map(|j| (*j, &movers[*j]))
            .filter(|(j, other)| other.aerial == me.aerial && (yielding[*j] || !other.wishes_to_move()));
        let surroundings = Surroundings {
            discs: blockers
                .map(|(_, other)| (other.position - me.position, me.radius + other.radius + margin))
                .collect(),
            obstacles: me.obstacles,
        };
        match passing_direction(me, &surroundings) {
            Some(direction) => Directive::Proceed(direction * me.wish.length()),
            None => Directive::Blocked,
        }
    }
}

fn flags<'a>(count: usize, members: impl Iterator<Item = &'a usize>) -> Vec<bool> {
    let mut flags = vec![false; count];
    members.for_each(|i| flags[*i] = true);
    flags
}
