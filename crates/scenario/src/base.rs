//! A scenario over a base: it names the base, as in `base: "paper.ron"`, and gives only the fields that
//! differ.
//!
//! A section in round brackets changes the fields that it names and leaves the others as they are. Entries of
//! a table are named, as in `roles: (carrier: (speed_mps: 3.0))`. Any other value, such as a list in square
//! brackets, replaces the value of the base. The base must not have a base itself.

use std::path::{Path, PathBuf};

use ron_tree::{Node, Problem, Value};

use super::carried::beside;
use super::error::{Problems, ScenarioError};
use super::named::{self, Names};
use super::reading::parse_tree;
use super::{ReadText, Scenario};

/// The field that names the base.
const FIELD: &str = "base";

/// Whether a tree names a base.
pub(super) fn is_named_in(root: &Node) -> bool {
    root.get(FIELD).is_some()
}

/// The scenario of a tree that names a base.
pub(super) fn parse(mut over: Node, path: &Path, read: &ReadText<'_>) -> Result<Scenario, ScenarioError> {
    let invalid = |list| ScenarioError::Invalid(Problems { path: path.to_owned(), list });
    let (names, wrong) = named::take_out(&mut over);
    if !wrong.is_empty() {
        return Err(invalid(wrong));
    }
    let base = Base::read(&over, path, names, read)?;
    over.remove(FIELD);
    named::expand(&mut over, &base.names).map_err(|problem| invalid(vec![*problem]))?;
    let (mut tree, mut problems) = (base.scenario.tree(), Vec::new());
    for (name, value) in over.fields() {
        change(&mut tree, &name.to_string(), value, &mut problems);
    }
    let checked = if problems.is_empty() { Scenario::read(tree, &base.names) } else { Err(problems) };
    checked.map_err(|list| invalid(list.into_iter().map(|problem| base.placed(problem, &over)).collect()))
}

/// A base that was read.
struct Base {
    scenario: Scenario,
    path: PathBuf,
    /// As it is written.
    tree: Node,
    /// The values of all names.
    names: Names,
}

impl Base {
    /// Reads the base of a tree, whose path is relative to the folder of the text. The names in `names`
    /// replace those of the base.
    fn read(over: &Node, path: &Path, mut names: Names, read: &ReadText<'_>) -> Result<Self, ScenarioError> {
        let node = over.get(FIELD).unwrap_or(over);
        let wrong = |rule: &str| {
            let problem = Problem { line: over.line(FIELD), ..Problem::new(FIELD, rule, node) };
            ScenarioError::Invalid(Problems { path: path.to_owned(), list: vec![problem] })
        };
        let name = node.as_text().ok_or_else(|| wrong("must be the path of a scenario in quotes"))?;
        if name.is_empty() || Path::new(name).is_absolute() {
            return Err(wrong("must be a path from this file's folder"));
        }
        let path = beside(path, name);
        let tree = parse_tree(&read(&path)?, &path).map_err(|error| error.of_named(name))?;
        if is_named_in(&tree) {
            return Err(wrong("must be a scenario without a base of its own"));
        }
        let scenario = Scenario::parse_with(tree.clone(), &path, &mut names)?;
        Ok(Self { scenario, path, tree, names })
    }

    /// A problem with its line. The line of a field that only the base has is that in the base.
    fn placed(&self, problem: Problem, over: &Node) -> Problem {
        let field = &problem.field;
        if problem.line.is_some() {
            return problem;
        }
        if over.get(field).is_none() && self.tree.get(field).is_some() {
            return Problem { file: Some(self.path.clone()), line: self.tree.line(field), ..problem };
        }
        Problem { line: over.line(field), ..problem }
    }
}

/// Makes the change of a field of a tree, and notes a problem if there is no such field.
fn change(tree: &mut Node, path: &str, value: &Node, problems: &mut Vec<Problem>) {
    let is_section = matches!(&value.value, Value::Struct(name, _) if name.is_empty());
    if is_section && tree.get(path).is_some_and(has_fields) {
        for (name, value) in value.fields() {
            change(tree, &format!("{path}.{name}"), value, problems);
        }
    } else if let Err(problem) = tree.set(path, value.clone(), "a scenario") {
        problems.push(Problem { line: Some(value.place.line as usize), ..*problem });
    }
}

