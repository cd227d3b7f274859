//! Right of way: who moves and who waits when robots would come too close (paper: Section V and Algorithm 6).
//!
//! Two rules can be chosen: the paper's, in which robots form conflict sets (`sets`), and the default rule,
//! reciprocal avoidance, which forms none (`reciprocal`).
//!
//! The resolver reads positions and wishes and returns directives. Between steps it keeps only the order of
//! the sets, the retreats, and per robot its last direction, its blocked steps and its state at a passage.

mod deadlock;
mod delay;
mod mover;
mod passing;
mod predict;
mod priority;
mod reciprocal;
mod retreat;
mod room;
mod sets;
#[cfg(test)]
mod testing;

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use crate::event::{Event, EventLog};
use crate::scenario::{ConflictRules, ResolverRule, RightOfWay, Scenario};

use deadlock::{ConflictSet, Patience};
pub use delay::{Delay, DelayCause, wait_cycles};
pub use mover::{Directive, Mover};
pub use passing::PASSING_RANGE_M;
use passing::Surroundings;
use predict::{Conflicts, Neighbours};
pub use priority::PriorityKey;
use reciprocal::Entry;
use retreat::{Limits, Manner, Retreats};

/// How long a deadlocked set backs off, in seconds.
const BACK_OFF_S: f64 = 1.0;

/// How long the head of a set may move without coming nearer before it loses its turn, in seconds.
const LIVELOCK_S: f64 = 2.0;

/// How long a robot tries to reach the place where it makes room without coming nearer to it, in seconds.
const RETREAT_PATIENCE_S: f64 = 3.0;

/// How long a robot keeps making room at its place while the other robot stands still, in seconds.
const ROOM_PATIENCE_S: f64 = 15.0;

/// How long a robot is not asked again after a retreat that failed, in seconds.
const RESPITE_S: f64 = 3.0;

/// Share of its top speed at which a robot retreats under the paper's rule.
const RETREAT_SPEED: f32 = 0.8;

/// Under the default rule, a robot that made room goes on as soon as its route is clear of the other robot's
/// for this distance, in metres.
const GOES_ON_WITHIN_M: f32 = 3.0;

/// How often a robot asks again for room while it is blocked or comes no nearer, in seconds.
const ASK_AGAIN_S: f64 = 0.5;

/// The conflict resolver of one trial.
#[derive(Serialize, Deserialize)]
pub struct Resolver {
    #[serde(skip)]
    rules: ConflictRules,
    #[serde(skip)]
    right_of_way: RightOfWay,
    #[serde(skip)]
    patience: Patience,
    #[serde(skip)]
    ask_again: u32,
    #[serde(skip)]
    arena: Vector,
    sets: Vec<ConflictSet>,
    retreats: Retreats,
    /// Recomputed in every step, like the three fields below.
    #[serde(skip)]
    neighbours: Neighbours,
    #[serde(skip)]
    conflicts: Conflicts,
    /// For each robot, the set that it is in.
    #[serde(skip)]
    set_of: Vec<Option<usize>>,
    /// For each robot, whether it stops and others pass it: it has nowhere to go, or it yields.
    #[serde(skip)]
    stands: Vec<bool>,
    directives: Vec<Directive>,
    /// For each robot, the direction of its last directive; zero if it stood.
    headings: Vec<Vector>,
    /// For each robot, the number of successive steps in which it was blocked. Under the default rule: in
    /// which a parked robot slowed it down.
    blocked_steps: Vec<u32>,
    /// For each robot, its state at a narrow passage.
    entries: Vec<Entry>,
    /// Steps without coming nearer after which a robot is stuck.
    #[serde(skip)]
    stuck_steps: u32,
    /// Steps of waiting before a passage after which a robot ends the turn of the other direction.
    #[serde(skip)]
    turn_steps: u32,
    /// Steps without coming nearer after which a robot no longer holds up the robots behind it.
    #[serde(skip)]
    holds_queue_steps: u32,
    /// Steps without coming nearer after which a robot that makes room is let out.
    #[serde(skip)]
    let_out_steps: u32,
}

