//! Random feasible worlds: does everybody get there? Fails when a fleet stands still for a minute, more than one robot in a hundred does
//! not come on for half a minute, or an invariant is violated.
//!
//! `cargo run --release --example worlds [FIRST_SEED] [WORLDS]`

#[path = "../../../tests/journeys.rs"]
mod journeys;
#[path = "../../../tests/worlds.rs"]
mod worlds;

use std::process::ExitCode;

use journeys::{Journeys, STANDSTILL_S};
use rayon::prelude::*;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse::<u64>().expect("a number"));
    let first = arguments.next().unwrap_or(0);
    let count = arguments.next().unwrap_or(500);
    let results: Vec<(u64, Result<Journeys, String>)> = (first..first + count)
        .into_par_iter()
        .map(|seed| (seed, Journeys::run(&worlds::world(seed))))
        .collect();
    let (mut robots, mut stalls, mut faults) = (0, 0, 0);
    let mut undone = 0;
    let mut longest: f64 = 0.0;
    for (seed, result) in &results {
        match result {
            Ok(journeys) => {
                robots += journeys.record.robots.len();
                for stall in journeys.stalls() {
                    stalls += 1;
                    println!("world {seed}: {stall}");
                }
                longest = longest.max(journeys.standstill_s);
                if journeys.standstill_s > STANDSTILL_S {
                    faults += 1;
                    println!("world {seed}: all stood for {:.1} s", journeys.standstill_s);
                }
                let record = &journeys.record;
                if seed.is_multiple_of(2) && record.status.name() != "errands_over" {
                    undone += 1;
                    println!("world {seed}: {} robots, errands not over in time", record.robots.len());
                }
            }
            Err(reason) => {
                faults += 1;
                println!("world {seed}: {reason}");
            }
        }
    }
    let share = 100.0 * f64::from(stalls) / robots as f64;
    println!(
        "{count} worlds, {robots} robots: {faults} faults, longest standstill {longest:.1} s, {stalls} robots ({share:.2} %) \
         without progress for 30 s, {undone} worlds with errands left"
    );
    ExitCode::from(u8::from(faults > 0 || share > 1.0))
}
