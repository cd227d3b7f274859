//! Random feasible worlds: whether all robots arrive. It fails if a fleet stands still for a minute, more
//! than one robot in a hundred makes no progress for half a minute, an invariant is violated, or a panic
//! occurs.
//!
//! `worlds [FIRST_SEED] [WORLDS] [SECONDS] [open|rooms]`: worlds in the open, or rooms whose walls meet, for
//! so many simulated seconds; by default 500 of both, for 900 s.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use rayon::prelude::*;
use usar_sim::scenario::{Scenario, ScenarioFile};
use xtask::journeys::{Journeys, JourneysError, STANDSTILL_S};
use xtask::{rooms, worlds};

/// A family of worlds: its name, and the world of a seed.
struct Family {
    name: &'static str,
    world: fn(u64) -> Scenario,
}

const FAMILIES: [Family; 2] =
    [Family { name: "open", world: worlds::world }, Family { name: "rooms", world: rooms::rooms }];

pub fn run(arguments: &[String]) -> ExitCode {
    let is_number = |text: &&String| text.parse::<u64>().is_ok();
    let numbers: Vec<u64> =
        arguments.iter().filter(is_number).map(|text| text.parse().expect("a number")).collect();
    let (first, count) = (numbers.first().copied().unwrap_or(0), numbers.get(1).copied().unwrap_or(500));
    let duration_s = numbers.get(2).map_or(900.0, |seconds| *seconds as f64);
    let chosen = arguments.iter().find(|text| !is_number(text));
    let is_chosen = |family: &&Family| chosen.is_none_or(|name| name == family.name);
    let families: Vec<&Family> = FAMILIES.iter().filter(is_chosen).collect();
    if families.is_empty() || arguments.len() > 4 {
        eprintln!("usage: worlds [FIRST_SEED] [WORLDS] [SECONDS] [open|rooms]");
        return ExitCode::from(2);
    }
    std::panic::set_hook(Box::new(|_| {})); // a panic is counted, and told in one line
    let is_sound = |family: &&&Family| run_family(family, first..first + count, duration_s);
    let sound = families.iter().filter(is_sound);
    ExitCode::from(u8::from(sound.count() < families.len()))
}

/// Runs a family's worlds; returns whether they are sound.
fn run_family(family: &Family, seeds: std::ops::Range<u64>, duration_s: f64) -> bool {
    let mut totals = Totals { family: family.name, ..Totals::default() };
    for start in seeds.clone().step_by(CHUNK) {
        let chunk = start..(start + CHUNK as u64).min(seeds.end);
        let run = |seed: u64| {
            let result = catch_unwind(AssertUnwindSafe(|| {
                Journeys::run(&lasting(&(family.world)(seed), duration_s), seed)
            }));
            (seed, result.unwrap_or(Err(JourneysError::Panicked)))
        };
        let results: Vec<(u64, Result<Journeys, JourneysError>)> = chunk.into_par_iter().map(run).collect();
        results.iter().for_each(|(seed, result)| totals.add(*seed, result));
    }
    totals.print(seeds.end - seeds.start)
}

/// A world with another duration.
pub(super) fn lasting(scenario: &Scenario, duration_s: f64) -> Scenario {
    let file = ScenarioFile { duration_s, ..(**scenario).clone() };
    Scenario::try_from(file).unwrap_or_else(|problems| panic!("{problems:?}"))
}

/// Number of worlds between two outputs.
const CHUNK: usize = 10;

#[derive(Default)]
struct Totals {
    family: &'static str,
    robots: usize,
    stalls: u32,
    violations: u32,
    internal: u32,
    refused: u32,
    standstills: u32,
    cut_off: usize,
    stalled: u32,
    undone: u32,
    longest: f64,
}

impl Totals {
    /// Adds a world, and prints its problems.
    fn add(&mut self, seed: u64, result: &Result<Journeys, JourneysError>) {
        let journeys = match result {
            Ok(journeys) => journeys,
            Err(error) => {
                match error {
                    JourneysError::Panicked => self.internal += 1,
                    JourneysError::Failed { reason } if reason.starts_with("invariant violated") => {
                        self.violations += 1;
                    }
                    JourneysError::Failed { .. } | JourneysError::Layout(_) => self.refused += 1,
                }
                println!("{} {seed}: {error}", self.family);
                return;
            }
        };
        let record = &journeys.record;
        self.robots += record.robots.len();
        self.cut_off += record.cut_off.len();
        for stall in journeys.stalls() {
            self.stalls += 1;
            println!("{} {seed}: {stall}", self.family);
        }
        if record.stalled > 0 {
            self.stalled += 1;
            let causes = record.cut_off.iter().map(|cut| format!("robot {} {}", cut.robot, cut.cause.name()));
            let causes: Vec<String> = causes.collect();
            println!("{} {seed}: {} robots stalled: {}", self.family, record.stalled, causes.join(", "));
        }
        self.longest = self.longest.max(journeys.standstill_s);
        if journeys.standstill_s > STANDSTILL_S {
            self.standstills += 1;
            println!("{} {seed}: all stood for {:.1} s", self.family, journeys.standstill_s);
        }
        if seed.is_multiple_of(2) && record.status.name() != "errands_over" {
            self.undone += 1;
            println!("{} {seed}: {} robots, errands not over in time", self.family, record.robots.len());
        }
    }

    /// Prints the counts; returns whether the worlds are sound.
    fn print(&self, count: u64) -> bool {
        let Self { family, robots, stalls, violations, internal, refused, standstills, .. } = self;
        let share = 100.0 * f64::from(*stalls) / (*robots).max(1) as f64;
        println!(
            "{family}: {count} worlds, {robots} robots: {violations} violations, {internal} internal errors, \
             {refused} other failures, {standstills} fleets that stood for {STANDSTILL_S} s (longest {:.1} \
             s), {stalls} robots ({share:.2} %) without progress for 30 s, {} cut off, {} stalled trials, {} \
             worlds with errands left",
            self.longest, self.cut_off, self.stalled, self.undone
        );
        violations + internal + refused + standstills == 0 && share <= 1.0
    }
}
