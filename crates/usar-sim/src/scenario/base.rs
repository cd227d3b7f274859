//! A scenario over a base: it names the base, as in `base: "paper.ron"`, and gives only the fields that
//! differ.
//!
//! A section in round brackets changes the fields that it names and leaves the others as they are. Entries of
//! a table are named, as in `roles: (carrier: (speed_mps: 3.0))`. Any other value, such as a list in square
//! brackets, replaces the value of the base. The base must not have a base itself.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use ron_fields::{Fields, SetError};

use super::error::{Problem, Problems, ScenarioError};
use super::file::ScenarioFile;
use super::named::{self, Names};
use super::{Scenario, read_text};

/// The field that names the base.
const FIELD: &str = "base";

/// The text of a scenario that names a base.
pub(super) struct Overlay<'t> {
    text: Cow<'t, str>,
    path: &'t Path,
    fields: Fields,
    base: PathBuf,
    base_fields: Fields,
}

/// Whether a text names a base.
pub(super) fn is_named_in(text: &str) -> bool {
    Fields::outer(text).value(FIELD).is_some()
}

impl<'t> Overlay<'t> {
    /// The scenario of a text that names a base.
    pub(super) fn parse(text: &'t str, path: &'t Path) -> Result<Scenario, ScenarioError> {
        let fields = Fields::of(text);
        let (base, base_fields) = (PathBuf::new(), Fields::of("()"));
        let mut overlay = Overlay { text: text.into(), path, fields, base, base_fields };
        let (names, wrong) = named::names(text);
        if !wrong.is_empty() {
            return Err(overlay.invalid(wrong));
        }
        let (mut file, names) = overlay.read_base(names)?;
        if !names.is_empty() {
            overlay.expand(&names)?;
        }
        let mut problems = Vec::new();
        for name in overlay.fields.inside("") {
            if name != FIELD {
                overlay.change(&mut file, name, &mut problems);
            }
        }
        if !problems.is_empty() {
            problems.iter_mut().for_each(|problem| named::hint(problem, &names));
            return Err(overlay.invalid(problems));
        }
        Scenario::try_from(file).map_err(|problems| overlay.invalid(problems))
    }

    /// Replaces names by their values.
    fn expand(&mut self, names: &Names) -> Result<(), ScenarioError> {
        let text = named::expanded(&self.text, names).map_err(|problem| self.invalid(vec![*problem]))?;
        self.fields = Fields::of(&text);
        self.text = text.into();
        Ok(())
    }

    /// Reads the base, whose path is relative to the folder of the text. The names in `over` replace those of
    /// the base. Returns the values of all names too.
    fn read_base(&mut self, over: Names) -> Result<(ScenarioFile, Names), ScenarioError> {
        let place = self.fields.value(FIELD).unwrap_or_default();
        let written: Result<String, _> = ron::from_str(&self.text[place.clone()]);
        let Ok(name) = written else {
            let found = self.text[place].to_owned();
            return Err(self.wrong_base("must be the path of a scenario in quotes", found));
        };
        if name.is_empty() || Path::new(&name).is_absolute() {
            return Err(self.wrong_base("must be a path from this file's folder", format!("{name:?}")));
        }
        self.base = self.path.parent().unwrap_or(Path::new("")).join(&name);
        let text = read_text(&self.base)?;
        if is_named_in(&text) {
            return Err(self.wrong_base("must be a scenario without a base of its own", format!("{name:?}")));
        }
        let scenario = Scenario::parse_with(&text, &self.base, &over)?;
        self.base_fields = Fields::of(&text);
        let (mut names, _) = named::names(&text);
        names.extend(over);
        Ok(((*scenario).clone(), names))
    }

    fn wrong_base(&self, rule: &str, found: String) -> ScenarioError {
        self.invalid(vec![Problem {
            field: FIELD.to_owned(),
            rule: rule.to_owned(),
            found,
            ..Problem::default()
        }])
    }

    /// Applies the changes of a field, and notes a problem for each change that is not possible.
    fn change(&self, file: &mut ScenarioFile, path: &str, problems: &mut Vec<Problem>) {
        let Some(place) = self.fields.value(path) else { return };
        let (value, names) = (&self.text[place], self.fields.inside(path));
        let is_section = value.starts_with('(') && !names.is_empty();
        if is_section && file.has_fields(path) {
            for name in names {
                self.change(file, &format!("{path}.{name}"), problems);
            }
            return;
        }
        if let Err(error) = file.set(path, value) {
            let problem = match error {
                SetError::Unknown { within, known, meant, .. } => {
                    let meant = meant.map_or(String::new(), |meant| format!("did you mean {meant}? "));
                    let hint = format!("{meant}{within} has {known}");
                    Problem { rule: "is no field".to_owned(), hint, ..Problem::default() }
                }
                SetError::Malformed { reason, found, .. } => {
                    Problem { rule: reason, found, ..Problem::default() }
                }
            };
            problems.push(Problem { field: path.to_owned(), ..problem });
        }
    }

    /// Adds files and lines to problems. The line of a field that only the base has is that in the base.
    fn invalid(&self, mut list: Vec<Problem>) -> ScenarioError {
        for problem in &mut list {
            let field = &problem.field;
            let is_of_base = self.fields.value(field).is_none() && self.base_fields.value(field).is_some();
            if is_of_base {
                problem.file = Some(self.base.clone());
                problem.line = self.base_fields.line(field);
            } else {
                problem.line = self.fields.line(field);
            }
        }
        ScenarioError::Invalid(Problems { path: self.path.to_owned(), list })
    }
}

impl ScenarioFile {
    /// Whether a field has fields or named entries of its own, which can be changed one by one.
    fn has_fields(&self, path: &str) -> bool {
        let text = ron::to_string(self).unwrap_or_default();
        let fields = Fields::of(&text);
        let is_named = fields.value(path).is_some_and(|value| !text[value].starts_with("Some("));
        is_named
            && (!fields.inside(path).is_empty() || fields.canonical(&format!("{path}[0].name")).is_some())
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
        let paper = include_str!("../../../../scenarios/paper.ron");
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
            Scenario::parse(include_str!("../../../../scenarios/paper.ron"), "paper.ron".as_ref()).unwrap();
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
        let base = include_str!("../../../../scenarios/paper.ron").replacen(
            "\n(",
            "\n(values: (rest: 20, near: 3),",
            1,
        );
        let base = base.replacen("rest_s: 30.0", "rest_s: rest", 1);
        let over = "(base: \"named.ron\", name: \"over\", values: (rest: 7, far: 9), mission: (loading_s: \
            near), roles: (carrier: (speed_mps: far)))";
        let wrong = "(base: \"named.ron\", mission: (loading_s: neer))";
        let folder = folder(&[("named.ron", &base), ("over.ron", over), ("wrong.ron", wrong)]);
        let (scenario, _) = Scenario::load(&folder.join("over.ron")).unwrap();
        let expected =
            [("mission.rest_s", "7"), ("mission.loading_s", "3"), ("roles.carrier.speed_mps", "9")];
        let (base, _) = Scenario::load(&folder.join("named.ron")).unwrap();
        let mut file = (*base).clone();
        expected.iter().for_each(|(path, value)| file.set(path, value).unwrap());
        file.name = "over".to_owned();
        assert_eq!(*scenario, file);
        file.set("mission.rest_s", "20").unwrap();
        assert_eq!(
            base.mission,
            crate::scenario::MissionRules { loading_s: base.mission.loading_s, ..file.mission }
        );
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
                "over.ron:2: mission.rest is no field; did you mean rest_s? mission has energy_threshold",
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