/// Whether a node has fields or named entries, which can be changed one by one.
fn has_fields(node: &Node) -> bool {
    match &node.value {
        Value::Struct(..) => true,
        Value::List(_) => node.get("[0].name").is_some(),
        Value::Word(_) | Value::Text(_) | Value::Tuple(..) | Value::Map(_) => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creates a folder with these files.
    fn folder(files: &[(&str, &str)]) -> PathBuf {
        let name = files.iter().map(|(_, text)| text.len().to_string()).collect::<Vec<_>>().join("-");
        let folder = std::env::temp_dir().join(format!("usar-base-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        files.iter().for_each(|(name, text)| std::fs::write(folder.join(name), text).unwrap());
        folder
    }

    fn scenario(over: &str) -> Result<Scenario, String> {
        let paper = include_str!("../../../scenarios/paper.ron");
        let second = "(base: \"over.ron\", name: \"second\")";
        let folder = folder(&[("paper.ron", paper), ("over.ron", over), ("second.ron", second)]);
        let result = Scenario::load(&folder.join("over.ron")).map(|(scenario, _)| scenario);
        let second = Scenario::load(&folder.join("second.ron"));
        let told = folder.display().to_string();
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(second.is_err(), "a base has no base");
        result.map_err(|error| error.to_string().replace(&format!("{told}/"), ""))
    }

    #[test]
    fn what_is_said_changes_and_the_rest_is_the_bases() {
        let base =
            Scenario::parse(include_str!("../../../scenarios/paper.ron"), "paper.ron".as_ref()).unwrap();
        let over = scenario(
            "(base: \"paper.ron\", name: \"over\", mission: (rest_s: 10.0), roles: (carrier: (speed_mps: \
             3.0)),\n radiation: [],
             tasks: (easy: (grid: (2, 3))), conflicts: (resolver: Rotation(margin_m: 0.3)), team: \
             [(role: \"carrier\", count: 1,
             center: (40, 10), width_m: 0)])",
        )
        .unwrap();
        let mut expected = (*base).clone();
        expected.name = "over".to_owned();
        expected.mission.rest_s = 10.0;
        expected.roles[0].speed_mps = 3.0;
        expected.radiation.clear();
        expected.tasks[1].grid = [2, 3];
        expected.set("conflicts.resolver", "Rotation(margin_m: 0.3)").unwrap();
        expected.set("team", "[(role: \"carrier\", count: 1, center: (40, 10), width_m: 0)]").unwrap();
        assert_eq!(*over, expected);
    }

    #[test]
    fn names_of_the_base_are_known_and_may_have_other_values() {
        let base = include_str!("../../../scenarios/paper.ron").replacen(
            "\n(",
            "\n(values: (rest: 20, near: 3),",
            1,
        );
        let base = base.replacen("rest_s: 30.0", "rest_s: rest", 1);
        let over = "(base: \"named.ron\", name: \"over\", values: (rest: 7, far: 5), mission: (loading_s: \
            near), roles: (carrier: (speed_mps: far)))";
        let wrong = "(base: \"named.ron\", mission: (loading_s: neer))";
        let folder = folder(&[("named.ron", &base), ("over.ron", over), ("wrong.ron", wrong)]);
        let (scenario, _) = Scenario::load(&folder.join("over.ron")).unwrap();
        let expected =
            [("mission.rest_s", "7"), ("mission.loading_s", "3"), ("roles.carrier.speed_mps", "5")];
        let (base, _) = Scenario::load(&folder.join("named.ron")).unwrap();
        let mut file = (*base).clone();
        expected.iter().for_each(|(path, value)| file.set(path, value).unwrap());
        file.name = "over".to_owned();
        assert_eq!(*scenario, file);
        file.set("mission.rest_s", "20").unwrap();
        assert_eq!(base.mission, crate::MissionRules { loading_s: base.mission.loading_s, ..file.mission });
        let error = Scenario::load(&folder.join("wrong.ron")).unwrap_err().to_string();
        assert!(
            error.contains("mission.loading_s must be a number, found neer; did you mean near?"),
            "{error}"
        );
    }

    #[test]
    fn what_is_wrong_is_told_with_its_file_and_line() {
        for (over, says) in [
            ("(base: 3)", "over.ron:1: base must be the path of a scenario in quotes, found 3"),
            (
                "(base: \"/a.ron\")",
                "over.ron:1: base must be a path from this file's folder, found \"/a.ron\"",
            ),
            (
                "(base: \"paper.ron\",\n mission: (rest: 1))",
                "over.ron:2: mission.rest is no field; did you mean rest_s? There are energy_threshold",
            ),
            (
                "(base: \"paper.ron\",\n mission: (rest_s: \"x\"))",
                "over.ron:2: mission.rest_s must be a number, found \"x\"",
            ),
            ("(base: \"paper.ron\",\n\n arena_m: (9, 9))", "paper.ron:"),
            (
                "(base: \"paper.ron\",\n\n mission: (rest_s: -1))",
                "over.ron:3: mission.rest_s must be a number from 0",
            ),
            ("(base: \"second.ron\")", "over.ron:1: base must be a scenario without a base of its own"),
            ("(base: \"paper.ron\"", "over.ron:1:19: `(` of line 1 is not closed"),
        ] {
            let error = scenario(over).unwrap_err();
            assert!(error.starts_with(says), "{over}: {error}");
        }
    }
}
