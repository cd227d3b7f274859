//! `HP_DIS`: the healthier robots take the hard task, ties by distance (paper: Section VI).

use super::{Grouping, GroupingPolicy, Team, missing, squared_distance, upper_half_to_hard};
use crate::error::GroupingError;

/// Per role, sorts by health level and sends the upper half to the hard task. Of robots with the same level, the one nearer to the
/// hard task goes first (where the tasks' positions are known), then the lower id.
pub(super) struct HpDistance;

impl GroupingPolicy for HpDistance {
    fn name(&self) -> &'static str {
        "HP_DIS"
    }

    fn group(&self, team: &Team, _: &mut dyn rand::Rng) -> Result<Grouping, GroupingError> {
        upper_half_to_hard(
            team,
            |member| {
                let level =
                    member.hp_level.ok_or_else(|| missing(self.name(), "the HP level", Some(member.id)))?;
                let distance =
                    team.tasks().map_or(0.0, |tasks| squared_distance(member.position, tasks.hard));
                Ok((level, distance))
            },
            |a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)),
        )
    }
}
