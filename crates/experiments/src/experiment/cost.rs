//! The cost of trials: bodies times steps.

use ron_tree::limits::Limit;
use scenario::Scenario;
use store::Failure;

use super::Experiment;
use crate::limits::{SWEEP_WORK, TRIAL_WORK};

/// Bodies times steps that a thread simulates per second, roughly. Used to estimate times in messages.
const PER_SECOND: f64 = 1.5e6;

/// The cost of one trial or of many.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Robots and pieces of debris.
    pub bodies: usize,
    /// Steps of one trial.
    pub steps: u64,
    /// Number of trials.
    pub trials: f64,
}

impl Cost {
    /// The cost of one trial.
    pub fn of(scenario: &Scenario) -> Self {
        let sampled: u32 = scenario.tasks.iter().map(|task| task.sampled.debris).sum();
        let bodies = scenario.robots() as usize + scenario.obstacles().len() + sampled as usize;
        Self { bodies, steps: scenario.steps(), trials: 1.0 }
    }

    /// Bodies times steps.
    pub fn work(&self) -> f64 {
        self.bodies as f64 * self.steps as f64 * self.trials
    }

    fn check(&self, limit: Limit) -> Result<(), Failure> {
        let work = self.work();
        if work <= limit.most {
            return Ok(());
        }
        let Self { bodies, steps, trials } = self;
        let trials = if *trials > 1.0 { format!(" x {trials} trials") } else { String::new() };
        Err(Failure::input(format!(
            "{bodies} robots and pieces of debris x {steps} steps{trials} is {work:.1e}, more than {:.0e}: \
             about {} on one thread. --allow-expensive runs it all the same",
            limit.most,
            duration(work / PER_SECOND)
        )))
    }
}

fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 7_200.0 => format!("{:.0} minutes", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} hours", s / 3_600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}

/// Refuses a trial that is too expensive, unless that is allowed.
///
/// # Errors
/// The trial costs more than [`TRIAL_WORK`].
pub fn check_cost(scenario: &Scenario, is_allowed: bool) -> Result<(), Failure> {
    if is_allowed { Ok(()) } else { Cost::of(scenario).check(TRIAL_WORK) }
}

impl Experiment {
    /// Refuses a sweep that is too expensive, unless that is allowed, and a sweep with policies that may
    /// not run in its scenarios.
    ///
    /// # Errors
    /// A scenario allows only another policy; or the errors of [`Experiment::check_cost`].
    pub fn check(&self, is_allowed: bool) -> Result<(), Failure> {
        self.check_policies()?;
        self.check_cost(is_allowed)
    }

    /// Refuses policies that may not run in the sweep's scenarios.
    ///
    /// # Errors
    /// A scenario allows only another policy.
    pub fn check_policies(&self) -> Result<(), Failure> {
        let mut scenarios = self.cases.iter().map(|case| &case.scenario);
        scenarios.try_for_each(|scenario| {
            self.policies.iter().try_for_each(|policy| policy.check_allowed(scenario))
        })
    }

    /// Refuses a sweep that is too expensive, unless that is allowed.
    ///
    /// # Errors
    /// A trial costs more than [`TRIAL_WORK`], or all trials together cost more than [`SWEEP_WORK`].
    pub fn check_cost(&self, is_allowed: bool) -> Result<(), Failure> {
        let costs = self.cases.iter().map(|case| Cost::of(&case.scenario));
        let Some(dearest) = costs.max_by(|a, b| a.work().total_cmp(&b.work())).filter(|_| !is_allowed) else {
            return Ok(());
        };
        dearest.check(TRIAL_WORK)?;
        let trials = self.cases.len() as f64 * self.policies.len() as f64 * f64::from(self.trials);
        Cost { trials, ..dearest }.check(SWEEP_WORK)
    }
}
