//! Scenarios: read from RON and checked, so that every [`Scenario`] is usable.

mod base;
mod carried;
mod checker;
mod debris;
mod deceit;
mod defaults;
mod distribution;
mod draws;
mod errands;
mod error;
mod feasibility;
mod file;
mod homes;
pub mod limits;
mod named;
mod partial;
mod places;
mod ranges;
mod rates;
mod reading;
mod rules;
mod scatter;
mod schema;
mod schema_ranges;
pub mod seed;
mod set;
pub mod shapes;
mod steps;
mod telemetry;
mod timeline;
mod validate;
mod warnings;
mod words;

use std::ops::Deref;
use std::path::Path;

use ron_tree::Node;
use ron_tree::file::MAX_TEXT_BYTES;
use teaming::question::hardest_first;
use teaming::{RoleId, TaskId};

pub use carried::{CARRIED, beside, carry, is_file};
pub use checker::{NOT_MISTAKEN, is_mistaken};
pub use debris::LEAST_POLYGON_WIDTH_M;
pub use deceit::rounded_share;
pub use error::{LayoutError, Location, Problem, Problems, ScenarioError};
pub use file::*;
pub use rates::{Rates, WorkRates};
pub use reading::{ReadText, formatted, parse_ron, parse_tree, read_text};
pub use schema::scenario_schema;
pub use words::Words;

/// The format of scenario files that this program reads.
pub const FORMAT: u32 = 2;

/// Most radii for which ground routes are planned separately. Each radius costs a map of the known obstacles.
pub const MAX_RADIUS_CLASSES: usize = 4;

/// A scenario of which every value was checked. It dereferences to the [`ScenarioFile`] from which it was
/// made.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario(ScenarioFile);

impl Deref for Scenario {
    type Target = ScenarioFile;

    fn deref(&self) -> &ScenarioFile {
        &self.0
    }
}

impl TryFrom<ScenarioFile> for Scenario {
    type Error = Vec<Problem>;

    fn try_from(file: ScenarioFile) -> Result<Self, Vec<Problem>> {
        let problems = validate::problems(&file);
        if problems.is_empty() { Ok(Self(file)) } else { Err(problems) }
    }
}

/// Factor by which spelling out every default lengthens a scenario at most.
const LONGEST_IN_FULL: u64 = 32;

impl Scenario {
    /// Reads and checks a file; returns the scenario and its text.
    ///
    /// # Errors
    /// The file is missing, a folder, not text or too large; the text is not a scenario; or values break
    /// rules.
    pub fn load(path: &Path) -> Result<(Self, String), ScenarioError> {
        let text = read_text(path)?;
        let scenario = Self::parse(&text, path)?;
        scenario.check_can_be_read_again(&text, path)?;
        Ok((scenario, text))
    }

    /// Checks that the scenario with every default spelled out, as results hold it, is a file that can be
    /// read.
    fn check_can_be_read_again(&self, text: &str, path: &Path) -> Result<(), ScenarioError> {
        if text.len() as u64 <= MAX_TEXT_BYTES / LONGEST_IN_FULL {
            return Ok(());
        }
        let in_full = self.resolved();
        let reason = if in_full.len() as u64 > MAX_TEXT_BYTES {
            format!(
                "is {:.1} MiB long when every default is spelled out, as results hold it; at most {} MiB can \
                 be read again",
                in_full.len() as f64 / f64::from(1 << 20),
                MAX_TEXT_BYTES >> 20
            )
        } else {
            let Err(found) = Node::parse(&in_full) else { return Ok(()) };
            format!("{} when every default is spelled out, as results hold it", found.message)
        };
        Err(ScenarioError::Unreadable { path: path.to_owned(), reason })
    }

    /// Checks the text of a scenario. `path` is used in messages, and to find a base that the text names.
    ///
    /// # Errors
    /// The text is not a scenario, or values break rules.
    pub fn parse(text: &str, path: &Path) -> Result<Self, ScenarioError> {
        Self::parse_from(text, path, &read_text)
    }

    /// The same, where `read` gives the text of a base by its path: for programs without files.
    ///
    /// # Errors
    /// Those of [`Scenario::parse`] and of `read`.
    pub fn parse_from(text: &str, path: &Path, read: &ReadText<'_>) -> Result<Self, ScenarioError> {
        let root = parse_tree(text, path)?;
        if base::is_named_in(&root) {
            return base::parse(root, path, read);
        }
        Self::parse_with(root, path, &mut named::Names::new())
    }

