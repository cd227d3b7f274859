//! Which parameters of a scenario matter, for outcomes and for differences between policies.
//!
//! All points of a block share the seeds of their trials, and each block has seeds of its own. A
//! parameter's effect is therefore measured within the same random draws. The bootstrap over blocks covers
//! the parameters' places and the seeds together.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};
use store::Failure;

use super::design::{Block, MOVE, Method};
use super::space::Point;
use super::{Outcome, Parameter, Space, Values};
use crate::job::{Job, JobFolder};
use statistics::bootstrap::interval;
use statistics::sensitivity::{self as indices, Effects, Known, Shares};

/// Name of the table of indices.
pub const INDICES: &str = "indices.csv";
/// Name of the figure.
pub const FIGURE: &str = "indices.svg";
const JOB: Job = Job {
    noun: "sensitivity study",
    origin: "sensitivity.json",
    log: "evaluations.jsonl",
    results: &[INDICES, FIGURE],
};

/// A study of sensitivity.
pub struct Sensitivity {
    /// The parameters, and the outcomes.
    pub space: Space,
    /// The method.
    pub method: Method,
    /// Seed of the points' places.
    pub seed: u64,
    /// Seed of the first trial.
    pub first_seed: u64,
}

/// Block and point of an evaluation, from 0.
type Place = (u32, usize);

/// An evaluation: of a point of a block.
#[derive(Serialize, Deserialize)]
pub struct Evaluation {
    block: u32,
    point: usize,
    first_seed: u64,
    values: Vec<f64>,
    outcomes: Values,
}

/// The evaluations of a study.
pub type Evaluations = JobFolder<Evaluation>;

/// A parameter's index; its form depends on the method.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Index {
    /// Elementary effects: change of the outcome over the parameter's whole range. For chance, the effects
    /// of other seeds.
    Effects {
        /// Summary of the effects.
        #[serde(flatten)]
        effects: Effects,
        /// mu* minus the mu* of other seeds; `None` for chance itself.
        #[serde(rename = "beyond_chance")]
        beyond: Option<Known>,
    },
    /// Shares of the variance.
    Shares(Shares),
    /// The share of the variance that the seeds alone make.
    Chance {
        /// The share.
        first: Known,
    },
}

/// A parameter's index for an outcome.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The outcome.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// The parameter; [`CHANCE`] for the seeds.
    pub parameter: String,
    /// Number of blocks in which the index is known.
    pub blocks: usize,
    /// The index.
    #[serde(flatten)]
    pub index: Index,
}

/// Stands in the place of a parameter's name, for the effect of other seeds.
pub const CHANCE: &str = "chance (other seeds)";

impl Row {
    /// The value by which rows are ranked: mu*, or the total index.
    pub fn size(&self) -> f64 {
        match self.index {
            Index::Effects { effects, .. } => effects.size.value,
            Index::Shares(Shares { total, .. }) => total.value,
            Index::Chance { first } => first.value,
        }
    }

    /// Whether this is the row of chance.
    pub fn is_chance(&self) -> bool {
        self.parameter == CHANCE
    }

    /// Whether the index is distinguishable from chance. For effects, the mean effect's interval excludes
    /// zero, or the effects are larger than those of other seeds. For shares, the first-order interval is
    /// above zero.
    pub fn is_shown(&self) -> bool {
        let excludes_zero = |known: &Known| known.interval.is_some_and(|[low, high]| low > 0.0 || high < 0.0);
        let is_above = |known: &Known| known.interval.is_some_and(|[low, _]| low > 0.0);
        match &self.index {
            Index::Effects { effects, beyond } => {
                excludes_zero(&effects.mean) || beyond.as_ref().is_some_and(is_above)
            }
            Index::Shares(Shares { first, .. }) | Index::Chance { first } => is_above(first),
        }
    }
}

/// The values of the evaluated points in the first `blocks` blocks, in order.
fn known(evaluations: &Evaluations, blocks: u32) -> BTreeMap<Place, &Values> {
    let known = evaluations.entries.iter().filter(|entry| entry.block < blocks);
    known.map(|entry| ((entry.block, entry.point), &entry.outcomes)).collect()
}

