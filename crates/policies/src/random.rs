//! `RANDOM`: a fair draw per role, the lowest of the baselines.

use rand::seq::SliceRandom;

use crate::ranking::deal;
use teaming::decision::Decision;
use teaming::error::PolicyError;
use teaming::policy::Policy;
use teaming::question::Question;
use teaming::registry::PolicyKind;

/// Per role, shuffles the robots and deals them out over the tasks by quota.
#[derive(Debug, Clone, Copy)]
pub struct Random;

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::plain("RANDOM", "a fair draw", Random).from_sources(env!("SOURCES_RANDOM"))
}

impl Policy for Random {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let mut draws = question.draws();
        let shuffled = |role| {
            let mut ids: Vec<u32> = question.of_role(role).map(|member| member.id).collect();
            ids.shuffle(&mut draws);
            ids
        };
        let orders: Vec<Vec<u32>> = question.role_ids().map(shuffled).collect();
        Ok(deal(question, &orders))
    }
}
