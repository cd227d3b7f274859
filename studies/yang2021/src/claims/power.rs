//! Power: the verdicts expected from experiments of other sizes, if the trials at hand are the truth.

use experiments::comparison::CONFIDENCE;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use statistics::Moments;
use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

use super::{Finding, Side, Verdict};

/// An experiment is drawn only from at least this many times as many trials.
pub(super) const TIMES: usize = 5;

/// Largest number of trials whose differences are used for the errors of large experiments.
const MOST_TRIALS: usize = 2_000;

/// Number of drawn experiments.
const EXPERIMENTS: usize = 4_000;

/// Desired power.
const WANTED: f64 = 0.8;

/// Largest experiment considered, in pairs.
const MOST_PAIRS: u32 = 1_000_000;

/// Shares of experiments with each verdict; the remaining experiments are undecided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// The claim holds.
    pub holds: f64,
    /// The claim does not hold.
    pub does_not_hold: f64,
}

/// The verdicts expected from experiments on one claim.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Power {
    /// Verdicts of experiments with few pairs, drawn from the trials at hand with replacement.
    pub of_few: Shares,
    /// The verdict of large experiments, if the means of the trials at hand are the truth; undecided if one
    /// of the means is 0.
    pub leaning: Verdict,
    /// Pairs with which 80 % of experiments reach this verdict; `None` if more than a million would be
    /// needed.
    pub pairs_needed: Option<u32>,
}

/// The power of experiments on one claim, drawn with this seed from the trials of `finding`. `None` if
/// there are fewer than `TIMES` times `few` trials, since experiments drawn from them would be too similar.
/// Verdicts follow the rules of [`super::judge`], but with paired t intervals, since thousands of
/// bootstraps would take hours.
pub fn power(finding: &Finding, few: usize, seed: u64) -> Option<Power> {
    let trials = &finding.trials;
    if few < 2 || trials.len() < TIMES * few {
        return None;
    }
    let claimed: Vec<Side> = finding.parts.iter().map(|part| part.claimed).collect();
    let mut draws = ChaCha8Rng::seed_from_u64(seed);
    let few_limits = limits(few, claimed.len());
    let of_few = Shares::of((0..EXPERIMENTS).map(|_| {
        let chosen: Vec<&[f64]> = (0..few)
            .map(|_| trials[draws.random_range(0..trials.len() as u32) as usize].as_slice())
            .collect();
        verdict(&claimed, |part| t_of(chosen.iter().map(|trial| trial[part])), few_limits)
    }));
    let effects: Vec<f64> = (0..claimed.len()).map(|part| effect(trials, part)).collect();
    let leaning = leaning(&effects, &claimed);
    if leaning == Verdict::Undecided {
        return Some(Power { of_few, leaning, pairs_needed: None });
    }
    let noise = noise(&trials[..trials.len().min(MOST_TRIALS)], &mut draws);
    let reaches = |pairs: u32| {
        let (root, limits) = (f64::from(pairs).sqrt(), limits(pairs as usize, claimed.len()));
        let of_noise =
            |errors: &Vec<f64>| verdict(&claimed, |part| root * effects[part] + errors[part], limits);
        let shares = Shares::of(noise.iter().map(of_noise));
        let share = if leaning == Verdict::Holds { shares.holds } else { shares.does_not_hold };
        share >= WANTED
    };
    Some(Power { of_few, leaning, pairs_needed: least_pairs(reaches) })
}

/// The verdict on a claim if its parts have these true effects.
fn leaning(effects: &[f64], claimed: &[Side]) -> Verdict {
    let towards = |(effect, side): (&f64, &Side)| if *side == Side::More { *effect } else { -effect };
    let least = effects.iter().zip(claimed).map(towards).fold(f64::INFINITY, f64::min);
    match least.partial_cmp(&0.0) {
        Some(std::cmp::Ordering::Greater) => Verdict::Holds,
        Some(std::cmp::Ordering::Less) => Verdict::DoesNotHold,
        _ => Verdict::Undecided,
    }
}

impl Shares {
    /// The shares among [`EXPERIMENTS`] verdicts.
    fn of(verdicts: impl Iterator<Item = Verdict>) -> Self {
        let mut counts = [0_u32; 2];
        for verdict in verdicts {
            counts[0] += u32::from(verdict == Verdict::Holds);
            counts[1] += u32::from(verdict == Verdict::DoesNotHold);
        }
        let [holds, does_not_hold] = counts.map(|count| f64::from(count) / EXPERIMENTS as f64);
        Self { holds, does_not_hold }
    }
}

/// Student's t of a sample's mean. Without any spread, it is 0 or the largest number with the sign of the
/// mean.
fn t_of(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    let Moments { mean: Some(mean), sd: Some(sd), .. } = Moments::of(&values) else { return 0.0 };
    if sd > 0.0 {
        mean / sd * (values.len() as f64).sqrt()
    } else if mean == 0.0 {
        0.0
    } else {
        mean.signum() * f64::MAX
    }
}

/// Effect size of one part: mean over standard deviation.
fn effect(trials: &[Vec<f64>], part: usize) -> f64 {
    t_of(trials.iter().map(|trial| trial[part])) / (trials.len() as f64).sqrt()
}

