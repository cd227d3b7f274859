//! Reads scenarios and sweep files as parts of an experiment. Errors name the line.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use ron_fields::Fields;
use ron_fields::limits::Limit;
use ron_fields::nearest;
use usar_sim::scenario::{FORMAT, Problem, Scenario, ScenarioFile, parse_ron, read_text};

use xxhash_rust::xxh3::xxh3_128;

use super::file::{Map, SweepFile};
use super::grid::{VARIANT, check_bytes};
use super::policy::{PolicySpec, registry};
use super::{Axis, Keep, Parts, Seeds};
use crate::failure::Failure;
use crate::limits;

/// A scenario with fields set by `path=value`.
///
/// # Errors
/// An unknown field, or a value that does not fit the field or breaks a rule.
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

/// The sweep file that belongs to a scenario: `paper.sweep.ron` beside `paper.ron`.
#[must_use]
pub fn companion(scenario: &Path) -> PathBuf {
    scenario.with_extension("sweep.ron")
}

/// The first policy and the first seed of a scenario's sweep.
///
/// # Errors
/// A scenario or a companion that cannot be used.
pub fn defaults(scenario: &Path) -> Result<(String, u64), Failure> {
    let (parts, _) = from_scenario(read_text(scenario).map_err(Failure::input)?, scenario)?;
    let seed = match &parts.seeds {
        Seeds::From(first) => *first,
        Seeds::Listed(list) => list.first().copied().unwrap_or(1),
    };
    Ok((parts.policies.into_iter().next().unwrap_or_default(), seed))
}

