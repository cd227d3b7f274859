//! The readings of RNE in a sweep: which reading forms other groups, and how that changes the outcome.

use std::collections::BTreeSet;

use experiments::Failure;
use experiments::comparison::{self, CONFIDENCE, Pairs};
use experiments::experiment::PolicySpec;
use experiments::metric::{Catalogue, Values};
use experiments::rounds::Round;
use experiments::sweep::folder::Folder;
use rayon::prelude::*;
use statistics::Moments;
use statistics::paired::t_half_width_at;

/// The metrics whose differences are shown: rescuees, of all tasks and of each task, and energy per
/// rescuee.
pub fn shown(metrics: &Catalogue) -> Vec<usize> {
    let energy = metrics.named("energy_per_rescuee.total").ok();
    metrics.declared("rescuees").into_iter().chain(energy).collect()
}

/// A mean difference with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Mean.
    pub mean: f64,
    /// Half the width of the paired t interval, at 95 % unless another confidence is stated.
    pub half: f64,
}

impl Difference {
    /// The mean of these differences.
    fn of(differences: &[f64]) -> Option<Self> {
        Self::at(differences, CONFIDENCE)
    }

    /// The same with an interval at another confidence.
    fn at(differences: &[f64], confidence: f64) -> Option<Self> {
        Some(Self { mean: Moments::of(differences).mean?, half: t_half_width_at(differences, confidence)? })
    }

    /// The side of zero on which the whole interval lies: 1, -1, or 0 for neither.
    pub fn side(&self) -> i32 {
        if self.mean - self.half > 0.0 { 1 } else { -i32::from(self.mean + self.half < 0.0) }
    }
}

/// One reading compared with the default.
#[derive(Debug, Clone)]
pub struct ReadingRow {
    /// The option and its value.
    pub reading: String,
    /// Share of the default's rounds in which the reading decides otherwise: with other groups for the
    /// tasks, and with another split.
    pub regrouped: [f64; 2],
    /// Share of the trials with another outcome.
    pub trials: f64,
    /// Differences of the metrics that are [`shown`], reading minus default.
    pub differences: Vec<Option<Difference>>,
}

/// Number of readings above, below or on neither side of another policy, or of all other policies at once.
#[derive(Debug, Clone)]
pub struct RivalRow {
    /// The other policy; `None` for all at once.
    pub rival: Option<String>,
    /// The metric.
    pub metric: String,
    /// Number of readings whose interval lies above zero, below zero, and around zero.
    pub counts: [usize; 3],
    /// The first two counts, with intervals at 95 % shared by all readings.
    pub corrected: [usize; 2],
    /// The least and the greatest mean difference, with the reading; `None` against all at once.
    pub ends: Option<[(String, Difference); 2]>,
}

/// The trials that every policy has finished.
#[derive(Clone)]
pub struct Trials<'f> {
    folder: &'f Folder,
    /// Numbers of these trials.
    pub numbers: Vec<u32>,
}

impl<'f> Trials<'f> {
    /// The trials of a sweep without axes.
    pub fn of(folder: &'f Folder) -> Self {
        let policies = folder.experiment().policies.len();
        let has = |policy: usize, trial: u32| {
            folder.results().get(&(0, policy, trial)).is_some_and(|measured| measured.metrics.is_some())
        };
        let is_whole = |trial: &u32| (0..policies).all(|policy| has(policy, *trial));
        Self { folder, numbers: (1..=folder.experiment().trials).filter(is_whole).collect() }
    }

    fn policies(&self) -> &'f [PolicySpec] {
        &self.folder.experiment().policies
    }

    fn catalogue(&self) -> &'f Catalogue {
        &self.folder.experiment().metrics
    }

    fn metrics(&self, policy: usize, trial: u32) -> Option<&'f Values> {
        self.folder.results().get(&(0, policy, trial))?.metrics.as_ref()
    }

    /// Metric of one policy minus that of another, for several pairs over the same trials.
    fn joint(&self, metric: usize, pairs: &[[usize; 2]]) -> Vec<Vec<f64>> {
        let numbers = self.numbers.iter().copied();
        let trials = comparison::Trials::new(self.catalogue(), self.folder.results(), numbers);
        let quantities = pairs.iter().map(|pair| pair.map(|policy| ((0, policy), metric)));
        trials.joint(&quantities.collect::<Vec<_>>()).iter().map(Pairs::differences).collect()
    }

    /// The same for one pair.
    fn differences(&self, metric: usize, a: usize, b: usize) -> Vec<f64> {
        self.joint(metric, &[[a, b]]).concat()
    }

    /// Share of the trials in which two policies differ in any metric.
    fn otherwise(&self, a: usize, b: usize) -> f64 {
        let is_other = |trial: &&u32| self.metrics(a, **trial) != self.metrics(b, **trial);
        self.numbers.iter().filter(is_other).count() as f64 / self.numbers.len() as f64
    }

    /// The readings, without any reading whose trials equal those of an earlier one.
    pub fn distinct(&self, readings: &[usize]) -> Vec<usize> {
        let mut distinct: Vec<usize> = Vec::new();
        for reading in readings {
            let is_new = distinct.iter().all(|known| self.otherwise(*known, *reading) > 0.0);
            distinct.extend(is_new.then_some(*reading));
        }
        distinct
    }
}

