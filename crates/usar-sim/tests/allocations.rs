//! A steady step allocates no memory: between events, a trial reuses the memory that it has. An allocator
//! counts, in a process of its own.

use std::alloc::System;

use scenario::Scenario;
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use teaming::Session;
use usar_sim::conflict::DelayCause;
use usar_sim::hash::PERIOD_S;
use usar_sim::simulation::Simulation;
use usar_sim::stage::Stage;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

const STAGES: usize = Stage::ALL.len();

/// Allocations of each stage in one step.
fn count(trial: &mut Simulation, session: &mut dyn Session) -> [usize; STAGES] {
    let mut taken = [0; STAGES];
    let mut region = Region::new(ALLOCATOR);
    let step = trial.watch(session, |stage| {
        let change = region.change_and_reset();
        taken[stage as usize] = change.allocations + change.reallocations;
    });
    assert_eq!(step, None);
    taken
}

/// Whether a robot waits for, or makes room for, another robot.
fn is_in_conflict(trial: &Simulation) -> bool {
    trial.delays().any(|delay| {
        let own = [DelayCause::UnderWay, DelayCause::NothingToDo, DelayCause::Loading, DelayCause::Resting];
        !own.contains(&delay.cause)
    })
}

#[test]
fn a_step_without_events_plans_and_conflicts_takes_no_memory() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/paper.ron");
    let (scenario, _) = Scenario::load(path.as_ref()).unwrap();
    let mut policy = policies::standard().open("RNE").unwrap();
    let mut trial = Simulation::new(&scenario, 1).unwrap();
    let (mut steady, mut planned, mut longer) = (0, 0, 0);
    for _ in 0..10_000 {
        // Events are hashed at the beginning of the step after them.
        let was_busy = is_in_conflict(&trial) || !trial.events().is_empty();
        let mut taken = count(&mut trial, &mut *policy);
        // Allocations of the engine itself: its step, and its list of driven bodies.
        taken[Stage::Integrate as usize] = 0;
        taken[Stage::Drive as usize] = 0;
        let has_link = trial.steps().is_multiple_of((PERIOD_S / scenario.dt_s).round() as u64);
        if was_busy || is_in_conflict(&trial) || !trial.events().is_empty() || has_link {
            continue;
        }
        if taken[Stage::Plan as usize] > 0 {
            planned += 1;
            continue;
        }
        steady += 1;
        longer += usize::from(taken != [0; STAGES]);
    }
    println!(
        "{steady} steady steps; in {longer} a list is longer than ever before; {planned} more plan a route"
    );
    assert!(steady > 5_000 && planned < steady / 100, "{steady} steady steps, routes planned in {planned}");
    // Occasionally a list is longer than ever before, or a robot that comes no nearer to its goal searches
    // for the robot in its way.
    assert!(longer <= 10, "{longer} of {steady} steady steps take memory");
}
