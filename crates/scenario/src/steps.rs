//! The steps of a trial, and those in which robots choose their velocities.

use serde::{Deserialize, Serialize};

use super::Scenario;

/// The step for which costs per step are written, the paper's and the defaults among them, in seconds.
pub(super) const USUAL_STEP_S: f64 = 0.02;

/// A robot chooses its velocity anew before it has gone farther than this, in metres: no farther than it may
/// be from a waypoint that it passes.
pub(super) const CONTROL_WAY_M: f64 = 0.25;

/// Of older files, which chose between the steps of `dt_s` and longer ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Fidelity {
    /// In steps of `dt_s`, as all trials.
    AsWritten,
    /// In steps of 0.05 s at the same costs in a second; refused.
    Coarse,
}

impl Scenario {
    /// Steps from one control step to the next: at least one.
    pub fn control_steps(&self) -> u64 {
        let fastest = self.bodies().map(|(body, _)| body.speed_mps).fold(0.0, f64::max);
        let period_s = self.control_period_s.min(CONTROL_WAY_M / fastest);
        ((period_s / self.dt_s + 1e-9) as u64).max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paper() -> Scenario {
        let text = include_str!("../../../scenarios/paper.ron");
        Scenario::parse(text, "paper.ron".as_ref()).unwrap()
    }

    fn set(scenario: &Scenario, path: &str, value: &str) -> Scenario {
        let mut file = (**scenario).clone();
        file.set(path, value).unwrap();
        Scenario::try_from(file).unwrap()
    }

    #[test]
    fn control_steps_are_0_1_s_apart_but_for_fast_robots() {
        let steps = |path: &str, value: &str| set(&paper(), path, value).of_trial(1).unwrap().control_steps();
        assert_eq!((steps("dt_s", "0.02"), steps("dt_s", "0.03"), steps("dt_s", "0.05")), (5, 3, 2));
        assert_eq!((steps("control_period_s", "0.001"), steps("control_period_s", "1.0")), (1, 5));
        assert_eq!(
            (steps("roles.carrier.speed_mps", "3.0"), steps("roles.carrier.speed_mps", "5.9")),
            (4, 2)
        );
    }
}