/// The readings that differ from the default in one option.
///
/// # Errors
/// A policy cannot group one of the rounds.
pub fn single(
    trials: &Trials,
    default: usize,
    readings: &[usize],
    rounds: &[Round],
) -> Result<Vec<ReadingRow>, Failure> {
    let (policies, shown) = (trials.policies(), shown(trials.catalogue()));
    let alone: Vec<usize> = readings.iter().copied().filter(|i| policies[*i].options().len() == 1).collect();
    let row = |reading: &usize| {
        let difference = |metric: &usize| Difference::of(&trials.differences(*metric, *reading, default));
        Ok(ReadingRow {
            reading: options_in_words(&policies[*reading]),
            regrouped: regrouped(trials.folder, *reading, rounds)?,
            trials: trials.otherwise(*reading, default),
            differences: shown.iter().map(difference).collect(),
        })
    };
    alone.par_iter().map(row).collect()
}

fn options_in_words(policy: &PolicySpec) -> String {
    let options: Vec<String> =
        policy.options().iter().map(|(option, value)| format!("{option}: {value}")).collect();
    if options.is_empty() { "default".to_owned() } else { options.join(", ") }
}

/// Shares of the rounds in which a reading forms other groups, and another split.
fn regrouped(folder: &Folder, reading: usize, rounds: &[Round]) -> Result<[f64; 2], Failure> {
    let policy = folder.experiment().policies[reading].made();
    let same = rounds.par_iter().map(|round| Ok(round.is_as(&round.grouped_by(policy)?)));
    let same = same.collect::<Result<Vec<[bool; 2]>, Failure>>()?;
    let share =
        |which: usize| same.iter().filter(|same| !same[which]).count() as f64 / same.len().max(1) as f64;
    Ok([share(0), share(1)])
}

/// For each option and value other than the default: the difference to the same combination with the
/// default, trial by trial, averaged over all combinations of the other options.
pub fn averaged(trials: &Trials, readings: &[usize]) -> Vec<(String, Vec<Option<Difference>>)> {
    let (policies, shown) = (trials.policies(), shown(trials.catalogue()));
    let mut values: Vec<(String, String)> = Vec::new();
    for reading in readings {
        for option in policies[*reading].options() {
            if !values.contains(option) {
                values.push(option.clone());
            }
        }
    }
    let without = |reading: usize, option: &str| {
        let rest: Vec<_> = policies[reading].options().iter().filter(|(name, _)| name != option).collect();
        let is_rest = |other: &&usize| policies[**other].options().iter().collect::<Vec<_>>() == rest;
        readings.iter().find(is_rest).copied()
    };
    let row = |(option, value): &(String, String)| {
        let with =
            readings.iter().filter(|i| policies[**i].options().contains(&(option.clone(), value.clone())));
        let pairs: Vec<[usize; 2]> = with.filter_map(|i| Some([*i, without(*i, option)?])).collect();
        let difference = |metric: &usize| {
            let all = trials.joint(*metric, &pairs);
            let mean = |trial: usize| Moments::of(&all.iter().map(|of| of[trial]).collect::<Vec<_>>()).mean;
            Difference::of(&(0..all.first()?.len()).filter_map(mean).collect::<Vec<_>>())
        };
        (
            format!("{option}: {value} ({} pairs of readings)", pairs.len()),
            shown.iter().map(difference).collect(),
        )
    };
    values.par_iter().map(row).collect()
}

/// The side of a rival on which each reading is: by its own interval, and by an interval shared by all
/// readings.
type Sides = Vec<[i32; 2]>;

