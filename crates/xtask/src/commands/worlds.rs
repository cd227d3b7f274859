//! Random feasible worlds: does everybody get there? Fails when a fleet stands still for a minute, more than one robot in a hundred does
//! not come on for half a minute, or an invariant is violated.
//!
//! `worlds [FIRST_SEED] [WORLDS]`

use std::process::ExitCode;

use rayon::prelude::*;
use xtask::journeys::{Journeys, STANDSTILL_S};
use xtask::worlds;

pub fn run(arguments: &[String]) -> ExitCode {
    let mut arguments = arguments.iter().map(|text| text.parse::<u64>().expect("a number"));
    let first = arguments.next().unwrap_or(0);
    let count = arguments.next().unwrap_or(500);
    let mut totals = Totals::default();
    for start in (first..first + count).step_by(CHUNK) {
        let seeds = start..(start + CHUNK as u64).min(first + count);
        let run = |seed: u64| (seed, Journeys::run(&worlds::world(seed), seed));
        let results: Vec<(u64, Result<Journeys, String>)> = seeds.into_par_iter().map(run).collect();
        results.iter().for_each(|(seed, result)| totals.add(*seed, result));
    }
    let Totals { robots, stalls, faults, undone, longest } = totals;
    let share = 100.0 * f64::from(stalls) / robots as f64;
    println!(
        "{count} worlds, {robots} robots: {faults} faults, longest standstill {longest:.1} s, {stalls} robots ({share:.2} %) \
         without progress for 30 s, {undone} worlds with errands left"
    );
    ExitCode::from(u8::from(faults > 0 || share > 1.0))
}

/// Worlds between two outputs.
const CHUNK: usize = 10;

#[derive(Default)]
struct Totals {
    robots: usize,
    stalls: u32,
    faults: u32,
    undone: u32,
    longest: f64,
}

impl Totals {
    /// Adds a world, and prints what is to be said of it.
    fn add(&mut self, seed: u64, result: &Result<Journeys, String>) {
        let journeys = match result {
            Ok(journeys) => journeys,
            Err(reason) => {
                self.faults += 1;
                println!("world {seed}: {reason}");
                return;
            }
        };
        let record = &journeys.record;
        self.robots += record.robots.len();
        for stall in journeys.stalls() {
            self.stalls += 1;
            println!("world {seed}: {stall}");
        }
        self.longest = self.longest.max(journeys.standstill_s);
        if journeys.standstill_s > STANDSTILL_S {
            self.faults += 1;
            println!("world {seed}: all stood for {:.1} s", journeys.standstill_s);
        }
        if seed.is_multiple_of(2) && record.status.name() != "errands_over" {
            self.undone += 1;
            println!("world {seed}: {} robots, errands not over in time", record.robots.len());
        }
        let Self { robots, stalls, .. } = self;
        println!(
            "world {seed}: {} robots; {stalls} of {robots} so far did not come nearer for 30 s",
            record.robots.len()
        );
    }
}
