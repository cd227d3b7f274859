//! `usar self completions`: scripts with which shells complete commands and options.

use clap_complete::{Shell, generate};

use crate::commands::command;
use crate::prelude::*;

/// Print the completion script of a shell
#[derive(Debug, Args)]
#[command(after_help = "\
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

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let mut script = Vec::new();
        generate(self.shell, &mut command(), "usar", &mut script);
        Ok(out.write_all(&script)?)
    }
}
