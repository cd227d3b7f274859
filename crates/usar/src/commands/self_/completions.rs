//! `usar self completions`: scripts with which shells complete commands, options, and what is given to them.
//!
//! The scripts ask the program itself, so that they know its policies and scenarios, and the results that are
//! there.

use std::ffi::OsStr;

use clap::Command;
use clap_complete::env::Shells;
use clap_complete::{ArgValueCompleter, CompletionCandidate, PathCompleter, Shell};

use crate::library;
use crate::prelude::*;
use crate::report::sentences;

/// Print the completion script of a shell
#[derive(Debug, Args)]
#[command(after_help = "\
Completes commands, options, policies, scenarios and folders of results.

Examples:
  usar self completions bash > ~/.local/share/bash-completion/completions/usar
  usar self completions zsh > ~/.zfunc/_usar                  (a folder of your fpath)
  usar self completions fish > ~/.config/fish/completions/usar.fish
  usar self completions powershell >> $PROFILE
  usar self completions elvish >> ~/.config/elvish/rc.elv")]
pub(crate) struct Arguments {
    /// The shell
    shell: Shell,
}

/// The variable by which a script asks the program.
pub(crate) const ASKED: &str = "USAR_COMPLETE";

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry) -> Result<Report, Failure> {
        let shells = Shells::builtins();
        let shell = shells.completer(&self.shell.to_string());
        let shell = shell.ok_or_else(|| Failure::run("no script for this shell"))?;
        let mut out = sentences();
        shell.write_registration(ASKED, "usar", "usar", "usar", &mut out)?;
        out.flush()?;
        Ok(Report::default())
    }
}

/// The command with what can be given to its arguments.
pub(crate) fn completing(command: Command) -> Command {
    let subcommands: Vec<String> = command.get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
    let command = command.mut_args(|argument| match argument.get_id().as_str() {
        "file" | "files" | "from" => argument.add(ArgValueCompleter::new(scenarios)),
        "folder" => argument.add(ArgValueCompleter::new(PathCompleter::dir())),
        "policy" | "policies" | "baseline" | "against" | "instead" => {
            argument.add(ArgValueCompleter::new(policies))
        }
        _ => argument,
    });
    subcommands.into_iter().fold(command, |command, name| command.mut_subcommand(name, completing))
}

/// Files, folders, and the scenarios that the program carries.
fn scenarios(current: &OsStr) -> Vec<CompletionCandidate> {
    use clap_complete::engine::ValueCompleter;
    let names = library::scenarios().map(|(name, _)| name);
    let carried = names.filter(|name| name.starts_with(&*current.to_string_lossy()));
    carried.map(CompletionCandidate::new).chain(PathCompleter::any().complete(current)).collect()
}

/// The last name of a list of policies.
fn policies(current: &OsStr) -> Vec<CompletionCandidate> {
    let current = current.to_string_lossy();
    let (before, begun) = current.rfind(',').map_or(("", &*current), |comma| current.split_at(comma + 1));
    let registry = policies::standard();
    let names = registry.kinds().iter().map(|kind| kind.name.clone());
    let fitting = names.filter(|name| name.starts_with(begun));
    fitting.map(|name| CompletionCandidate::new(format!("{before}{name}"))).collect()
}
