//! `usar new`: writes a commented scenario to start from, or a policy.

mod policy;

use clap::Subcommand;
use scenario::{Scenario, read_text};

use crate::library;
use crate::output::{create_new, trouble};
use crate::prelude::*;

/// Write a commented scenario or policy to begin with
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
#[command(disable_help_subcommand = true)]
#[command(after_help = "\
Writes NAME.ron, which must not exist yet. Every field is optional that the comments call so; edit the file, \
then `usar check NAME.ron`. `usar new policy` writes a policy in a language of your own.

Examples:
  usar new mine                            a small mission: four robots, one task
  usar new mine --from paper               the paper's scenario with all its values
  usar new mine --from warehouse
  usar new mine && usar run mine.ron
  usar new policy mine --lang python       a policy in Python: mine.py")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    what: Option<What>,
    /// Name of the scenario: letters, digits, `-`, `_` and `.`
    #[arg(required = true)]
    name: Option<String>,
    /// Scenario to begin with: a file, or one of `usar scenario list` [default: a small mission]
    #[arg(long, value_name = "SCENARIO", value_parser = library::path)]
    from: Option<PathBuf>,
    /// File or folder to write [default: this folder]
    #[arg(long)]
    out: Option<PathBuf>,
}

/// What else can be begun.
#[derive(Debug, Subcommand)]
enum What {
    Policy(policy::Arguments),
}

/// As little as a mission needs.
const MINIMAL: &str = include_str!("../../assets/minimal.ron");

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let name = match (&self.what, &self.name) {
            (Some(What::Policy(policy)), _) => return policy.execute(registry),
            (None, Some(name)) => name,
            (None, None) => refuse!("NAME: must be given"),
        };
        let folder = self.out.as_deref().unwrap_or(Path::new(""));
        let path = folder.join(format!("{name}.ron"));
        let name = [("name".to_owned(), format!("{name:?}"))];
        let from = self.from.as_deref().map(read_text).transpose().map_err(Failure::input)?;
        let text = ron_tree::edited(from.as_deref().unwrap_or(MINIMAL), &name).map_err(Failure::input)?;
        Scenario::parse(&text, Path::new("NAME")).map_err(Failure::input)?;
        let written = create_new("NAME", &path)?.write_all(text.as_bytes());
        written.map_err(|error| trouble("NAME", &path, &error))?;
        Ok(path.display().to_string().into())
    }
}
