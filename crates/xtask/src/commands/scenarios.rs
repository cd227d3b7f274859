//! Random valid scenarios of all kinds, each run for a minute under the checker of invariants.
//!
//! `scenarios [FIRST_SEED] [SCENARIOS]`

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::Instant;

use rayon::prelude::*;
use xtask::random;

use super::number;

pub fn run(arguments: &[String]) -> ExitCode {
    let (first, count) = (number(arguments, 0, 0), number(arguments, 1, 500));
    std::panic::set_hook(Box::new(|_| {})); // a panic is counted, and told in one line
    let began = Instant::now();
    let run = |seed: u64| (seed, catch_unwind(AssertUnwindSafe(|| random::run(seed))).ok());
    let results: Vec<_> = (first..first + count).into_par_iter().map(run).collect();
    let mut totals = [0_usize; 6];
    let mut bad = 0;
    for (seed, ran) in &results {
        let Some(ran) = ran else {
            println!("seed {seed}: internal error\n{}", random::text(seed * 1_000));
            bad += 1;
            continue;
        };
        if let Some(violation) = &ran.violation {
            println!("seed {seed}: {violation}\n{}", ran.text);
            bad += 1;
        }
        let parts = [
            ran.events,
            ran.draws,
            ran.scattered,
            ran.refused as usize,
            usize::from(ran.tasks == 0),
            ran.tasks,
        ];
        totals.iter_mut().zip(parts).for_each(|(total, part)| *total += part);
    }
    let [events, draws, scattered, refused, errands, tasks] = totals;
    println!(
        "{count} scenarios, {bad} with a violation or an internal error; {tasks} tasks, {errands} scenarios \
         with errands, {events} events, {draws} distributions, {scattered} entries of scatter; {refused} \
         texts whose values did not go together; {:.0} s",
        began.elapsed().as_secs_f64()
    );
    ExitCode::from(u8::from(bad > 0))
}
