//! Parses expectations.

use std::path::Path;

use store::Failure;

use super::{Expectation, Expected, Relation};
use crate::experiment::{Experiment, PolicySpec};
use crate::metric::Catalogue;

/// Confidence of an expectation without a stated confidence.
const CONFIDENCE: f64 = 0.95;

/// Error of an expectation, in one sentence.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("expect: {reason}, found {found:?}")]
pub struct Bad {
    reason: String,
    found: String,
}

const FORMS: &str = "must be like \"rescuees.total >= 60 in 90 % of seeds\", \"DIS: rounds > 2 in 50 % of \
    seeds\", \
                     \"rescuees.total: RNE > DIS by 5 (95 %)\" or \"rescuees.total: RNE = ENG within 3 \
                     (95 %)\"";

/// What the file of a sweep expects, in the order in which it is written there.
///
/// # Errors
/// Expectations that cannot be read, all of them.
pub fn expectations(experiment: &Experiment, file: &Path) -> Result<Vec<Expected>, Failure> {
    let read = |text: &String| parse(text, &experiment.metrics, &experiment.policies);
    let (read, bad): (Vec<_>, Vec<_>) = experiment.plan.expect.iter().map(read).partition(Result::is_ok);
    let bad: Vec<String> =
        bad.into_iter().filter_map(Result::err).map(|bad| format!("{}: {bad}", file.display())).collect();
    if bad.is_empty() {
        Ok(read.into_iter().flatten().collect())
    } else {
        Err(Failure::input(bad.join("\n")))
    }
}

/// Reads an expectation of a sweep with these metrics and policies.
///
/// # Errors
/// Text of another form, or a metric, a policy or a number that cannot be used.
pub fn parse(text: &str, metrics: &Catalogue, policies: &[PolicySpec]) -> Result<Expected, Bad> {
    let bad = |reason: String| Bad { reason, found: text.to_owned() };
    let parser = Parser { metrics, policies };
    let (rest, confidence) = confidence(text).map_err(&bad)?;
    let what = if let Some((rest, share)) = rest.rsplit_once(" in ") {
        parser.share(rest, share)
    } else {
        parser.difference(rest)
    };
    Ok(Expected { text: text.trim().to_owned(), what: what.map_err(bad)?, confidence })
}

/// Splits off the confidence in brackets at the end; without brackets, it is the default.
fn confidence(text: &str) -> Result<(&str, f64), String> {
    let text = text.trim();
    let Some((rest, last)) = text.strip_suffix(')').and_then(|text| text.rsplit_once('(')) else {
        return Ok((text, CONFIDENCE));
    };
    match percent(last) {
        Some(share) if (0.5..1.0).contains(&share) => Ok((rest.trim(), share)),
        _ => Err("the confidence in brackets must be from 50 % to below 100 %".to_owned()),
    }
}

fn percent(text: &str) -> Option<f64> {
    Some(text.trim().strip_suffix('%')?.trim().parse::<f64>().ok()? / 100.0)
}

fn number(text: &str) -> Result<f64, String> {
    let value = text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    value.ok_or_else(|| format!("{:?} must be a number", text.trim()))
}

/// Splits a text at the first of these words, into the text before it, the word's value, and the text after
/// it.
fn split<'t, T: Copy>(text: &'t str, words: &[(&str, T)]) -> Option<(&'t str, T, &'t str)> {
    let found = words.iter().filter_map(|(word, value)| Some((text.find(word)?, *word, *value)));
    // Of two words at the same place, the longer one wins: `>=` before `>`.
    let (at, word, value) = found.min_by_key(|(at, word, _)| (*at, usize::MAX - word.len()))?;
    Some((text[..at].trim(), value, text[at + word.len()..].trim()))
}

struct Parser<'a> {
    metrics: &'a Catalogue,
    policies: &'a [PolicySpec],
}

impl Parser<'_> {
    /// `[POLICY:] METRIC >= VALUE` and `P % of seeds`.
    fn share(&self, rest: &str, share: &str) -> Result<Expectation, String> {
        let share = share.trim().strip_suffix("of seeds").and_then(percent);
        let share = share.filter(|share| *share > 0.0 && *share <= 1.0);
        let share = share.ok_or("the share must be `in P % of seeds` with P above 0 and up to 100")?;
        let relations = [
            (">=", Relation::AtLeast),
            (">", Relation::Above),
            ("<=", Relation::AtMost),
            ("<", Relation::Below),
            ("==", Relation::Equal),
        ];
        let (before, relation, value) = split(rest, &relations).ok_or(FORMS)?;
        let (policy, metric) = match before.rsplit_once(':') {
            Some((policy, metric)) => (self.policy(policy)?, metric),
            None => (0, before),
        };
        Ok(Expectation::Share {
            policy,
            metric: self.metric(metric)?,
            relation,
            value: number(value)?,
            share,
        })
    }

    /// `METRIC: A > B [by D]`, `METRIC: A < B [by D]` or `METRIC: A = B within D`.
    fn difference(&self, rest: &str) -> Result<Expectation, String> {
        let (metric, rest) = rest.split_once(':').ok_or(FORMS)?;
        let metric = self.metric(metric)?;
        if let Some((pair, margin)) = rest.split_once(" within ") {
            let (a, b) = pair.split_once('=').ok_or(FORMS)?;
            let within = number(margin)?;
            if within <= 0.0 {
                return Err("the margin after `within` must be above 0".to_owned());
            }
            return Ok(Expectation::Equal { metric, policies: self.two(a, b)?, within });
        }
        let (pair, by) = match rest.split_once(" by ") {
            Some((pair, by)) => (pair, number(by)?),
            None => (rest, 0.0),
        };
        let (a, is_above, b) = split(pair, &[(">", true), ("<", false)]).ok_or(FORMS)?;
        let [a, b] = self.two(a, b)?;
        Ok(Expectation::Above { metric, policies: if is_above { [a, b] } else { [b, a] }, by })
    }

    fn metric(&self, name: &str) -> Result<usize, String> {
        self.metrics.named(name.trim()).map_err(|error| error.to_string())
    }

    fn two(&self, a: &str, b: &str) -> Result<[usize; 2], String> {
        let both = [self.policy(a)?, self.policy(b)?];
        if both[0] == both[1] { Err("the two policies must differ".to_owned()) } else { Ok(both) }
    }

    fn policy(&self, label: &str) -> Result<usize, String> {
        let found = self.policies.iter().position(|policy| policy.label == label.trim());
        found.ok_or_else(|| {
            let labels: Vec<&str> = self.policies.iter().map(|policy| policy.label.as_str()).collect();
            format!("{:?} must be a policy of the sweep ({})", label.trim(), labels.join(", "))
        })
    }
}
