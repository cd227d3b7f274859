//! Right of way: who moves and who waits when robots would come too close (paper: Section V and Algorithm 6).
//!
//! Two rules can be chosen: the paper's, in which robots form conflict sets (`sets`), and the default rule,
//! reciprocal avoidance, which forms none (`reciprocal`). Each is a type with a state of its own; its
//! constants are in the model.
//!
//! The resolver reads positions and preferred velocities and returns directives.

mod deadlock;
mod delay;
mod mover;
mod passing;
mod predict;
mod priority;
mod reciprocal;
mod retreat;
mod sets;
#[cfg(test)]
mod testing;
mod yield_place;

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use crate::event::EventLog;
use crate::executor::Executor;
use crate::model::{RetreatModel, RightOfWayModel, RuleKind};
use crate::report::Track;

pub use delay::{Delay, DelayCause, wait_cycles};
pub use mover::{Directive, Mover};
pub use passing::PASSING_RANGE_M;
use predict::{Conflicts, Neighbours};
pub use priority::PriorityKey;
use reciprocal::{Near, Reciprocal, Sight, Turn, Unhindered};
use retreat::{Crowd, Retreats};
use sets::Sets;

/// The conflict resolver of one trial.
#[derive(Serialize, Deserialize)]
pub struct Resolver {
    rule: Rule,
    /// The directives of the last step, by robot.
    directives: Vec<Directive>,
}

/// The rule of the trial, with its state.
#[derive(Serialize, Deserialize)]
enum Rule {
    Reciprocal(Reciprocal),
    Sets(Sets),
    /// Robots drive as they prefer.
    None,
}

/// What a step works out anew. It is kept only so that the next step reuses its memory.
#[derive(Default)]
pub struct Scratch {
    neighbours: Neighbours,
    conflicts: Conflicts,
    /// For each robot, the set that it is in.
    set_of: Vec<Option<usize>>,
    /// For each robot, whether it stops and others pass it: it has nowhere to go, or it yields.
    stands: Vec<bool>,
    /// For each robot, its turn at a narrow passage.
    turns: Vec<Turn>,
    unhindered: Unhindered,
    /// For each robot, what is near it. The walls are kept from step to step, to save time.
    near: Vec<Near>,
    /// For each part of the team.
    sights: Vec<Sight>,
    /// For each robot, the direction of its preferred velocity; zero if it has nowhere to go.
    directions: Vec<Vector>,
    /// For each robot, the robot for which it makes room.
    heads: Vec<Option<usize>>,
    /// Who does the work of the step.
    pub executor: Executor,
}

/// One step, whatever the rule.
struct Step<'s, 'm> {
    model: &'s RightOfWayModel,
    scratch: &'s mut Scratch,
    movers: &'s mut [Mover<'m>],
    /// Those of the last step, until they are replaced.
    directives: &'s mut Vec<Directive>,
    log: &'s mut EventLog,
}

impl Step<'_, '_> {
    /// Has `blocker` make room for `i`. Returns whether it does.
    fn make_room(&mut self, retreats: &mut Retreats, rules: &RetreatModel, i: usize, blocker: usize) -> bool {
        let crowd = Crowd { rules, movers: self.movers, neighbours: &self.scratch.neighbours };
        retreats.make_room(i, blocker, &crowd, self.log)
    }
}

impl Resolver {
    /// A resolver without conflicts.
    pub fn new(model: &RightOfWayModel) -> Self {
        let rule = match model.rule {
            RuleKind::Reciprocal => Rule::Reciprocal(Reciprocal::default()),
            RuleKind::Sets => Rule::Sets(Sets::default()),
            RuleKind::None => Rule::None,
        };
        Self { rule, directives: Vec::new() }
    }

    /// One directive for each mover, in the order of the movers. Replaces the preferred velocities of robots
    /// that make room or let others out, and limits those of robots that wait or queue before a passage.
    pub fn resolve(
        &mut self,
        model: &RightOfWayModel,
        movers: &mut [Mover],
        scratch: &mut Scratch,
        log: &mut EventLog,
    ) -> &[Directive] {
        let directives = &mut self.directives;
        directives.resize(movers.len(), Directive::Stand);
        let mut step = Step { model, scratch, movers, directives, log };
        match &mut self.rule {
            Rule::Reciprocal(state) => state.resolve(&mut step),
            Rule::Sets(state) => state.resolve(&mut step),
            Rule::None => {
                step.directives.clear();
                step.directives.extend(step.movers.iter().map(|mover| Directive::granted(mover.preferred)));
            }
        }
        &self.directives
    }

    /// Adapts the velocities of the last directives to how robots move now, by id: under the default rule,
    /// those of robots that are close to others.
    pub fn adapt(&mut self, tracks: &[Track], scratch: &mut Scratch) {
        if let Rule::Reciprocal(state) = &self.rule {
            state.adapt(&mut self.directives, tracks, scratch);
        }
    }

    /// The directives of the last control step, by robot.
    pub fn directives(&self) -> &[Directive] {
        &self.directives
    }

    /// The conflict sets of the last step: the members' indices, in order of precedence.
    pub fn sets(&self) -> impl Iterator<Item = &[usize]> {
        let sets = if let Rule::Sets(sets) = &self.rule { sets.sets() } else { &[] };
        sets.iter().map(|set| set.order.as_slice())
    }
}
