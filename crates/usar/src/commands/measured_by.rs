//! The trust measure by which decisions are looked at.

use clap::Args;
use experiments::Failure;
use rne_core::Registry;

/// Which trust measure.
#[derive(Debug, Clone, Args)]
pub(crate) struct MeasureArguments {
    /// Trust measure for a look at decisions, with its options [default: the policy's own; RNE where it has
    /// none and a measure is needed]
    #[arg(long, value_name = "MEASURE")]
    measure: Option<String>,
}

impl MeasureArguments {
    /// Chooses the measure in a registry, if one is named.
    pub(crate) fn choose(&self, registry: &mut Registry) -> Result<(), Failure> {
        let Some(text) = &self.measure else { return Ok(()) };
        registry.choose_measure(text).map_err(|error| Failure::input(format!("--measure: {error}")))
    }
}
