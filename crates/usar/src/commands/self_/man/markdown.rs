//! All commands on one page, each with its `--help`.

use std::fmt::Write;

use clap::Command;

const HEAD: &str = "\
# Commands

What `--help` prints of every command. `usar self man --markdown` makes this page, and a test compares it with
the program.
";

/// Width of the help texts in columns.
const COLUMNS: usize = 110;

/// The page.
pub(super) fn page(command: &Command) -> String {
    let mut page = HEAD.to_owned();
    add(&mut page, command);
    page
}

/// Adds a command, and then its own.
fn add(page: &mut String, command: &Command) {
    let name = command.get_bin_name().unwrap_or("usar").to_owned();
    let all = command.get_after_long_help().cloned().unwrap_or_default();
    // The short layout, a line for an option, with all options.
    let whole = command.clone().mut_args(|option| option.hide_short_help(false)).after_help(all);
    let mut help = whole.term_width(COLUMNS).render_help().to_string();
    if name == "usar" {
        help = format!("{help}\n{}", command.get_after_long_help().cloned().unwrap_or_default());
    }
    let help: Vec<&str> = help.lines().map(str::trim_end).collect();
    let _ = write!(page, "\n## {name}\n\n```text\n{}\n```\n", help.join("\n").trim_end());
    command.get_subcommands().for_each(|below| add(page, below));
}
