//! Reproducing results: a command for one trial, and a file for the whole sweep.

use rne_core::{Asked, TrialStart};
use usar_sim::record::{DecisionRecord, TrialRecord};

use super::asks::Asks;
use super::{Axis, Experiment, Seeds};
use crate::failure::Failure;
use crate::run::TrialKey;

/// How often a policy is asked the same question again.
const TIMES_ASKED: usize = 3;

impl Experiment {
    /// The command that runs one trial again, in the folder of the results.
    #[must_use]
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
    /// questions a few times again. `None` if every answer is the same, or if the policy does not answer from
    /// the question.
    #[must_use]
    pub fn answers_otherwise(&self, key: &TrialKey, record: &TrialRecord) -> Option<u32> {
        let spec = &self.policies[key.policy];
        if !spec.is_of_question() {
            return None;
        }
        let mut session = spec.made().open().ok()?;
        let start = TrialStart { scenario: &self.cases[key.case].scenario.name, seed: key.seed };
        let mut first_other = || {
            session.reset(&start).ok()?;
            let is_other = |asked: &&DecisionRecord| {
                let answer = session.decide(&Asked::of(&record.question(asked)));
                answer.ok().is_none_or(|answer| answer.assignment != asked.decision.assignment)
            };
            record.decisions.iter().find(is_other).map(|asked| asked.question.round)
        };
        (0..TIMES_ASKED).find_map(|_| first_other())
    }

    /// The same sweep as a sweep file for its resolved scenario, which is in the same folder.
    ///
    /// # Errors
    /// None: it can be written to memory.
    pub fn as_sweep_file(&self, scenario: &str) -> Result<String, Failure> {
        let quoted = |text: &str| ron::to_string(text).map_err(Failure::run);
        let policies =
            self.policies.iter().map(|policy| quoted(policy.written())).collect::<Result<Vec<_>, _>>()?;
        let seeds = match &self.seeds {
            Seeds::From(first) => format!("first_seed: {first}"),
            Seeds::Listed(list) => format!("seeds: {list:?}"),
        };
        let line =
            |axis: &Axis| Ok(format!("        {}: [{}],\n", quoted(&axis.path)?, axis.values.join(", ")));
        let (of_variants, of_fields): (Vec<&Axis>, Vec<&Axis>) =
            self.axes.iter().partition(|axis| !axis.variants.is_empty());
        let axes = of_fields.into_iter().map(line).collect::<Result<Vec<_>, Failure>>()?.concat();
        let variant = |(name, settings): (&String, &Vec<(String, String)>)| {
            let settings = settings.iter().map(|(path, value)| Ok(format!("{}: {value}", quoted(path)?)));
            let settings = settings.collect::<Result<Vec<_>, Failure>>()?.join(", ");
            Ok(format!("        {}: {{{settings}}},\n", quoted(name)?))
        };
        let named = of_variants.into_iter().flat_map(|axis| axis.values.iter().zip(&axis.variants));
        let variants = named.map(variant).collect::<Result<Vec<_>, Failure>>()?.concat();
        let questions = self.questions_in_ron()?;
        Ok(format!(
            "(\n    name: {},\n    scenario: {},\n    policies: [{}],\n    trials: {},\n    {seeds},\n    \
             keep: {},\n{questions}    variants: {{\n{variants}    }},\n    axes: {{\n{axes}    }},\n)\n",
            quoted(&self.name)?,
            quoted(scenario)?,
            policies.join(", "),
            self.trials,
            self.keep.in_files(),
        ))
    }

    /// The fields of a sweep file with what is asked of the results; empty if nothing is.
    fn questions_in_ron(&self) -> Result<String, Failure> {
        let quoted = |text: &String| ron::to_string(text).map_err(Failure::run);
        let list = |texts: &[String]| -> Result<String, Failure> {
            Ok(texts.iter().map(quoted).collect::<Result<Vec<_>, _>>()?.join(", "))
        };
        let Asks { primary, baseline, margins, expect } = self.asks()?;
        let mut lines = Vec::new();
        if !primary.is_empty() {
            lines.push(format!("primary: [{}]", list(&primary)?));
        }
        if let Some(baseline) = &baseline {
            lines.push(format!("baseline: {}", quoted(baseline)?));
        }
        if !margins.is_empty() {
            let margins = margins.iter().map(|(name, margin)| Ok(format!("{}: {margin:?}", quoted(name)?)));
            lines.push(format!("margins: {{{}}}", margins.collect::<Result<Vec<_>, Failure>>()?.join(", ")));
        }
        if !expect.is_empty() {
            lines.push(format!("expect: [{}]", list(&expect)?));
        }
        Ok(lines.into_iter().map(|line| format!("    {line},\n")).collect::<Vec<_>>().concat())
    }
}
