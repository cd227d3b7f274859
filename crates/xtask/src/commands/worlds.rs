//! Feasible worlds: whether all robots arrive. It fails if a fleet stands still for a minute, more than one
//! robot in a hundred makes no progress for half a minute, an invariant is violated, a number is undefined,
//! or a panic occurs.
//!
//! `worlds [FIRST_SEED] [WORLDS] [SECONDS] [open|rooms|doors|paper]`: random worlds in the open, rooms whose
//! walls meet, or crowds of up to 60 in rooms with doors from one lane on, by default 500 of each, for 900 s;
//! or the paper's scenario under every policy, by default 100 seeds, for 600 s, in which every robot must
//! make progress.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use rayon::prelude::*;
use scenario::{Scenario, ScenarioFile};
use usar_sim::record::RobotRecord;
use xtask::journeys::{Journeys, JourneysError, STANDSTILL_S};
use xtask::{rooms, worlds};

/// A family of worlds.
struct Family {
    name: &'static str,
    /// The world of a seed.
    world: fn(u64) -> Scenario,
    /// Default number of seeds.
    seeds: u64,
    /// Default simulated time, in seconds.
    duration_s: f64,
    /// Whether each seed runs under every policy, instead of under RANDOM alone.
    has_every_policy: bool,
    /// The largest share of robots that may make no progress for half a minute, in percent.
    stalls_percent: f64,
}

impl Family {
    const fn random(name: &'static str, world: fn(u64) -> Scenario) -> Self {
        Self { name, world, seeds: 500, duration_s: 900.0, has_every_policy: false, stalls_percent: 1.0 }
    }
}

const FAMILIES: [Family; 4] = [
    Family::random("open", worlds::world),
    Family::random("rooms", rooms::rooms),
    Family::random("doors", rooms::doors),
    Family {
        name: "paper",
        world: |_| worlds::paper(),
        seeds: 100,
        duration_s: 600.0,
        has_every_policy: true,
        stalls_percent: 0.0,
    },
];

/// A robot without progress for longer than this is counted apart, in seconds.
const LONG_STALL_S: f64 = 60.0;

pub fn run(arguments: &[String]) -> ExitCode {
    let is_number = |text: &&String| text.parse::<u64>().is_ok();
    let numbers: Vec<u64> =
        arguments.iter().filter(is_number).map(|text| text.parse().expect("a number")).collect();
    let chosen = arguments.iter().find(|text| !is_number(text));
    let is_chosen = |family: &&Family| chosen.is_none_or(|name| name == family.name);
    let families: Vec<&Family> = FAMILIES.iter().filter(is_chosen).collect();
    if families.is_empty() || arguments.len() > 4 {
        eprintln!("usage: worlds [FIRST_SEED] [WORLDS] [SECONDS] [open|rooms|doors|paper]");
        return ExitCode::from(2);
    }
    std::panic::set_hook(Box::new(|_| {})); // a panic is counted, and told in one line
    let is_sound = |family: &&&Family| run_family(family, &numbers);
    let sound = families.iter().filter(is_sound);
    ExitCode::from(u8::from(sound.count() < families.len()))
}

