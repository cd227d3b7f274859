//! Quiet steps against the engine in every step: the same trial both ways.

use scenario::Scenario;
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
    let run = |mut trial: Simulation| {
        let mut random = policies::standard().open("RANDOM").expect("known");
        while trial.step(&mut *random).is_none() {}
        let steps = trial.world().physics.steps();
        (trial.finish().chain, steps)
    };
    let (quick, steps) = run(Simulation::new(scenario, seed).ok()?.with_whole_team_stepped());
    let (always, _) = run(Simulation::new(scenario, seed).ok()?.with_engine_always_on());
    let mut pairs = quick.links().iter().zip(always.links());
    let differs_at = pairs.find(|(a, b)| a.digest != b.digest).map(|(link, _)| link.step);
    let is_shorter = quick.links().len() != always.links().len();
    Some(BothWays { differs_at: differs_at.or(is_shorter.then_some(steps[0])), steps })
}
