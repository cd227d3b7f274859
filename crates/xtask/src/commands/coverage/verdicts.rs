//! How often `usar test` is wrong: sequential tests of a mean difference that is exactly the expected one,
//! where each verdict is an error.

use experiments::expect::{Expectation, Expected, Verdict, judge_pairs, looks};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use statistics::comparison::{Pairs, Sums};
use statistics::paired::t_half_width_at;

use super::{cost, exponential, normal};

/// Most trials of a test: the default of `usar test`.
const MOST: u32 = 200;

/// What a pair of trials has.
#[derive(Clone, Copy)]
enum Draw {
    /// A difference of a metric.
    Difference(fn(&mut ChaCha8Rng) -> f64),
    /// Costs and rescuees of both trials, of which ratios of sums are compared.
    Costs(fn(&mut ChaCha8Rng) -> [[f64; 2]; 2]),
}

/// Pairs of a kind.
#[derive(Clone, Copy)]
struct Kind {
    name: &'static str,
    /// The true difference.
    mean: f64,
    draw: Draw,
}

const KINDS: [Kind; 7] = [
    Kind { name: "normal", mean: 0.0, draw: Draw::Difference(normal) },
    Kind { name: "exponential", mean: 1.0, draw: Draw::Difference(exponential) },
    Kind {
        name: "60 % zeros, else normal",
        mean: 0.0,
        draw: Draw::Difference(|draws| mostly_zero(draws, normal)),
    },
    Kind {
        name: "60 % zeros, else exponential",
        mean: 0.4,
        draw: Draw::Difference(|draws| mostly_zero(draws, exponential)),
    },
    // The mean is e^(1/2).
    Kind {
        name: "log-normal, sd 1",
        mean: 1.648_721_270_700_128,
        draw: Draw::Difference(|draws| normal(draws).exp()),
    },
    Kind {
        name: "cost per rescuee, 0 to 4 rescuees",
        mean: 2.0,
        draw: Draw::Costs(|draws| [cost(draws, 8.0), cost(draws, 6.0)]),
    },
    Kind {
        name: "cost per rescuee, 60 % without in one of two",
        mean: 4.0,
        draw: Draw::Costs(|draws| [rare(draws), cost(draws, 10.0)]),
    },
];

const CONFIDENCES: [f64; 3] = [0.95, 0.99, 0.998];

fn mostly_zero(draws: &mut ChaCha8Rng, else_of: fn(&mut ChaCha8Rng) -> f64) -> f64 {
    if draws.random::<f64>() < 0.6 { 0.0 } else { else_of(draws) }
}

/// Cost and rescuees of a trial that mostly has none: four for each, and a fixed cost of 12.
fn rare(draws: &mut ChaCha8Rng) -> [f64; 2] {
    let count = mostly_zero(draws, |draws| f64::from(draws.random_range(1..5_u32)));
    [4.0 * count + 12.0 + normal(draws), count]
}

impl Draw {
    /// The first pairs of a test, for any number of them.
    fn test(self, draws: &mut ChaCha8Rng) -> Box<dyn Fn(usize) -> Pairs> {
        match self {
            Self::Difference(draw) => {
                let all: Vec<f64> = (0..MOST).map(|_| draw(draws)).collect();
                Box::new(move |n| Pairs { a: all[..n].to_vec(), b: vec![0.0; n], ..Pairs::default() })
            }
            Self::Costs(draw) => {
                let all: Vec<[f64; 4]> = (0..MOST)
                    .map(|_| draw(draws))
                    .map(|[[cost, count], [other, others]]| [cost, count, other, others])
                    .collect();
                Box::new(move |n| Pairs::default().of_sums(Sums { pairs: all[..n].to_vec() }))
            }
        }
    }
}

/// Whether a test comes to a verdict.
fn is_wrong(draws: &mut ChaCha8Rng, kind: Kind, confidence: f64) -> bool {
    let Kind { mean, draw, .. } = kind;
    let what = Expectation::Above { metric: 0, policies: [0, 1], by: mean };
    let expected = Expected { text: String::new(), what, confidence };
    let looks = looks(MOST);
    let first = draw.test(draws);
    looks.iter().any(|look| {
        let pairs = first(*look as usize);
        // The interval holds the t interval. Where that has the mean, there is no need to draw the bootstrap.
        let half = t_half_width_at(&pairs.differences(), 1.0 - (1.0 - confidence) / looks.len() as f64);
        let observed = pairs.difference();
        if observed.zip(half).is_none_or(|(observed, half)| (observed - mean).abs() <= half) {
            return false;
        }
        judge_pairs(&expected, &pairs, looks.len()).verdict != Verdict::Undecided
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
