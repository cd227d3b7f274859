//! The choice between candidates that were fitted under different readings. Trials to which no candidate
//! was fitted decide it; the result states the uncertainty from the data and the seeds.

use std::path::Path;
use std::sync::atomic::AtomicBool;

use experiments::Failure;
use experiments::explore::Parameter;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use ron_tree::Node;
use scenario::Scenario;
use serde::Serialize;
use teaming::Registry;

use super::log::{CALIBRATED, JOB, Log};
use super::target::misfit;
use super::{Calibration, Evaluation, Identified, Spread, Target, the_policy};

/// Resamples of the data and of the seeds.
const RESAMPLES: usize = 4_000;

/// A candidate that is nearest to the data in at least this share of the resamples cannot be told apart
/// from the chosen one.
pub const NOT_TOLD_APART: f64 = 0.05;

/// A candidate: the result of a calibration.
pub struct Candidate {
    /// Name of the calibration's folder.
    pub name: String,
    calibration: Calibration,
    values: Vec<f64>,
    evaluations: Vec<Evaluation>,
}

/// A candidate with its judgement.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Judged {
    /// Name of the calibration's folder.
    pub candidate: String,
    /// Distance from the data, including the edge penalty.
    pub misfit: f64,
    /// Edge penalty: the part of the misfit from values near the ends of their ranges.
    pub edge_penalty: f64,
    /// Share of the resamples of the recorded trials and of the seeds in which this candidate is nearest.
    pub share_nearest: f64,
    /// Mean and standard deviation of each quantity.
    #[serde(skip)]
    pub spreads: Vec<Spread>,
}

impl Candidate {
    /// Reads the result of a calibration from its folder.
    ///
    /// # Errors
    /// The folder does not hold a finished calibration, or the target does not fit its scenario.
    pub fn read(folder: &Path, target: &Path, registry: &Registry) -> Result<Self, Failure> {
        let unreadable = |name: &str, error: &dyn std::fmt::Display| {
            Failure::input(format!(
                "{}: is not the folder of a finished calibration: {name}: {error}",
                folder.display()
            ))
        };
        let (base, text) =
            Scenario::load(&folder.join(CALIBRATED)).map_err(|error| unreadable(CALIBRATED, &error))?;
        let Log { origin, entries: evaluations, .. } = JOB.read(folder)?;
        let tree = Node::parse(&text).map_err(|error| unreadable(CALIBRATED, &error))?;
        let specs = origin["free"].as_array().into_iter().flatten().filter_map(|free| free.as_str());
        let free = specs.map(|spec| Parameter::parse(spec, &tree, &tree)).collect::<Result<Vec<_>, _>>();
        let free = free.map_err(|error| unreadable(JOB.origin, &error))?;
        let target = Target::load(target, &base)?;
        let policy = the_policy(registry)?;
        let trials =
            origin["trials"].as_u64().and_then(|trials| u32::try_from(trials).ok()).unwrap_or_default();
        let (first_seed, first_step) = (0, 0.0);
        let calibration = Calibration { text, base, policy, free, target, trials, first_seed, first_step };
        let values = calibration.present()?;
        let name = folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy().into_owned();
        Ok(Self { name, calibration, values, evaluations })
    }

    /// How well each of its values is known.
    pub fn identified(&self) -> Vec<Identified> {
        self.calibration.identified(&self.evaluations)
    }

    /// The quantities of the candidate's trials with these seeds, each a list over the trials. `None` if
    /// `stop` was set.
    ///
    /// # Errors
    /// The candidate cannot be run.
    pub fn measure(&self, seeds: &[u64], stop: &AtomicBool) -> Result<Option<Vec<Vec<f64>>>, Failure> {
        let measured = self.calibration.measure(&self.values, seeds.to_vec(), stop);
        measured.map_err(|reason| Failure::run(format!("{}: {reason}", self.name)))
    }
}

