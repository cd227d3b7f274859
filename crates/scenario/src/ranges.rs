//! Ranges of numbers and lengths of lists: the paths of [`limits`] lead to the places of a file.

use std::fmt::{self, Write};

use ron_tree::limits::Limit;
use ron_tree::{Node, Value};

use super::checker::Checker;
use super::distribution::WORDS;
use crate::limits;

/// Limits that apply at further paths. In a path of the schema and of a file, the name of a variant may be
/// left out.
const MORE: [(&str, Limit); 27] = [
    ("team[*].count", Limit { least: 0.0, ..limits::ROBOTS }),
    ("timeline[*].event.RobotLoses.hp", limits::LOSS),
    ("timeline[*].event.RescueesAppear.grid[*]", limits::GRID),
    ("timeline[*].event.SourceAppears.radius_m", limits::ZONE_RADIUS_M),
    ("scatter[*].radius_m", limits::SAMPLED_RADIUS_M),
    ("scatter[*].place.Poisson", limits::GAP_M),
    ("tasks.*.requires", Limit { least: 0.0, ..limits::NEEDS }),
    ("tasks.*.quota", Limit { least: 0.0, ..limits::ROLES }),
    ("tasks.*.after", Limit { least: 0.0, ..limits::TASKS }),
    ("roles.*.sight.miss", limits::PROBABILITY),
    ("medium.loss.GilbertElliott.*", limits::PROBABILITY),
    ("medium.resend.after_s", limits::DELAY_S),
    ("medium.blackouts[*].from_s", limits::AT_S),
    ("medium.blackouts[*].to_s", limits::AT_S),
    ("deceit[*].since_s", limits::AT_S),
    ("deceit[*].until_s", limits::AT_S),
    ("deceit[*].who.Share", limits::PROBABILITY),
    ("deceit[*].lie.Exaggerate.by", limits::PROBABILITY),
    ("deceit[*].lie.Understate.by", limits::PROBABILITY),
    ("deceit[*].lie.Offset.points", limits::GAUGE_BIAS),
    ("deceit[*].lie.Uniform.low", limits::SAID_LEVEL),
    ("deceit[*].lie.Uniform.high", limits::SAID_LEVEL),
    ("deceit[*].lie.OnOff.duty", limits::PROBABILITY),
    ("deceit[*].lie.PhantomRescuee.every_s", limits::LIE_PERIOD_S),
    ("deceit[*].lie.Misplace.by_m", limits::SIGHT_NOISE_M),
    ("scatter[*].movable.mass_kg", limits::PIECE_MASS_KG),
    ("scatter[*].movable.friction", limits::FRICTION),
];

/// Parts of a file that have the fields of another one.
const ALIKE: [(&str, &str); 4] = [
    ("roles.*.", "team[*].body."),
    ("debris[*].", "timeline[*].event.DebrisFalls."),
    ("deceit[*].lie.", "deceit[*].lie.OnOff.lie."),
    ("deceit[*].lie.", "timeline[*].event.RobotLies.lie."),
];

/// All paths with their limits.
pub(super) fn all() -> Vec<(String, Limit)> {
    // Errands take the place of tasks, and rescuees are counted in all tasks together.
    let least = |limit: &Limit| if *limit == limits::TASKS { 0.0 } else { limit.least };
    let declared = limits::ALL.iter().map(|limit| (limit.of, Limit { least: least(limit), ..*limit }));
    let mut all: Vec<(String, Limit)> =
        declared.chain(MORE).map(|(path, limit)| (path.replace("[*]", ".[]"), limit)).collect();
    for (from, to) in ALIKE.map(|(from, to)| (from.replace("[*]", ".[]"), to.replace("[*]", ".[]"))) {
        for i in 0..all.len() {
            if let Some(rest) = all[i].0.strip_prefix(&from) {
                all.push((format!("{to}{rest}"), all[i].1));
            }
        }
    }
    all
}

/// Checks every number of a file that has a range, and the length of every list that has one. Returns whether
/// the lengths let the other rules be checked.
pub(super) fn in_range(check: &mut Checker, file: &Node) -> bool {
    let all = all();
    let parts: Vec<Vec<&str>> = all.iter().map(|(path, _)| path.split('.').collect()).collect();
    let rules: Vec<Rule> = parts.iter().zip(&all).map(|(parts, (_, limit))| (&parts[..], *limit)).collect();
    let mut walk = Walk { check, path: String::new(), is_sound: true };
    walk.node(file, &rules);
    walk.is_sound
}

