//! Random worlds with the engine at rest in quiet steps, and with the engine on in every step: every hash
//! must be the same.
//!
//! `quiet [FIRST_SEED] [WORLDS] [SECONDS]`: so many worlds of each kind (open, rooms, and of all kinds with
//! timelines), for so many simulated seconds; by default 170 of each, for 200 s.

use std::process::ExitCode;

use rayon::prelude::*;
use scenario::Scenario;
use xtask::quiet::{BothWays, both_ways};
use xtask::{random, rooms, worlds};

use super::{number, worlds::lasting};

/// A kind of worlds: its name, and the world of a seed.
type Kind = (&'static str, fn(u64) -> Scenario);

const KINDS: [Kind; 3] = [("open", worlds::world), ("rooms", rooms::rooms), ("all kinds", random::scenario)];

pub fn run(arguments: &[String]) -> ExitCode {
    let (first, count, seconds) =
        (number(arguments, 0, 0), number(arguments, 1, 170), number(arguments, 2, 200) as f64);
    let mut differ = 0;
    for (kind, world) in KINDS {
        let run = |seed: u64| Some((seed, both_ways(&lasting(&world(seed), seconds), seed)?));
        let results: Vec<(u64, BothWays)> = (first..first + count).into_par_iter().filter_map(run).collect();
        let (mut all, mut on) = (0, 0);
        for (seed, BothWays { differs_at, steps }) in &results {
            (all, on) = (all + steps[0], on + steps[1]);
            if let Some(step) = differs_at {
                differ += 1;
                println!("{kind} {seed}: differs by step {step}");
            }
        }
        let share = 100.0 * on as f64 / f64::max(all as f64, 1.0);
        println!("{kind}: {} worlds, the engine ran in {share:.1} % of {all} steps", results.len());
    }
    println!("{differ} worlds differ");
    ExitCode::from(u8::from(differ > 0))
}
