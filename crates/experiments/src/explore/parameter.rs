//! A free parameter of a scenario: the fields that it sets, and the range in which it is searched or varied.

use std::fmt;

use ron_tree::{Node, Problem};
use scenario::ScenarioFile;
use store::{Failure, refuse};

/// Significant digits of a candidate value. With so few digits, the log and the calibrated scenario hold
/// exactly the value that was run.
const DIGITS: usize = 4;

/// A free parameter. It may set several fields that belong together, each in a fixed ratio to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Its name: the first path as written.
    pub name: String,
    /// Every field that it sets, by path, with the field's ratio to the parameter.
    fields: Vec<(String, f64)>,
    low: f64,
    high: f64,
    is_log: bool,
    /// Whether its fields take whole numbers only.
    is_whole: bool,
    /// What its one field may be, in RON, if it is no number: the parameter is the place in this list.
    choices: Vec<String>,
}

impl Parameter {
    /// Reads `PATH[*RATIO] [+ PATH[*RATIO] ...]=LOW..HIGH[ log]`, or `PATH=[VALUE, VALUE, ...]` for a field
    /// that is no number; `[*]` in a path is every entry of a list. `fields` are the fields that the scenario
    /// writes; each path must be one of them. `known` are all
    /// fields that a scenario has.
    ///
    /// # Errors
    /// The text has another form, the scenario lacks a path, or the range cannot be searched.
    pub fn parse(spec: &str, fields: &Node, known: &Node) -> Result<Self, Failure> {
        if let Some((path, list)) = spec.split_once('=').filter(|(_, list)| list.trim().starts_with('[')) {
            return Self::of_choices(path.trim(), list, fields, known);
        }
        let form = || {
            let rule = "must be 'PATH=LOW..HIGH', 'PATH + PATH*RATIO=LOW..HIGH log' with finite numbers, or \
                'PATH=[VALUE, VALUE]'";
            Failure::input(format!("{rule}, found {spec:?}"))
        };
        let (paths, range) = spec.rsplit_once('=').ok_or_else(form)?;
        let (range, is_log) =
            range.trim().strip_suffix("log").map_or((range.trim(), false), |range| (range.trim(), true));
        let (low, high) = range.split_once("..").ok_or_else(form)?;
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
        let (low, high) = number(low).zip(number(high)).ok_or_else(form)?;
        if low >= high {
            refuse!("the lower bound must be below the upper one, found {spec:?}");
        }
        if is_log && low <= 0.0 {
            refuse!("a logarithmic range must be above 0, found {spec:?}");
        }
        let mut named = Vec::new();
        let mut name = String::new();
        for part in paths.split('+') {
            let (path, ratio) = match part.rfind('*').filter(|at| !part[at + 1..].starts_with(']')) {
                Some(at) => (part[..at].trim(), number(&part[at + 1..]).ok_or_else(form)?),
                None => (part.trim(), 1.0),
            };
            if ratio <= 0.0 {
                refuse!("a ratio must be above 0, found {spec:?}");
            }
            if name.is_empty() {
                path.clone_into(&mut name);
            }
            let place = fields.canonical(path);
            let leaves = fields.leaves().into_iter().filter(|(known, _)| matches(&place, known));
            let matching: Vec<(String, f64)> = leaves
                .map(|(known, _)| (if known == place { path.to_owned() } else { known }, ratio))
                .collect();
            if matching.is_empty() {
                return Err(not_there(path, known));
            }
            named.extend(matching);
        }
        Ok(Self { name, fields: named, low, high, is_log, is_whole: false, choices: Vec::new() })
    }

    /// The parameter of a field that is one of these values.
    fn of_choices(path: &str, list: &str, fields: &Node, known: &Node) -> Result<Self, Failure> {
        let choices = Node::parse(list).map_err(Failure::input_at(path))?;
        let choices: Vec<String> = choices.children().map(ToString::to_string).collect();
        if choices.len() < 2 {
            refuse!("{path}: must have at least two values to choose from, found {list}");
        }
        if fields.get(path).is_none() {
            return Err(not_there(path, known));
        }
        let (name, high) = (path.to_owned(), (choices.len() - 1) as f64);
        let fields = vec![(name.clone(), 1.0)];
        Ok(Self { name, fields, low: 0.0, high, is_log: false, is_whole: true, choices })
    }

    /// The same parameter for this scenario. If one of its fields takes whole numbers only, its values are
    /// rounded to whole numbers.
    #[must_use]
    pub fn in_scenario(self, base: &ScenarioFile) -> Self {
        let is_whole = self.is_whole || self.whole_numbers(base).is_some();
        Self { is_whole, ..self }
    }

