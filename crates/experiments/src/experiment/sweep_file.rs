//! Reads a sweep file as parts of an experiment. All its problems are told at once, each with its line.

use std::collections::BTreeSet;
use std::error::Error;
use std::fmt::{self, Display};
use std::mem;
use std::path::Path;

use ron_tree::limits::Limit;
use ron_tree::{Node, nearest};
use scenario::{
    FORMAT, Location, NOT_MISTAKEN, Scenario, ScenarioFile, beside, is_mistaken, parse_ron, parse_tree,
};
use teaming::Registry;
use xxhash_rust::xxh3::xxh3_128;

use super::file::{Map, SweepFile};
use super::grid::{VARIANT, check_bytes};
use super::policy::PolicySpec;
use super::setting::{decides, is_part, overlapping};
use super::{AnalysisPlan, Axis, Parts, Seeds};
use crate::limits;
use crate::metric::Catalogue;
use store::Failure;

/// Most problems that are told at once.
const MOST_PROBLEMS: usize = 20;

/// An option of RNE with its values.
pub(super) type Reading = (String, Vec<String>);

/// The parts of an experiment, and the readings of RNE. It can be run in another scenario than the file's.
pub(super) fn from_sweep_file(
    text: String,
    path: &Path,
    scenario: Option<&Path>,
    registry: &Registry,
) -> Result<(Parts, Vec<Reading>), Failure> {
    let mut file: SweepFile = parse_ron(&text, path).map_err(Failure::input)?;
    let tree = parse_tree(&text, path).map_err(Failure::input)?;
    let mut check = Check { path, tree, registry, problems: Vec::new() };
    check.sizes(&file);
    check.must_be_sound()?; // the rules below take time with each entry
    if let Some(stem) = scenario.and_then(Path::file_stem) {
        file.name = format!("{}-{}", file.name, stem.display());
    }
    let base = check.base(&file, scenario);
    let mut axes = Vec::new();
    if let Some(base) = &base {
        axes.extend(check.variants(&file.variants, base));
        check.axes(&file.axes, base, &mut axes);
        check.questions(&file, base);
    }
    let readings = check.readings(&file.readings);
    let policies = file.policies.clone().unwrap_or_else(|| vec!["RNE".to_owned()]);
    check.policies(&policies, file.baseline.as_deref(), !readings.is_empty());
    let seeds = check.seeds(&file);
    check.must_be_sound()?;
    // Without one there is a problem.
    let base = base.ok_or_else(|| Failure::input(path.display().to_string()))?;
    let listed = if let Seeds::Listed(list) = &seeds { Some(list.len() as u32) } else { None };
    let parts = Parts {
        name: file.name.clone(),
        given: text,
        axes,
        policies,
        registry: registry.clone(),
        trials: file.trials.or(listed).unwrap_or(1),
        seeds,
        is_checked: false,
        plan: AnalysisPlan::of(&file),
        keep: file.keep,
        program: None,
        base,
    };
    Ok((parts, readings))
}

/// What is wrong with a sweep file, line by line.
#[derive(Debug)]
pub struct SweepFileError(Vec<SweepFileProblem>);

#[derive(Debug)]
struct SweepFileProblem {
    place: Location,
    /// The line of the message.
    text: String,
}

impl SweepFileError {
    /// Where the first problem is.
    pub fn place(&self) -> Option<&Location> {
        self.0.first().map(|problem| &problem.place)
    }
}

impl Display for SweepFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown: Vec<&str> =
            self.0.iter().take(MOST_PROBLEMS).map(|problem| problem.text.as_str()).collect();
        f.write_str(&shown.join("\n"))?;
        match self.0.len() - shown.len() {
            0 => Ok(()),
            more => write!(f, "\nand {more} more"),
        }
    }
}

impl Error for SweepFileError {}

/// The rules of a sweep file, and the problems found so far.
struct Check<'a> {
    path: &'a Path,
    tree: Node,
    registry: &'a Registry,
    problems: Vec<SweepFileProblem>,
}

