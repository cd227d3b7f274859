//! Scenarios and sweep files as parts of an experiment, with the line of whatever is wrong.

use std::path::Path;

use ron_fields::Fields;
use usar_sim::scenario::{Problem, Scenario, ScenarioFile, parse_ron};

use super::file::{Map, SweepFile};
use super::{Axis, Parts, Program, Seeds};
use crate::failure::Failure;

/// Most combinations of readings that a sweep may have.
const MAX_READINGS: usize = 10_000;

/// A scenario with fields set by `path=value`.
///
/// # Errors
/// A field that is not there, a value that does not fit it or breaks a rule.
pub fn with_settings(scenario: &Scenario, settings: &[String]) -> Result<Scenario, Failure> {
    let mut file: ScenarioFile = (**scenario).clone();
    for entry in settings {
        let (path, value) = entry
            .split_once('=')
            .ok_or_else(|| Failure::input(format!("--set: must be path=value, found {entry:?}")))?;
        let path = path.trim();
        if !decides(path) {
            return Err(Failure::input(format!(
                "--set: {path}: decides no number of a trial; --policies, --trials and --seed say what is run"
            )));
        }
        file.set(path, value).map_err(|error| Failure::input(format!("--set: {error}")))?;
    }
    checked(file, "--set: ")
}

pub(super) fn from_scenario(text: String, path: &Path) -> Result<(Parts, Vec<Reading>), Failure> {
    let base = Scenario::parse(&text, path).map_err(Failure::input)?;
    let parts = Parts {
        name: base.name.clone(),
        given: text,
        axes: Vec::new(),
        policies: base.sweep.policies.clone(),
        trials: base.sweep.trials,
        seeds: Seeds::From(base.sweep.first_seed),
        is_checked: false,
        is_lean: false,
        program: Program::this(),
        base,
    };
    Ok((parts, Vec::new()))
}

pub(super) fn from_sweep_file(text: String, path: &Path) -> Result<(Parts, Vec<Reading>), Failure> {
    let file: SweepFile = parse_ron(&text, path).map_err(Failure::input)?;
    let fields = Fields::of(&text);
    let bad = |field: &str, reason: &dyn std::fmt::Display| {
        let line = fields.line(field).map_or(String::new(), |line| format!(":{line}"));
        Failure::input(format!("{}{line}: {field}: {reason}", path.display()))
    };
    let usable = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if file.name.is_empty() || file.name.starts_with('.') || !file.name.chars().all(usable) {
        return Err(bad("name", &format!("must be letters, digits, -, _ and ., found {:?}", file.name)));
    }
    let scenario = path.parent().unwrap_or(Path::new("")).join(&file.scenario);
    let (base, _) = Scenario::load(&scenario).map_err(Failure::input)?;
    let mut set: ScenarioFile = (*base).clone();
    if !file.description.is_empty() {
        set.description.clone_from(&file.description);
    }
    for (field, value) in &file.set.0 {
        let place = format!("set.{field:?}");
        set.set(field, value.trim().get_ron()).map_err(|error| bad(&place, &error))?;
    }
    let base = checked(set, &format!("{}: set: ", path.display()))?;
    let axes = axes(file.axes, &base, &bad)?;
    let readings = readings(file.readings, &base, &bad)?;
    if let Some((option, _)) =
        readings.iter().find(|(option, _)| axes.iter().any(|axis| axis.path == format!("rne.{option}")))
    {
        return Err(bad("readings", &format!("{option} is an axis as well")));
    }
    let policies = file.policies.unwrap_or_else(|| base.sweep.policies.clone());
    let seeds = match (file.seeds, file.first_seed) {
        (Some(_), Some(_)) => return Err(bad("seeds", &"must not stand beside first_seed")),
        (Some(list), None) if list.is_empty() => {
            return Err(bad("seeds", &"must have at least one, found none"));
        }
        (Some(list), None) if (1..list.len()).any(|i| list[..i].contains(&list[i])) => {
            return Err(bad("seeds", &"must differ: trials of one seed are one trial"));
        }
        (Some(list), None) => Seeds::Listed(list),
        (None, first) => Seeds::From(first.unwrap_or(base.sweep.first_seed)),
    };
    let listed = if let Seeds::Listed(list) = &seeds { Some(list.len() as u32) } else { None };
    let parts = Parts {
        name: file.name,
        given: text,
        axes,
        policies,
        trials: file.trials.or(listed).unwrap_or(base.sweep.trials),
        seeds,
        is_checked: false,
        is_lean: file.lean,
        program: Program::this(),
        base,
    };
    Ok((parts, readings))
}