/// Errors of the parts' t in large experiments: normal, with the correlations of the differences between
/// the parts (Gaussian multipliers).
fn noise(trials: &[Vec<f64>], draws: &mut ChaCha8Rng) -> Vec<Vec<f64>> {
    let normal = Normal::standard();
    let parts = trials.first().map_or(0, Vec::len);
    let standardised: Vec<Vec<f64>> = (0..parts)
        .map(|part| {
            let values: Vec<f64> = trials.iter().map(|trial| trial[part]).collect();
            let Moments { mean: Some(mean), sd: Some(sd), .. } = Moments::of(&values) else { return values };
            let scale = sd.max(f64::MIN_POSITIVE) * ((values.len() - 1) as f64).sqrt();
            values.iter().map(|value| (value - mean) / scale).collect()
        })
        .collect();
    let mut experiment = || {
        let multipliers: Vec<f64> =
            trials.iter().map(|_| normal.inverse_cdf(draws.random_range(1e-12..1.0 - 1e-12))).collect();
        let error = |values: &Vec<f64>| values.iter().zip(&multipliers).map(|(value, by)| value * by).sum();
        standardised.iter().map(error).collect()
    };
    (0..EXPERIMENTS).map(|_| experiment()).collect()
}

/// The values of t beyond which one part is decided with this many pairs: by itself, and shared by all
/// parts.
fn limits(pairs: usize, parts: usize) -> [f64; 2] {
    [1, parts].map(|parts| quantile(pairs, 1.0 - (1.0 - CONFIDENCE) / 2.0 / parts as f64))
}

/// The verdict from the t of each part.
fn verdict(claimed: &[Side], t: impl Fn(usize) -> f64, [each, shared]: [f64; 2]) -> Verdict {
    let towards = |part: usize| if claimed[part] == Side::More { t(part) } else { -t(part) };
    if (0..claimed.len()).all(|part| towards(part) > each) {
        Verdict::Holds
    } else if (0..claimed.len()).any(|part| towards(part) < -shared) {
        Verdict::DoesNotHold
    } else {
        Verdict::Undecided
    }
}

/// Quantile of Student's t for this many pairs.
fn quantile(pairs: usize, share: f64) -> f64 {
    let freedom = pairs as f64 - 1.0;
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::INFINITY, |t| t.inverse_cdf(share))
}

/// The least number of pairs that reaches the power. The power grows with the number.
fn least_pairs(reaches: impl Fn(u32) -> bool) -> Option<u32> {
    let mut enough = 2;
    while !reaches(enough) {
        enough *= 2;
        if enough > MOST_PAIRS {
            return None;
        }
    }
    let mut short = enough / 2;
    while enough - short > 1 {
        let middle = u32::midpoint(short, enough);
        if reaches(middle) { enough = middle } else { short = middle }
    }
    Some(enough)
}

#[cfg(test)]
mod tests {
    use experiments::comparison::Standing;

    use super::super::PartFinding;
    use super::*;

    /// A claim of one part whose differences have this mean and a standard deviation of one.
    fn finding(mean: f64, trials: u32) -> Finding {
        let normal = Normal::standard();
        let share = |i: u32| (f64::from(i) + 0.5) / f64::from(trials);
        let values: Vec<f64> = (0..trials).map(|i| normal.inverse_cdf(share(i))).collect();
        let sd = Moments::of(&values).sd.unwrap();
        let part = PartFinding {
            is_equivalent: false,
            claimed: Side::More,
            standing: Standing::Judged,
            n: values.len(),
            difference: None,
            sd: None,
            interval: None,
            shared_interval: None,
            pairs_needed: None,
        };
        let trials = values.iter().map(|value| vec![mean + value / sd]).collect();
        Finding { verdict: Verdict::Undecided, parts: vec![part], trials }
    }

    #[test]
    fn power_of_one_comparison_is_the_textbooks() {
        // statsmodels' TTestPower().solve_power(effect_size=0.5, power=0.8, alpha=0.05): 33.37
        let power = power(&finding(0.5, 200), 10, 1).unwrap();
        assert_eq!(power.leaning, Verdict::Holds);
        let needed = power.pairs_needed.unwrap();
        assert!((31..=36).contains(&needed), "{needed}");
        // ... .power(0.5, nobs=10, alpha=0.05): 0.293
        assert!((power.of_few.holds - 0.293).abs() < 0.03, "{}", power.of_few.holds);
        assert!(power.of_few.does_not_hold < 0.01);
    }

    #[test]
    fn a_difference_the_other_way_is_found_as_such() {
        let power = power(&finding(-1.0, 200), 10, 1).unwrap();
        assert_eq!(power.leaning, Verdict::DoesNotHold);
        assert!(power.of_few.does_not_hold > 0.75, "{}", power.of_few.does_not_hold);
    }

    #[test]
    fn nothing_is_said_of_experiments_larger_than_the_trials_at_hand() {
        assert_eq!(power(&finding(0.5, 49), 10, 1), None);
        assert!(power(&finding(0.0001, 200), 10, 1).unwrap().pairs_needed.is_none());
        let mut nothing = finding(0.5, 200);
        nothing.trials.iter_mut().for_each(|row| row[0] = 0.0);
        let nothing = power(&nothing, 10, 1).unwrap();
        assert_eq!((nothing.leaning, nothing.pairs_needed), (Verdict::Undecided, None));
    }
}
