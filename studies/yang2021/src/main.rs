//! The command `usar yang2021`.

mod commands;

use std::process::ExitCode;

use clap::Parser;
use usar::CommandLine;
use usar::arguments::ProgramsArgument;
use usar::prelude::*;

/// The paper that started this laboratory: its claims, readings and calibration
#[derive(Debug, Parser)]
#[command(name = "usar-yang2021", bin_name = "usar yang2021", disable_help_subcommand = true)]
struct Yang2021 {
    #[command(subcommand)]
    verb: commands::Verb,
    #[command(flatten)]
    programs: ProgramsArgument,
}

impl CommandLine for Yang2021 {
    fn runs_programs(&self) -> bool {
        self.programs.run_programs
    }

    fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        self.verb.execute(registry)
    }
}

fn main() -> ExitCode {
    usar::main_of::<Yang2021>()
}
