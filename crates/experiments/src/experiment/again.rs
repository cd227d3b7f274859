//! Reproducing results: a command for one trial, and a file for the whole sweep.

use ron_tree::Node;
use scenario::seed::trial_number;
use teaming::{Asked, TrialStart};
use usar_sim::record::{DecisionRecord, TrialRecord};

use super::file::{Map, SweepFile};
use super::{AnalysisPlan, Axis, Experiment, Seeds};
use crate::run::TrialKey;
use store::Failure;

/// How often a policy is asked the same question again.
const TIMES_ASKED: usize = 3;

impl Experiment {
    /// The command that runs one trial again, in the folder of the results.
    pub fn replay_command(&self, key: &TrialKey) -> String {
        let policy = &self.policies[key.policy];
        let axes = self.axes.iter().zip(&self.cases[key.case].values);
        let set = |path: &str, value: &str| {
            let value = value.split_whitespace().collect::<Vec<_>>().join(" ");
            format!("--set '{}={}'", path, value.replace('\'', "'\\''"))
        };
        let settings = axes.flat_map(|(axis, value)| axis.settings(value));
        let axes = settings.map(|(path, value)| set(path, value));
        let quoted = match policy.plain() {
            plain if plain == policy.name => plain,
            plain => format!("'{}'", plain.replace('\'', "'\\''")),
        };
        let command = format!("usar run resolved.ron --policy {quoted} --seed {}", key.seed);
        let check = self.is_checked.then(|| "--check".to_owned());
        std::iter::once(command).chain(axes).chain(check).collect::<Vec<_>>().join(" ")
    }

    /// The first round in which the policy gives another answer than in the trial when it is asked the same
    /// questions a few times again, each time in a session of its own. `None` if every answer is the same, or
    /// if the policy does not answer from the question.
    pub fn answers_otherwise(&self, key: &TrialKey, record: &TrialRecord) -> Option<u32> {
        let spec = &self.policies[key.policy];
        if !spec.is_of_question() {
            return None;
        }
        let start =
            TrialStart { scenario: &self.cases[key.case].scenario.name, number: trial_number(key.seed) };
        let first_other = || {
            let mut session = spec.made().open().ok()?;
            session.reset(&start).ok()?;
            let is_other = |asked: &&DecisionRecord| {
                let question = record.question(asked);
                let answer = session.decide(&Asked::of(&question).knowing(asked.team()));
                answer.ok().is_none_or(|answer| answer.assignment != asked.decision.assignment)
            };
            let of_base = record.decisions.iter().filter(|made| made.joins.is_empty());
            of_base.into_iter().find(is_other).map(|asked| asked.question.round)
        };
        (0..TIMES_ASKED).find_map(|_| first_other())
    }

    /// The same sweep as a sweep file for its resolved scenario, which is in the same folder.
    ///
    /// # Errors
    /// A value of an axis is no value in RON.
    pub fn as_sweep_file(&self, scenario: &str) -> Result<String, Failure> {
        let node = |text: &String| Node::parse(text).map_err(Failure::run);
        let nodes = |texts: &[String]| texts.iter().map(node).collect::<Result<Vec<_>, _>>();
        let settings = |settings: &Vec<(String, String)>| {
            let settings = settings.iter().map(|(path, value)| Ok((path.clone(), node(value)?)));
            settings.collect::<Result<Vec<_>, Failure>>().map(Map)
        };
        let (of_variants, of_fields): (Vec<&Axis>, Vec<&Axis>) =
            self.axes.iter().partition(|axis| !axis.variants.is_empty());
        let named = of_variants.into_iter().flat_map(|axis| axis.values.iter().zip(&axis.variants));
        let variants = named.map(|(name, set)| Ok((name.clone(), settings(set)?)));
        let axes = of_fields.into_iter().map(|axis| Ok((axis.path.clone(), nodes(&axis.values)?)));
        let (first_seed, seeds) = match &self.seeds {
            Seeds::From(first) => (Some(*first), None),
            Seeds::Listed(list) => (None, Some(list.clone())),
        };
        let AnalysisPlan { primary, baseline, margins, expect } = self.plan.clone();
        let file = SweepFile {
            format: None,
            name: self.name.clone(),
            description: String::new(),
            scenario: scenario.to_owned(),
            set: Map::default(),
            policies: Some(self.policies.iter().map(|policy| policy.written().to_owned()).collect()),
            readings: Map::default(),
            trials: Some(self.trials),
            first_seed,
            seeds,
            keep: self.keep,
            primary,
            baseline,
            margins: Map(margins),
            expect,
            variants: Map(variants.collect::<Result<_, Failure>>()?),
            axes: Map(axes.collect::<Result<_, Failure>>()?),
        };
        Ok(Node::of(&file).map_err(Failure::run)?.pretty() + "\n")
    }
}
