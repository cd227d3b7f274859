//! Values that are drawn anew in every trial: a distribution may stand in place of any value of a scenario.
//!
//! Before a tree is read, each distribution is replaced by one of its values and kept with the file, by the
//! path of its field. Each trial has its own scenario, with values drawn from the streams of these paths.

use std::collections::BTreeMap;

use rand::rngs::ChaCha8Rng;
use ron_tree::{Node, Problem, Value};
use xxhash_rust::xxh3::xxh3_64;

use super::distribution::{Distribution, index, is_distribution};
use super::error::LayoutError;
use super::file::ScenarioFile;
use super::{Scenario, validate};
use crate::limits;
use crate::seed::{Purpose, stream};

/// The seed whose draws show whether the values of a file fit together at all.
const CHECKED_SEED: u64 = 1;

/// Times that the values of a trial are drawn before the trial fails because they never fit together.
const TRIES: u32 = 100;

/// The same limit for a scenario longer than [`LONG_BYTES`].
const TRIES_OF_A_LONG_ONE: u32 = 5;

/// Length above which a scenario is read fewer times, in bytes. Of a choice, only the first two values are
/// then checked before a trial.
const LONG_BYTES: usize = 1 << 18;

/// The distributions of a scenario as they are written, each by the path of its field, with numbers instead
/// of names.
pub type Draws = BTreeMap<String, Node>;

/// The replacement of one value.
enum Draw {
    Number(Distribution),
    /// One of these.
    Choice(Vec<Node>),
}

impl Draw {
    /// Reads a distribution.
    fn read(written: &Node) -> Result<Self, Box<Problem>> {
        let wrong = |rule: String| Err(Box::new(Problem::new("", rule, written)));
        if let Value::Tuple(name, entries) = &written.value
            && &**name == "Choice"
        {
            let values = if let [list] = &entries[..] { list.entries() } else { &[] };
            return match values.len() {
                0 => wrong("must be Choice([...]) with at least one value".to_owned()),
                many if !limits::CHOICES.allows(many) => {
                    wrong(format!("must have at most {} values to choose from", limits::CHOICES.most))
                }
                _ => Ok(Self::Choice(values.to_vec())),
            };
        }
        let distribution: Distribution = written.read_as()?;
        match distribution.fault() {
            Some(rule) => wrong(rule.to_owned()),
            None => Ok(Self::Number(distribution)),
        }
    }

    /// Values to be checked: the ends of a distribution, or all choices.
    fn examples(&self, is_whole: bool) -> Vec<Node> {
        match self {
            Self::Number(distribution) => distribution.support().map(|end| number(end, is_whole)).to_vec(),
            Self::Choice(values) => values.clone(),
        }
    }

    /// The value that is read in place of the distribution: its greatest value, or the first choice.
    fn stand_in(&self, written: &Node) -> Node {
        match self {
            Self::Number(distribution) => {
                let is_whole = !written.to_string().contains('.');
                number(distribution.support()[1], is_whole)
            }
            Self::Choice(values) => values[0].clone(),
        }
    }

    /// A value from a stream.
    fn value(&self, draws: &mut ChaCha8Rng, is_whole: bool) -> Node {
        match self {
            Self::Number(distribution) => number(distribution.draw(draws, is_whole), is_whole),
            Self::Choice(values) => values[index(draws, values.len())].clone(),
        }
    }
}

/// A number as it is written.
fn number(value: f64, is_whole: bool) -> Node {
    Node::word(if is_whole && value.fract() == 0.0 { format!("{value:.0}") } else { format!("{value:?}") })
}

/// Whether a value is written as a whole number.
fn is_whole(node: &Node) -> bool {
    let word = node.peeled().as_word().unwrap_or_default();
    word.starts_with(|c: char| c.is_ascii_digit() || c == '-') && !word.contains(['.', 'e', 'E'])
}

/// Whether the field at this path draws a number for each thing instead of one for all.
fn is_drawn_for_each(path: &str) -> bool {
    let field = |list: &str, rest: &str| {
        let inside = path.strip_prefix(list).and_then(|path| path.split_once(']'));
        inside.is_some_and(|(_, path)| path.starts_with(rest))
    };
    field("team[", ".levels.") || field("scatter[", ".radius_m")
}

/// The distributions of a tree, and the problems with them.
#[derive(Default)]
struct Taken {
    draws: Draws,
    problems: Vec<Problem>,
}

/// Replaces each distribution in a tree by one of its values.
fn take_out(root: &mut Node) -> Taken {
    let mut taken = Taken::default();
    if has_distribution(root) {
        taken.take_out(root, "");
    }
    taken
}

