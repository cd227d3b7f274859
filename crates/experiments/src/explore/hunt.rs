//! The search for the scenario in which a policy performs worst.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use ron_tree::edited;
use serde::{Deserialize, Serialize};
use store::Failure;

use super::space::{Point, PointError, Space};
use super::{Descent, Parameter, WORST};
use crate::job::{Job, JobFolder};

/// Name of the file with the found scenario.
pub const FOUND: &str = "found.ron";
const JOB: Job = Job { noun: "search", origin: "search.json", log: "evaluations.jsonl", results: &[FOUND] };

/// Start of a found scenario's first line.
const ORIGIN_LINE: &str = "// Found by usar search";

/// Suffix of a found scenario's name.
const SUFFIX: &str = "-found";

/// A search. The space has one outcome.
pub struct Hunt {
    /// The parameters, and the outcome.
    pub space: Space,
    /// Whether to look for the lowest outcome instead of the highest.
    pub is_lowest: bool,
    /// Seed of the first trial of each candidate.
    pub first_seed: u64,
    /// Settings of the search.
    pub descent: Descent,
}

/// A candidate and its outcome.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// A value for each parameter.
    pub values: Vec<f64>,
    /// The outcome on the search's seeds, or why there is none.
    pub outcome: Result<f64, PointError>,
}

/// The candidates of a search, in the order in which they were evaluated; the first is the start.
pub type Trail = JobFolder<Candidate>;

impl Hunt {
    /// Opens the search's log in a folder.
    ///
    /// # Errors
    /// The folder belongs to something else, or the disk does not take the log.
    pub fn open(&self, folder: &Path, is_fresh: bool) -> Result<Trail, Failure> {
        JOB.open(folder, self.origin(), is_fresh)
    }

    /// Everything that decides the evaluations.
    fn origin(&self) -> serde_json::Value {
        let experiment = &self.space.experiment;
        serde_json::json!({
            "program": experiment.program.digest().to_string(),
            "over": self.space.free.iter().map(Parameter::to_string).collect::<Vec<_>>(),
            "outcome": self.space.outcomes[0].name(),
            "is_lowest": self.is_lowest,
            "trials": experiment.trials,
            "first_seed": self.first_seed,
            "seed": self.descent.seed,
            "first_step": self.descent.first_step,
            "scenario": experiment.base.resolved(),
        })
    }

    /// The candidate with the lowest or the highest outcome, as the search wants it; the earliest of
    /// equals.
    pub fn best<'a>(&self, trail: &'a Trail) -> Option<(&'a Candidate, f64)> {
        let found = trail.entries.iter();
        let found = found.filter_map(|candidate| Some((candidate, *candidate.outcome.as_ref().ok()?)));
        found.min_by(|a, b| self.turned(a.1).total_cmp(&self.turned(b.1)))
    }

    /// The outcome with its sign chosen so that lower is better.
    fn turned(&self, outcome: f64) -> f64 {
        if self.is_lowest { outcome } else { -outcome }
    }

    /// Continues the search. Returns false if `stop` interrupted it. `done` receives the number of
    /// candidates so far and the best outcome.
    ///
    /// # Errors
    /// The disk does not take the log.
    pub fn search(
        &self,
        trail: &mut Trail,
        stop: &AtomicBool,
        mut done: impl FnMut(usize, f64),
    ) -> Result<bool, Failure> {
        let present = self.space.present()?;
        let ends = self.space.free.iter().map(Parameter::ends);
        let start: Vec<f64> =
            present.into_iter().zip(ends).map(|(value, [low, high])| value.clamp(low, high)).collect();
        let mut asked = 0;
        self.descent.search(&self.space.free, &start, stop, |values| {
            let known = trail.entries.iter().find(|candidate| candidate.values == values).cloned();
            let is_known = known.is_some();
            let Some(candidate) = known.or_else(|| self.evaluate(values, stop)) else { return Ok(None) };
            if !is_known {
                trail.add(vec![candidate.clone()])?;
            }
            asked += 1;
            done(asked, self.best(trail).map_or(f64::NAN, |(_, outcome)| outcome));
            Ok(Some(candidate.outcome.map_or(WORST, |outcome| self.turned(outcome))))
        })
    }

    fn evaluate(&self, values: Vec<f64>, stop: &AtomicBool) -> Option<Candidate> {
        let point = Point { values, first_seed: self.first_seed };
        let outcome = self.space.evaluate(std::slice::from_ref(&point), stop)?.pop()?;
        let outcome = outcome.and_then(|values| values[0].ok_or(PointError::Undefined));
        Some(Candidate { values: point.values, outcome })
    }

    /// A candidate as a scenario file with every value; `what` appears in its first line.
    ///
    /// # Errors
    /// None for a candidate that was run.
    pub fn text(&self, candidate: &Candidate, what: &str) -> Result<String, Failure> {
        let base = &self.space.experiment.base;
        let pairs = self.space.free.iter().zip(&candidate.values);
        let mut settings: Vec<(String, String)> = pairs
            .flat_map(|(free, value)| free.settings(*value))
            .map(|(path, value)| (path.to_owned(), value))
            .collect();
        let name = base.name.strip_suffix(SUFFIX).unwrap_or(&base.name);
        settings.push(("name".to_owned(), format!("{:?}", format!("{name}{SUFFIX}"))));
        let text = edited(&base.resolved(), &settings).map_err(Failure::run)?;
        Ok(format!("{ORIGIN_LINE}: {what}\n{text}"))
    }
}
