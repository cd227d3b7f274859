//! What a registry makes: policies, trust measures and estimators, with their names and options.

use std::fmt;
use std::sync::Arc;

use crate::decision::Decision;
use crate::error::PolicyError;
use crate::estimate::{Estimate, Estimator};
use crate::measure::TrustMeasure;
use crate::question::Question;
use crate::session::{Asked, Declared, Driver, Session};
use crate::truth::Truth;

/// A policy as it was requested.
pub type MadePolicy = Made<dyn Driver>;

/// A trust measure as it was requested.
pub type MadeMeasure = Made<dyn TrustMeasure>;

/// An estimator as it was requested.
pub type MadeEstimator = Made<dyn Estimator>;

/// What a registry made.
pub struct Made<T: ?Sized> {
    /// Its name.
    pub name: String,
    /// Its name, with the options as they were written if not all are the defaults.
    pub label: String,
    /// All its options in RON, including the defaults. Policies with the same name and options give the same
    /// answers. Empty where there are none.
    pub options: String,
    /// What was made.
    pub it: Arc<T>,
    /// Hash of the sources of its kind, if the kind has one.
    pub(crate) sources: Option<String>,
}

impl<T: ?Sized> fmt::Debug for Made<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.name, self.options)
    }
}

impl<T: ?Sized> Clone for Made<T> {
    fn clone(&self) -> Self {
        let (name, label, options) = (self.name.clone(), self.label.clone(), self.options.clone());
        Self { name, label, options, it: Arc::clone(&self.it), sources: self.sources.clone() }
    }
}

impl MadeMeasure {
    /// A text that changes whenever its values may change: that of its
    /// [kind](crate::registry::Kind::from_sources).
    #[must_use]
    pub fn fingerprint(&self) -> Option<&str> {
        self.sources.as_deref()
    }
}

impl MadeEstimator {
    /// An estimate of each member. The truth is told to an estimator that needs it, and to no other.
    ///
    /// # Errors
    /// Those of [`Estimator::estimate`].
    pub fn estimate(
        &self,
        question: &Question,
        truth: Option<Truth<'_>>,
    ) -> Result<Vec<Estimate>, PolicyError> {
        match truth.filter(|_| self.it.needs_truth()) {
            Some(truth) => self.it.estimate_with(question, truth),
            None => self.it.estimate(question),
        }
    }

    /// A text that changes whenever its answers may change: that of the [estimator](Estimator::fingerprint),
    /// or else that of the [kind](crate::registry::Kind::from_sources).
    #[must_use]
    pub fn fingerprint(&self) -> Option<String> {
        self.it.fingerprint().or_else(|| self.sources.clone())
    }
}

impl MadePolicy {
    /// Opens a session.
    ///
    /// # Errors
    /// The session cannot be opened.
    pub fn open(&self) -> Result<Box<dyn Session>, PolicyError> {
        Ok(Box::new(Declared::open(&*self.it)?))
    }

    /// The same policy under the label that it has in tables.
    #[must_use]
    pub fn labelled(mut self, label: &str) -> Self {
        if let Some(it) = self.it.labelled(label) {
            self.it = it;
        }
        self
    }

    /// Answers one question, in a session of its own.
    ///
    /// # Errors
    /// The session cannot be opened, or the question cannot be answered.
    pub fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        self.open()?.decide(&Asked::of(question))
    }

    /// Whether it gets to see what is true: by the truth that it is told, or by the trial that it plays on.
    #[must_use]
    pub fn sees_truth(&self) -> bool {
        self.it.needs_truth() || self.it.needs_trial()
    }

    /// A text that changes whenever its answers may change: that of the [driver](Driver::fingerprint), or
    /// else that of the [kind](crate::registry::Kind::from_sources).
    #[must_use]
    pub fn fingerprint(&self) -> Option<String> {
        self.it.fingerprint().or_else(|| self.sources.clone())
    }
}
