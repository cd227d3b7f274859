//! `usar readings`: which reading of the paper's ambiguous places changes what.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use rayon::prelude::*;

use super::explain::rounds_in;
use crate::experiment::PolicySpec;
use crate::failure::Failure;
use crate::metric::metric_named;
use crate::rounds::Round;
use crate::stats::Moments;
use crate::stats::paired::t_half_width;
use crate::sweep::folder::Folder;
use crate::table::{averaged_table, readings_table, rivals_table};

/// The metrics whose differences are shown.
pub(crate) const SHOWN: [&str; 4] =
    ["rescuees.total", "rescuees.hard", "rescuees.easy", "energy_per_rescuee.total"];

/// Which reading of the paper's ambiguous places decides what?
#[derive(Debug, Args)]
#[command(after_help = "\
For a sweep with `readings` (scenarios/sweeps/readings.ron): how often each reading of RNE groups the teams that the default reading met otherwise \
than the default does, and what that does to the outcome, paired by seed; first each reading by itself, then averaged over all others.

Examples:
  usar sweep scenarios/sweeps/readings.ron
  usar readings results/readings")]
pub(crate) struct Arguments {
    /// Folder of a sweep with readings of RNE, the default among them
    folder: PathBuf,
}

/// A mean difference with the ends of its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Difference {
    /// Mean.
    pub mean: f64,
    /// Half the width of the paired t interval.
    pub half: f64,
}

impl Difference {
    fn of(differences: &[f64]) -> Option<Self> {
        Some(Self { mean: Moments::of(differences).mean?, half: t_half_width(differences)? })
    }

    /// On which side of zero the interval lies, if on one.
    pub(crate) fn side(&self) -> i32 {
        if self.mean - self.half > 0.0 { 1 } else { -i32::from(self.mean + self.half < 0.0) }
    }
}

/// One reading against the default.
pub(crate) struct ReadingRow {
    /// The option and its value.
    pub reading: String,
    /// Share of the default's rounds that it groups otherwise: with other tasks, and as another split.
    pub regrouped: [f64; 2],
    /// Share of the trials that go otherwise.
    pub trials: f64,
    /// Differences of the metrics of [`SHOWN`], reading less default.
    pub differences: Vec<Option<Difference>>,
}

/// How many readings are above, below or neither against another policy.
pub(crate) struct RivalRow {
    /// The other policy.
    pub rival: String,
    /// The metric.
    pub metric: &'static str,
    /// Readings whose interval lies above zero, below, and around it.
    pub counts: [usize; 3],
    /// The least and the greatest mean difference, with the reading.
    pub ends: [(String, Difference); 2],
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let mut folder = Folder::read(&self.folder)?;
        let policies = folder.experiment().policies.clone();
        let default = policies.iter().position(|policy| policy.label == "RNE").ok_or_else(|| {
            Failure::input(format!("{}: has no policy RNE to compare readings with", self.folder.display()))
        })?;
        let readings: Vec<usize> = (0..policies.len()).filter(|i| policies[*i].name == "RNE").collect();
        if readings.len() < 2 {
            return Err(Failure::input(format!("{}: has no readings to compare", self.folder.display())));
        }
        let rounds = rounds_in(&mut folder, 0, default)?;
        let rows = single(&folder, default, &readings, &rounds)?;
        let trials = folder.experiment().trials;
        writeln!(out, "Each reading by itself against the default, over {trials} pairs")?;
        writeln!(out, "{}", readings_table(&rows))?;
        writeln!(
            out,
            "regrouped: share of the {} rounds of the default's trials that the reading would group otherwise, and of those that it would split otherwise\n\
             whichever half takes which task; trials: share that go otherwise; differences: reading less default, with 95 % paired t intervals\n",
            rounds.len()
        )?;
        let averaged = averaged(&folder, &readings);
        if !averaged.is_empty() {
            writeln!(
                out,
                "Each reading averaged over all combinations of the others, against the default of its option"
            )?;
            writeln!(out, "{}\n", averaged_table(&averaged))?;
        }
        let rivals = rivals(&folder, &readings);
        if !rivals.is_empty() {
            writeln!(
                out,
                "All {} readings against each other policy: how many are above, below, neither",
                readings.len()
            )?;
            writeln!(out, "{}", rivals_table(&rivals))?;
        }
        writeln!(out, "{}", distinct(&folder, &readings, &rounds)?)?;
        Ok(())
    }
}

/// The readings that differ from the default in one option.
fn single(
    folder: &Folder,
    default: usize,
    readings: &[usize],
    rounds: &[Round],
) -> Result<Vec<ReadingRow>, Failure> {
    let policies = &folder.experiment().policies;
    let alone: Vec<usize> = readings.iter().copied().filter(|i| policies[*i].options().len() == 1).collect();
    let row = |reading: &usize| {
        let regrouped = regrouped(folder, *reading, rounds)?;
        let differences = SHOWN.map(|metric| Difference::of(&differences(folder, metric, *reading, default)));
        Ok(ReadingRow {
            reading: options_in_words(&policies[*reading]),
            regrouped,
            trials: other_trials(folder, *reading, default),
            differences: differences.to_vec(),
        })
    };
    alone.par_iter().map(row).collect()
}

