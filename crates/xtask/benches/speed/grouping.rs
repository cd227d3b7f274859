//! Grouping alone: the time that RNE takes to split teams of different sizes.

use std::time::Instant;

use teaming::{Asked, Question};
use xtask::team::question;

/// Number of groupings of each team; the median is printed.
const TURNS: usize = 9;

/// Teams by name, with their numbers of carriers, suppliers and observers, and of tasks.
const TEAMS: [(&str, [u32; 3], usize); 6] = [
    ("6/4/2 robots, exact", [6, 4, 2], 2),
    ("20 robots of one role, exact", [20, 0, 0], 2),
    ("100 robots, local search", [50, 33, 17], 2),
    ("1000 robots, local search", [500, 333, 167], 2),
    ("1000 robots, three tasks", [500, 333, 167], 3),
    ("1000 of one role, three tasks", [1000, 0, 0], 3),
];

/// Prints the time that RNE takes for each team.
pub fn print_table() {
    println!("\n{:<32}{:>12}", "grouping by RNE", "ms");
    for (name, counts, tasks) in TEAMS {
        println!("{name:<32}{:>12.3}", 1e3 * seconds(&question(counts, tasks)));
    }
}

fn seconds(question: &Question) -> f64 {
    let mut rne = policies::standard().open("RNE").expect("known");
    let mut turns: Vec<f64> = (0..TURNS)
        .map(|_| {
            let start = Instant::now();
            std::hint::black_box(rne.decide(&Asked::of(question)).expect("a decision"));
            start.elapsed().as_secs_f64()
        })
        .collect();
    turns.sort_by(f64::total_cmp);
    turns[TURNS / 2]
}
