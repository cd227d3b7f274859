//! Quiet steps against the engine in every step: the same trial both ways.

use scenario::Scenario;
use usar_sim::physics::Physics;
use usar_sim::simulation::Simulation;

/// A trial that ran both ways.
pub struct BothWays {
    /// The first step at which the hash chains differ, if they do.
    pub differs_at: Option<u64>,
    /// Steps done, and those in which the engine ran.
    pub steps: [u64; 2],
}

/// Runs a trial of a scenario both ways; `None` if its layout cannot be drawn.
pub fn both_ways(scenario: &Scenario, seed: u64) -> Option<BothWays> {
    let run = |set: fn(&mut Physics)| {
        let mut trial = Simulation::new(scenario, seed).ok()?;
        set(&mut trial.world_mut().physics);
        let mut random = policies::standard().open("RANDOM").expect("known");
        while trial.step(&mut *random).is_none() {}
        let steps = trial.world().physics.steps();
        Some((trial.finish().chain, steps))
    };
    let (quick, steps) = run(Physics::step_whole_team)?;
    let (always, _) = run(Physics::keep_engine_on)?;
    let mut pairs = quick.links().iter().zip(always.links());
    let differs_at = pairs.find(|(a, b)| a.digest != b.digest).map(|(link, _)| link.step);
    let is_shorter = quick.links().len() != always.links().len();
    Some(BothWays { differs_at: differs_at.or(is_shorter.then_some(steps[0])), steps })
}