/// Judges the candidates by their trials, the nearest to the data first. Each candidate has a list of
/// quantities; all candidates have the same seeds.
pub fn judge(target: &Target, candidates: &[(Candidate, Vec<Vec<f64>>)]) -> Vec<Judged> {
    let trials = candidates.first().and_then(|(_, quantities)| quantities.first()).map_or(0, Vec::len);
    let of = |values: &[Vec<f64>], rows: &[usize]| -> Vec<Spread> {
        let spread = |values: &Vec<f64>| {
            let drawn: Vec<f64> = rows.iter().map(|row| values[*row]).collect();
            Spread::of(&drawn)
        };
        values.iter().filter_map(spread).collect()
    };
    let penalty = |candidate: &Candidate| candidate.calibration.edge_penalty(&candidate.values);
    let distances = |data_rows: &[usize], rows: &[usize]| -> Vec<f64> {
        let data = of(&target.values, data_rows).into_iter().zip(&target.spreads);
        // A resample of ten trials may have equal values. Their standard deviation of zero could not
        // measure any distance.
        let data: Vec<Spread> =
            data.map(|(drawn, whole)| Spread { sd: drawn.sd.max(whole.sd / 2.0), ..drawn }).collect();
        let distance = |(candidate, quantities): &(Candidate, Vec<Vec<f64>>)| {
            misfit(&data, &of(quantities, rows), target.trials, trials) + penalty(candidate)
        };
        candidates.iter().map(distance).collect()
    };
    let all = |count: usize| (0..count).collect::<Vec<usize>>();
    let whole = distances(&all(target.trials), &all(trials));
    let mut wins = vec![0_usize; candidates.len()];
    let mut draws = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..RESAMPLES {
        let mut some = |count: usize| -> Vec<usize> {
            (0..count).map(|_| draws.random_range(0..count as u32) as usize).collect()
        };
        let distances = distances(&some(target.trials), &some(trials));
        let nearest = (0..distances.len()).min_by(|a, b| distances[*a].total_cmp(&distances[*b]));
        nearest.into_iter().for_each(|nearest| wins[nearest] += 1);
    }
    let mut judged: Vec<Judged> = candidates
        .iter()
        .zip(whole.iter().zip(&wins))
        .map(|((candidate, quantities), (misfit, wins))| Judged {
            candidate: candidate.name.clone(),
            misfit: *misfit,
            edge_penalty: penalty(candidate),
            share_nearest: *wins as f64 / RESAMPLES as f64,
            spreads: of(quantities, &all(trials)),
        })
        .collect();
    judged.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    judged
}

#[cfg(test)]
mod tests {
    use super::*;

    fn candidate(name: &str) -> Candidate {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios");
        let (base, text) = Scenario::load(&root.join("paper.ron")).unwrap();
        let target = Target::load(&root.join("reference/dis_trials.csv"), &base).unwrap();
        let (policy, free) = (the_policy(&policies::standard()).unwrap(), Vec::new());
        let (trials, first_seed, first_step) = (0, 0, 0.0);
        let calibration = Calibration { text, base, policy, free, target, trials, first_seed, first_step };
        Candidate { name: name.to_owned(), calibration, values: Vec::new(), evaluations: Vec::new() }
    }

    #[test]
    fn the_nearest_is_chosen_and_what_is_like_it_is_not_told_apart() {
        let (first, twin, far) = (candidate("first"), candidate("twin"), candidate("far"));
        let target = Target::load(
            &Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/reference/dis_trials.csv"),
            &first.calibration.base,
        )
        .unwrap();
        let data = target.values.clone();
        // The data in reverse order: the same means and spreads, but other trials in each resample.
        let turned: Vec<Vec<f64>> =
            data.iter().map(|values| values.iter().rev().copied().collect()).collect();
        let off: Vec<Vec<f64>> = data
            .iter()
            .zip(&target.spreads)
            .map(|(values, spread)| values.iter().map(|value| value + 3.0 * spread.sd).collect())
            .collect();
        let judged = judge(&target, &[(far, off), (first, data), (twin, turned)]);
        let names: Vec<&str> = judged.iter().map(|judged| judged.candidate.as_str()).collect();
        assert_eq!(names, ["first", "twin", "far"]);
        assert!(judged[0].misfit < 1e-20 && judged[2].misfit > 300.0, "{judged:?}");
        assert!(judged[..2].iter().all(|judged| judged.share_nearest > 0.3), "{judged:?}");
        assert!(judged[2].share_nearest < NOT_TOLD_APART, "{judged:?}");
    }
}
