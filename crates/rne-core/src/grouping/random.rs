//! `RANDOM`: a fair draw per role, the baseline below all baselines.

use rand::seq::SliceRandom;

use super::{Grouping, GroupingPolicy, Role, RoleQuota, Team};
use crate::error::GroupingError;

/// Per role, shuffles the robots and deals them over the tasks by quota.
pub(super) struct Random;

impl GroupingPolicy for Random {
    fn name(&self) -> &'static str {
        "RANDOM"
    }

    fn group(&self, team: &Team, mut draws: &mut dyn rand::Rng) -> Result<Grouping, GroupingError> {
        let (mut easy, mut hard) = (Vec::new(), Vec::new());
        for role in Role::ALL {
            let mut ids: Vec<u32> = team.of_role(role).map(|member| member.id).collect();
            ids.shuffle(&mut draws);
            let quota = RoleQuota::halves(ids.len());
            hard.extend(&ids[..quota.hard]);
            easy.extend(&ids[quota.hard..]);
        }
        Ok(Grouping::unscored(easy, hard))
    }
}
