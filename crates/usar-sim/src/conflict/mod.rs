//! Right of way: who moves and who waits when robots would come too close (paper: Section V and Algorithm 6).
//!
//! Robots whose next moves would bring them into each other's safety distance form a conflict set. The head of the set moves,
//! passing the others at a tangent; the others yield until it is out of the set; then the next one is the head. A set in which nobody
//! moves, or whose head moves but comes no nearer, is deadlocked: its order is rotated, and after a full cycle in vain it backs off sideways.
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

use deadlock::{ConflictSet, Observation, Patience, Verdict};
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
    /// Way that is left to its next waypoint, in metres.
    pub leg_left: f32,
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

/// How long a deadlocked set backs off, in seconds.
const BACK_OFF_S: f64 = 1.0;

/// How long the head of a set may move without coming nearer before it loses its turn, in seconds.
const LIVELOCK_S: f64 = 1.0;

/// Where there is no way past at the full margin, robots squeeze past at this one, in metres.
const SQUEEZE_MARGIN_M: f32 = 0.03;

/// Share of the wished speed at which robots squeeze past.
const SQUEEZE_SPEED: f32 = 0.4;

/// The conflict resolver of one trial.
pub struct Resolver {
    rules: ConflictRules,
    patience: Patience,
    sets: Vec<ConflictSet>,
    neighbours: Neighbours,
    directives: Vec<Directive>,
}

impl Resolver {
    /// No conflicts yet.
    #[must_use]
    pub fn new(rules: ConflictRules, dt: f64) -> Self {
        let steps = |seconds: f64| (seconds / dt).round() as u32;
        Self {
            rules,
            patience: Patience {
                deadlock: rules.deadlock_steps,
                livelock: steps(LIVELOCK_S),
                back_off: steps(BACK_OFF_S),
            },
            sets: Vec::new(),
            neighbours: Neighbours::default(),
            directives: Vec::new(),
        }
    }

    /// One directive for each mover, in their order.
    pub fn resolve(&mut self, movers: &[Mover], log: &mut EventLog) -> &[Directive] {
        let (margin, horizon) = (self.rules.margin_m as f32, self.rules.horizon_s as f32);
        self.neighbours.find(movers, margin, horizon);
        let pairs = self.neighbours.pairs().iter().copied();
        let conflicts = pairs.filter(|(a, b)| will_conflict(&movers[*a], &movers[*b], margin, horizon));
        self.carry_over(&components(movers.len(), conflicts), movers, log);

        self.directives.clear();
        self.directives.resize(movers.len(), Directive::Stand);
        let verdicts: Vec<Verdict> = (0..self.sets.len()).map(|set| self.judge(set, movers, log)).collect();
        let mut stands: Vec<bool> = movers.iter().map(|mover| !mover.wishes_to_move()).collect();
        for set in &self.sets {
            set.order[1..].iter().for_each(|member| stands[*member] = true);
        }
        for i in 0..movers.len() {
            if movers[i].wishes_to_move() && !stands[i] {
                self.directives[i] = self.pass(i, movers, movers[i].wish, &stands);
            }
        }
        for (set, verdict) in self.sets.iter().zip(verdicts) {
            let backs_off = matches!(verdict, Verdict::BacksOff | Verdict::BackingOff);
            let members = if backs_off { &set.order[..] } else { &set.order[1..] };
            for i in members {
                self.directives[*i] = if backs_off {
                    let wish = back_off_wish(*i, &set.order, movers);
                    Directive::BackOff(self.pass(*i, movers, wish, &stands).velocity())
                } else {
                    Directive::Yield { to: movers[set.order[0]].robot }
                };
            }
        }
        &self.directives
    }

    /// Sets that share at least half their members with one of the last step are its continuation: whoever is head stays it until
    /// it is out of the set. The others are new.
    fn carry_over(&mut self, members: &[Vec<usize>], movers: &[Mover], log: &mut EventLog) {
        let mut before = std::mem::take(&mut self.sets);
        let priority = |i: usize| movers[i].priority;
        for members in members {
            let known =
                before.iter().position(|set| 2 * set.shared(members) >= members.len().max(set.order.len()));
            if let Some(at) = known {
                let mut set = before.remove(at);
                set.regroup(members, priority);
                self.sets.push(set);
            } else {
                log.push(Event::ConflictStarted { robots: robots(members, movers) });
                self.sets.push(ConflictSet::new(members, priority));
            }
        }
    }

    fn judge(&mut self, set: usize, movers: &[Mover], log: &mut EventLog) -> Verdict {
        let set = &mut self.sets[set];
        let speeds = set.order.iter().map(|i| movers[*i].velocity.length());
        let seen =
            Observation { fastest: speeds.fold(0.0, f32::max), head_way_left: movers[set.order[0]].way_left };
        let verdict = set.observe(seen, self.patience);
        match verdict {
            Verdict::Rotated => log.push(Event::Deadlocked { robots: robots(&set.order, movers) }),
            Verdict::BacksOff => log.push(Event::BackedOff { robots: robots(&set.order, movers) }),
            Verdict::Ordered | Verdict::BackingOff => {}
        }
        verdict
    }

    /// The way of a robot that has the right of way, past those that stand.
    fn pass(&self, i: usize, movers: &[Mover], wish: Vector, stands: &[bool]) -> Directive {
        let me = Mover { wish, ..movers[i] };
        let blockers = self.neighbours.of(i).iter().filter(|j| stands[**j]).map(|j| &movers[*j]);
        let mut surroundings = Surroundings {
            discs: blockers.map(|other| (other.position - me.position, me.radius + other.radius)).collect(),
            margin: self.rules.margin_m as f32,
            obstacles: me.obstacles,
        };
        if let Some(direction) = passing_direction(&me, &surroundings) {
            return Directive::Proceed(direction * wish.length());
        }
        surroundings.margin = surroundings.margin.min(SQUEEZE_MARGIN_M);
        match passing_direction(&me, &surroundings) {
            Some(direction) => Directive::Proceed(direction * wish.length() * SQUEEZE_SPEED),
            None => Directive::Blocked,
        }
    }
}

/// Sideways and away from the middle of the set, at half the wished speed.
fn back_off_wish(i: usize, order: &[usize], movers: &[Mover]) -> Vector {
    let middle = order.iter().map(|j| movers[*j].position).sum::<Vector>() / order.len() as f32;
    let me = &movers[i];
    let away = (me.position - middle).normalize_or_zero();
    let to_the_right = -me.wish.perp().normalize_or_zero();
    (away + to_the_right).normalize_or(to_the_right) * (0.5 * me.wish.length())
}

fn robots(members: &[usize], movers: &[Mover]) -> Vec<RobotId> {
    members.iter().map(|i| movers[*i].robot).collect()
}
