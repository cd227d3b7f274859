//! `usar new`: writes a commented scenario to start from.

use usar_sim::scenario::{Scenario, read_text};

use crate::library;
use crate::output::{create_new, trouble};
use crate::prelude::*;

/// Write a commented scenario to begin with
#[derive(Debug, Args)]
#[command(after_help = "\
Writes NAME.ron, which must not exist yet. Every field is optional that the comments call so; edit the file, \
then `usar check NAME.ron`.

Examples:
  usar new mine                            a small mission: four robots, one task
  usar new mine --from paper               the paper's scenario with all its values
  usar new mine --from warehouse
  usar new mine && usar run mine.ron")]
pub(crate) struct Arguments {
    /// Name of the scenario: letters, digits, `-`, `_` and `.`
    name: String,
    /// Scenario to begin with: a file, or one of `usar scenario list` [default: a small mission]
    #[arg(long, value_name = "SCENARIO", value_parser = library::path)]
    from: Option<PathBuf>,
    /// File or folder to write [default: this folder]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// As little as a mission needs.
const MINIMAL: &str = include_str!("../../assets/minimal.ron");

impl Arguments {
    pub(crate) fn execute(&self, _: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let folder = self.out.as_deref().unwrap_or(Path::new(""));
        let path = folder.join(format!("{}.ron", self.name));
        let name = [("name".to_owned(), format!("{:?}", self.name))];
        let from = self.from.as_deref().map(read_text).transpose().map_err(Failure::input)?;
        let text = ron_tree::edited(from.as_deref().unwrap_or(MINIMAL), &name).map_err(Failure::input)?;
        Scenario::parse(&text, Path::new("NAME")).map_err(Failure::input)?;
        let written = create_new("NAME", &path)?.write_all(text.as_bytes());
        written.map_err(|error| trouble("NAME", &path, &error))?;
        Ok(writeln!(out, "{}", path.display())?)
    }
}
