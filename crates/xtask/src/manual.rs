//! The command line of `usar` for people: a manual page of each command, and all commands on one page of
//! the book.

use std::fmt::Write;
use std::path::Path;

use clap::Command;
use clap_mangen::Man;

const HEAD: &str = "\
# Commands

What `--help` prints of every command.
";

/// Width of the help texts in columns.
const COLUMNS: usize = 110;

fn command() -> Command {
    let mut command = usar::command();
    command.build();
    command
}

/// All commands on one page, each with its `--help`.
#[must_use]
pub fn commands() -> String {
    let mut page = HEAD.to_owned();
    add(&mut page, &command());
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

/// Writes a manual page of each command to a folder.
///
/// # Errors
/// The pages cannot be written.
pub fn write_pages(folder: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    let mut commands = vec![command()];
    while let Some(command) = commands.pop() {
        commands.extend(command.get_subcommands().cloned());
        let name = format!("{}.1", command.get_display_name().unwrap_or("usar"));
        std::fs::write(folder.join(name), page(command)?)?;
    }
    Ok(())
}

/// The manual page of a command. From the examples on, it keeps the lines of `--help`.
fn page(command: Command) -> std::io::Result<String> {
    let mut rendered = Vec::new();
    Man::new(command).render(&mut rendered)?;
    let mut page = String::new();
    let mut by_line = false;
    for line in String::from_utf8_lossy(&rendered).lines() {
        if by_line && line.starts_with(".SH") {
            by_line = false;
            page += ".fi\n";
        }
        if line.starts_with("Example:") || line.starts_with("Examples:") {
            by_line = true;
            page += ".nf\n";
        }
        page += if line == ".SH EXTRA" { ".SH NOTES" } else { line };
        page.push('\n');
    }
    Ok(page)
}
