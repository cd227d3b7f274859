//! The results of each policy in each world, as predictions of the authors' trials. With the authors'
//! table, anyone can score them.

use std::path::Path;

use experiments::Failure;
use experiments::files::NewFile;
use experiments::sweep::folder::Folder;
use serde::Serialize;
use statistics::Moments;
use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::scenarios::{PAPERS_TRIALS, POLICIES, Standing};

/// Quantities that the authors report for a trial.
const QUANTITIES: [&str; 4] = ["rescuees", "energy", "hp", "rounds"];

/// The name that stands for the chosen calibrated world and its alternatives together.
const ALL: &str = "all calibrated worlds";

/// A prediction: a quantity of a policy in one world, or in all calibrated worlds together.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Prediction {
    /// Name of the scenario.
    pub scenario: String,
    /// The policy.
    pub policy: String,
    /// The quantity, under the authors' name.
    pub quantity: String,
    /// Number of simulated trials.
    pub trials: usize,
    /// Mean over these trials.
    pub mean: f64,
    /// Sample standard deviation over these trials.
    pub sd: f64,
    /// The mean of ten other trials lies above this in 97.5 % of experiments, if the world is the authors'.
    pub low: f64,
    /// The mean of ten other trials lies below this in 97.5 % of experiments, if the world is the authors'.
    pub high: f64,
}

/// The predictions of one world.
///
/// # Errors
/// The sweep lacks a policy of the paper.
pub fn predictions(folder: &Folder, trials: u32) -> Result<Vec<Prediction>, Failure> {
    let experiment = folder.experiment();
    let mut predictions = Vec::new();
    for name in POLICIES {
        let policy = experiment.policies.iter().position(|policy| policy.label == name);
        let policy = policy
            .ok_or_else(|| Failure::input(format!("{}: has no policy {name}", folder.path().display())))?;
        for place in QUANTITIES.iter().flat_map(|name| experiment.metrics.declared(name)) {
            let value = |trial| folder.value((0, policy, trial), place);
            let values: Vec<f64> = (1..=trials).filter_map(value).collect();
            let (scenario, quantity) = (experiment.name.clone(), experiment.metrics[place].column());
            predictions.extend(of_values(&values).map(|[mean, sd, low, high]| Prediction {
                scenario,
                policy: name.to_owned(),
                quantity,
                trials: values.len(),
                mean,
                sd,
                low,
                high,
            }));
        }
    }
    Ok(predictions)
}

/// Mean, standard deviation, and the 95 % prediction interval for the mean of the paper's number of other
/// trials.
fn of_values(values: &[f64]) -> Option<[f64; 4]> {
    let Moments { mean, sd, .. } = Moments::of(values);
    let (mean, sd, count) = (mean?, sd?, values.len() as f64);
    let t = StudentsT::new(0.0, 1.0, count - 1.0).ok()?.inverse_cdf(0.975);
    let half = t * sd * (1.0 / f64::from(PAPERS_TRIALS) + 1.0 / count).sqrt();
    // No quantity of the authors is negative.
    Some([mean, sd, (mean - half).max(0.0), mean + half])
}

/// The predictions of all calibrated worlds together: the mean of their means, the root mean square of
/// their standard deviations, and an interval that holds all their intervals. Empty if there is only one
/// such world.
pub(crate) fn over_worlds(worlds: &[(Standing, Vec<Prediction>)]) -> Vec<Prediction> {
    let calibrated: Vec<&Vec<Prediction>> = worlds
        .iter()
        .filter(|(standing, _)| standing.is_in_ensemble())
        .map(|(_, predictions)| predictions)
        .collect();
    let Some(first) = calibrated.first().filter(|_| calibrated.len() > 1) else { return Vec::new() };
    let together = |one: &Prediction| {
        let alike = |other: &&Prediction| other.policy == one.policy && other.quantity == one.quantity;
        let all: Vec<&Prediction> =
            calibrated.iter().filter_map(|predictions| predictions.iter().find(alike)).collect();
        let mean = |value: &dyn Fn(&Prediction) -> f64| {
            all.iter().map(|prediction| value(prediction)).sum::<f64>() / all.len() as f64
        };
        Prediction {
            scenario: ALL.to_owned(),
            trials: all.iter().map(|prediction| prediction.trials).sum(),
            mean: mean(&|prediction| prediction.mean),
            sd: mean(&|prediction| prediction.sd * prediction.sd).sqrt(),
            low: all.iter().map(|prediction| prediction.low).fold(f64::INFINITY, f64::min),
            high: all.iter().map(|prediction| prediction.high).fold(f64::NEG_INFINITY, f64::max),
            ..one.clone()
        }
    };
    first.iter().map(together).collect()
}

/// Writes `predictions.csv`: the predictions of each world, then of all calibrated worlds together.
///
/// # Errors
/// The disk does not take it.
pub fn write_predictions(out: &Path, worlds: &[(Standing, Vec<Prediction>)]) -> Result<(), Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let together = over_worlds(worlds);
    let mut rows = worlds.iter().flat_map(|(_, predictions)| predictions).chain(&together);
    rows.try_for_each(|row| table.serialize(row)).map_err(Failure::run)?;
    let bytes = table.into_inner().map_err(Failure::run)?;
    NewFile::write(out, "predictions.csv", &bytes).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_is_that_of_the_mean_of_ten_other_trials() {
        // numpy and scipy: t.ppf(0.975, 4) * std(ddof=1) * sqrt(1/10 + 1/5)
        let [mean, sd, low, high] = of_values(&[11.0, 12.0, 13.0, 14.0, 20.0]).unwrap();
        assert!((mean - 14.0).abs() < 1e-12 && (sd - 3.535_533_905_932_738).abs() < 1e-12);
        assert!((high - mean - 5.376_562_827_045_078).abs() < 1e-9, "{}", high - mean);
        assert!((mean - low - (high - mean)).abs() < 1e-12);
        assert_eq!(of_values(&[1.0]), None);
        assert!(of_values(&[0.0, 0.1]).unwrap()[2].abs() < 1e-12, "nothing is below nothing");
    }

    #[test]
    fn an_interval_over_worlds_holds_that_of_each_world_that_cannot_be_told_apart() {
        let one = |mean: f64, scenario: &str| Prediction {
            scenario: scenario.to_owned(),
            policy: "RNE".to_owned(),
            quantity: "rounds".to_owned(),
            trials: 10,
            mean,
            sd: 1.0,
            low: mean - 1.0,
            high: mean + 1.0,
        };
        let worlds = [
            (Standing::Printed, vec![one(90.0, "paper")]),
            (Standing::Calibrated, vec![one(6.0, "a")]),
            (Standing::Alternative, vec![one(8.0, "b")]),
            (Standing::FitsWorse, vec![one(40.0, "c")]),
        ];
        let together = over_worlds(&worlds);
        assert_eq!(together, [Prediction { trials: 20, low: 5.0, high: 9.0, ..one(7.0, ALL) }]);
        assert!(over_worlds(&worlds[..2]).is_empty());
    }
}