/// Readings compared with each policy that is not a reading, and with all of these policies at once.
pub fn rivals(trials: &Trials, readings: &[usize]) -> Vec<RivalRow> {
    let policies = trials.policies();
    let rivals: Vec<usize> = (0..policies.len()).filter(|i| policies[*i].name != "RNE").collect();
    let shared = 1.0 - (1.0 - CONFIDENCE) / readings.len() as f64;
    let mut rows = Vec::new();
    for metric in shown(trials.catalogue()) {
        let name = &trials.catalogue()[metric].name;
        let mut all: Vec<Sides> = Vec::new();
        for rival in &rivals {
            let differences: Vec<_> =
                readings.par_iter().map(|reading| trials.differences(metric, *reading, *rival)).collect();
            let side = |differences: &Vec<f64>| {
                [CONFIDENCE, shared].map(|at| Difference::at(differences, at).map_or(0, |found| found.side()))
            };
            let sides: Sides = differences.iter().map(side).collect();
            let in_words = |reading: &usize| options_in_words(&policies[*reading]);
            let found = readings.iter().zip(&differences);
            let found: Vec<(String, Difference)> =
                found.filter_map(|(reading, of)| Some((in_words(reading), Difference::of(of)?))).collect();
            let Some(ends) = ends(&found) else { continue };
            rows.push(RivalRow {
                rival: Some(policies[*rival].label.clone()),
                metric: name.clone(),
                counts: [1, -1, 0].map(|side| count(&sides, 0, side)),
                corrected: [1, -1].map(|side| count(&sides, 1, side)),
                ends: Some(ends),
            });
            all.push(sides);
        }
        if all.len() > 1 && all.len() == rivals.len() {
            let sides = together(&all);
            let counts = [1, -1, 0].map(|side| count(&sides, 0, side));
            let corrected = [1, -1].map(|side| count(&sides, 1, side));
            rows.push(RivalRow { rival: None, metric: name.clone(), counts, corrected, ends: None });
        }
    }
    rows
}

fn count(sides: &Sides, which: usize, side: i32) -> usize {
    sides.iter().filter(|of| of[which] == side).count()
}

/// The side on which a reading is against all rivals; 0 if the sides differ.
fn together(all: &[Sides]) -> Sides {
    let of = |reading: usize, which: usize| {
        let mut sides = all.iter().map(|sides| sides[reading][which]);
        let first = sides.next().unwrap_or(0);
        if sides.all(|side| side == first) { first } else { 0 }
    };
    (0..all[0].len()).map(|reading| [of(reading, 0), of(reading, 1)]).collect()
}

/// The least and the greatest difference; the first of equals.
fn ends(found: &[(String, Difference)]) -> Option<[(String, Difference); 2]> {
    let by_mean = |a: &&(String, Difference), b: &&(String, Difference)| a.1.mean.total_cmp(&b.1.mean);
    let (least, most) = (found.iter().min_by(by_mean)?, found.iter().rev().max_by(by_mean)?);
    Some([least.clone(), most.clone()])
}

/// Number of readings that form different groups, in a sentence.
///
/// # Errors
/// A policy cannot group one of the rounds.
pub fn groupings_in_words(folder: &Folder, readings: &[usize], rounds: &[Round]) -> Result<String, Failure> {
    let groups = |reading: &usize| {
        let policy = folder.experiment().policies[*reading].made();
        let groups = rounds.iter().map(|round| Ok(round.grouped_by(policy)?.groups));
        groups.collect::<Result<Vec<Vec<Vec<u32>>>, Failure>>()
    };
    let all = readings.par_iter().map(groups).collect::<Result<Vec<_>, Failure>>()?;
    let distinct = all.iter().collect::<BTreeSet<_>>().len();
    let per_round: f64 = (0..rounds.len())
        .map(|round| all.iter().map(|groups| &groups[round]).collect::<BTreeSet<_>>().len() as f64)
        .sum::<f64>()
        / rounds.len().max(1) as f64;
    Ok(format!(
        "Of {} readings, {distinct} differ in how they group at least one of these rounds; a round is \
         grouped in {per_round:.1} different ways on average.",
        readings.len()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reading_is_above_all_when_it_is_above_each() {
        let (dis, eng) = (vec![[1, 1], [1, 0], [-1, -1], [0, 0]], vec![[1, 1], [1, 1], [-1, 0], [1, 1]]);
        let all = together(&[dis, eng]);
        assert_eq!(all, [[1, 1], [1, 0], [-1, 0], [0, 0]]);
        assert_eq!([1, -1, 0].map(|side| count(&all, 0, side)), [2, 1, 1]);
    }

    #[test]
    fn the_first_of_equal_ends_is_named() {
        let found: Vec<(String, Difference)> = [("a", 1.0), ("b", 3.0), ("c", 3.0), ("d", 1.0)]
            .map(|(name, mean)| (name.to_owned(), Difference { mean, half: 0.5 }))
            .to_vec();
        let [least, most] = ends(&found).unwrap();
        assert_eq!((least.0.as_str(), most.0.as_str()), ("a", "b"));
        assert_eq!(ends(&[]), None);
    }
}
