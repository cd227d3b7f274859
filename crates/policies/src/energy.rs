//! `ENG`: the robots with more energy take the harder tasks (paper: Section VI, after Yang et al. 2020).

use crate::facts::missing;
use crate::ranking::deal_by_rank;
use teaming::decision::Decision;
use teaming::error::PolicyError;
use teaming::levels::ENERGY;
use teaming::policy::Policy;
use teaming::question::Question;
use teaming::registry::PolicyKind;

const NAME: &str = "ENG";

/// Per role, sorts by battery level; the upper robots take the harder tasks. Ties go to the lower id.
#[derive(Debug, Clone, Copy)]
pub struct Energy;

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::plain(NAME, "robots with more energy take the harder tasks", Energy)
        .from_sources(env!("SOURCES_ENERGY"))
}

impl Policy for Energy {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        deal_by_rank(
            question,
            "energy level",
            |level: &f64| *level,
            |member| {
                let level = question.level_of(member, ENERGY);
                level.ok_or_else(|| missing(NAME, "the energy level", Some(member.id)))
            },
            |a, b| b.total_cmp(a),
        )
    }
}