    /// The value at a place. [0, 1] is the range; beyond it, the range is mirrored again and again.
    pub fn value(&self, place: f64) -> f64 {
        let folded = place.rem_euclid(2.0);
        let unit = if folded > 1.0 { 2.0 - folded } else { folded };
        let value = if self.is_log {
            self.low * (self.high / self.low).powf(unit)
        } else {
            self.low + unit * (self.high - self.low)
        };
        let value = if self.is_whole { value.round() } else { rounded(value) };
        value.clamp(self.low, self.high)
    }

    /// The place of a value, kept at least a tenth of the range away from the ends.
    pub fn place(&self, value: f64) -> f64 {
        self.place_of(value).clamp(0.1, 0.9)
    }

    /// The place of a value in the range, from 0 to 1. A value outside has the place of the nearest end.
    pub fn place_of(&self, value: f64) -> f64 {
        let value = value.clamp(self.low, self.high);
        if self.is_log {
            (value / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// The ends of the parameter's range.
    pub fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    /// The parameter's fields, each with its value in RON.
    pub fn settings(&self, value: f64) -> impl Iterator<Item = (&str, String)> {
        let text = |value: f64| match self.choices.get(value as usize) {
            Some(choice) => choice.clone(),
            None if self.is_whole => format!("{value:.0}"),
            None => in_ron(rounded(value)),
        };
        self.fields.iter().map(move |(path, ratio)| (path.as_str(), text(value * ratio)))
    }

    /// Whether one of the parameter's fields is at this path or within it.
    pub fn is_of(&self, path: &str) -> bool {
        let is_within = |field: &str| {
            field.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        self.fields.iter().any(|(field, _)| is_within(field))
    }

    /// Whether a value is within a hundredth of the range of one of its ends.
    pub fn is_at_end(&self, value: f64) -> bool {
        let place = self.place_of(value);
        !(0.01..=0.99).contains(&place)
    }

    /// What a search has found for the parameter, in words.
    pub fn found(&self, value: f64) -> String {
        if let Some(choice) = self.choices.get(value as usize) {
            return format!("{} = {choice} (of {})", self.name, self.choices.join(", "));
        }
        let end = if self.is_at_end(value) { "; it is at the end of its range" } else { "" };
        format!("{} = {value} (searched from {} to {}{end})", self.name, self.low, self.high)
    }

    /// The parameter's present value, computed from its first field. A field with another value than those to
    /// choose from counts as the first of them.
    ///
    /// # Errors
    /// The first field is not a number.
    pub fn present(&self, tree: &Node) -> Result<f64, Failure> {
        let (path, ratio) = &self.fields[0];
        let written = tree.get(path).map(ToString::to_string).unwrap_or_default();
        if !self.choices.is_empty() {
            let place = self.choices.iter().position(|choice| *choice == written);
            return Ok(place.unwrap_or_default() as f64);
        }
        let not_number = |_| Failure::input(format!("{path}: must be a number, found {written}"));
        written.parse::<f64>().map(|value| value / ratio).map_err(not_number)
    }

    /// A message if one of the parameter's fields takes whole numbers only.
    pub fn whole_numbers(&self, base: &ScenarioFile) -> Option<String> {
        let takes = |path: &str, value: &str| base.clone().set(path, value).is_ok();
        let field = self.fields.iter().find(|(path, _)| takes(path, "1") && !takes(path, "1.5"));
        field.map(|(path, _)| {
            format!("{path}: takes whole numbers only, and a search tries those between as well")
        })
    }

    /// Sets the parameter's fields in a scenario.
    ///
    /// # Errors
    /// A field does not take the value.
    pub fn set(&self, file: &mut ScenarioFile, value: f64) -> Result<(), Box<Problem>> {
        self.settings(value).try_for_each(|(path, value)| file.set(path, &value))
    }
}

impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let fields = self.fields.iter().map(|(path, ratio)| format!("{path} * {ratio}"));
        let fields: Vec<String> = fields.collect();
        let scale = if self.is_log { " log" } else { "" };
        if !self.choices.is_empty() {
            return write!(f, "{} = [{}]", self.name, self.choices.join(", "));
        }
        write!(f, "{} = {}..{}{scale}", fields.join(" + "), self.low, self.high)
    }
}

/// Why a path cannot be free.
fn not_there(path: &str, known: &Node) -> Failure {
    let first = path.replace("[*]", "[0]");
    if known.leaves().iter().any(|(field, _)| *field == first) {
        Failure::input(format!(
            "{path}: is not written in the scenario; write it there, so that what is found can take its place"
        ))
    } else if let Some(node) = known.get(&first) {
        Failure::input(format!("{path}: is not a number but has parts: {}", node.names().join(", ")))
    } else {
        Failure::input(known.unknown(&first, "a scenario"))
    }
}

/// A number as RON writes a float.
fn in_ron(value: f64) -> String {
    format!("{value:?}")
}

/// A number rounded to [`DIGITS`] significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

/// Whether a path matches a pattern, in which `[*]` stands for any index.
fn matches(pattern: &str, path: &str) -> bool {
    let mut rest = path;
    let mut parts = pattern.split("[*]").peekable();
    while let Some(part) = parts.next() {
        let Some(after) = rest.strip_prefix(part) else { return false };
        rest = after;
        if parts.peek().is_some() {
            let Some(end) = rest.find(']').filter(|_| rest.starts_with('[')) else { return false };
            rest = &rest[end + 1..];
        }
    }
    rest.is_empty()
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "values are rounded to four digits")]
mod tests {
    use super::*;