/// The rest of a path, part by part, and what may be there.
type Rule<'r> = (&'r [&'r str], Limit);

/// The rules one step further down: those whose next part is `part`.
fn below<'r>(rules: &[Rule<'r>], part: impl Fn(&str) -> bool) -> Vec<Rule<'r>> {
    let step = |(path, limit): &Rule<'r>| {
        let (head, tail) = path.split_first()?;
        part(head).then_some((tail, *limit))
    };
    rules.iter().filter_map(step).collect()
}

/// A walk over a file, with the path up to where it is.
struct Walk<'c> {
    check: &'c mut Checker,
    path: String,
    is_sound: bool,
}

impl Walk<'_> {
    fn node(&mut self, node: &Node, rules: &[Rule]) {
        let here = rules.iter().filter(|(path, _)| path.is_empty()).map(|(_, limit)| *limit);
        let here = here.reduce(|a, b| Limit { least: a.least.max(b.least), most: a.most.min(b.most), ..a });
        match (&node.value, here) {
            (Value::Word(word), Some(limit)) => {
                if let Ok(number) = word.parse() {
                    self.check.number(&self.path[1..], number, limit);
                }
            }
            (Value::List(entries), Some(limit)) => self.length(entries.len(), limit),
            (Value::Map(entries), Some(limit)) => self.length(entries.len(), limit),
            (_, _) => {}
        }
        self.inner(node, rules);
    }

    fn length(&mut self, length: usize, limit: Limit) {
        // A list within an entry that is too short hides no other mistake.
        self.is_sound &= limit.allows(length) || length <= limit.count() && self.path[1..].contains('.');
        self.check.entries(&self.path[1..], length, limit);
    }

    fn inner(&mut self, node: &Node, rules: &[Rule]) {
        match &node.value {
            Value::Word(_) | Value::Text(_) => {}
            Value::Tuple(name, entries) if !name.is_empty() => {
                let rules = of_variant(rules, name);
                match &entries[..] {
                    _ if WORDS.contains(&&**name) => {} // a distribution
                    [one] => self.node(one, &rules),
                    more => {
                        let rules = below(&rules, |part| part == "[]");
                        more.iter().for_each(|entry| self.node(entry, &rules));
                    }
                }
            }
            Value::List(entries) | Value::Tuple(_, entries) => {
                let rules = below(rules, |part| part == "[]" || part == "*");
                let is_named = [".roles", ".needs", ".tasks"].contains(&self.path.as_str());
                for (i, entry) in entries.iter().enumerate() {
                    let name = is_named.then(|| entry.get("name").and_then(Node::as_text)).flatten();
                    match name {
                        Some(name) => self.step(format_args!(".{name}"), entry, &rules),
                        None => self.step(format_args!("[{i}]"), entry, &rules),
                    }
                }
            }
            Value::Map(entries) => {
                let rules = below(rules, |part| part == "*");
                entries.iter().for_each(|(key, entry)| self.step(format_args!(".{key}"), entry, &rules));
            }
            Value::Struct(name, fields) => {
                let rules = of_variant(rules, name);
                for (field, value) in fields {
                    let Some(field) = field.as_word() else { continue };
                    let below = below(&rules, |part| matches(part, field));
                    self.step(format_args!(".{field}"), value, &below);
                }
            }
        }
    }

    fn step(&mut self, segment: fmt::Arguments<'_>, node: &Node, rules: &[Rule]) {
        if rules.is_empty() {
            return;
        }
        let end = self.path.len();
        let _ = write!(self.path, "{segment}"); // a String takes all
        self.node(node, rules);
        self.path.truncate(end);
    }
}

/// The rules inside a variant: of those that name it the rest, and all that name none.
fn of_variant<'r>(rules: &[Rule<'r>], name: &str) -> Vec<Rule<'r>> {
    if name.is_empty() {
        return rules.to_vec();
    }
    let mut inside = below(rules, |part| part == name);
    let names_none = |path: &[&str]| path.first().is_none_or(|head| !head.starts_with(char::is_uppercase));
    inside.extend(rules.iter().filter(|(path, _)| names_none(path)));
    inside
}

/// Whether a part of a path, perhaps with a star, is that of this field.
pub(super) fn matches(part: &str, name: &str) -> bool {
    let star = part.bytes().position(|byte| byte == b'*'); // faster than a search in text
    star.map_or(part == name, |at| name.starts_with(&part[..at]) && name.ends_with(&part[at + 1..]))
}