fn has_distribution(node: &Node) -> bool {
    is_distribution(node) || node.children().any(has_distribution)
}

impl Taken {
    fn take_out(&mut self, node: &mut Node, path: &str) {
        let node = node.peeled_mut();
        if !is_distribution(node) || is_drawn_for_each(path) {
            for (segment, child) in node.children_mut() {
                let segment = if path.is_empty() { segment.trim_start_matches('.') } else { &segment };
                self.take_out(child, &format!("{path}{segment}"));
            }
            return;
        }
        let mut stand_in = match Draw::read(node) {
            Ok(draw) => draw.stand_in(node),
            Err(problem) => {
                self.fail(path, node, *problem);
                Node::word("0")
            }
        };
        stand_in.put_at(node.place);
        let written = std::mem::replace(node, stand_in);
        let count = self.draws.len() + 1;
        if limits::DRAWS.allows(count) {
            self.draws.insert(path.to_owned(), written);
        } else if self.problems.is_empty() {
            let rule = format!("is one distribution too many: at most {}", limits::DRAWS.most);
            self.fail(path, node, Problem::new("", rule, ""));
        }
    }

    fn fail(&mut self, path: &str, node: &Node, problem: Problem) {
        let line = Some(node.place.line as usize).filter(|line| *line > 0);
        self.problems.push(Problem { field: path.to_owned(), line, ..problem });
    }
}

impl ScenarioFile {
    /// The tree of the file without its distributions: each is replaced by one of its values.
    pub(super) fn plain_tree(&self) -> Node {
        // Types of a scenario refuse nothing when they are written.
        Node::of(self).unwrap_or_else(|_| Node::word("()"))
    }

    /// The whole file as a tree.
    pub fn tree(&self) -> Node {
        let mut tree = self.plain_tree();
        for (path, written) in &self.draws {
            // A distribution whose field has no name stays out; the rules refuse it.
            let _ = tree.set(path, written.clone(), "a scenario");
        }
        tree
    }

    /// Reads a file from a tree, and notes all values of wrong types; no file is returned if a distribution
    /// is wrong. The distributions in the tree are replaced by values.
    pub(super) fn read(tree: &mut Node) -> (Option<Self>, Vec<Problem>) {
        let taken = take_out(tree);
        let (file, mut problems) = tree.read_all();
        for problem in problems.iter_mut().filter(|problem| !problem.rule.contains("number")) {
            // Where no number may stand, the distribution was found, not the value that stands in for it.
            let written = taken.draws.get(&problem.field);
            problem.found = written.map_or(std::mem::take(&mut problem.found), Node::to_string);
        }
        let file = file.filter(|_| taken.problems.is_empty());
        let file = file.map(|file: Self| Self { draws: taken.draws, ..file });
        problems.extend(taken.problems);
        (file, problems)
    }

    /// The file with a value in place of each distribution in its plain tree.
    fn with_drawn(
        &self,
        plain: &Node,
        value: impl Fn(&str, &Draw, bool) -> Option<Node>,
    ) -> Result<Self, Box<Problem>> {
        let mut tree = plain.clone();
        for (path, written) in &self.draws {
            let problem = |problem: Box<Problem>| Box::new(Problem { field: path.clone(), ..*problem });
            let draw = Draw::read(written).map_err(problem)?;
            let Some(place) = tree.get_mut(path) else {
                let rule = "must stand in a field with a name: write the names of the fields";
                return Err(Box::new(Problem::new(path, rule, written)));
            };
            if let Some(value) = value(path, &draw, is_whole(place)) {
                *place = value;
            }
        }
        tree.read_as()
    }

    /// Whether reading it takes long.
    fn is_long(&self) -> bool {
        self.plain_tree().to_string().len() > LONG_BYTES
    }

    /// The broken rules of a file with distributions. Each value is checked at the ends of its distribution.
    /// Each trial checks whether its values fit together. The file is refused only if every draw for one seed
    /// breaks the same rule in the same field: most often, values that are not drawn contradict each other.
    pub(super) fn problems_of_draws(&self) -> Vec<Problem> {
        let plain = self.plain_tree();
        let most = self.draws.values().filter_map(|written| Draw::read(written).ok());
        let most = most.map(|draw| draw.examples(false).len()).max().unwrap_or_default();
        let most = if self.is_long() { most.min(2) } else { most };
        for example in 0..most {
            let nth = |_: &str, draw: &Draw, is_whole: bool| {
                let examples = draw.examples(is_whole);
                examples.get(example.min(examples.len() - 1)).cloned()
            };
            let problems = match self.with_drawn(&plain, nth) {
                Ok(file) => validate::problems_of_values(&file),
                Err(problem) => vec![*problem],
            };
            if !problems.is_empty() {
                return problems;
            }
        }
        if self.is_long() {
            return Vec::new(); // a draw of it takes long
        }
        let Err(problems) = self.of_trial(CHECKED_SEED) else { return Vec::new() };
        let hint = format!("none of {} draws of the distributions avoids this", problems.len());
        let is_in_all = |problem: &Problem| {
            problems.iter().all(|other| (&other.field, &other.rule) == (&problem.field, &problem.rule))
        };
        let first = problems.first().filter(|problem| is_in_all(problem));
        first.map(|problem| Problem { hint, ..problem.clone() }).into_iter().collect()
    }

