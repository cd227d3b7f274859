//! `usar new`: writes a commented scenario to start from.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use experiments::Failure;
use usar_sim::scenario::Scenario;

/// Write a commented scenario to begin with
#[derive(Debug, Args)]
#[command(after_help = "\
Writes NAME.ron, which must not exist yet. Every field is optional that the comments call so; edit the file, \
then `usar check NAME.ron`.

Examples:
  usar new mine                            a small mission: four robots, one task
  usar new mine --from paper               the paper's scenario with all its values
  usar new mine --from three-tasks
  usar new mine && usar run mine.ron")]
pub(crate) struct Arguments {
    /// Name of the scenario: letters, digits, `-`, `_` and `.`
    name: String,
    /// What to begin with
    #[arg(long, default_value = "minimal")]
    from: From,
    /// Folder to write to
    #[arg(long, default_value = ".")]
    folder: PathBuf,
}

/// The paper's scenario.
pub(super) const PAPER: &str = include_str!("../../../../scenarios/paper.ron");

#[derive(Debug, Clone, Copy, ValueEnum)]
enum From {
    /// As little as a mission needs
    Minimal,
    /// The paper's experiment
    Paper,
    /// Three tasks
    ThreeTasks,
}

impl From {
    fn text(self) -> &'static str {
        match self {
            Self::Minimal => include_str!("../../assets/minimal.ron"),
            Self::Paper => PAPER,
            Self::ThreeTasks => include_str!("../../../../scenarios/three-tasks.ron"),
        }
    }
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let path = self.folder.join(format!("{}.ron", self.name));
        let name = [("name".to_owned(), format!("{:?}", self.name))];
        let text = ron_tree::edited(self.from.text(), &name).map_err(Failure::input)?;
        Scenario::parse(&text, Path::new("NAME")).map_err(Failure::input)?;
        let taken = || Failure::input(format!("{} exists; nothing was overwritten", path.display()));
        let trouble = |error: std::io::Error| match error.kind() {
            std::io::ErrorKind::AlreadyExists => taken(),
            _ => Failure::storage(format!("cannot write {}: {error}", path.display())),
        };
        let mut file = std::fs::File::create_new(&path).map_err(trouble)?;
        file.write_all(text.as_bytes()).map_err(trouble)?;
        Ok(writeln!(out, "{}", path.display())?)
    }
}
