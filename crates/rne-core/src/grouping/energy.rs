//! `ENG`: the robots with more energy take the hard task (paper: Section VI, after Yang et al. 2020).

use super::{Grouping, GroupingPolicy, Team, missing, upper_half_to_hard};
use crate::error::GroupingError;

/// Per role, sorts by battery level and sends the upper half to the hard task; ties by id.
pub(super) struct Energy;

impl GroupingPolicy for Energy {
    fn name(&self) -> &'static str {
        "ENG"
    }

    fn group(&self, team: &Team, _: &mut dyn rand::Rng) -> Result<Grouping, GroupingError> {
        upper_half_to_hard(
            team,
            |member| {
                member.energy_level.ok_or_else(|| missing(self.name(), "the energy level", Some(member.id)))
            },
            |a, b| b.total_cmp(a),
        )
    }
}