impl Resolver {
    /// A resolver without conflicts.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let mut resolver = Self {
            rules: scenario.conflicts,
            right_of_way: scenario.conflicts.right_of_way(),
            patience: Patience::default(),
            ask_again: 0,
            arena: Vector::ZERO,
            sets: Vec::new(),
            retreats: Retreats::default(),
            neighbours: Neighbours::default(),
            conflicts: Conflicts::default(),
            set_of: Vec::new(),
            stands: Vec::new(),
            directives: Vec::new(),
            headings: Vec::new(),
            blocked_steps: Vec::new(),
            entries: Vec::new(),
            stuck_steps: 0,
            turn_steps: 0,
            holds_queue_steps: 0,
            let_out_steps: 0,
        };
        resolver.restore(scenario);
        resolver
    }

    /// Restores the fields that a snapshot leaves out: they follow from the scenario or from the other
    /// fields.
    pub(crate) fn restore(&mut self, scenario: &Scenario) {
        let steps = |seconds: f64| (seconds / scenario.dt_s).round() as u32;
        self.rules = scenario.conflicts;
        self.right_of_way = self.rules.right_of_way();
        self.patience = Patience {
            deadlock: self.right_of_way.deadlock_steps,
            livelock: steps(LIVELOCK_S),
            back_off: steps(BACK_OFF_S),
        };
        self.ask_again = steps(ASK_AGAIN_S).max(1);
        self.stuck_steps = steps(reciprocal::STUCK_S);
        self.turn_steps = steps(reciprocal::TURN_S);
        self.holds_queue_steps = steps(reciprocal::HOLDS_QUEUE_S);
        self.let_out_steps = steps(reciprocal::LET_OUT_S);
        let limits = Limits {
            underway: steps(RETREAT_PATIENCE_S),
            at_place: steps(ROOM_PATIENCE_S),
            respite: steps(RESPITE_S),
        };
        self.arena = Vector::new(scenario.arena_m[0] as f32, scenario.arena_m[1] as f32);
        let margin = self.right_of_way.margin_m as f32;
        let manner = if self.rules.resolver == ResolverRule::Reciprocal {
            Manner { limits, margin, speed: 1.0, goes_on_within: Some(GOES_ON_WITHIN_M) }
        } else {
            Manner { limits, margin, speed: RETREAT_SPEED, goes_on_within: None }
        };
        self.retreats.restore(manner, self.arena);
    }

    /// One directive for each mover, in the order of the movers. Replaces the wishes of robots that make
    /// room or let others out, and limits those of robots that wait or queue before a passage.
    pub fn resolve(&mut self, movers: &mut [Mover], log: &mut EventLog) -> &[Directive] {
        if self.rules.resolver == ResolverRule::None {
            self.directives.clear();
            self.directives.extend(movers.iter().map(|mover| Directive::granted(mover.wish)));
            return &self.directives;
        }
        self.blocked_steps.resize(movers.len(), 0);
        self.headings.resize(movers.len(), Vector::ZERO);
        self.directives.resize(movers.len(), Directive::Stand);
        self.neighbours.sort(movers);
        self.retreats.follow(movers, &self.neighbours);
        if self.rules.resolver == ResolverRule::Reciprocal {
            self.reciprocate(movers, log);
            return &self.directives;
        }
        self.settle_by_sets(movers, log);
        &self.directives
    }

    /// The directives of the last step, by robot.
    #[must_use]
    pub fn directives(&self) -> &[Directive] {
        &self.directives
    }

    /// The conflict sets of the last step: the members' indices, in order of precedence.
    pub fn sets(&self) -> impl Iterator<Item = &[usize]> {
        self.sets.iter().map(|set| set.order.as_slice())
    }

    fn surroundings<'m>(
        &self,
        i: usize,
        me: &Mover<'m>,
        discs: impl Iterator<Item = (Vector, f32)>,
    ) -> Surroundings<'m> {
        let margin = self.right_of_way.margin_m as f32;
        Surroundings { discs: discs.collect(), margin, known: me.known, heading: self.headings[i] }
    }

    fn make_room(&mut self, i: usize, blocker: usize, movers: &[Mover], log: &mut EventLog) -> bool {
        let may_ask = self.retreats.may_ask(i, blocker, movers);
        let makes = may_ask && self.retreats.ask(i, blocker, movers, &self.neighbours);
        if makes {
            log.push(Event::MadeRoom { robot: movers[blocker].robot, room_for: movers[i].robot });
        }
        makes
    }
}
