//! Statistics of a sweep: slices in, numbers out.

use statrs::statistics::Statistics;
use usar_sim::record::TrialRecord;

use crate::sweep::Outcome;
use crate::table::ratio;

/// Mean and sample standard deviation of the trials in which a quantity is defined.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Number of trials in which it is defined.
    pub count: usize,
    /// Mean; `None` without any trial.
    pub mean: Option<f64>,
    /// Sample standard deviation (divisor n - 1); `None` with fewer than two trials.
    pub sd: Option<f64>,
}

impl Moments {
    /// Of these values.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        Self {
            count: values.len(),
            mean: (!values.is_empty()).then(|| values.mean()),
            sd: (values.len() > 1).then(|| values.std_dev()),
        }
    }
}

/// The paper's metrics of one policy.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Trials that can be used.
    pub trials: usize,
    /// Metrics in the order of [`METRICS`].
    pub metrics: Vec<Moments>,
}

/// A quantity of a trial; `None` where it is undefined.
type Metric = fn(&TrialRecord) -> Option<f64>;

/// The paper's metrics with their names: rescuees, energy and HP per rescuee, each together and per task; and rounds.
pub const METRICS: [(&str, Metric); 10] = [
    ("rescuees total", |r| Some(f64::from(r.rescued()))),
    ("         hard", |r| Some(f64::from(r.hard.rescued))),
    ("         easy", |r| Some(f64::from(r.easy.rescued))),
    ("energy per rescuee total", |r| ratio(r.energy(), r.rescued())),
    ("                   hard", |r| ratio(r.hard.energy, r.hard.rescued)),
    ("                   easy", |r| ratio(r.easy.energy, r.easy.rescued)),
    ("HP per rescuee total", |r| ratio(r.hp(), r.rescued())),
    ("               hard", |r| ratio(r.hard.hp, r.hard.rescued)),
    ("               easy", |r| ratio(r.easy.hp, r.easy.rescued)),
    ("rounds", |r| Some(f64::from(r.completed_rounds))),
];

impl Summary {
    /// One summary per policy, in their order.
    #[must_use]
    pub fn of_all(policies: &[String], outcomes: &[Outcome]) -> Vec<Self> {
        let of_policy = |policy| {
            let records: Vec<&TrialRecord> = outcomes
                .iter()
                .filter(|outcome| outcome.key.policy == policy)
                .filter_map(Outcome::record)
                .collect();
            let metrics = METRICS
                .iter()
                .map(|(_, metric)| Moments::of(&records.iter().filter_map(|r| metric(r)).collect::<Vec<_>>()))
                .collect();
            Self { trials: records.len(), metrics }
        };
        (0..policies.len()).map(of_policy).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_standard_deviation_is_the_samples() {
        // numpy.std([2, 4, 4, 4, 5, 5, 7, 9], ddof=1)
        let moments = Moments::of(&[2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0]);
        assert!((moments.mean.unwrap() - 5.0).abs() < 1e-12);
        assert!((moments.sd.unwrap() - 2.138_089_935_299_395).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_defined_is_nothing_and_not_nan() {
        assert_eq!(Moments::of(&[]), Moments { count: 0, mean: None, sd: None });
        assert_eq!(Moments::of(&[3.0]), Moments { count: 1, mean: Some(3.0), sd: None });
    }
}