/// Runs a family's worlds, from a seed on, as many, and as long as these numbers say; returns whether they
/// are sound.
fn run_family(family: &Family, numbers: &[u64]) -> bool {
    let first = numbers.first().copied().unwrap_or(0);
    let count = numbers.get(1).copied().unwrap_or(family.seeds);
    let duration_s = numbers.get(2).map_or(family.duration_s, |seconds| *seconds as f64);
    let registry = policies::standard();
    let policies = if family.has_every_policy { registry.names() } else { vec!["RANDOM"] };
    let trials: Vec<(u64, &str)> =
        (first..first + count).flat_map(|seed| policies.iter().map(move |policy| (seed, *policy))).collect();
    let mut totals = Totals::default();
    for chunk in trials.chunks(CHUNK) {
        let run = |&(seed, policy): &(u64, &str)| {
            catch_unwind(AssertUnwindSafe(|| {
                let world = lasting(&(family.world)(seed), duration_s);
                Journeys::run(&world, policy, seed).map(|journeys| (journeys, world.errands.is_empty()))
            }))
            .unwrap_or(Err(JourneysError::Panicked))
        };
        let results: Vec<Result<(Journeys, bool), JourneysError>> = chunk.par_iter().map(run).collect();
        for ((seed, policy), result) in chunk.iter().zip(&results) {
            let policy = if family.has_every_policy { format!(" {policy}") } else { String::new() };
            totals.add(&format!("{}{policy} {seed}", family.name), result);
        }
    }
    totals.print(family, trials.len())
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
    robots: usize,
    stalls: u32,
    violations: u32,
    internal: u32,
    refused: u32,
    standstills: u32,
    cut_off: usize,
    stalled: u32,
    undone: u32,
    long_stalls: usize,
    without_round: u32,
    longest: f64,
}

impl Totals {
    /// Adds a world, and prints its problems.
    fn add(&mut self, name: &str, result: &Result<(Journeys, bool), JourneysError>) {
        let (journeys, is_mission) = match result {
            Ok((journeys, is_mission)) => (journeys, *is_mission),
            Err(error) => {
                match error {
                    JourneysError::Panicked => self.internal += 1,
                    JourneysError::Failed { reason } if reason.starts_with("invariant violated") => {
                        self.violations += 1;
                    }
                    JourneysError::Failed { .. } | JourneysError::Layout(_) => self.refused += 1,
                }
                println!("{name}: {error}");
                return;
            }
        };
        let record = &journeys.record;
        self.robots += record.robots.len();
        self.cut_off += record.cut_off.len();
        let is_long = |robot: &&RobotRecord| robot.longest_stall_s > LONG_STALL_S;
        self.long_stalls += record.robots.iter().filter(is_long).count();
        for stall in journeys.stalls() {
            self.stalls += 1;
            println!("{name}: {stall}");
        }
        if record.stalled > 0 {
            self.stalled += 1;
            let causes = record.cut_off.iter().map(|cut| format!("robot {} {}", cut.robot, cut.cause.name()));
            let causes: Vec<String> = causes.collect();
            println!("{name}: {} robots stalled: {}", record.stalled, causes.join(", "));
        }
        self.longest = self.longest.max(journeys.standstill_s);
        if journeys.standstill_s > STANDSTILL_S {
            self.standstills += 1;
            println!("{name}: all stood for {:.1} s", journeys.standstill_s);
        }
        if !is_mission && record.status.name() != "finished" {
            self.undone += 1;
            println!("{name}: {} robots, errands not over in time", record.robots.len());
        }
        if is_mission && record.completed_rounds == 0 {
            self.without_round += 1;
            println!("{name}: {} robots, no round is over", record.robots.len());
        }
    }

    /// Prints the counts; returns whether the worlds are sound.
    fn print(&self, family: &Family, count: usize) -> bool {
        let Self { robots, stalls, violations, internal, refused, standstills, .. } = self;
        let share = 100.0 * f64::from(*stalls) / (*robots).max(1) as f64;
        println!(
            "{}: {count} worlds, {robots} robots: {violations} violations, {internal} internal errors, \
             {refused} other failures, {standstills} fleets that stood for {STANDSTILL_S} s (longest {:.1} \
             s), {stalls} robots ({share:.2} %) without progress for 30 s, {} for {LONG_STALL_S} s, {} cut \
             off, {} stalled trials, {} worlds with errands left, {} without a finished round",
            family.name,
            self.longest,
            self.long_stalls,
            self.cut_off,
            self.stalled,
            self.undone,
            self.without_round
        );
        violations + internal + refused + standstills == 0 && share <= family.stalls_percent
    }
}