    /// The scenario of one trial, in which each distribution is replaced by a value drawn from the stream of
    /// its path. If the values do not fit together, all of them are drawn again. The error is what was wrong
    /// with each draw.
    fn of_trial(&self, seed: u64) -> Result<Scenario, Vec<Problem>> {
        let mut problems = Vec::new();
        let tries = if self.is_long() { TRIES_OF_A_LONG_ONE } else { TRIES };
        let plain = self.plain_tree();
        for attempt in 0..tries {
            let drawn = self.with_drawn(&plain, |path, draw, is_whole| {
                let entity = if attempt == 0 { path.to_owned() } else { format!("{path} {attempt}") };
                let mut draws = stream(seed, Purpose::Slot, xxh3_64(entity.as_bytes()));
                Some(draw.value(&mut draws, is_whole))
            });
            match drawn {
                Err(problem) => problems.push(*problem),
                Ok(file) => match Scenario::try_from(file) {
                    Ok(scenario) => return Ok(scenario),
                    Err(found) => problems.extend(found.into_iter().next()),
                },
            }
        }
        Err(problems)
    }
}

impl Scenario {
    /// Whether trials differ by more than their initial levels.
    pub fn is_drawn(&self) -> bool {
        let samples = |task: &super::TaskFile| task.sampled != super::SampledCounts::default();
        !self.draws.is_empty() || !self.scatter.is_empty() || self.tasks.iter().any(samples)
    }