    /// Checks the tree of a scenario without a base. The values of the names in `over` replace those in the
    /// tree; the others of the tree are added to them.
    fn parse_with(mut root: Node, path: &Path, over: &mut named::Names) -> Result<Self, ScenarioError> {
        let invalid = |list| ScenarioError::Invalid(Problems { path: path.to_owned(), list });
        let (mut names, wrong) = named::take_out(&mut root);
        if !wrong.is_empty() {
            return Err(invalid(wrong));
        }
        names.append(over);
        *over = names;
        named::expand(&mut root, over).map_err(|problem| invalid(vec![*problem]))?;
        Self::read(root, over).map_err(invalid)
    }

    /// Checks the tree of a scenario in which names are replaced by their values. The names are used in
    /// messages only.
    fn read(mut root: Node, names: &named::Names) -> Result<Self, Vec<Problem>> {
        let (file, mut list) = ScenarioFile::read(&mut root);
        for problem in &mut list {
            named::hint(problem, names);
            distribution::hint(problem);
        }
        let checked = match file {
            Some(file) if list.is_empty() => Self::try_from(file),
            Some(file) => Self::try_from(ScenarioFile { draws: Draws::new(), ..file }),
            None => Err(Vec::new()),
        };
        list.extend(checked.as_ref().err().into_iter().flatten().cloned());
        for problem in list.iter_mut().filter(|problem| problem.line.is_none()) {
            problem.line = root.line(&problem.field);
        }
        list.sort_by_key(|problem| problem.line);
        checked.ok().filter(|_| list.is_empty()).ok_or(list)
    }

    /// Whether a policy, by its name with its options, may run in this scenario.
    pub fn allows(&self, policy: &str) -> bool {
        self.only_policy.is_empty() || self.only_policy == policy
    }

    /// The whole scenario with every value, as text, with one line for each entry of a list.
    pub fn resolved(&self) -> String {
        self.tree().pretty() + "\n"
    }

    /// Number of simulation steps in a trial.
    pub fn steps(&self) -> u64 {
        (self.duration_s / self.dt_s).round() as u64
    }

    /// Number of robots.
    pub fn robots(&self) -> u32 {
        self.team.iter().map(|row| row.count).sum()
    }

    /// The role of a row of the team.
    pub fn role_of(&self, row: &Row) -> RoleId {
        let place = self.roles.iter().position(|role| role.name == row.role);
        RoleId(place.unwrap_or_default() as u16)
    }

    /// The tasks from the hardest to the easiest.
    pub fn hardest_first(&self) -> Vec<TaskId> {
        hardest_first(self.tasks.iter().map(|task| task.difficulty))
    }

    /// Radii for which ground routes are planned, in ascending order, in metres: those of the team's ground
    /// robots. If there are more than [`MAX_RADIUS_CLASSES`], robots use the routes of the next larger radius
    /// that is kept. There is at least one radius; it is 0 if the team has no ground robot.
    pub fn ground_radii_m(&self) -> Vec<f64> {
        let roles = self.team.iter().filter_map(|row| self.body_of(row));
        let ground = roles.filter(|role| role.kind == RoleKind::Ground);
        let mut radii: Vec<f64> = ground.map(|role| role.radius_m).collect();
        radii.sort_by(f64::total_cmp);
        radii.dedup();
        let all = radii.len();
        if all > MAX_RADIUS_CLASSES {
            radii = (1..=MAX_RADIUS_CLASSES).map(|i| radii[i * all / MAX_RADIUS_CLASSES - 1]).collect();
        }
        if radii.is_empty() { vec![0.0] } else { radii }
    }

    /// Radius of the largest robot of this kind in the team, in metres; 0 if there is none.
    pub fn largest_radius_m(&self, kind: RoleKind) -> f64 {
        let roles = self.team.iter().filter_map(|row| self.body_of(row));
        roles.filter(|role| role.kind == kind).map(|role| role.radius_m).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scenario_that_results_could_not_hold_is_refused() {
        let text = include_str!("../../../scenarios/minimal/stranded.ron");
        let mut scenario = Scenario::parse(text, "stranded.ron".as_ref()).unwrap();
        let long = " ".repeat(1 << 20);
        assert!(scenario.check_can_be_read_again(&long, "a.ron".as_ref()).is_ok());
        let one = scenario.0.debris[0].clone();
        scenario.0.debris = vec![one; 80_000];
        let refused = scenario.check_can_be_read_again(&long, "a.ron".as_ref()).unwrap_err().to_string();
        assert!(refused.contains("MiB long when every default is spelled out"), "{refused}");
    }
}
