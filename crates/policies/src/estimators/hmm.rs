//! `Hmm`: each robot is healthy or faulty, and a faulty one is slower than it says.
//!
//! A hidden Markov model with two states, by the forward algorithm (Rabiner 1989, *A Tutorial on Hidden
//! Markov Models*). `b` is how likely a robot is faulty: 0.05 at first, from then on `b- = b + (1 - b) 0.02`
//! a round (a fault stays); `b = b- f1 / (b- f1 + (1 - b-) f0)` with the normal densities `f0 = N(1, 0.15)`
//! of a healthy and `f1 = N(0.5, 0.25)` of a faulty robot at `x`, the speed that was seen in terms of the
//! speed that was said: the median of the mates' ratings in a round. In a round without any, `b = b-`. Trust
//! is `1 - b`.

use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

use super::last_said::{last_said, last_said_with};
use super::speeds::by_question_round;

/// How likely a robot is faulty at first.
const FIRST: f64 = 0.05;

/// How likely a healthy robot breaks from one round to the next.
const FAILS: f64 = 0.02;

/// Mean and standard deviation of the speed seen, in terms of that said, of a healthy robot.
const HEALTHY: [f64; 2] = [1.0, 0.15];

/// The same of a faulty robot.
const FAULTY: [f64; 2] = [0.5, 0.25];

/// Believes robots that are as fast as they say; levels are those said last.
#[derive(Debug, Clone, Copy)]
pub struct Hmm;

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::plain("Hmm", "trust by a hidden Markov model of speeds", Hmm)
        .from_sources(env!("SOURCES_ESTIMATOR_HMM"))
}

impl Estimator for Hmm {
    fn judges_trust_only(&self) -> bool {
        true
    }

    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let Some(evidence) = &question.evidence else { return last_said(question) };
        let rounds = by_question_round(question, evidence);
        last_said_with(question, rounds.into_iter().map(|rounds| (1.0 - faulty(&rounds)).clamp(0.0, 1.0)))
    }
}

/// How likely a robot with these speeds, round by round, is faulty.
fn faulty(rounds: &[Option<f64>]) -> f64 {
    let mut b = FIRST;
    for (round, x) in rounds.iter().enumerate() {
        let before = if round == 0 { b } else { b + (1.0 - b) * FAILS };
        let Some(x) = x else {
            b = before;
            continue;
        };
        // Only the ratio of the densities counts, and it is finite where each of them may be 0.
        let odds = libm::exp(log_density(*x, FAULTY) - log_density(*x, HEALTHY)).min(f64::MAX);
        b = if odds > 1.0 {
            before / (before + (1.0 - before) / odds)
        } else {
            before * odds / (before * odds + 1.0 - before)
        };
    }
    b
}

/// The logarithm of a normal density, up to a constant.
fn log_density(x: f64, [mean, sd]: [f64; 2]) -> f64 {
    let z = (x - mean) / sd;
    -0.5 * z * z - libm::log(sd)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference: an independent implementation in Python.
    #[test]
    fn faults_are_as_likely_as_computed_elsewhere() {
        let ratios = [1.02, 0.95, 0.55, 0.6, 0.4].map(Some);
        let expected = [
            0.003_649_257_174_261_793_7,
            0.003_021_650_273_203_589_4,
            0.554_397_494_244_641_1,
            0.961_555_425_095_644_7,
            0.999_976_288_128_446_5,
        ];
        for (count, expected) in (1..).zip(expected) {
            let found = faulty(&ratios[..count]);
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        }
        assert!((faulty(&[]) - 0.05).abs() < 1e-15);
        let all = |x| faulty(&[Some(x); 100]);
        assert!(faulty(&[Some(1e9)]) <= 1.0 && all(0.0) <= 1.0 && all(1.0) > 0.0);
    }

    /// Reference: an independent implementation in Python.
    #[test]
    fn a_round_without_a_look_makes_a_fault_likelier_and_tells_nothing_else() {
        let rounds = [Some(0.9), Some(0.72), None, Some(0.71), Some(1.05), Some(0.3)];
        let expected = [
            0.087_096_591_149_023_35,
            0.243_454_660_102_028_99,
            0.019_291_642_112_721_608,
            0.998_942_864_218_156_4,
        ];
        for (count, expected) in (3..).zip(expected) {
            let found = faulty(&rounds[..count]);
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        }
    }
}