impl Sensitivity {
    /// Opens the study's log in a folder.
    ///
    /// # Errors
    /// The folder belongs to something else, or the disk does not take the log.
    pub fn open(&self, folder: &Path, is_fresh: bool) -> Result<Evaluations, Failure> {
        JOB.open(folder, self.origin(), is_fresh)
    }

    /// Number of evaluated points in the first `blocks` blocks.
    pub fn evaluated(&self, blocks: u32, evaluations: &Evaluations) -> usize {
        known(evaluations, blocks).len()
    }

    /// Number of points in this many blocks.
    pub fn count(&self, blocks: u32) -> usize {
        blocks as usize * self.points(0).len()
    }

    fn block(&self, number: u32) -> Block {
        Block::draw(self.method, self.space.free.len(), self.seed, number)
    }

    /// The points of a block. For elementary effects, the last point repeats the first with other seeds.
    fn points(&self, number: u32) -> Vec<Point> {
        let trials = u64::from(self.space.experiment.trials);
        let first_seed = self.first_seed + 2 * trials * u64::from(number);
        let places = self.block(number).places;
        let values = |places: &Vec<f64>| -> Vec<f64> {
            self.space.free.iter().zip(places).map(|(free, place)| free.value(*place)).collect()
        };
        let mut points: Vec<Point> =
            places.iter().map(|places| Point { values: values(places), first_seed }).collect();
        if self.method == Method::Morris {
            points.push(Point { values: values(&places[0]), first_seed: first_seed + trials });
        }
        points
    }

    /// Evaluates the missing points of the first `blocks` blocks. Returns false if `stop` interrupted it.
    /// `done` receives the number of evaluated points.
    ///
    /// # Errors
    /// The disk does not take the log.
    pub fn evaluate(
        &self,
        blocks: u32,
        evaluations: &mut Evaluations,
        stop: &AtomicBool,
        mut done: impl FnMut(usize),
    ) -> Result<bool, Failure> {
        let all = (0..blocks).flat_map(|block| {
            self.points(block).into_iter().enumerate().map(move |(i, point)| ((block, i), point))
        });
        let known = known(evaluations, blocks);
        let missing: Vec<_> = all.filter(|(place, _)| !known.contains_key(place)).collect();
        let trials = self.space.experiment.trials as usize;
        // A batch is large enough to keep all threads busy, and small enough that an interruption loses
        // little.
        let batch = (4 * rayon::current_num_threads()).div_ceil(trials);
        let mut there = self.count(blocks) - missing.len();
        for batch in missing.chunks(batch) {
            let (places, points): (Vec<_>, Vec<_>) = batch.iter().cloned().unzip();
            let Some(values) = self.space.evaluate(&points, stop) else { return Ok(false) };
            let points = places.into_iter().zip(points).zip(values);
            let entry = |(((block, point), Point { values, first_seed }), outcomes)| Evaluation {
                block,
                point,
                first_seed,
                values,
                outcomes,
            };
            evaluations.add(points.map(entry).collect())?;
            there += batch.len();
            done(there);
        }
        Ok(true)
    }

    /// Everything that decides the evaluations.
    fn origin(&self) -> serde_json::Value {
        let experiment = &self.space.experiment;
        let policies: Vec<&str> = experiment.policies.iter().map(|policy| policy.label.as_str()).collect();
        serde_json::json!({
            "program": experiment.program.digest().to_string(),
            "method": self.method,
            "over": self.space.free.iter().map(Parameter::to_string).collect::<Vec<_>>(),
            "policies": policies,
            "outcomes": self.space.outcomes.iter().map(Outcome::name).collect::<Vec<_>>(),
            "trials": experiment.trials,
            "first_seed": self.first_seed,
            "seed": self.seed,
            "scenario": experiment.base.resolved(),
        })
    }

