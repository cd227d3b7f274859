//! The command `usar bench`.

mod commands;

use std::process::ExitCode;

use clap::Parser;
use usar::CommandLine;
use usar::arguments::ProgramsArgument;
use usar::prelude::*;

#[derive(Debug, Parser)]
#[command(name = "usar-bench", bin_name = "usar bench")]
struct Bench {
    #[command(flatten)]
    arguments: commands::Arguments,
    #[command(flatten)]
    programs: ProgramsArgument,
}

impl CommandLine for Bench {
    fn runs_programs(&self) -> bool {
        self.programs.run_programs
    }

    fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        self.arguments.execute(registry)
    }
}

fn main() -> ExitCode {
    usar::main_of::<Bench>()
}
