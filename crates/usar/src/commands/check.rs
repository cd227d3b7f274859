//! `usar check`: validates scenarios and sweep files without running them.

use std::panic::{AssertUnwindSafe, catch_unwind};

use experiments::expect::expectations;
use experiments::experiment::{Experiment, Overrides};
use experiments::panic_message;

use crate::input::tell_warnings_of_all;
use crate::library;
use crate::prelude::*;

/// Validate scenarios and sweep files without running them
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  usar check scenarios/*.ron scenarios/sweeps/*.ron")]
pub(crate) struct Arguments {
    /// Scenario or sweep files (RON)
    #[arg(required = true, value_parser = library::path)]
    files: Vec<PathBuf>,
}

/// Checks one file, and returns a sentence about a sound file.
fn check(file: &Path, registry: &Registry) -> Result<String, Failure> {
    let experiment = Experiment::load(file, &Overrides::default(), registry)?;
    expectations(&experiment, file)?;
    experiment.with_trials(1)?.check_start(file)?;
    tell_warnings_of_all(experiment.cases.iter().map(|case| &case.scenario), &experiment.given, file);
    let cost = experiment.check_cost(false).err();
    Ok(cost.map_or_else(|| "ok".to_owned(), |cost| format!("ok, but expensive: {cost}")))
}

/// Checks each file, and tells all problems at the end. A panic counts as a problem of its file, so that the
/// other files are still checked.
fn check_each(
    files: &[PathBuf],
    check: impl Fn(&Path) -> Result<String, Failure>,
    out: &mut dyn Write,
) -> Result<(), Failure> {
    let mut problems = Vec::new();
    for file in files {
        let checked = catch_unwind(AssertUnwindSafe(|| check(file))).unwrap_or_else(|panic| {
            let reason = panic_message(&*panic);
            Err(Failure::Input(format!("{}: internal error: {reason}", file.display())))
        });
        match checked {
            Ok(told) => writeln!(out, "{}: {told}", file.display())?,
            Err(failure) => problems.push(failure.to_string()),
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(Failure::Input(problems.join("\n"))) }
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        check_each(&self.files, |file| check(file, registry), out)
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
        let mut out = Vec::new();
        let problems =
            check_each(&["a.ron", "b.ron", "c.ron"].map(PathBuf::from), check, &mut out).unwrap_err();
        assert_eq!(String::from_utf8(out).unwrap(), "a.ron: ok\nc.ron: ok\n");
        assert!(matches!(problems, Failure::Input(_)));
        assert!(problems.to_string().starts_with("b.ron: internal error: no such world"), "{problems}");
    }
}
