//! The interface of a policy.

use crate::decision::Decision;
use crate::error::PolicyError;
use crate::question::Question;

/// A way to group a team over the tasks.
///
/// A policy is a function of its question: the same question always gets the same answer. Sweeps rely on this
/// when policies share trials. A policy that needs randomness draws from [`Question::draws`]. A policy that
/// learns uses [`Question::history`].
///
/// ```
/// use teaming::{Decision, Policy, PolicyError, Question};
///
/// /// Sends everybody to the hardest task.
/// struct AllToTheHardest;
///
/// impl Policy for AllToTheHardest {
///     fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
///         let mut groups = vec![Vec::new(); question.tasks.len()];
///         let hardest = question.hardest_first()[0];
///         groups[hardest.index()] = question.members.iter().map(|member| member.id).collect();
///         Ok(Decision::unscored(groups))
///     }
/// }
/// ```
pub trait Policy: Send + Sync {
    /// Answers the question.
    ///
    /// # Errors
    /// The question lacks a fact that the policy needs, or has needs that it cannot use.
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError>;
}
