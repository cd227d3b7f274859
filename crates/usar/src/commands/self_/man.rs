//! `usar self man`: manual pages, and the book's reference of commands, made from the description of the
//! command line.

mod markdown;

use clap::Command;
use clap_mangen::Man;
use experiments::files::NewFile;

use crate::arguments::ReplaceArgument;
use crate::commands::command;
use crate::prelude::*;

/// Print the manual page, or write the pages of all commands
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  usar self man | man -l -                     read it
  usar self man --out ~/.local/share/man/man1  a page for each command; then: man usar-sweep
  usar self man --markdown                     all commands on one page: docs/commands.md")]
pub(crate) struct Arguments {
    /// File or folder to write
    #[arg(long, conflicts_with = "markdown")]
    out: Option<PathBuf>,
    #[command(flatten)]
    replace: ReplaceArgument,
    /// Print all commands as one page of Markdown
    #[arg(long)]
    markdown: bool,
}

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let mut command = command();
        command.build();
        if self.markdown {
            return Ok(out.write_all(markdown::page(&command).as_bytes())?);
        }
        let Some(folder) = &self.out else { return Ok(out.write_all(&page(command)?)?) };
        make_folder(folder, self.replace.force)?;
        let mut commands = vec![command];
        while let Some(command) = commands.pop() {
            commands.extend(command.get_subcommands().cloned());
            let name = format!("{}.1", command.get_display_name().unwrap_or("usar"));
            NewFile::write(folder, &name, &page(command)?)?;
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