    /// The scenario of one trial. Each distribution is replaced by a value drawn
    /// from the stream of its path. If the values do not fit together, all of them are drawn again.
    ///
    /// # Errors
    /// The values never fit together.
    pub fn of_trial(&self, seed: u64) -> Result<Self, LayoutError> {
        if self.draws.is_empty() {
            return Ok(self.clone());
        }
        self.0.of_trial(seed).map_err(|problems| LayoutError::NeverFits {
            tries: problems.len() as u32,
            problem: problems.last().map(ToString::to_string).unwrap_or_default(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = r#"(
        name: "t", duration_s: 60, dt_s: 0.02, arena_m: (40, 40),
        team: [(role: "robot", count: Uniform(2, 4), center: (20, 5), width_m: 6,
            levels: (energy: Uniform(50, 60), hp: 90.0), body: (speed_mps: Truncated(Normal(2, 0.5), 1, 3)))],
        tasks: [(name: "a", difficulty: 1, center: (Uniform(10, 30), 30), size_m: (2, 2), grid: (2, 2),
            rest: (20, 12))], debris: [(shape: Choice([Disc(0.5), Box(1.0, 2.0)]), at: (20, 20))],
        radiation: [(at: (8, 20), radius_m: Uniform(1, 3))],
    )"#;

    fn scenario(text: &str) -> Scenario {
        Scenario::parse(text, "t.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn every_trial_has_values_of_its_own() {
        let scenario = scenario(TEXT);
        let trials: Vec<Scenario> = (1..60).map(|seed| scenario.of_trial(seed).unwrap()).collect();
        assert!(trials.iter().all(|trial| trial.draws.is_empty() && (2..=4).contains(&trial.robots())));
        assert!((2..=4).all(|count| trials.iter().any(|trial| trial.robots() == count)));
        let speeds = trials.iter().map(|trial| trial.team[0].body.unwrap().speed_mps.unwrap());
        assert!(speeds.clone().all(|speed| (1.0..=3.0).contains(&speed)));
        let centers: Vec<f64> = trials.iter().map(|trial| trial.tasks[0].center[0]).collect();
        assert!(centers.iter().any(|x| *x < 15.0) && centers.iter().any(|x| *x > 25.0));
        let boxes =
            trials.iter().filter(|trial| matches!(trial.debris[0].shape, super::super::DebrisShape::Box(..)));
        assert!((15..45).contains(&boxes.count()));
        assert_eq!(scenario.of_trial(7).unwrap(), scenario.of_trial(7).unwrap());
    }

    #[test]
    fn one_distribution_more_leaves_the_other_draws_alone() {
        let before = scenario(TEXT);
        let after = scenario(&TEXT.replace("width_m: 6", "width_m: Uniform(5, 7)"));
        for seed in 1..20 {
            let (before, after) = (before.of_trial(seed).unwrap(), after.of_trial(seed).unwrap());
            assert_eq!(before.tasks, after.tasks);
            assert_eq!(before.radiation, after.radiation);
            assert_eq!(before.team[0].count, after.team[0].count);
        }
    }

    #[test]
    fn the_whole_scenario_is_read_again_as_it_was() {
        let scenario = scenario(TEXT);
        let again = self::scenario(&scenario.resolved());
        assert_eq!(scenario, again);
        assert!(scenario.resolved().contains("radius_m: Uniform(1, 3)"), "{}", scenario.resolved());
    }

    #[test]
    fn a_value_takes_the_place_of_a_distribution_and_back() {
        let mut file = (*scenario(TEXT)).clone();
        file.set("tasks.a.center", "(12, 30)").unwrap();
        file.set("radiation[0].at[1]", "Uniform(18, 22)").unwrap();
        let keys: Vec<&str> = file.draws.keys().map(String::as_str).collect();
        assert_eq!(
            keys,
            [
                "debris[0].shape",
                "radiation[0].at[1]",
                "radiation[0].radius_m",
                "team[0].body.speed_mps",
                "team[0].count"
            ]
        );
        assert!(
            file.set("mission.rest_s", "Uniform(5, 2)")
                .unwrap_err()
                .to_string()
                .contains("least value first")
        );
    }

    #[test]
    fn what_is_wrong_with_a_distribution_is_told() {
        let error = |from: &str, to: &str| {
            Scenario::parse(&TEXT.replace(from, to), "t.ron".as_ref()).unwrap_err().to_string()
        };
        for (from, to, says) in [
            (
                "Uniform(2, 4)",
                "Uniform(4, 2)",
                "t.ron:3: team[0].count must have its least value first, found Uniform(4, 2)",
            ),
            ("Uniform(2, 4)", "Uniform(2, 4.5)", "t.ron:3: team[0].count must be a whole number, found 4.5"),
            (
                "Uniform(1, 3)",
                "Uniform(0, 3)",
                "t.ron:7: radiation[0].radius_m must be a number from 0.01 to 1000, found 0",
            ),
            ("Uniform(1, 3)", "Normal(1, 3)", "t.ron:7: radiation[0].radius_m must be bounded"),
            (
                "Uniform(50, 60)",
                "Uniform(50, 160)",
                "t.ron:4: team[0].levels.energy must be a number from 0.01 to 100, found 160",
            ),
            (
                "Uniform(50, 60)",
                "Uniform(70, 60)",
                "t.ron:4: team[0].levels.energy must have its least value first, found Uniform(70, 60)",
            ),
            (
                "Choice([Disc(0.5), Box(1.0, 2.0)])",
                "Choice([])",
                "t.ron:6: debris[0].shape must be Choice([...]) with at least one value",
            ),
            ("Box(1.0, 2.0)", "Bax(1.0, 2.0)", "t.ron:6: debris[0].shape must be one of Disc, Box, Polygon"),
            ("name: \"t\"", "name: Uniform(1, 2)", "t.ron:2: name must be"),
        ] {
            let error = error(from, to);
            assert!(error.contains(says), "{to}: {error}");
        }
    }

    #[test]
    fn values_that_never_go_together_are_told_with_their_line() {
        let text = TEXT.replace("at: (20, 20)", "at: (20, Uniform(4.9, 5.1))").replace("Uniform(2, 4)", "3");
        let error = Scenario::parse(&text, "t.ron".as_ref()).unwrap_err().to_string();
        assert!(error.contains("t.ron:6: debris[0].at must leave every robot's home free"), "{error}");
        assert!(error.contains("none of 100 draws"), "{error}");
    }

    /// Here one draw in about thirty fits.
    #[test]
    fn a_trial_whose_values_never_go_together_fails() {
        let text = TEXT.replace("at: (20, 20)", "at: (20, Uniform(4.9, 5.95))").replace("Uniform(2, 4)", "3");
        let scenario = scenario(&text);
        let errors = (1..200).filter_map(|seed| scenario.of_trial(seed).err());
        let error = errors.map(|error| error.to_string()).next().expect("some seed fails");
        assert!(
            error.contains("100 times") && error.contains("must leave every robot's home free"),
            "{error}"
        );
    }
}
