//! `BANDIT(width)`: learns from earlier rounds how much each robot rescues at each task.
//!
//! Combinatorial upper confidence bounds (Chen, Wang, Yuan 2013, *Combinatorial Multi-Armed Bandit: General
//! Framework and Applications*, ICML): a pair of a member and a task that was tried n times in t rounds
//! counts with `mean + width * sqrt(3 ln t / (2 n))`, where the mean of what the member rescued there goes
//! over the most that any member rescued in a round. A pair that was never tried counts more than any other.
//! The assignment with the largest sum is that of OPTIMAL on these numbers. Time: the cube of a role's
//! members.
//!
//! Example: of two robots and two tasks of one place each, the first robot goes to the harder task in round 1,
//! and they change places in round 2. With 4 and 1 rescued in round 1, and 2 and 2 in round 2, the means over
//! 4 are (1, 0.5) for the first and (0.5, 0.25) for the second; the bounds are equally wide. All sums are
//! 1.25 and 1: in round 3 the first one goes to the harder task.

use rne_core::decision::Decision;
use rne_core::error::PolicyError;
use rne_core::policy::Policy;
use rne_core::question::Question;
use rne_core::registry::PolicyKind;
use serde::{Deserialize, Serialize};

use crate::assigning::{best, groups};

/// Options of `BANDIT`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// How much being unsure counts, from 0 to 10; 1 is the authors' choice.
    pub width: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { width: 1.0 }
    }
}

/// Per role, the largest sum of what members may rescue.
#[derive(Debug, Clone, Copy)]
pub struct Bandit {
    options: Options,
}

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::with_options("BANDIT", "learns how much each robot rescues at each task", Bandit::new)
        .from_sources(env!("SOURCES_BANDIT"))
}

impl Bandit {
    fn new(options: Options) -> Result<Self, &'static str> {
        let is_width = (0.0..=10.0).contains(&options.width);
        if is_width { Ok(Self { options }) } else { Err("width must be from 0 to 10") }
    }
}

impl Policy for Bandit {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let tried = tried(question);
        let most = tried.iter().flatten().fold(1.0, |most: f64, pair| most.max(pair.most));
        let rounds = question.history.len().max(1) as f64;
        let width = |times: f64| self.options.width * (1.5 * libm::log(rounds) / times).sqrt();
        let value = |pair: &Tried| match pair.times {
            0.0 => 2.0 + width(1.0),
            times => pair.rescued / times / most + width(times),
        };
        let values: Vec<Vec<f64>> = tried.iter().map(|row| row.iter().map(value).collect()).collect();
        Ok(Decision::unscored(groups(question, &best(question, &values))))
    }
}

/// What a member did at a task in earlier rounds.
#[derive(Debug, Clone, Copy, Default)]
struct Tried {
    times: f64,
    rescued: f64,
    /// The most in one round.
    most: f64,
}

/// For each member, what it did at each task.
fn tried(question: &Question) -> Vec<Vec<Tried>> {
    let mut tried = vec![vec![Tried::default(); question.tasks.len()]; question.members.len()];
    for group in question.history.iter().flat_map(|round| &round.groups) {
        for outcome in &group.members {
            let member = question.members.binary_search_by_key(&outcome.id, |member| member.id);
            let Some(pair) = member.ok().and_then(|at| tried[at].get_mut(group.task.index())) else {
                continue;
            };
            let rescued = f64::from(outcome.rescued);
            *pair = Tried {
                times: pair.times + 1.0,
                rescued: pair.rescued + rescued,
                most: pair.most.max(rescued),
            };
        }
    }
    tried
}
