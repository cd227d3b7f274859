//! The commands: a file for each verb, in a folder for each noun. The first verbs are of no noun.

mod bench;
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

use crate::prelude::*;

/// The version, with the commit from which the program was built, if known.
static VERSION: LazyLock<String> = LazyLock::new(|| match COMMIT {
    "unknown" => env!("CARGO_PKG_VERSION").to_owned(),
    commit => format!("{} (commit {commit})", env!("CARGO_PKG_VERSION")),
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
}

impl Cli {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        self.verb.execute(registry, out)
    }
}

/// The command line. `usar --help` is an overview; of each command, `-h` shows the options that most people
/// need and its examples, `--help` all.
pub(crate) fn command() -> clap::Command {
    let command = Cli::command();
    let text = overview::text(&command);
    examples_first(command).override_help(text)
}

/// Leaves the explanation of each command to `--help`, and the examples to both.
fn examples_first(command: clap::Command) -> clap::Command {
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
macro_rules! verbs {
    ($name:ident { $($(#[$attribute:meta])* $verb:ident: $arguments:ty),+ $(,)? }) => {
        #[derive(Debug, clap::Subcommand)]
        pub(crate) enum $name {
            $($(#[$attribute])* $verb($arguments),)+
        }

        impl $name {
            pub(crate) fn execute(
                &self,
                registry: &rne_core::Registry,
                out: &mut dyn std::io::Write,
            ) -> Result<(), experiments::Failure> {
                match self {
                    $(Self::$verb(arguments) => arguments.execute(registry, out),)+
                }
            }
        }
    };
}
pub(crate) use verbs;

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
    Bench: bench::Arguments,
    Trust: trust::Arguments,
    /// Scenario files: list, draw, lay out, explain
    #[command(subcommand, disable_help_subcommand = true)]
    Scenario: scenario::Verb,
    /// Figures, tables, pictures and films, and trials for other programs
    #[command(subcommand, disable_help_subcommand = true)]
    Export: export::Verb,
    /// Sweeps on a cluster
    #[command(subcommand, disable_help_subcommand = true)]
    Cluster: cluster::Verb,
    /// Studies: what matters, how good decisions are, and a paper's claims
    #[command(subcommand, disable_help_subcommand = true)]
    Study: study::Verb,
    /// This program: its state, completions for shells, manual pages
    #[command(name = "self", subcommand, disable_help_subcommand = true)]
    Own: self_::Verb,
});

#[cfg(test)]
mod tests;
