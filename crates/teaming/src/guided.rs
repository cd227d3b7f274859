//! A policy that is asked what an estimator thinks of the team, and not what robots said.

use std::sync::Arc;

use crate::decision::Decision;
use crate::error::PolicyError;
use crate::made::{MadeEstimator, MadePolicy};
use crate::session::{Asked, Basis, Driver, Session, TrialStart};
use crate::trust_use::TrustUse;

/// A policy behind an estimator: `RULE <- ESTIMATOR | USE`.
#[derive(Debug, Clone)]
pub struct Guided {
    /// Its label, for errors.
    pub label: String,
    /// The policy that is asked.
    pub rule: MadePolicy,
    /// What judges the evidence.
    pub estimator: MadeEstimator,
    /// What is done about trust.
    pub trust_use: TrustUse,
}

impl Driver for Guided {
    fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        let (label, estimator) = (self.label.clone(), self.estimator.clone());
        let rule = self.rule.open()?;
        Ok(Box::new(GuidedSession { label, rule, estimator, trust_use: self.trust_use }))
    }

    fn basis(&self) -> Basis {
        self.rule.it.basis()
    }

    fn needs_truth(&self) -> bool {
        self.estimator.it.needs_truth() || self.rule.it.needs_truth()
    }

    fn needs_trial(&self) -> bool {
        self.rule.it.needs_trial()
    }

    fn leaves_idle(&self) -> bool {
        self.trust_use.leaves_idle() || self.rule.it.leaves_idle()
    }

    fn least_raters(&self) -> Option<u32> {
        self.estimator.it.least_raters().max(self.rule.it.least_raters())
    }

    fn idle_part(&self) -> Option<String> {
        let is_idle = self.trust_use == TrustUse::Ignore && self.estimator.it.judges_trust_only();
        let name = &self.estimator.label;
        is_idle.then(|| {
            format!("{name} judges trust only, and nothing uses it: add `| Discount` or `| Exclude`")
        })
    }

    fn labelled(&self, label: &str) -> Option<Arc<dyn Driver>> {
        let (label, rule) = (label.to_owned(), self.rule.clone().labelled(label));
        Some(Arc::new(Self { label, rule, ..self.clone() }))
    }

    fn program(&self) -> Option<String> {
        self.rule.it.program()
    }

    fn permission(&self) -> Result<(), PolicyError> {
        self.rule.it.permission()
    }

    fn gave_up(&self) -> Option<String> {
        self.rule.it.gave_up()
    }

    /// It leans on its rule and on its estimator.
    fn fingerprint(&self) -> Option<String> {
        Some(format!("{} <- {}", self.rule.fingerprint()?, self.estimator.fingerprint()?))
    }
}

/// A policy behind an estimator at work.
struct GuidedSession {
    label: String,
    rule: Box<dyn Session>,
    estimator: MadeEstimator,
    trust_use: TrustUse,
}

impl Session for GuidedSession {
    fn reset(&mut self, trial: &TrialStart<'_>) -> Result<(), PolicyError> {
        self.rule.reset(trial)
    }

    /// A question without evidence is asked as it is: there is nothing to judge.
    fn decide(&mut self, asked: &Asked<'_>) -> Result<Decision, PolicyError> {
        let question = asked.question;
        if question.evidence.is_none() {
            return self.rule.decide(asked);
        }
        if self.trust_use.leaves_idle() && !question.may_idle {
            return Err(PolicyError::MayNotIdle { policy: self.label.clone() });
        }
        let estimates = self.estimator.estimate(question, asked.truth())?;
        let believed = Some(estimates.clone());
        let judged = self.trust_use.judged(question, estimates)?;
        let mut decision = self.rule.decide(&asked.about(&judged.question))?;
        let others = decision.alternatives.iter_mut().map(|other| &mut other.assignment);
        for assignment in std::iter::once(&mut decision.assignment).chain(others) {
            assignment.idle.extend(&judged.excluded);
            assignment.idle.sort_unstable();
        }
        Ok(Decision { believed, ..decision })
    }
}
