//! `usar new`: writes a commented scenario to start from.

use clap::ValueEnum;
use usar_sim::scenario::Scenario;

use crate::output::{create_new, trouble};
use crate::prelude::*;

/// Write a commented scenario to begin with
#[derive(Debug, Args)]
#[command(after_help = "\
Writes NAME.ron, which must not exist yet. Every field is optional that the comments call so; edit the file, \
then `usar check NAME.ron`.

Examples:
  usar new mine                            a small mission: four robots, one task
  usar new mine --like paper               the paper's scenario with all its values
  usar new mine --like three-tasks
  usar new mine && usar run mine.ron")]
pub(crate) struct Arguments {
    /// Name of the scenario: letters, digits, `-`, `_` and `.`
    name: String,
    /// What to begin with
    #[arg(long, value_enum, default_value = "minimal")]
    like: Like,
    /// File or folder to write [default: this folder]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// The paper's scenario.
pub(crate) const PAPER: &str = include_str!("../../../../scenarios/paper.ron");

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Like {
    /// As little as a mission needs
    Minimal,
    /// The paper's experiment
    Paper,
    /// Three tasks
    ThreeTasks,
}

impl Like {
    fn text(self) -> &'static str {
        match self {
            Self::Minimal => include_str!("../../assets/minimal.ron"),
            Self::Paper => PAPER,
            Self::ThreeTasks => include_str!("../../../../scenarios/three-tasks.ron"),
        }
    }
}

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let folder = self.out.as_deref().unwrap_or(Path::new(""));
        let path = folder.join(format!("{}.ron", self.name));
        let name = [("name".to_owned(), format!("{:?}", self.name))];
        let text = ron_tree::edited(self.like.text(), &name).map_err(Failure::input)?;
        Scenario::parse(&text, Path::new("NAME")).map_err(Failure::input)?;
        let written = create_new("NAME", &path)?.write_all(text.as_bytes());
        written.map_err(|error| trouble("NAME", &path, &error))?;
        Ok(writeln!(out, "{}", path.display())?)
    }
}
