//! `usar scenario schema`: the JSON Schema of files, and of questions and decisions.

use clap::ValueEnum;
use experiments::experiment::sweep_schema;
use scenario::scenario_schema;
use teaming::{Decision, Question};

use crate::prelude::*;

/// Print the JSON Schema of scenario and sweep files, of a question or of a decision
#[derive(Debug, Args)]
#[command(after_help = "\
docs/scenarios-reference.md and docs/decisions.md tell what the fields mean. RON has no schemas of its own: \
that of a file describes it as JSON, with structs as objects, lists and tuples as arrays, and `Disc(0.5)` as \
{\"Disc\": 0.5}.

Examples:
  usar scenario schema scenario > scenario.schema.json
  usar scenario schema question
  usar scenario schema decision > decision.schema.json")]
pub(crate) struct Arguments {
    /// What the schema is of
    of: Of,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Of {
    /// A scenario file
    Scenario,
    /// A sweep file
    Sweep,
    /// What a policy is asked
    Question,
    /// What it answers
    Decision,
}

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry) -> Result<Report, Failure> {
        let schema = match self.of {
            Of::Scenario => serde_json::to_string_pretty(&scenario_schema()),
            Of::Sweep => serde_json::to_string_pretty(&sweep_schema()),
            Of::Question => serde_json::to_string_pretty(&schemars::schema_for!(Question)),
            Of::Decision => serde_json::to_string_pretty(&schemars::schema_for!(Decision)),
        };
        Ok(schema.map_err(Failure::run)?.into())
    }
}
