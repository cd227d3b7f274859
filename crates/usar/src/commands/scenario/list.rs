//! `usar scenario list`: lists the available scenarios, policies, estimators, protocols, roles or metrics.

use clap::ValueEnum;
use experiments::metric::{Catalogue, Metric};
use scenario::{RoleFile, RoleKind, Scenario};
use serde::Serialize;
use teaming::Kind;

use crate::arguments::JsonArgument;
use crate::input::load;
use crate::library;
use crate::prelude::*;

/// List scenarios, policies, estimators, protocols, roles or metrics, a line each
#[derive(Debug, Args)]
#[command(after_help = "\
A line begins with the name, then a tab and what it is. Roles and metrics are those of a scenario.

Examples:
  usar scenario list                                the scenarios that the program carries
  usar scenario list scenarios my-scenarios         those of a folder
  usar scenario list policies                       with their options and defaults
  usar scenario list estimators                     what may stand behind a policy: RNE <- Kalman
  usar scenario list protocols                      how robots that decide may talk: RNE by Gossip
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
    #[command(flatten)]
    json: JsonArgument,
}

/// A name, and what it is.
#[derive(Serialize)]
struct Listed {
    name: String,
    about: String,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Of {
    /// Scenarios
    Scenarios,
    /// Grouping policies
    Policies,
    /// Estimators of what is true and whom to believe
    Estimators,
    /// How robots talk before they decide
    Protocols,
    /// Roles of a scenario
    Roles,
    /// What is measured of a trial
    Metrics,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let listed = match (self.of, &self.path) {
            (Of::Scenarios, Some(path)) => scenarios(path)?,
            (Of::Scenarios, None) => carried()?,
            (Of::Policies, _) => {
                kinds(registry.kinds(), |name| registry.make(name, "").is_ok_and(|made| made.sees_truth()))
            }
            (Of::Estimators, _) => kinds(registry.estimators(), |name| {
                registry.estimator(name).is_ok_and(|made| made.it.needs_truth())
            }),
            (Of::Protocols, _) => kinds(registry.protocols(), |_| false),
            (Of::Roles, _) => roles(&self.scenario()?),
            (Of::Metrics, _) => metrics(&self.scenario()?),
        };
        let mut out = Report::of(listed.iter().map(|one| format!("{}\t{}", one.name, one.about)));
        out.rows("listed", &listed)?;
        Ok(out)
    }

    /// The scenario that was named, or the paper's.
    fn scenario(&self) -> Result<Scenario, Failure> {
        let Ok(paper) = library::path("paper");
        Ok(load(self.path.as_deref().unwrap_or(&paper))?.0)
    }
}

/// The scenarios that the program carries.
fn carried() -> Result<Vec<Listed>, Failure> {
    let one = |(name, _): (&str, &str)| {
        let Ok(path) = library::path(name);
        let (scenario, _) = load(&path)?;
        Ok(Listed { name: name.to_owned(), about: scenario.description.clone() })
    };
    library::scenarios().map(one).collect()
}

/// The scenarios of a folder by name; files that are not scenarios are left out.
fn scenarios(folder: &Path) -> Result<Vec<Listed>, Failure> {
    let entries = std::fs::read_dir(folder)
        .map_err(|error| Failure::input(format!("{}: cannot be read: {error}", folder.display())))?;
    let mut files: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|kind| kind == "ron"));
    files.sort();
    let one = |path: &PathBuf| {
        let (scenario, _) = Scenario::load(path).ok()?;
        Some(Listed { name: path.display().to_string(), about: scenario.description.clone() })
    };
    Ok(files.iter().filter_map(one).collect())
}

fn kinds<T: ?Sized>(kinds: &[Kind<T>], sees_truth: impl Fn(&str) -> bool) -> Vec<Listed> {
    let about = |kind: &Kind<T>| {
        let truth = if sees_truth(&kind.name) { ", and sees what is true" } else { "" };
        format!("{}{truth} {}", kind.about, kind.defaults)
    };
    kinds.iter().map(|kind| Listed { name: kind.name.clone(), about: about(kind) }).collect()
}

fn roles(scenario: &Scenario) -> Vec<Listed> {
    let one = |role: &RoleFile| {
        let rows = scenario.team.iter().filter(|row| row.role == role.name);
        let count: u32 = rows.map(|row| row.count).sum();
        let moves = match role.kind {
            RoleKind::Ground => "drives",
            RoleKind::Aerial => "flies",
        };
        let about = format!(
            "{count} robots; {moves} at {} m/s, senses {} m, carries {}, has {} resources",
            role.speed_mps, role.sensing_m, role.capacity, role.resources
        );
        Listed { name: role.name.clone(), about }
    };
    scenario.roles.iter().map(one).collect()
}

fn metrics(scenario: &Scenario) -> Vec<Listed> {
    let one = |metric: &Metric| {
        let unit =
            if metric.unit.is_empty() { String::new() } else { format!(" In {}.", metric.unit_in_words) };
        Listed { name: metric.name.clone(), about: format!("{}{unit}", metric.meaning) }
    };
    Catalogue::of(scenario).iter().map(one).collect()
}
