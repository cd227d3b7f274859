//! The interface of an estimator: what is true of each robot, how sure that is, and how far the robot is
//! believed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::PolicyError;
use crate::evidence::{Body, Evidence};
use crate::question::{Member, Question};
use rne_core::needs::NeedVector;

/// A way to judge the evidence of a question.
///
/// An estimator is a function of its question: the same question always has the same estimates. It sees what
/// the base heard, and not what is true.
pub trait Estimator: Send + Sync {
    /// An estimate of each member, in the order of the members. Without evidence they are
    /// [the members as they are](as_said).
    ///
    /// # Errors
    /// The question lacks a fact that the estimator needs.
    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError>;

    /// The least number of raters that each robot must have for it to hold what it promises.
    fn least_raters(&self) -> Option<u32> {
        None
    }

    /// A text that changes whenever its answers may change, of an estimator that leans on others: with
    /// theirs. `None` is for one that is known by its own sources, see `from_sources` of its kind.
    fn fingerprint(&self) -> Option<String> {
        None
    }
}

/// What is thought of one member.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Estimate {
    /// Levels of energy and health, in percent.
    pub levels: [f64; 2],
    /// Standard deviations of the levels, in percent points.
    pub sd: [f64; 2],
    /// Needs, in the order of the table of needs.
    pub needs: NeedVector,
    /// How far the robot is believed, from 0 to 1.
    pub trust: f64,
}

impl Estimate {
    /// The estimate of a member with these levels, with the needs that follow from them. The other needs are
    /// as they were said.
    ///
    /// # Errors
    /// The needs are no needs: a level or a body is not finite.
    pub fn of_levels(
        member: &Member,
        evidence: &Evidence,
        levels: [f64; 2],
        sd: [f64; 2],
    ) -> Result<Self, PolicyError> {
        let needs = needs_at(member, evidence.body(member.id), levels)?;
        Ok(Self { levels, sd, needs, trust: 1.0 })
    }
}

/// The members as they are: what the question says of them, believed.
///
/// # Errors
/// The question does not have both levels of a member.
pub fn as_said(question: &Question) -> Result<Vec<Estimate>, PolicyError> {
    question.members.iter().map(of_member).collect()
}

fn of_member(member: &Member) -> Result<Estimate, PolicyError> {
    let missing = |what| PolicyError::Unestimated { what, robot: member.id };
    let energy = member.energy_level.ok_or_else(|| missing("the energy level"))?;
    let health = member.hp_level.ok_or_else(|| missing("the HP level"))?;
    Ok(Estimate { levels: [energy, health], sd: [0.0; 2], needs: member.needs.clone(), trust: 1.0 })
}

/// The needs of a member at these levels, in percent. Those that follow from no level stay.
fn needs_at(member: &Member, body: Option<&Body>, levels: [f64; 2]) -> Result<NeedVector, PolicyError> {
    let mut needs = member.needs.values().to_vec();
    for follows in body.into_iter().flat_map(|body| &body.needs) {
        if let Some(need) = needs.get_mut(follows.need.index()) {
            *need = follows.at(levels);
        }
    }
    NeedVector::new(needs).map_err(|source| PolicyError::Needs { id: member.id, source })
}
