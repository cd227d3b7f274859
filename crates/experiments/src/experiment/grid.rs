//! The grid that the axes of a sweep span, and the policies at each of its points.

use usar_sim::scenario::{Scenario, ScenarioFile};

use super::policy::PolicySpec;
use super::read::checked;
use crate::failure::Failure;
use crate::run::Driver;

/// Most cases that the axes of a sweep may span.
const MAX_CASES: usize = 100_000;

/// A field of the scenario and the values that it takes, in RON.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Axis {
    /// Path of the field.
    pub path: String,
    /// Its values.
    pub values: Vec<String>,
}

/// One point of the grid that the axes span.
pub struct Case {
    /// The value of each axis, in RON.
    pub values: Vec<String>,
    /// The scenario there.
    pub scenario: Scenario,
    /// What answers there for each of the sweep's policies.
    pub drivers: Vec<Driver>,
}

/// The policies of a sweep, each once.
///
/// # Errors
/// One that cannot be read, or none.
pub(super) fn checked_policies(written: &[String]) -> Result<Vec<PolicySpec>, Failure> {
    let mut policies: Vec<PolicySpec> = Vec::new();
    for text in written {
        let policy = PolicySpec::parse(text).map_err(|error| Failure::input(format!("policies: {error}")))?;
        if policies.iter().any(|known| known.label == policy.label) {
            return Err(Failure::input(format!(
                "policies: must not be listed twice, found {:?}",
                policy.label
            )));
        }
        policies.push(policy);
    }
    if policies.is_empty() {
        return Err(Failure::input("policies: must name at least one policy, found none"));
    }
    Ok(policies)
}

/// The full grid, the last axis fastest.
///
/// # Errors
/// It is too large, or a case cannot be used.
pub(super) fn cases(base: &Scenario, axes: &[Axis], policies: &[PolicySpec]) -> Result<Vec<Case>, Failure> {
    let count = axes.iter().try_fold(1_usize, |count, axis| count.checked_mul(axis.values.len()));
    if count.is_none_or(|count| count > MAX_CASES) {
        return Err(Failure::input(format!("axes: must span at most {MAX_CASES} cases")));
    }
    let mut grid: Vec<Vec<&str>> = vec![Vec::new()];
    for axis in axes {
        grid = grid
            .iter()
            .flat_map(|case| {
                axis.values.iter().map(move |value| [case.as_slice(), &[value.as_str()]].concat())
            })
            .collect();
    }
    let case = |values: Vec<&str>| {
        let mut file: ScenarioFile = (**base).clone();
        let places = axes.iter().zip(&values).map(|(axis, value)| format!("{}={value}: ", axis.path));
        let place = places.collect::<Vec<_>>().concat();
        for (axis, value) in axes.iter().zip(&values) {
            file.set(&axis.path, value).map_err(|error| Failure::input(format!("axes: {error}")))?;
        }
        let scenario = checked(file, &place)?;
        let made = policies.iter().map(PolicySpec::driver);
        let drivers =
            made.collect::<Result<_, _>>().map_err(|error| Failure::input(format!("{place}{error}")))?;
        Ok(Case { values: values.into_iter().map(str::to_owned).collect(), scenario, drivers })
    };
    grid.into_iter().map(case).collect()
}

/// What of a scenario decides numbers, as text: all but its name and its description.
pub(super) fn deciding_text(scenario: &Scenario) -> String {
    let mut file: ScenarioFile = (**scenario).clone();
    file.name = String::new();
    file.description = String::new();
    ron::to_string(&file).unwrap_or_default()
}
