//! `Both(level, trust)`: the levels of one estimator, the trust of another.

use std::sync::Arc;

use teaming::nested::Part;
use teaming::{Estimate, Estimator, EstimatorKind, MadeEstimator, PolicyError, Question, Truth};

/// The options: each is an estimator, with options of its own.
const PARTS: [Part; 2] = [Part { name: "level", default: "Kalman" }, Part { name: "trust", default: "Brs" }];

/// Takes levels, deviations and needs from one estimator and trust from another.
#[derive(Debug, Clone)]
pub struct Both {
    level: MadeEstimator,
    trust: MadeEstimator,
}

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    let make = |others: Vec<MadeEstimator>| -> Arc<dyn Estimator> {
        Arc::new(Both { level: others[0].clone(), trust: others[1].clone() })
    };
    EstimatorKind::of_others("Both", "levels of one estimator, trust of another", &PARTS, make)
        .from_sources(env!("SOURCES_ESTIMATOR_BOTH"))
}

impl Both {
    fn joined(&self, question: &Question, truth: Option<Truth<'_>>) -> Result<Vec<Estimate>, PolicyError> {
        let (levels, trust) = (self.level.estimate(question, truth)?, self.trust.estimate(question, truth)?);
        let joined = |(level, trust): (Estimate, Estimate)| Estimate { trust: trust.trust, ..level };
        Ok(levels.into_iter().zip(trust).map(joined).collect())
    }
}

impl Estimator for Both {
    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        self.joined(question, None)
    }

    fn needs_truth(&self) -> bool {
        self.level.it.needs_truth() || self.trust.it.needs_truth()
    }

    fn estimate_with(&self, question: &Question, truth: Truth<'_>) -> Result<Vec<Estimate>, PolicyError> {
        self.joined(question, Some(truth))
    }

    fn judges_trust_only(&self) -> bool {
        self.level.it.judges_trust_only()
    }

    fn least_raters(&self) -> Option<u32> {
        self.level.it.least_raters().max(self.trust.it.least_raters())
    }

    fn fingerprint(&self) -> Option<String> {
        let own = env!("SOURCES_ESTIMATOR_BOTH");
        Some(format!("{own} ({}, {})", self.level.fingerprint()?, self.trust.fingerprint()?))
    }
}
