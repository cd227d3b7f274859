//! `HP_DIS`: the healthier robots take the harder tasks, ties by distance (paper: Section VI).

use crate::facts::{missing, squared_distance};
use crate::ranking::deal_by_rank;
use teaming::decision::Decision;
use teaming::error::PolicyError;
use teaming::levels::HP;
use teaming::policy::Policy;
use teaming::question::Question;
use teaming::registry::PolicyKind;

const NAME: &str = "HP_DIS";

/// Per role, sorts by health level; the upper robots take the harder tasks. Among robots with the same level,
/// the robot whose home is nearer to the hardest task goes first (if that task's place is known), then the
/// robot with the lower id.
#[derive(Debug, Clone, Copy)]
pub struct HpDistance;

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::plain(NAME, "healthier robots take the harder tasks, ties by distance", HpDistance)
        .from_sources(env!("SOURCES_HP_DISTANCE"))
}

impl Policy for HpDistance {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let hardest = question.hardest_first().first().and_then(|task| question.tasks[task.index()].place);
        deal_by_rank(
            question,
            "HP level",
            |key: &(f64, f64)| key.0,
            |member| {
                let level = question.level_of(member, HP);
                let level = level.ok_or_else(|| missing(NAME, "the HP level", Some(member.id)))?;
                Ok((level, hardest.map_or(0.0, |place| squared_distance(member.home, place))))
            },
            |a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)),
        )
    }
}