type Bad<'a> = dyn Fn(&str, &dyn std::fmt::Display) -> Failure + 'a;

/// Checks each value of each axis alone, so that a wrong one is named with its line.
fn axes(map: Map<Vec<Box<ron::value::RawValue>>>, base: &Scenario, bad: &Bad) -> Result<Vec<Axis>, Failure> {
    let mut axes = Vec::new();
    for (path, values) in map.0 {
        let field = format!("axes.{path:?}");
        let values: Vec<String> = values.iter().map(|value| value.trim().get_ron().to_owned()).collect();
        if values.is_empty() {
            return Err(bad(&field, &"must have at least one value, found none"));
        }
        if !decides(&path) {
            return Err(bad(&field, &"decides no number of a trial, so that it can be no axis"));
        }
        let holds = |outer: &str, inner: &str| {
            inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        if let Some(Axis { path: other, .. }) =
            axes.iter().find(|axis: &&Axis| holds(&axis.path, &path) || holds(&path, &axis.path))
        {
            return Err(bad(&field, &format!("must not be a part of another axis, found {other}")));
        }
        let mut files: Vec<ScenarioFile> = Vec::new();
        for (i, value) in values.iter().enumerate() {
            let entry = format!("{field}[{i}]");
            let mut file: ScenarioFile = (**base).clone();
            file.set(&path, value).map_err(|error| bad(&entry, &error))?;
            if files.contains(&file) {
                return Err(bad(&entry, &format!("must not stand twice, found {value}")));
            }
            files.push(file);
        }
        axes.push(Axis { path, values });
    }
    Ok(axes)
}

/// An option of RNE with its values.
pub(super) type Reading = (String, Vec<String>);

/// Checks each value of each option alone.
fn readings(
    map: Map<Vec<Box<ron::value::RawValue>>>,
    base: &Scenario,
    bad: &Bad,
) -> Result<Vec<Reading>, Failure> {
    let mut readings: Vec<Reading> = Vec::new();
    for (option, values) in map.0 {
        let field = format!("readings.{option:?}");
        let values: Vec<String> = values.iter().map(|value| value.trim().get_ron().to_owned()).collect();
        if values.is_empty() {
            return Err(bad(&field, &"must have at least one value, found none"));
        }
        for (i, value) in values.iter().enumerate() {
            let mut file: ScenarioFile = (**base).clone();
            file.set(&format!("rne.{option}"), value)
                .map_err(|error| bad(&format!("{field}[{i}]"), &error))?;
            if values[..i].contains(value) {
                return Err(bad(&format!("{field}[{i}]"), &format!("must not stand twice, found {value}")));
            }
        }
        readings.push((option, values));
    }
    let count = readings.iter().map(|(_, values)| values.len()).try_fold(1_usize, usize::checked_mul);
    if count.is_none_or(|count| count > MAX_READINGS) {
        return Err(bad("readings", &format!("must be at most {MAX_READINGS} combinations")));
    }
    Ok(readings)
}

/// The policies with every combination of the readings in the place of RNE. One is named by the options in which it differs from the scenario's.
pub(super) fn with_readings(policies: Vec<String>, readings: &[Reading], base: &Scenario) -> Vec<String> {
    let mut combinations = vec![Vec::new()];
    for (option, values) in readings {
        let mut longer = Vec::new();
        for combination in &combinations {
            for value in values {
                let mut file: ScenarioFile = (**base).clone();
                let is_default = file.set(&format!("rne.{option}"), value).is_ok() && file == **base;
                let mut next: Vec<String> = combination.clone();
                next.extend((!is_default).then(|| format!("{option}: {value}")));
                longer.push(next);
            }
        }
        combinations = longer;
    }
    let named = |combination: &Vec<String>| {
        if combination.is_empty() { "RNE".to_owned() } else { format!("RNE({})", combination.join(", ")) }
    };
    let expand = |policy: String| {
        if policy.trim() == "RNE" { combinations.iter().map(named).collect() } else { vec![policy] }
    };
    policies.into_iter().flat_map(expand).collect()
}

pub(super) fn checked(file: ScenarioFile, prefix: &str) -> Result<Scenario, Failure> {
    Scenario::try_from(file).map_err(|problems| {
        let line = |p: &Problem| format!("{prefix}{} {}, found {}", p.field, p.rule, p.found);
        Failure::Input(problems.iter().map(line).collect::<Vec<_>>().join("\n"))
    })
}

/// Whether a field decides numbers: all do but the scenario's name, its description and what a sweep runs by default.
fn decides(path: &str) -> bool {
    let first = path.split(['.', '[']).next().unwrap_or_default();
    !["name", "description", "sweep"].contains(&first)
}
