//! The grid that the axes of a sweep span, and the policies of a sweep.

use std::collections::BTreeSet;

use scenario::{Scenario, ScenarioFile, Words};
use store::{Failure, refuse};
use teaming::Registry;

use super::policy::PolicySpec;
use super::setting::checked;
use crate::limits::{CASE_BYTES, CASES, POLICIES};

/// A field of the scenario and the values that it takes, in RON.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Axis {
    /// Path of the field; [`VARIANT`] for an axis of variants.
    pub path: String,
    /// The field's values in RON, or the names of the variants.
    pub values: Vec<String>,
    /// Settings of each variant: paths and values in RON. Empty for an axis of one field.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub variants: Vec<Vec<(String, String)>>,
}

/// Name of an axis of variants.
pub const VARIANT: &str = "variant";

impl Axis {
    /// The settings for one of the axis's values: paths and values in RON.
    pub fn settings<'a>(&'a self, value: &'a str) -> Vec<(&'a str, &'a str)> {
        if self.variants.is_empty() {
            return vec![(&self.path, value)];
        }
        let place = self.values.iter().position(|name| name == value);
        let settings = place.into_iter().flat_map(|place| &self.variants[place]);
        settings.map(|(path, value)| (path.as_str(), value.as_str())).collect()
    }

    /// The fields that the axis sets. A field that several variants set comes once for each of them.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        let own = self.variants.is_empty().then_some(self.path.as_str());
        own.into_iter().chain(self.variants.iter().flatten().map(|(path, _)| path.as_str()))
    }
}

/// One point of the grid that the axes span.
pub struct Case {
    /// The value of each axis, in RON.
    pub values: Vec<String>,
    /// The scenario at this point.
    pub scenario: Scenario,
}

/// The policies of a sweep, each once.
///
/// # Errors
/// A policy cannot be read or is listed twice, or there is none.
pub(super) fn checked_policies(written: &[String], registry: &Registry) -> Result<Vec<PolicySpec>, Failure> {
    if written.len() > POLICIES.count() {
        let most = POLICIES.most;
        refuse!("policies: must be at most {most}, found {}", written.len());
    }
    let (mut policies, mut labels): (Vec<PolicySpec>, _) = (Vec::new(), BTreeSet::new());
    for text in written {
        let policy = PolicySpec::parse(text, registry);
        let policy = policy.map_err(Failure::input_at("policies"))?;
        if !labels.insert(policy.label.clone()) {
            refuse!("policies: must not be listed twice, found {:?}", policy.label);
        }
        policies.push(policy);
    }
    if policies.is_empty() {
        refuse!("policies: must name at least one policy, found none");
    }
    Ok(policies)
}

/// The full grid; the last axis changes fastest.
///
/// # Errors
/// The grid is too large, or a case cannot be used.
pub(super) fn cases(base: &Scenario, axes: &[Axis]) -> Result<Vec<Case>, Failure> {
    let count = axes.iter().try_fold(1_usize, |count, axis| count.checked_mul(axis.values.len()));
    let Some(count) = count.filter(|count| CASES.allows(*count)) else {
        refuse!("axes: must span at most {} cases", CASES.most);
    };
    check_bytes(base, count)?;
    let mut grid = Grid { axes, cases: Vec::with_capacity(count) };
    grid.add((**base).clone(), &mut Vec::new())?;
    Ok(grid.cases)
}

/// Refuses more cases, or values of an axis, than memory holds.
pub(super) fn check_bytes(base: &Scenario, count: usize) -> Result<(), Failure> {
    let bytes = base.resolved().len().saturating_mul(count);
    if count == 1 || CASE_BYTES.allows(bytes) {
        return Ok(());
    }
    let (most, mib) = (CASE_BYTES.count() >> 20, bytes >> 20);
    Err(Failure::input(format!(
        "axes: {count} cases of this scenario take {mib} MiB, at most {most} MiB: fewer cases, or a smaller \
         scenario"
    )))
}

/// The grid while it is built. Each value of an axis is set once for all cases that share the values of the
/// earlier axes.
struct Grid<'a> {
    axes: &'a [Axis],
    cases: Vec<Case>,
}

impl Grid<'_> {
    /// Adds the cases that begin with these values. `file` already has the values set.
    fn add(&mut self, file: ScenarioFile, values: &mut Vec<String>) -> Result<(), Failure> {
        let Some(axis) = self.axes.get(values.len()) else { return self.add_case(file, values) };
        for value in &axis.values {
            let mut file = file.clone();
            for (path, value) in axis.settings(value) {
                file.set(path, value).map_err(Failure::input_at("axes"))?;
            }
            values.push(value.clone());
            self.add(file, values)?;
            values.pop();
        }
        Ok(())
    }

    fn add_case(&mut self, file: ScenarioFile, values: &[String]) -> Result<(), Failure> {
        let places = self.axes.iter().zip(values).map(|(axis, value)| format!("{}={value}: ", axis.path));
        let place = places.collect::<Vec<_>>().concat();
        let scenario = checked(file, &place)?;
        self.cases.push(Case { values: values.to_vec(), scenario });
        Ok(())
    }
}

/// The part of a scenario that decides numbers, as text: everything except its name and its description.
pub(crate) fn deciding_text(scenario: &Scenario) -> String {
    let mut file: ScenarioFile = (**scenario).clone();
    file.name = String::new();
    file.description = String::new();
    file.words = Words::default();
    file.tree().to_string()
}
