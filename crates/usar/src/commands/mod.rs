//! The commands: a file for each verb, in a folder for each noun. The first verbs are of no noun.

mod check;
mod cluster;
mod compare;
mod export;
mod fork;
mod new;
mod oracle;
mod overview;
mod report;
mod run;
mod scenario;
mod search;
mod self_;
mod study;
mod sweep;
mod test;
mod trust;
mod verify;
mod view;
mod why;

pub(crate) use self_::{ASKED, completing};

use std::sync::LazyLock;

use clap::{CommandFactory, Parser};
use experiments::provenance::COMMIT;

use crate::arguments::ProgramsArgument;
use crate::builds::features;
use crate::command_line::CommandLine;
use crate::prelude::*;
use crate::studies::present;

/// The version, with the commit from which the program was built, if known, and its features.
pub(crate) static VERSION: LazyLock<String> = LazyLock::new(|| {
    let (version, features) = (env!("CARGO_PKG_VERSION"), features());
    match COMMIT {
        "unknown" => format!("{version} (features: {features})"),
        commit => format!("{version} (commit {commit}; features: {features})"),
    }
});

/// Which robots should team up? A laboratory for trust and grouping policies
#[derive(Debug, Parser)]
#[command(
    name = "usar",
    version = VERSION.as_str(),
    max_term_width = 110,
    disable_help_subcommand = true,
    after_long_help = "\
Exit status:
  0    a result
  1    a failure while running: a trial without numbers, a failed check, an internal error
  2    input that cannot be used; nothing was written
  3    a disk error; what was finished is kept
  130  stopped by Ctrl-C (129 by SIGHUP, 143 by SIGTERM)

Data goes to stdout, progress and messages to stderr."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    verb: Verb,
    #[command(flatten)]
    programs: ProgramsArgument,
}

impl CommandLine for Cli {
    fn runs_programs(&self) -> bool {
        self.programs.run_programs
    }

    fn asks_policies(&self) -> bool {
        match &self.verb {
            Verb::Check(check) => check.policy.is_some(),
            Verb::Report(report) => report.simulates(),
            Verb::Verify(verify) => !verify.without_programs,
            Verb::Cluster(verb) => matches!(verb, cluster::Verb::Submit(_)),
            Verb::Export(export) => export.simulates(),
            Verb::New(_) | Verb::Compare(_) | Verb::Trust(_) | Verb::Scenario(_) | Verb::Own(_) => false,
            Verb::Run(_)
            | Verb::View(_)
            | Verb::Sweep(_)
            | Verb::Test(_)
            | Verb::Why(_)
            | Verb::Fork(_)
            | Verb::Oracle(_)
            | Verb::Search(_)
            | Verb::Study(_) => true,
        }
    }

    fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        self.verb.execute(registry)
    }
}

/// The command line. `usar --help` is an overview; of each command, `-h` shows the options that most people
/// need and its examples, `--help` all.
#[must_use]
pub fn command() -> clap::Command {
    let of_study =
        |command: clap::Command, (name, about)| command.subcommand(clap::Command::new(name).about(about));
    let command = present().fold(Cli::command(), of_study);
    let text = overview::text(&command);
    examples_first(command).override_help(text)
}

/// Leaves the explanation of each command to `--help`, and the examples to both.
pub(crate) fn examples_first(command: clap::Command) -> clap::Command {
    let all = command.get_after_help().map(ToString::to_string);
    let command = match all {
        None => command,
        Some(all) => {
            let examples = all.find("Example").map_or(String::new(), |at| all[at..].to_owned());
            command.after_help(examples).after_long_help(all)
        }
    };
    command.mut_subcommands(examples_first)
}

/// The verbs of a noun: an enum of their arguments, and a way to execute each.
#[macro_export]
macro_rules! verbs {
    ($name:ident { $($(#[$attribute:meta])* $verb:ident: $arguments:ty),+ $(,)? }) => {
        #[derive(Debug, clap::Subcommand)]
        pub(crate) enum $name {
            $($(#[$attribute])* $verb($arguments),)+
        }

        impl $name {
            pub(crate) fn execute(
                &self,
                registry: &$crate::prelude::Registry,
            ) -> Result<$crate::prelude::Report, $crate::prelude::Failure> {
                match self {
                    $(Self::$verb(arguments) => arguments.execute(registry),)+
                }
            }
        }
    };
}
pub(crate) use crate::verbs;

verbs!(Verb {
    New: new::Arguments,
    Check: check::Arguments,
    Run: run::Arguments,
    View: view::Arguments,
    Sweep: sweep::Arguments,
    Compare: compare::Arguments,
    Report: report::Arguments,
    Test: test::Arguments,
    Verify: verify::Arguments,
    Why: why::Arguments,
    Fork: fork::Arguments,
    Oracle: oracle::Arguments,
    Search: search::Arguments,
    Trust: trust::Arguments,
    /// Scenario files: list, draw, lay out, explain
    #[command(subcommand, disable_help_subcommand = true)]
    Scenario: scenario::Verb,
    Export: export::Arguments,
    /// Sweeps on a cluster
    #[command(subcommand, disable_help_subcommand = true)]
    Cluster: cluster::Verb,
    /// Studies: what matters, and how good decisions are
    #[command(subcommand, disable_help_subcommand = true)]
    Study: study::Verb,
    /// This program: its state, completions for shells
    #[command(name = "self", subcommand, disable_help_subcommand = true)]
    Own: self_::Verb,
});

#[cfg(test)]
mod tests;
