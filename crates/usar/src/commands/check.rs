//! `usar check`: validates scenarios and sweep files without running them, and policies by random questions.

mod policy;

use std::panic::{AssertUnwindSafe, catch_unwind};

use experiments::expect::expectations;
use experiments::experiment::{Experiment, Overrides};
use experiments::panic_message;
use serde::Serialize;

use crate::arguments::JsonArgument;
use crate::input::{tell_doubts, tell_out_of_reach, tell_warnings_of_all};
use crate::library;
use crate::prelude::*;

/// Check scenarios, sweep files and policies without running them
#[derive(Debug, Args)]
#[command(after_help = "\
With --policy, a policy answers 1,000 random questions, twice, half of them with reports and ratings of \
seven rounds, and is told which answers are against the rules or differ, and how long a decision takes. Exit \
status 1 if any is wrong.

Examples:
  usar check mine.ron mine.sweep.ron
  usar check scenarios/*.ron --json
  usar check --policy 'mine=EXEC(command: [\"python3\", \"mine.py\"])'")]
pub(crate) struct Arguments {
    /// Scenario or sweep files (RON)
    #[arg(required_unless_present = "policy", value_parser = library::path)]
    files: Vec<PathBuf>,
    /// Policy that decides, with its options in brackets [default: none, files are checked]
    #[arg(long, conflicts_with = "files")]
    pub(super) policy: Option<String>,
    #[command(flatten)]
    json: JsonArgument,
}

/// What came of the check of a file.
#[derive(Debug, Serialize)]
struct Checked {
    file: String,
    /// What is said of a sound file.
    told: Option<String>,
    /// The problems of any other, each with its line, field, rule and found value.
    problems: Vec<String>,
}

/// Checks one file, and returns a sentence about a sound file.
fn check(file: &Path, registry: &Registry) -> Result<String, Failure> {
    let experiment = Experiment::load(file, &Overrides::default(), registry)?;
    expectations(&experiment, file)?;
    tell_warnings_of_all(experiment.cases.iter().map(|case| &case.scenario), &experiment.given, file);
    tell_doubts(&experiment, file);
    for policy in &experiment.policies {
        if let Some(command) = policy.made().it.program() {
            tell(format_args!(
                "note: policy {} is a program, which was not started: {command}",
                policy.label
            ));
        }
    }
    tell_out_of_reach(&experiment, file);
    experiment.with_trials(1)?.check_start(file)?;
    let cost = experiment.check_cost(false).err();
    Ok(cost.map_or_else(|| "ok".to_owned(), |cost| format!("ok, but expensive: {cost}")))
}

/// Checks each file. A panic counts as a problem of its file, so that the other files are still checked.
fn check_each(files: &[PathBuf], check: impl Fn(&Path) -> Result<String, Failure>) -> Vec<Checked> {
    let one = |file: &PathBuf| {
        let checked = catch_unwind(AssertUnwindSafe(|| check(file))).unwrap_or_else(|panic| {
            let reason = panic_message(&*panic);
            Err(Failure::input(format!("{}: internal error: {reason}", file.display())))
        });
        let problems = checked
            .as_ref()
            .err()
            .map_or_else(Vec::new, |failure| failure.to_string().lines().map(str::to_owned).collect());
        Checked { file: file.display().to_string(), told: checked.ok(), problems }
    };
    files.iter().map(one).collect()
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        if let Some(policy) = &self.policy {
            return policy::check(policy, registry);
        }
        let checked = check_each(&self.files, |file| check(file, registry));
        let problems: Vec<&str> = checked.iter().flat_map(|one| &one.problems).map(String::as_str).collect();
        let told = |Checked { file, told, .. }: &Checked| Some(format!("{file}: {}", told.as_ref()?));
        let mut out = Report::of(checked.iter().filter_map(told));
        out.rows("files", &checked)?;
        out.print()?;
        if problems.is_empty() { Ok(Report::default()) } else { Err(Failure::input(problems.join("\n"))) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_a_problem_of_its_file_alone() {
        let check = |file: &Path| {
            assert!(!file.ends_with("b.ron"), "no such world");
            Ok("ok".to_owned())
        };
        let checked = check_each(&["a.ron", "b.ron", "c.ron"].map(PathBuf::from), check);
        let told: Vec<Option<&str>> = checked.iter().map(|one| one.told.as_deref()).collect();
        assert_eq!(told, [Some("ok"), None, Some("ok")]);
        let problems = &checked[1].problems;
        assert!(problems[0].starts_with("b.ron: internal error: no such world"), "{problems:?}");
    }
}
