//! Estimators: the time that a decision takes with each of them, in the eighth round.

use std::time::Instant;

use programs::questions::with_evidence;
use teaming::{Asked, Question};
use xtask::team::question;

/// Number of decisions of each team; the median is printed.
const TURNS: usize = 21;

/// A rule that takes next to no time itself.
const RULE: &str = "HP_DIS";

/// Prints the time of a decision with each estimator, for twelve robots and for a thousand.
pub fn print_table() {
    let teams = [[6, 4, 2], [500, 333, 167]].map(|counts| with_evidence(question(counts, 2)));
    println!("\n{:<32}{:>12}{:>12}", "a decision by an estimator", "12, us", "1000, ms");
    let registry = policies::standard();
    let behind = registry.estimators().iter().map(|kind| format!("{RULE} <- {} | Discount", kind.name));
    for policy in [RULE.to_owned()].into_iter().chain(behind) {
        let [few, many] = [0, 1].map(|team| seconds(&policy, &teams[team]));
        println!("{policy:<32}{:>12.1}{:>12.2}", 1e6 * few, 1e3 * many);
    }
}

fn seconds(policy: &str, question: &Question) -> f64 {
    let mut session = policies::standard().open(policy).expect("known");
    let mut turns: Vec<f64> = (0..TURNS)
        .map(|_| {
            let start = Instant::now();
            std::hint::black_box(session.decide(&Asked::of(question)).expect("a decision"));
            start.elapsed().as_secs_f64()
        })
        .collect();
    turns.sort_by(f64::total_cmp);
    turns[TURNS / 2]
}
