//! What a trial is set up from.

use std::sync::Arc;

use scenario::{LayoutError, Scenario};

use crate::model::{Layout, Model};

/// What a trial is set up from: its scenario, what was drawn from its seed, and the model compiled from both.
/// Nothing in it changes.
pub(super) struct Setup {
    /// The scenario as it was given, if it is simulated otherwise: with its distributions, in its own steps.
    given: Option<Scenario>,
    /// The scenario in the steps of the trial, with the values drawn from its distributions.
    pub(super) scenario: Scenario,
    pub(super) layout: Layout,
    pub(super) model: Model,
}

impl Setup {
    /// Draws what the seed decides.
    pub(super) fn new(given: &Scenario, seed: u64) -> Result<Arc<Self>, LayoutError> {
        let scenario = given.of_trial(seed)?;
        let given = (scenario != *given).then(|| given.clone());
        let layout = Layout::sample(&scenario, seed)?;
        let model = Model::compile(&scenario, &layout, seed);
        Ok(Arc::new(Self { given, scenario, layout, model }))
    }

    /// The scenario as it was given, with its distributions and in its own steps.
    pub(super) fn given(&self) -> &Scenario {
        self.given.as_ref().unwrap_or(&self.scenario)
    }
}
