//! `usar schema`: the JSON Schema of questions and decisions.

use std::io::Write;

use clap::{Args, ValueEnum};
use experiments::Failure;
use rne_core::{Decision, Question};

/// Print the JSON Schema of a question or of a decision
#[derive(Debug, Args)]
#[command(after_help = "\
docs/decisions.md tells what the fields mean.

Examples:
  usar schema question
  usar schema decision > decision.schema.json")]
pub(crate) struct Arguments {
    /// What the schema is of
    of: Of,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Of {
    /// What a policy is asked
    Question,
    /// What it answers
    Decision,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let schema = match self.of {
            Of::Question => schemars::schema_for!(Question),
            Of::Decision => schemars::schema_for!(Decision),
        };
        Ok(writeln!(out, "{}", serde_json::to_string_pretty(&schema).map_err(Failure::run)?)?)
    }
}