fn options_in_words(policy: &PolicySpec) -> String {
    let options: Vec<String> =
        policy.options().iter().map(|(option, value)| format!("{option}: {value}")).collect();
    if options.is_empty() { "default".to_owned() } else { options.join(", ") }
}

/// Shares of the rounds that a reading groups otherwise, and splits otherwise.
fn regrouped(folder: &Folder, reading: usize, rounds: &[Round]) -> Result<[f64; 2], Failure> {
    let case = &folder.experiment().cases[0];
    let policy = &case.policies[reading];
    let same = rounds.par_iter().map(|round| Ok(round.is_as(&round.grouped_by(&**policy)?)));
    let same = same.collect::<Result<Vec<[bool; 2]>, Failure>>()?;
    let share =
        |which: usize| same.iter().filter(|same| !same[which]).count() as f64 / same.len().max(1) as f64;
    Ok([share(0), share(1)])
}

/// Metric of a reading less that of another policy, trial by trial.
fn differences(folder: &Folder, metric: &str, a: usize, b: usize) -> Vec<f64> {
    let Ok(metric) = metric_named(metric) else { return Vec::new() };
    let value =
        |policy: usize, trial: u32| folder.results().get(&(0, policy, trial))?.metrics.as_ref()?[metric];
    (1..=folder.experiment().trials).filter_map(|trial| Some(value(a, trial)? - value(b, trial)?)).collect()
}

/// Share of the trials of two policies that differ in any metric.
fn other_trials(folder: &Folder, a: usize, b: usize) -> f64 {
    let trials = folder.experiment().trials;
    let metrics = |policy: usize, trial: u32| folder.results().get(&(0, policy, trial)).map(|m| &m.metrics);
    let other = (1..=trials).filter(|trial| metrics(a, *trial) != metrics(b, *trial)).count();
    other as f64 / f64::from(trials)
}

/// For each option and value that is not the default, the mean over all combinations of the other options of the differences to the same combination
/// with the default, trial by trial.
fn averaged(folder: &Folder, readings: &[usize]) -> Vec<(String, Vec<Option<Difference>>)> {
    let policies = &folder.experiment().policies;
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
        let pairs: Vec<(usize, usize)> = with.filter_map(|i| Some((*i, without(*i, option)?))).collect();
        let differences = SHOWN.map(|metric| {
            let all: Vec<Vec<f64>> = pairs.iter().map(|(a, b)| differences(folder, metric, *a, *b)).collect();
            let trials = all.iter().map(Vec::len).min().unwrap_or(0);
            let mean = |trial: usize| all.iter().map(|of| of[trial]).sum::<f64>() / all.len() as f64;
            let is_whole = all.iter().all(|of| of.len() == trials);
            is_whole.then(|| Difference::of(&(0..trials).map(mean).collect::<Vec<f64>>())).flatten()
        });
        (format!("{option}: {value} ({} pairs of readings)", pairs.len()), differences.to_vec())
    };
    values.par_iter().map(row).collect()
}

/// All readings against each policy that is none.
fn rivals(folder: &Folder, readings: &[usize]) -> Vec<RivalRow> {
    let policies = &folder.experiment().policies;
    let rivals: Vec<usize> = (0..policies.len()).filter(|i| policies[*i].name != "RNE").collect();
    let mut rows = Vec::new();
    for metric in SHOWN {
        for rival in &rivals {
            let found: Vec<(String, Difference)> = readings
                .iter()
                .filter_map(|reading| {
                    let difference = Difference::of(&differences(folder, metric, *reading, *rival))?;
                    Some((options_in_words(&policies[*reading]), difference))
                })
                .collect();
            let count = |side: i32| found.iter().filter(|(_, difference)| difference.side() == side).count();
            let by_mean =
                |a: &&(String, Difference), b: &&(String, Difference)| a.1.mean.total_cmp(&b.1.mean);
            let (Some(least), Some(most)) =
                (found.iter().min_by(by_mean), found.iter().rev().max_by(by_mean))
            else {
                continue;
            };
            let ends = [least.clone(), most.clone()];
            let counts = [count(1), count(-1), count(0)];
            rows.push(RivalRow { rival: policies[*rival].label.clone(), metric, counts, ends });
        }
    }
    rows
}

/// How many readings there are in effect.
fn distinct(folder: &Folder, readings: &[usize], rounds: &[Round]) -> Result<String, Failure> {
    let case = &folder.experiment().cases[0];
    let groups = |reading: &usize| {
        let policy = &case.policies[*reading];
        let groups = rounds.iter().map(|round| Ok(round.grouped_by(&**policy)?.hard));
        groups.collect::<Result<Vec<Vec<u32>>, Failure>>()
    };
    let all = readings.par_iter().map(groups).collect::<Result<Vec<_>, Failure>>()?;
    let distinct = all.iter().collect::<BTreeSet<_>>().len();
    let per_round: f64 = (0..rounds.len())
        .map(|round| all.iter().map(|groups| &groups[round]).collect::<BTreeSet<_>>().len() as f64)
        .sum::<f64>()
        / rounds.len().max(1) as f64;
    Ok(format!(
        "Of {} readings, {distinct} differ in how they group at least one of these rounds; a round is grouped in {per_round:.1} different ways on average.",
        readings.len()
    ))
}
