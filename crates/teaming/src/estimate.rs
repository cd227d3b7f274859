//! The interface of an estimator: what is true of each robot, how sure that is, and how far the robot is
//! believed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::PolicyError;
use crate::evidence::{Body, Evidence};
use crate::levels::Level;
use crate::question::{Member, Question};
use crate::truth::Truth;
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

    /// Whether it is a control that takes what is true.
    fn needs_truth(&self) -> bool {
        false
    }

    /// The same of an estimator that [needs the truth](Estimator::needs_truth). No other is told it.
    ///
    /// # Errors
    /// Those of [`Estimator::estimate`].
    fn estimate_with(&self, question: &Question, _truth: Truth<'_>) -> Result<Vec<Estimate>, PolicyError> {
        self.estimate(question)
    }

    /// Whether it judges trust alone: its levels are those that were said last.
    fn judges_trust_only(&self) -> bool {
        false
    }

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
    /// Its levels, in the order of the table of levels.
    pub levels: Vec<f64>,
    /// Standard deviations of the levels.
    pub sd: Vec<f64>,
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
        levels: Vec<f64>,
        sd: Vec<f64>,
    ) -> Result<Self, PolicyError> {
        let needs = needs_at(member, evidence.body(member.id), &levels)?;
        Ok(Self { levels, sd, needs, trust: 1.0 })
    }
}

/// The members as they are: what the question says of them, believed.
///
/// # Errors
/// The question does not have all levels of a member.
pub fn as_said(question: &Question) -> Result<Vec<Estimate>, PolicyError> {
    let of_member = |member: &Member| {
        let missing =
            |level: &Level| PolicyError::Unestimated { level: level.name.clone(), robot: member.id };
        let levels = question.levels.iter().zip(&member.levels);
        let levels = levels.map(|(level, value)| value.ok_or_else(|| missing(level)));
        let levels = levels.collect::<Result<Vec<_>, _>>()?;
        Ok(Estimate { sd: vec![0.0; levels.len()], levels, needs: member.needs.clone(), trust: 1.0 })
    };
    question.members.iter().map(of_member).collect()
}

/// The needs of a member at these levels, in percent. Those that follow from no level stay.
fn needs_at(member: &Member, body: Option<&Body>, levels: &[f64]) -> Result<NeedVector, PolicyError> {
    let mut needs = member.needs.values().to_vec();
    for follows in body.into_iter().flat_map(|body| &body.needs) {
        if let Some(need) = needs.get_mut(follows.need.index()) {
            *need = follows.at(levels);
        }
    }
    NeedVector::new(needs).map_err(|source| PolicyError::Needs { id: member.id, source })
}
