//! Grouping alone: how long RNE takes to split teams of different sizes.

use std::time::Instant;

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rne_core::{RneOptions, Team, policy_named};

use crate::team::team;

/// Groupings of one team; the median is printed.
const TURNS: usize = 9;

/// Teams by name: carriers, suppliers, observers.
const TEAMS: [(&str, [u32; 3]); 4] = [
    ("6/4/2 robots, exact", [6, 4, 2]),
    ("20 robots of one role, exact", [20, 0, 0]),
    ("100 robots, local search", [50, 33, 17]),
    ("1000 robots, local search", [500, 333, 167]),
];

/// Prints the time that RNE takes for each team.
pub fn print_table() {
    println!("\n{:<32}{:>12}", "grouping by RNE", "ms");
    for (name, counts) in TEAMS {
        println!("{name:<32}{:>12.3}", 1e3 * seconds(&team(counts)));
    }
}

fn seconds(team: &Team) -> f64 {
    let policy = policy_named("RNE", &RneOptions::default()).expect("known");
    let mut turns: Vec<f64> = (0..TURNS)
        .map(|_| {
            let mut draws = ChaCha8Rng::seed_from_u64(1);
            let start = Instant::now();
            std::hint::black_box(policy.group(team, &mut draws).expect("a grouping"));
            start.elapsed().as_secs_f64()
        })
        .collect();
    turns.sort_by(f64::total_cmp);
    turns[TURNS / 2]
}