impl Check<'_> {
    fn fail(&mut self, field: &str, reason: &dyn Display) {
        let line = self.tree.line(field);
        let at = line.map_or(String::new(), |line| format!(":{line}"));
        let text = format!("{}{at}: {field}: {reason}", self.path.display());
        let place = Location { file: self.path.to_owned(), line, field: Some(field.to_owned()) };
        self.problems.push(SweepFileProblem { place, text });
    }

    /// Takes the value, or notes why there is none.
    fn take<T>(&mut self, field: &str, result: Result<T, impl Display>) -> Option<T> {
        result.map_err(|reason| self.fail(field, &reason)).ok()
    }

    fn must_be_sound(&mut self) -> Result<(), Failure> {
        if self.problems.is_empty() {
            return Ok(());
        }
        let mut problems = mem::take(&mut self.problems);
        let line =
            |problem: &SweepFileProblem| problem.place.line.filter(|_| problem.place.file == self.path);
        problems.sort_by_key(line);
        Err(Failure::input(SweepFileError(problems)))
    }

    /// Format, name, and how much there is of everything.
    fn sizes(&mut self, file: &SweepFile) {
        let format = file.format.unwrap_or(FORMAT);
        if format != FORMAT {
            self.fail("format", &format!("must be {FORMAT}, which this program reads, found {format}"));
        }
        let usable = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        if file.name.is_empty() || file.name.starts_with(['.', '-']) || !file.name.chars().all(usable) {
            let rule = "must be letters, digits, -, _ and ., the first no . and no -";
            self.fail("name", &format!("{rule}, found {:?}", file.name));
        }
        for (field, count, limit) in [
            ("set", file.set.0.len(), limits::SETTINGS),
            ("axes", file.axes.0.len(), limits::AXES),
            ("policies", file.policies.as_ref().map_or(1, Vec::len), limits::POLICIES),
            ("variants", file.variants.0.len(), limits::AXIS_VALUES),
        ] {
            if count > limit.count() {
                self.fail(field, &too_many(count, limit));
            }
        }
        if let Some(trials) = file.trials.filter(|trials| !limits::TRIALS.allows(*trials as usize)) {
            let most = limits::TRIALS.most;
            self.fail("trials", &format!("must be a count from 1 to {most}, found {trials}"));
        }
    }

    /// The scenario with what the sweep sets in it.
    fn base(&mut self, file: &SweepFile, other: Option<&Path>) -> Option<Scenario> {
        let scenario = other.map_or_else(|| beside(self.path, &file.scenario), Path::to_owned);
        let (base, _) = match Scenario::load(&scenario) {
            Ok(loaded) => loaded,
            Err(error) => {
                let error = if other.is_some() { error } else { error.of_named(&file.scenario) };
                self.problems.push(SweepFileProblem { place: error.place(), text: error.to_string() });
                return None;
            }
        };
        let mut set: ScenarioFile = (*base).clone();
        if !file.description.is_empty() {
            set.description.clone_from(&file.description);
        }
        let (known, tree) = (self.problems.len(), base.tree());
        for (i, (field, value)) in file.set.0.iter().enumerate() {
            let entry = format!("set.{field:?}");
            let result = set.set(field, &value.to_string());
            self.take(&entry, result);
            self.once(&entry, &tree, &file.set.0[..i], field);
        }
        if self.problems.len() > known {
            return None; // what else is wrong may come from that
        }
        let broken = match Scenario::try_from(set) {
            Ok(base) => return Some(base),
            Err(broken) => broken,
        };
        for problem in broken {
            let entry =
                file.set.0.iter().map(|(path, _)| path).find(|path| is_part(&tree, &problem.field, path));
            match entry {
                Some(path) => self.fail(&format!("set.{path:?}"), &problem),
                None => self.fail("set", &problem),
            }
        }
        None
    }

    /// Notes a problem if one of the earlier settings sets the same field, by whatever name.
    fn once(&mut self, entry: &str, tree: &Node, earlier: &[(String, Node)], path: &str) {
        if let Some(other) = overlapping(tree, earlier.iter().map(|(path, _)| path.as_str()), path) {
            self.fail(entry, &format!("must not set a field that another entry sets, found {other}"));
        }
    }

    /// Checks each value of each axis alone, so that a problem names the wrong value and its line.
    fn axes(&mut self, map: &Map<Vec<Node>>, base: &Scenario, axes: &mut Vec<Axis>) {
        let tree = base.tree();
        for (path, values) in &map.0 {
            let field = format!("axes.{path:?}");
            let values = ron_of(values);
            if !self.are_some(&field, &values) {
                continue;
            }
            if !decides(path) {
                self.fail(&field, &"decides no number of a trial, so that it can be no axis");
                continue;
            }
            if let Some(other) = overlapping(&tree, axes.iter().flat_map(Axis::paths), path) {
                self.fail(&field, &format!("must not be a part of another axis, found {other}"));
                continue;
            }
            if self.take(&field, check_bytes(base, values.len())).is_none() {
                continue;
            }
            let mut files = BTreeSet::new();
            for (i, value) in values.iter().enumerate() {
                let entry = format!("{field}[{i}]");
                let mut file: ScenarioFile = (**base).clone();
                let is_set = self.take(&entry, file.set(path, value)).is_some();
                if is_set && !files.insert(hash(&file)) {
                    self.fail(&entry, &format!("must not be listed twice, found {value}"));
                }
            }
            axes.push(Axis { path: path.clone(), values, variants: Vec::new() });
        }
    }

    /// Whether an axis or a reading has values, and not too many.
    fn are_some(&mut self, field: &str, values: &[String]) -> bool {
        if values.is_empty() {
            self.fail(field, &"must have at least one value, found none");
        } else if !limits::AXIS_VALUES.allows(values.len()) {
            let most = limits::AXIS_VALUES.most;
            self.fail(field, &format!("must have at most {most} values, found {}", values.len()));
        }
        limits::AXIS_VALUES.allows(values.len())
    }

    /// The axis of the variants. Each is checked alone.
    fn variants(&mut self, map: &Map<Map<Node>>, base: &Scenario) -> Option<Axis> {
        if map.0.is_empty() || self.take("variants", check_bytes(base, map.0.len())).is_none() {
            return None;
        }
        let mut axis = Axis { path: VARIANT.to_owned(), values: Vec::new(), variants: Vec::new() };
        let (tree, mut files) = (base.tree(), BTreeSet::new());
        for (name, settings) in &map.0 {
            let field = format!("variants.{name:?}");
            let is_hidden = name.trim().is_empty() || name.chars().any(char::is_control);
            if is_hidden || name.starts_with(['=', '+', '-', '@']) {
                let rule = "must have a name of visible characters that does not begin like a formula";
                self.fail(&field, &rule);
            } else if is_mistaken(name) {
                self.fail(&field, &NOT_MISTAKEN);
            }
            let mut file: ScenarioFile = (**base).clone();
            let mut set = Vec::new();
            for (i, (path, value)) in settings.0.iter().enumerate() {
                let (entry, value) = (format!("{field}.{path:?}"), value.to_string());
                self.once(&entry, &tree, &settings.0[..i], path);
                if !decides(path) {
                    self.fail(&entry, &"decides no number of a trial, so that no variant can set it");
                } else if self.take(&entry, file.set(path, &value)).is_some() {
                    set.push((path.clone(), value));
                }
            }
            if set.len() == settings.0.len() && !files.insert(hash(&file)) {
                self.fail(&field, &"is the same scenario as a variant before it");
            }
            axis.values.push(name.clone());
            axis.variants.push(set);
        }
        Some(axis)
    }

    /// Primary metrics and margins.
    fn questions(&mut self, file: &SweepFile, base: &Scenario) {
        let metrics = Catalogue::of(base);
        for (i, name) in file.primary.iter().enumerate() {
            self.take(&format!("primary[{i}]"), metrics.named(name));
        }
        for (name, margin) in &file.margins.0 {
            let field = format!("margins.{name:?}");
            self.take(&field, metrics.named(name));
            if !margin.is_finite() || *margin <= 0.0 {
                self.fail(&field, &format!("must be a number above 0, found {margin}"));
            }
        }
    }

    /// Checks each value of each option of RNE alone.
    fn readings(&mut self, map: &Map<Vec<Node>>) -> Vec<Reading> {
        let mut readings: Vec<Reading> = Vec::new();
        for (option, values) in &map.0 {
            let field = format!("readings.{option:?}");
            let values = ron_of(values);
            if !self.are_some(&field, &values) {
                continue;
            }
            for (i, value) in values.iter().enumerate() {
                let entry = format!("{field}[{i}]");
                self.take(&entry, self.registry.make("RNE", &format!("({option}: {value})")));
                if values[..i].contains(value) {
                    self.fail(&entry, &format!("must not be listed twice, found {value}"));
                }
            }
            readings.push((option.clone(), values));
        }
        let count = readings.iter().map(|(_, values)| values.len()).try_fold(1_usize, usize::checked_mul);
        if count.is_none_or(|count| !limits::READINGS.allows(count)) {
            self.fail("readings", &format!("must be at most {} combinations", limits::READINGS.most));
        }
        readings
    }

    /// Each policy alone, and whether the baseline is one of them.
    fn policies(&mut self, policies: &[String], baseline: Option<&str>, has_readings: bool) {
        let mut labels = Vec::new();
        for (i, policy) in policies.iter().enumerate() {
            let spec = self.take(&format!("policies[{i}]"), PolicySpec::parse(policy, self.registry));
            let Some(label) = spec.map(|spec| spec.label) else { continue };
            if labels.contains(&label) {
                self.fail(&format!("policies[{i}]"), &format!("must not be listed twice, found {label:?}"));
            }
            labels.push(label);
        }
        let is_reading = |name: &str| has_readings && name.starts_with("RNE(");
        if let Some(found) = baseline.filter(|name| !is_reading(name) && labels.len() == policies.len())
            && !labels.iter().any(|label| label == found)
        {
            let meant = nearest(found, labels.iter().map(String::as_str));
            let hint = meant.map_or(String::new(), |meant| format!("; did you mean {meant}?"));
            let known = labels.join(", ");
            self.fail("baseline", &format!("must be a policy of the sweep ({known}), found {found:?}{hint}"));
        }
    }

    fn seeds(&mut self, file: &SweepFile) -> Seeds {
        let Some(list) = &file.seeds else { return Seeds::From(file.first_seed.unwrap_or(1)) };
        if file.first_seed.is_some() {
            self.fail("seeds", &"must not be given beside first_seed");
        } else if list.is_empty() {
            self.fail("seeds", &"must have at least one, found none");
        } else if !limits::SEEDS.allows(list.len()) {
            self.fail("seeds", &too_many(list.len(), limits::SEEDS));
        } else if list.iter().collect::<BTreeSet<_>>().len() < list.len() {
            self.fail("seeds", &"must differ: trials of one seed are one trial");
        } else if let Some(trials) = file.trials.filter(|trials| *trials as usize > list.len()) {
            let most = list.len();
            let rule = format!("must be at most the number of listed seeds, {most}, found {trials}");
            self.fail("trials", &rule);
        }
        Seeds::Listed(list.clone())
    }
}

fn too_many(count: usize, limit: Limit) -> String {
    format!("must have at most {} entries, found {count}", limit.most)
}

fn ron_of(values: &[Node]) -> Vec<String> {
    values.iter().map(ToString::to_string).collect()
}

/// A hash of a whole scenario file.
fn hash(file: &ScenarioFile) -> u128 {
    xxh3_128(file.tree().to_string().as_bytes())
}
