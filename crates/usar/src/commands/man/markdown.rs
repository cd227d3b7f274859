//! All commands on one page, each with its `--help`.

use std::fmt::Write;

use clap::Command;

const HEAD: &str = "\
# Commands

What `--help` prints of every command. `usar man --markdown` makes this page, and a test compares it with
the program.
";

/// Width of the help texts in columns.
const COLUMNS: usize = 110;

/// The page.
pub(super) fn page(command: Command) -> String {
    let mut page = HEAD.to_owned();
    let commands = command.get_subcommands().filter(|command| command.get_name() != "help");
    let mut commands: Vec<Command> = commands.cloned().collect();
    commands.insert(0, command);
    for command in commands {
        let name = command.get_bin_name().unwrap_or("usar").to_owned();
        // The version differs from commit to commit, so that it does not belong on a page that tests
        // compare.
        let help = command.term_width(COLUMNS).render_help().to_string();
        let help: Vec<&str> = help.lines().map(str::trim_end).collect();
        let _ = write!(page, "\n## {name}\n\n```text\n{}\n```\n", help.join("\n").trim_end());
    }
    page
}