/// The sweep of a scenario: its companion's sweep, or one trial of RNE.
pub(super) fn from_scenario(text: String, path: &Path) -> Result<(Parts, Vec<Reading>), Failure> {
    let companion = companion(path);
    if companion.is_file() {
        Scenario::parse(&text, path).map_err(Failure::input)?;
        let sweep = read_text(&companion).map_err(Failure::input)?;
        let file: SweepFile = parse_ron(&sweep, &companion).map_err(Failure::input)?;
        if Path::new(&file.scenario).file_name() != path.file_name() {
            return Err(Failure::input(format!(
                "{}: scenario: must be \"{}\", whose sweep this is, found {:?}",
                companion.display(),
                path.file_name().unwrap_or_default().display(),
                file.scenario
            )));
        }
        return from_sweep_file(sweep, &companion);
    }
    let base = Scenario::parse(&text, path).map_err(Failure::input)?;
    let parts = Parts {
        name: base.name.clone(),
        given: text,
        axes: Vec::new(),
        policies: vec!["RNE".to_owned()],
        trials: 1,
        seeds: Seeds::From(1),
        is_checked: false,
        keep: Keep::default(),
        program: None,
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
    let format = file.format.unwrap_or(FORMAT);
    if format != FORMAT {
        return Err(bad("format", &format!("must be {FORMAT}, which this program reads, found {format}")));
    }
    let usable = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if file.name.is_empty() || file.name.starts_with(['.', '-']) || !file.name.chars().all(usable) {
        let rule = "must be letters, digits, -, _ and ., the first no . and no -";
        return Err(bad("name", &format!("{rule}, found {:?}", file.name)));
    }
    let too_many = |field: &str, count: usize, limit: Limit| {
        bad(field, &format!("must have at most {} entries, found {count}", limit.most))
    };
    for (field, count, limit) in [
        ("set", file.set.0.len(), limits::SETTINGS),
        ("axes", file.axes.0.len(), limits::AXES),
        ("policies", file.policies.as_ref().map_or(1, Vec::len), limits::POLICIES),
    ] {
        if count > limit.count() {
            return Err(too_many(field, count, limit));
        }
    }
    if let Some(trials) = file.trials.filter(|trials| !limits::TRIALS.allows(*trials as usize)) {
        let most = limits::TRIALS.most;
        return Err(bad("trials", &format!("must be a count from 1 to {most}, found {trials}")));
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
    let variants = variants(file.variants, &base, &bad)?;
    let axes = axes(file.axes, &base, (variants, &bad))?;
    let readings = readings(file.readings, &bad)?;
    let policies = file.policies.unwrap_or_else(|| vec!["RNE".to_owned()]);
    let mut labels = Vec::new();
    for (i, policy) in policies.iter().enumerate() {
        let spec = PolicySpec::parse(policy).map_err(|error| bad(&format!("policies[{i}]"), &error))?;
        labels.push(spec.label);
    }
    let is_reading = |name: &str| !readings.is_empty() && name.starts_with("RNE(");
    if let Some(baseline) = file.baseline.as_deref().filter(|name| !is_reading(name)) {
        check_baseline(baseline, &labels).map_err(|problem| bad("baseline", &problem))?;
    }
    let seeds = match (file.seeds, file.first_seed) {
        (Some(_), Some(_)) => return Err(bad("seeds", &"must not be given beside first_seed")),
        (Some(list), None) if list.is_empty() => {
            return Err(bad("seeds", &"must have at least one, found none"));
        }
        (Some(list), None) if !limits::SEEDS.allows(list.len()) => {
            return Err(too_many("seeds", list.len(), limits::SEEDS));
        }
        (Some(list), None) if list.iter().collect::<BTreeSet<_>>().len() < list.len() => {
            return Err(bad("seeds", &"must differ: trials of one seed are one trial"));
        }
        (Some(list), None) => Seeds::Listed(list),
        (None, first) => Seeds::From(first.unwrap_or(1)),
    };
    let listed = if let Seeds::Listed(list) = &seeds { Some(list.len() as u32) } else { None };
    let parts = Parts {
        name: file.name,
        given: text,
        axes,
        policies,
        trials: file.trials.or(listed).unwrap_or(1),
        seeds,
        is_checked: false,
        keep: file.keep,
        program: None,
        base,
    };
    Ok((parts, readings))
}

/// The path of a field with indices instead of the names of list entries: `roles[0].speed_mps` for
/// `roles.carrier.speed_mps`.
pub(super) fn canonical(scenario: &Scenario, path: &str) -> String {
    Fields::of(&scenario.resolved()).canonical(path).unwrap_or_else(|| path.to_owned())
}

/// Checks that a baseline is one of the policies of its sweep.
fn check_baseline(found: &str, policies: &[String]) -> Result<(), String> {
    if policies.iter().any(|policy| policy == found) {
        return Ok(());
    }
    let meant = nearest(found, policies.iter().map(String::as_str));
    let hint = meant.map_or(String::new(), |meant| format!("; did you mean {meant}?"));
    Err(format!("must be a policy of the sweep ({}), found {found:?}{hint}", policies.join(", ")))
}

type Bad<'a> = dyn Fn(&str, &dyn std::fmt::Display) -> Failure + 'a;

/// Checks each value of each axis alone, so that an error names the wrong value and its line.
fn axes(
    map: Map<Vec<Box<ron::value::RawValue>>>,
    base: &Scenario,
    (variants, bad): (Option<Axis>, &Bad),
) -> Result<Vec<Axis>, Failure> {
    let mut axes: Vec<Axis> = variants.into_iter().collect();
    for (path, values) in map.0 {
        let field = format!("axes.{path:?}");
        let values: Vec<String> = values.iter().map(|value| value.trim().get_ron().to_owned()).collect();
        if values.is_empty() {
            return Err(bad(&field, &"must have at least one value, found none"));
        }
        if !limits::AXIS_VALUES.allows(values.len()) {
            let most = limits::AXIS_VALUES.most;
            return Err(bad(&field, &format!("must have at most {most} values, found {}", values.len())));
        }
        if !decides(&path) {
            return Err(bad(&field, &"decides no number of a trial, so that it can be no axis"));
        }
        let holds = |outer: &str, inner: &str| {
            inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        let here = canonical(base, &path);
        let overlaps = |axis: &&Axis| {
            axis.paths().any(|path| {
                let there = canonical(base, path);
                holds(&there, &here) || holds(&here, &there)
            })
        };
        if let Some(Axis { path: other, .. }) = axes.iter().find(overlaps) {
            return Err(bad(&field, &format!("must not be a part of another axis, found {other}")));
        }
        check_bytes(base, values.len())?;
        let mut files = BTreeSet::new();
        for (i, value) in values.iter().enumerate() {
            let entry = format!("{field}[{i}]");
            let mut file: ScenarioFile = (**base).clone();
            file.set(&path, value).map_err(|error| bad(&entry, &error))?;
            if !files.insert(xxh3_128(ron::to_string(&file).map_err(Failure::input)?.as_bytes())) {
                return Err(bad(&entry, &format!("must not be listed twice, found {value}")));
            }
        }
        axes.push(Axis { path, values, variants: Vec::new() });
    }
    Ok(axes)
}

/// Checks each variant alone.
fn variants(
    map: Map<Map<Box<ron::value::RawValue>>>,
    base: &Scenario,
    bad: &Bad,
) -> Result<Option<Axis>, Failure> {
    if map.0.is_empty() {
        return Ok(None);
    }
    if !limits::AXIS_VALUES.allows(map.0.len()) {
        let most = limits::AXIS_VALUES.most;
        return Err(bad("variants", &format!("must have at most {most} entries, found {}", map.0.len())));
    }
    check_bytes(base, map.0.len())?;
    let mut axis = Axis { path: VARIANT.to_owned(), values: Vec::new(), variants: Vec::new() };
    let mut files = BTreeSet::new();
    for (name, settings) in map.0 {
        let field = format!("variants.{name:?}");
        if name.trim().is_empty()
            || name.chars().any(char::is_control)
            || name.starts_with(['=', '+', '-', '@'])
        {
            return Err(bad(
                &field,
                &"must have a name of visible characters that does not begin like a formula",
            ));
        }
        let mut file: ScenarioFile = (**base).clone();
        let mut set = Vec::new();
        for (path, value) in settings.0 {
            let (entry, value) = (format!("{field}.{path:?}"), value.trim().get_ron().to_owned());
            if !decides(&path) {
                return Err(bad(&entry, &"decides no number of a trial, so that no variant can set it"));
            }
            file.set(&path, &value).map_err(|error| bad(&entry, &error))?;
            set.push((path, value));
        }
        if !files.insert(xxh3_128(ron::to_string(&file).map_err(Failure::input)?.as_bytes())) {
            return Err(bad(&field, &"is the same scenario as a variant before it"));
        }
        axis.values.push(name);
        axis.variants.push(set);
    }
    Ok(Some(axis))
}

/// An option of RNE with its values.
pub(super) type Reading = (String, Vec<String>);

/// Checks each value of each option alone.
fn readings(map: Map<Vec<Box<ron::value::RawValue>>>, bad: &Bad) -> Result<Vec<Reading>, Failure> {
    let mut readings: Vec<Reading> = Vec::new();
    for (option, values) in map.0 {
        let field = format!("readings.{option:?}");
        let values: Vec<String> = values.iter().map(|value| value.trim().get_ron().to_owned()).collect();
        if values.is_empty() {
            return Err(bad(&field, &"must have at least one value, found none"));
        }
        if !limits::AXIS_VALUES.allows(values.len()) {
            let most = limits::AXIS_VALUES.most;
            return Err(bad(&field, &format!("must have at most {most} values, found {}", values.len())));
        }
        for (i, value) in values.iter().enumerate() {
            registry()
                .make("RNE", &format!("({option}: {value})"))
                .map_err(|error| bad(&format!("{field}[{i}]"), &error))?;
            if values[..i].contains(value) {
                return Err(bad(
                    &format!("{field}[{i}]"),
                    &format!("must not be listed twice, found {value}"),
                ));
            }
        }
        readings.push((option, values));
    }
    let count = readings.iter().map(|(_, values)| values.len()).try_fold(1_usize, usize::checked_mul);
    if count.is_none_or(|count| !limits::READINGS.allows(count)) {
        return Err(bad("readings", &format!("must be at most {} combinations", limits::READINGS.most)));
    }
    Ok(readings)
}

/// The policies, with RNE replaced by every combination of the readings. Each combination is named by the
/// options that differ from the default.
pub(super) fn with_readings(policies: Vec<String>, readings: &[Reading]) -> Vec<String> {
    let all_options = |text: &str| registry().make("RNE", text).ok().map(|made| made.options);
    let default = all_options("");
    let mut combinations = vec![Vec::new()];
    for (option, values) in readings {
        let mut longer = Vec::new();
        for combination in &combinations {
            for value in values {
                let is_default = all_options(&format!("({option}: {value})")) == default;
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
        let line = |p: &Problem| format!("{prefix}{p}");
        Failure::Input(problems.iter().map(line).collect::<Vec<_>>().join("\n"))
    })
}

/// Whether a field decides numbers: not the scenario's name, its description, nor `only_policy`.
fn decides(path: &str) -> bool {
    let first = path.split(['.', '[']).next().unwrap_or_default();
    !["name", "description", "only_policy"].contains(&first)
}