    /// Number of failed points in the first `blocks` blocks, and the first failure's reason; `None` without
    /// failures.
    pub fn failures(&self, blocks: u32, evaluations: &Evaluations) -> Option<(usize, String)> {
        let known = known(evaluations, blocks);
        let mut reasons = known.values().filter_map(|values| values.as_ref().err());
        let first = reasons.next()?.to_string();
        Some((1 + reasons.count(), first))
    }

    /// The indices of all outcomes from the first `blocks` blocks. Each outcome's parameters are in the
    /// order of their size, with chance last. Blocks with an undefined point are left out.
    pub fn indices(&self, blocks: u32, evaluations: &Evaluations) -> Vec<Row> {
        let (outcomes, known) = (self.space.outcomes.iter().enumerate(), known(evaluations, blocks));
        let of = |(place, outcome): (usize, &Outcome)| {
            let values = |number: u32| -> Option<Vec<f64>> {
                let points = (0..self.count(1)).map(|point| known.get(&(number, point)));
                points.map(|values| values?.as_ref().ok()?[place]).collect()
            };
            let whole: Vec<(u32, Vec<f64>)> =
                (0..blocks).filter_map(|number| Some((number, values(number)?))).collect();
            let mut rows = match self.method {
                Method::Morris => self.effects(outcome, &whole),
                Method::Sobol => self.shares(outcome, &whole),
            };
            rows.sort_by(|a, b| {
                a.is_chance().cmp(&b.is_chance()).then_with(|| b.size().total_cmp(&a.size()))
            });
            rows
        };
        outcomes.flat_map(of).collect()
    }

    fn effects(&self, outcome: &Outcome, blocks: &[(u32, Vec<f64>)]) -> Vec<Row> {
        let count = self.space.free.len();
        let mut found = vec![Vec::new(); count];
        let mut chance = Vec::new();
        for (number, values) in blocks {
            let Block { places, moved } = self.block(*number);
            for (i, parameter) in moved.iter().enumerate() {
                let by = places[i + 1][*parameter] - places[i][*parameter];
                found[*parameter].push((values[i + 1] - values[i]) / by + 0.0); // no -0
            }
            chance.push((values[count + 1] - values[0]) / MOVE);
        }
        let row = |parameter: &str, effects: &[f64], beyond: Option<Known>| {
            let index = Index::Effects { effects: indices::effects(effects)?, beyond };
            Some(Row {
                outcome: outcome.clone(),
                parameter: parameter.to_owned(),
                blocks: blocks.len(),
                index,
            })
        };
        let beyond = |effects: &[f64]| {
            let pairs = effects.iter().zip(&chance);
            let beyond: Vec<f64> = pairs.map(|(effect, chance)| effect.abs() - chance.abs()).collect();
            let value = beyond.iter().sum::<f64>() / beyond.len().max(1) as f64;
            Some(Known { value, interval: interval(&beyond, 0.95) })
        };
        let free = self.space.free.iter().zip(&found);
        let rows = free.filter_map(|(free, effects)| row(&free.name, effects, beyond(effects)));
        rows.chain(row(CHANCE, &chance, None)).collect()
    }

    fn shares(&self, outcome: &Outcome, blocks: &[(u32, Vec<f64>)]) -> Vec<Row> {
        let of = |(_, values): &(u32, Vec<f64>)| indices::Block {
            a: values[0],
            b: values[1],
            mixed: values[2..].to_vec(),
        };
        let blocks: Vec<indices::Block> = blocks.iter().map(of).collect();
        let row = |parameter: &str, index: Index| Row {
            outcome: outcome.clone(),
            parameter: parameter.to_owned(),
            blocks: blocks.len(),
            index,
        };
        let free = self.space.free.iter().enumerate();
        let rows =
            free.filter_map(|(i, free)| Some(row(&free.name, Index::Shares(indices::shares(&blocks, i)?))));
        let chance = indices::common_share(&blocks).map(|first| row(CHANCE, Index::Chance { first }));
        rows.chain(chance).collect()
    }
}
