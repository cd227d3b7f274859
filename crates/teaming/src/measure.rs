//! The interface of a trust measure.

use crate::decision::Assignment;
use crate::error::PolicyError;
use crate::question::Question;

/// How far members of a team trust each other, as a function of the question alone. RNE is one such measure.
///
/// Its values are distrust: numbers >= 0, of which lower means more trust, and [`f64::INFINITY`] means none
/// at all. They need not be symmetric.
pub trait TrustMeasure: Send + Sync {
    /// Unit of the values, as it is printed ("nats").
    fn unit(&self) -> &str;

    /// Trust as a share in [0, 1]: 1 for no distrust, 0 for an infinite one.
    fn trust(&self, distrust: f64) -> f64 {
        libm::exp(-distrust)
    }

    /// Measures in the team of this question.
    ///
    /// # Errors
    /// The question lacks a fact that the measure needs.
    fn of_team<'q>(&'q self, question: &'q Question) -> Result<Box<dyn TeamTrust + 'q>, PolicyError>;
}

/// A trust measure in one team.
pub trait TeamTrust {
    /// The distrust of some members, taken as one group, towards others.
    ///
    /// # Errors
    /// A group is empty, or has needs that cannot be measured.
    fn towards(&self, from: &[u32], to: &[u32]) -> Result<f64, PolicyError>;

    /// The distrust between all groups of an assignment: unless a measure says otherwise, the sum over the
    /// pairs of groups that have members, of the larger of the two directions. `None` where fewer than two
    /// groups have members.
    ///
    /// # Errors
    /// Those of [`TeamTrust::towards`].
    fn between(&self, assignment: &Assignment) -> Result<Option<f64>, PolicyError> {
        let groups: Vec<&Vec<u32>> = assignment.groups.iter().filter(|group| !group.is_empty()).collect();
        let mut sum = 0.0;
        for (at, a) in groups.iter().enumerate() {
            for b in &groups[at + 1..] {
                sum += self.towards(a, b)?.max(self.towards(b, a)?);
            }
        }
        Ok((groups.len() > 1).then_some(sum))
    }

    /// What each need adds to the distrust of one group towards another; `None` if the measure does not go
    /// need by need.
    ///
    /// # Errors
    /// Those of [`TeamTrust::towards`].
    fn by_need(&self, _from: &[u32], _to: &[u32]) -> Result<Option<Vec<NeedPart>>, PolicyError> {
        Ok(None)
    }

    /// The weight of each need, as used; empty for a measure without weights.
    fn weights(&self) -> &[f64] {
        &[]
    }
}

/// One need's part in the distrust between two groups.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeedPart {
    /// The need's share in the weighted needs of the group that trusts, and of the group that is trusted.
    pub shares: [f64; 2],
    /// What it adds to the distrust; infinite for a need that one group has and the other lacks altogether.
    pub adds: f64,
}
