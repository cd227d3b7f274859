//! Checks a scenario, and tells every mistake with its place.

use std::path::Path;

use scenario::{Problem, Problems, Scenario, ScenarioError};
use serde::Serialize;

use crate::texts::{Texts, plain};

/// What a check says of a scenario.
#[derive(Serialize)]
pub(crate) struct Checked {
    problems: Vec<Mistake>,
    /// Values that are allowed but unusual, in a sentence each.
    warnings: Vec<String>,
    /// What the scenario is about, if it is sound.
    scenario: Option<Facts>,
}

/// A mistake and its place.
#[derive(Serialize)]
struct Mistake {
    /// The file, if it is the base of the one that was checked.
    file: Option<String>,
    /// Line, from 1.
    line: Option<usize>,
    /// Column, from 1, where it is known.
    column: Option<usize>,
    field: String,
    rule: String,
    found: String,
    hint: String,
    /// All of it in a sentence.
    sentence: String,
}

#[derive(Serialize)]
struct Facts {
    name: String,
    description: String,
    duration_s: f64,
    robots: u32,
    tasks: Vec<String>,
}

/// Checks a scenario.
pub(crate) fn check(texts: &Texts) -> Checked {
    match texts.scenario() {
        Ok(scenario) => Checked {
            problems: Vec::new(),
            warnings: scenario.warnings(&texts.text).iter().map(ToString::to_string).collect(),
            scenario: Some(facts(&scenario)),
        },
        Err(error) => {
            let mut problems = mistakes(error);
            for mistake in &mut problems {
                mistake.file = mistake.file.take().filter(|file| *file != texts.name);
            }
            Checked { problems, warnings: Vec::new(), scenario: None }
        }
    }
}

fn facts(scenario: &Scenario) -> Facts {
    Facts {
        name: scenario.name.clone(),
        description: scenario.description.clone(),
        duration_s: scenario.duration_s,
        robots: scenario.robots(),
        tasks: scenario.tasks.iter().map(|task| task.name.clone()).collect(),
    }
}

fn mistakes(error: ScenarioError) -> Vec<Mistake> {
    match error {
        ScenarioError::Invalid(Problems { path, list }) => {
            list.into_iter().map(|problem| of_problem(problem, &path)).collect()
        }
        ScenarioError::Malformed { path, source } => vec![Mistake {
            file: Some(plain(&path)),
            line: Some(source.line),
            column: Some(source.column),
            sentence: source.message.clone(),
            ..of_rule(source.message)
        }],
        ScenarioError::Unreadable { path, reason } => {
            let sentence = format!("{}: {reason}", path.display());
            vec![Mistake { sentence, ..of_rule(reason) }]
        }
    }
}

/// A mistake in a file, unless it names another one.
fn of_problem(problem: Problem, path: &Path) -> Mistake {
    let sentence = problem.to_string();
    let Problem { field, file, line, rule, found, hint } = problem;
    let file = Some(plain(file.as_deref().unwrap_or(path)));
    Mistake { file, line, column: None, field, rule, found, hint, sentence }
}

/// A mistake of which only the rule is known.
fn of_rule(rule: String) -> Mistake {
    let [field, found, hint, sentence] = Default::default();
    Mistake { file: None, line: None, column: None, field, rule, found, hint, sentence }
}
