//! `usar man`: manual pages, and the book's reference of commands, made from the description of the command
//! line.

mod markdown;

use std::io::Write;
use std::path::PathBuf;

use clap::{Args, Command};
use clap_mangen::Man;
use experiments::Failure;

use super::output::{check_folder, make_folder, write};

/// Print the manual page, or write the pages of all commands
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  usar man | man -l -                     read it
  usar man --out ~/.local/share/man/man1  usar.1, and usar-sweep.1 and so on for each command; then: man \
  usar-sweep
  usar man --markdown                     all commands on one page: docs/commands.md")]
pub(crate) struct Arguments {
    /// Write the pages of `usar` and of each command to this folder
    #[arg(long, value_name = "FOLDER", conflicts_with = "markdown")]
    out: Option<PathBuf>,
    /// Write them even if the folder is not empty
    #[arg(long, requires = "out")]
    force: bool,
    /// Print all commands as one page of Markdown
    #[arg(long)]
    markdown: bool,
}

impl Arguments {
    pub(crate) fn execute(&self, mut command: Command, out: &mut dyn Write) -> Result<(), Failure> {
        command.build();
        if self.markdown {
            return Ok(out.write_all(markdown::page(command).as_bytes())?);
        }
        let Some(folder) = &self.out else { return Ok(out.write_all(&page(command)?)?) };
        check_folder("--out", folder, self.force)?;
        let pages = command.get_subcommands().filter(|command| command.get_name() != "help");
        let mut pages: Vec<Command> = pages.cloned().collect();
        pages.insert(0, command);
        make_folder(folder)?;
        for command in pages {
            let name = format!("{}.1", command.get_display_name().unwrap_or("usar"));
            write(folder, &name, &page(command)?)?;
            writeln!(out, "{}", folder.join(name).display())?;
        }
        Ok(())
    }
}

/// The manual page of a command. From the examples on, it keeps the lines of `--help`.
fn page(command: Command) -> Result<Vec<u8>, Failure> {
    let mut rendered = Vec::new();
    Man::new(command).render(&mut rendered)?;
    let rendered = String::from_utf8(rendered).map_err(Failure::run)?;
    let mut page = Vec::new();
    let mut by_line = false;
    for line in rendered.lines() {
        if by_line && line.starts_with(".SH") {
            by_line = false;
            writeln!(page, ".fi")?;
        }
        if line.starts_with("Example:") || line.starts_with("Examples:") {
            by_line = true;
            writeln!(page, ".nf")?;
        }
        writeln!(page, "{}", if line == ".SH EXTRA" { ".SH NOTES" } else { line })?;
    }
    Ok(page)
}
