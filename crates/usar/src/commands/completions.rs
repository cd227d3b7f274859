//! `usar completions`: scripts with which shells complete commands and options.

use std::io::Write;

use clap::{Args, Command};
use clap_complete::{Shell, generate};
use experiments::Failure;

/// Print the completion script of a shell
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  usar completions bash > ~/.local/share/bash-completion/completions/usar
  usar completions zsh > ~/.zfunc/_usar                  (a folder of your fpath)
  usar completions fish > ~/.config/fish/completions/usar.fish
  usar completions powershell >> $PROFILE
  usar completions elvish >> ~/.config/elvish/rc.elv")]
pub(crate) struct Arguments {
    /// The shell
    shell: Shell,
}

impl Arguments {
    pub(crate) fn execute(&self, mut command: Command, out: &mut dyn Write) -> Result<(), Failure> {
        let mut script = Vec::new();
        generate(self.shell, &mut command, "usar", &mut script);
        Ok(out.write_all(&script)?)
    }
}