    const TEXT: &str = "(roles: (a: (v: 3.0), b: (v: 2.0)), zones: [(r: 4.5), (r: 4.5)], n: (k: 1))";

    fn free(spec: &str) -> Result<Parameter, Failure> {
        let tree = |text| Node::parse(text).unwrap();
        Parameter::parse(spec, &tree(TEXT), &tree("(roles: (a: (v: 3.0, w: 1.0), b: (v: 2.0)))"))
    }

    #[test]
    fn one_parameter_may_set_several_fields_in_fixed_ratios() {
        let speed = free("roles.a.v + roles.b.v*0.66667 = 1..6").unwrap();
        assert_eq!(speed.name, "roles.a.v");
        let settings: Vec<_> = speed.settings(3.0).collect();
        assert_eq!(settings, [("roles.a.v", "3.0".to_owned()), ("roles.b.v", "2.0".to_owned())]);
        let radius = free("zones[*].r=2..8").unwrap();
        assert_eq!(
            radius.settings(5.0).map(|(path, _)| path).collect::<Vec<_>>(),
            ["zones[0].r", "zones[1].r"]
        );
    }

    #[test]
    fn a_field_that_is_no_number_is_one_of_some_values() {
        let speed = free("roles.a=[(v: 1.0), (v: 3.0), (v: 9.0)]").unwrap();
        let text = |value: f64| speed.settings(value).next().unwrap().1;
        assert_eq!(
            [0.0, 0.4, 1.0].map(|place| text(speed.value(place))),
            ["(v: 1.0)", "(v: 3.0)", "(v: 9.0)"]
        );
        assert_eq!(speed.present(&Node::parse(TEXT).unwrap()).unwrap(), 1.0);
        assert_eq!(speed.found(2.0), "roles.a = (v: 9.0) (of (v: 1.0), (v: 3.0), (v: 9.0))");
        assert_eq!(speed.to_string(), "roles.a = [(v: 1.0), (v: 3.0), (v: 9.0)]");
    }

    #[test]
    fn a_range_is_mirrored_at_its_ends() {
        let linear = free("roles.a.v=1..3").unwrap();
        assert_eq!(
            [-0.25, 0.0, 0.5, 1.0, 1.25, 2.5].map(|x| linear.value(x)),
            [1.5, 1.0, 2.0, 3.0, 2.5, 2.0]
        );
        assert_eq!(linear.place(2.0), 0.5);
        assert_eq!(
            [1.0, 1.01, 1.5, 2.5, 2.99, 9.0].map(|value| linear.is_at_end(value)),
            [true, true, false, false, true, true]
        );
        let log = free("roles.a.v=0.01..1 log").unwrap();
        assert_eq!(log.value(0.5), 0.1);
        assert!((log.place(0.1) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn what_cannot_be_searched_is_refused() {
        for (spec, says) in [
            ("roles.a.v", "must be 'PATH=LOW..HIGH'"),
            ("roles.a.v=3..1", "the lower bound must be below"),
            ("roles.a.v=0..1 log", "must be above 0"),
            ("roles.a.v=1..x", "with finite numbers"),
            ("roles.a.v*0=1..2", "a ratio must be above 0"),
            ("roles.c.v=0..1", "roles.c.v is no field; did you mean a? roles has a, b"),
            ("roles.a.w=0..1", "roles.a.w: is not written in the scenario"),
            ("roles.a=[(v: 1.0)]", "roles.a: must have at least two values"),
            ("roles.d=[1, 2]", "roles.d is no field"),
            ("roles.a=0..1", "roles.a: is not a number but has parts: v, w"),
        ] {
            let error = free(spec).unwrap_err().to_string();
            assert!(error.contains(says), "{spec}: {error}");
        }
    }
}
