//! `usar scenario list`: lists the available scenarios, policies, roles or metrics.

use clap::ValueEnum;
use experiments::metric::Catalogue;
use usar_sim::scenario::{RoleKind, Scenario};

use crate::input::load;
use crate::library;
use crate::prelude::*;

/// List scenarios, policies, roles or metrics, a line each
#[derive(Debug, Args)]
#[command(after_help = "\
A line begins with the name, then a tab and what it is. Roles and metrics are those of a scenario.

Examples:
  usar scenario list                                the scenarios that the program carries
  usar scenario list scenarios my-scenarios         those of a folder
  usar scenario list policies                       with their options and defaults
  usar scenario list roles paper
  usar scenario list metrics warehouse")]
pub(crate) struct Arguments {
    /// What to list
    #[arg(value_enum, default_value = "scenarios")]
    of: Of,
    /// A folder of scenarios, or the scenario whose roles and metrics are listed [default: what the program
    /// carries, and of that the scenario `paper`]
    #[arg(value_parser = library::path)]
    path: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Of {
    /// Scenarios
    Scenarios,
    /// Grouping policies
    Policies,
    /// Roles of a scenario
    Roles,
    /// What is measured of a trial
    Metrics,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        match self.of {
            Of::Scenarios => match &self.path {
                Some(path) => scenarios(out, path),
                None => carried(out),
            },
            Of::Policies => policies(out, registry),
            Of::Roles => roles(out, &self.scenario()?),
            Of::Metrics => metrics(out, &self.scenario()?),
        }
    }

    /// The scenario that was named, or the paper's.
    fn scenario(&self) -> Result<Scenario, Failure> {
        let Ok(paper) = library::path("paper");
        Ok(load(self.path.as_deref().unwrap_or(&paper))?.0)
    }
}

/// Lists the scenarios that the program carries.
fn carried(out: &mut dyn Write) -> Result<(), Failure> {
    for (name, text) in library::scenarios() {
        let scenario = Scenario::parse(text, Path::new(name)).map_err(Failure::input)?;
        writeln!(out, "{name}\t{}", scenario.description)?;
    }
    Ok(())
}

/// Lists the scenarios of a folder by name; files that are not scenarios are left out.
fn scenarios(out: &mut dyn Write, folder: &Path) -> Result<(), Failure> {
    let entries = std::fs::read_dir(folder)
        .map_err(|error| Failure::input(format!("{}: cannot be read: {error}", folder.display())))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|kind| kind == "ron"));
    files.sort();
    for path in files {
        if let Ok((scenario, _)) = Scenario::load(&path) {
            writeln!(out, "{}\t{}", path.display(), scenario.description)?;
        }
    }
    Ok(())
}

fn policies(out: &mut dyn Write, registry: &Registry) -> Result<(), Failure> {
    for kind in registry.kinds() {
        writeln!(out, "{}\t{} {}", kind.name, kind.about, kind.defaults)?;
    }
    Ok(())
}

fn roles(out: &mut dyn Write, scenario: &Scenario) -> Result<(), Failure> {
    for role in &scenario.roles {
        let rows = scenario.team.iter().filter(|row| row.role == role.name);
        let count: u32 = rows.map(|row| row.count).sum();
        let moves = match role.kind {
            RoleKind::Ground => "drives",
            RoleKind::Aerial => "flies",
        };
        writeln!(
            out,
            "{}\t{count} robots; {moves} at {} m/s, senses {} m, carries {}, has {} resources",
            role.name, role.speed_mps, role.sensing_m, role.capacity, role.resources
        )?;
    }
    Ok(())
}

fn metrics(out: &mut dyn Write, scenario: &Scenario) -> Result<(), Failure> {
    for metric in Catalogue::of(scenario).iter() {
        let unit = if metric.unit.is_empty() { String::new() } else { format!(" In {}.", metric.unit) };
        writeln!(out, "{}\t{}{unit}", metric.name, metric.meaning)?;
    }
    Ok(())
}
