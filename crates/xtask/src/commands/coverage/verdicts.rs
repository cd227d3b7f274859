//! How often `usar test` is wrong: sequential tests of a mean difference that is exactly the expected one,
//! where each verdict is an error.

use experiments::expect::{Expectation, Expected, Verdict, judge, looks};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use statistics::{Moments, paired::t_half_width_at};

use super::{exponential, normal};

/// Most trials of a test: the default of `usar test`.
const MOST: u32 = 200;

/// Differences of a kind.
#[derive(Clone, Copy)]
struct Kind {
    name: &'static str,
    /// Their true mean.
    mean: f64,
    draw: fn(&mut ChaCha8Rng) -> f64,
}

const KINDS: [Kind; 5] = [
    Kind { name: "normal", mean: 0.0, draw: normal },
    Kind { name: "exponential", mean: 1.0, draw: exponential },
    Kind { name: "60 % zeros, else normal", mean: 0.0, draw: |draws| mostly_zero(draws, normal) },
    Kind { name: "60 % zeros, else exponential", mean: 0.4, draw: |draws| mostly_zero(draws, exponential) },
    // The mean is e^(1/2).
    Kind { name: "log-normal, sd 1", mean: 1.648_721_270_700_128, draw: |draws| normal(draws).exp() },
];

const CONFIDENCES: [f64; 3] = [0.95, 0.99, 0.998];

fn mostly_zero(draws: &mut ChaCha8Rng, else_of: fn(&mut ChaCha8Rng) -> f64) -> f64 {
    if draws.random::<f64>() < 0.6 { 0.0 } else { else_of(draws) }
}

/// Whether a test comes to a verdict.
fn is_wrong(draws: &mut ChaCha8Rng, kind: Kind, confidence: f64) -> bool {
    let Kind { mean, draw, .. } = kind;
    let what = Expectation::Above { metric: 0, policies: [0, 1], by: mean };
    let expected = Expected { text: String::new(), what, confidence };
    let looks = looks(MOST);
    let all: Vec<f64> = (0..MOST).map(|_| draw(draws)).collect();
    looks.iter().any(|look| {
        let values = &all[..*look as usize];
        // The interval holds the t interval. Where that has the mean, there is no need to draw the bootstrap.
        let half = t_half_width_at(values, 1.0 - (1.0 - confidence) / looks.len() as f64);
        let observed = Moments::of(values).mean;
        if observed.zip(half).is_none_or(|(observed, half)| (observed - mean).abs() <= half) {
            return false;
        }
        let value = |policy, _| values.iter().map(|d| Some(if policy == 0 { *d } else { 0.0 })).collect();
        judge(&expected, value, looks.len(), *look == MOST).verdict != Verdict::Undecided
    })
}

/// Prints the table.
pub(super) fn print(repetitions: u64) {
    println!("\nWrong verdicts of `usar test`, of {repetitions} tests each:\n");
    println!("| differences | at 95 % | at 99 % | at 99.8 % |\n| --- | ---: | ---: | ---: |");
    for (row, kind) in KINDS.into_iter().enumerate() {
        let share = |confidence: f64| {
            let one = |number: &u64| {
                let mut draws = ChaCha8Rng::seed_from_u64(*number);
                draws.set_stream(row as u64);
                is_wrong(&mut draws, kind, confidence)
            };
            let wrong = (0..repetitions).into_par_iter().filter(one).count();
            format!("{:.2} %", 100.0 * wrong as f64 / repetitions.max(1) as f64)
        };
        println!("| {} | {} |", kind.name, CONFIDENCES.map(share).join(" | "));
    }
}
