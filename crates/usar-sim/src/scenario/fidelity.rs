//! How finely a trial is simulated: in the steps of its scenario, or in longer ones at the same costs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Scenario;
use super::file::{ResolverRule, ScenarioFile};

/// The step for which costs per step are written, the paper's and the defaults among them, in seconds.
pub(super) const USUAL_STEP_S: f64 = 0.02;

/// Length of a step of a coarse trial, in seconds.
const COARSE_STEP_S: f64 = 0.05;

/// A robot chooses its velocity anew before it has gone farther than this, in metres: no farther than it may
/// be from a waypoint that it passes.
pub(super) const CONTROL_WAY_M: f64 = 0.25;

/// How finely a trial is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum Fidelity {
    /// In steps of `dt_s`. The default.
    #[default]
    AsWritten,
    /// In steps of 0.05 s, whatever `dt_s` is, for 1.1 to 1.3 times as many trials in the same time. In a
    /// second everything costs the same as in steps of `dt_s`: each cost `per_step` grows with the step, and
    /// the `deadlock_steps` last as long.
    Coarse,
}

impl Fidelity {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
    pub(super) fn is_as_written(&self) -> bool {
        *self == Self::AsWritten
    }
}

impl ScenarioFile {
    /// Length of a step of a trial, in seconds.
    pub fn step_s(&self) -> f64 {
        match self.fidelity {
            Fidelity::AsWritten => self.dt_s,
            Fidelity::Coarse => COARSE_STEP_S,
        }
    }
}

impl Scenario {
    /// Steps from one control step to the next: at least one.
    pub(crate) fn control_steps(&self) -> u64 {
        let fastest = self.bodies().map(|(body, _)| body.speed_mps).fold(0.0, f64::max);
        let period_s = self.control_period_s.min(CONTROL_WAY_M / fastest);
        ((period_s / self.step_s() + 1e-9) as u64).max(1)
    }

    /// The scenario as it is simulated: in steps of its fidelity, with what it states for each step.
    pub(super) fn in_its_steps(mut self) -> Self {
        let file = &mut self.0;
        let times = file.step_s() / file.dt_s;
        file.dt_s = file.step_s();
        for rates in [&mut file.costs.energy, &mut file.costs.hp] {
            rates.per_step *= times;
        }
        if let ResolverRule::Rotation(rule) | ResolverRule::Swap(rule) = &mut file.conflicts.resolver {
            rule.deadlock_steps = (f64::from(rule.deadlock_steps) / times).round().max(1.0) as u32;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::RightOfWay;
    use crate::vitals::Rates;

    fn paper() -> Scenario {
        let text = include_str!("../../../../scenarios/paper.ron");
        Scenario::parse(text, "paper.ron".as_ref()).unwrap()
    }

    fn set(scenario: &Scenario, path: &str, value: &str) -> Scenario {
        let mut file = (**scenario).clone();
        file.set(path, value).unwrap();
        Scenario::try_from(file).unwrap()
    }

    #[test]
    fn without_a_fidelity_nothing_changes() {
        let paper = paper();
        assert_eq!(paper.of_trial(1).unwrap(), paper);
        assert!(!paper.resolved().contains("fidelity"), "results and snapshots are those of before");
        assert_eq!(set(&paper, "fidelity", "AsWritten"), paper);
        let slow = set(&paper, "dt_s", "0.04");
        assert_eq!(slow.of_trial(1).unwrap(), slow);
    }

    #[test]
    fn a_coarse_trial_costs_and_waits_as_much_in_a_second() {
        for dt_s in ["0.01", "0.02", "0.05"] {
            let fine = set(&paper(), "dt_s", dt_s);
            let given = set(&fine, "fidelity", "Coarse");
            let coarse = given.of_trial(1).unwrap();
            assert_eq!((coarse.dt_s, given.dt_s), (0.05, fine.dt_s), "the file stays as it is written");
            assert_eq!([given.steps(), coarse.steps()], [12_000; 2]);
            let in_a_second = |rates: Rates, dt_s| [rates.per_step / dt_s, rates.per_metre, rates.per_second];
            for (a, b) in [(fine.costs.energy, coarse.costs.energy), (fine.costs.hp, coarse.costs.hp)] {
                let (a, b) = (in_a_second(a, fine.dt_s), in_a_second(b, coarse.dt_s));
                assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-12), "{dt_s}: {a:?}, {b:?}");
            }
            let waits = |scenario: &Scenario| match scenario.conflicts.resolver {
                ResolverRule::Rotation(RightOfWay { deadlock_steps, .. }) => {
                    f64::from(deadlock_steps) * scenario.dt_s
                }
                _ => f64::NAN,
            };
            assert!((waits(&fine) - waits(&coarse)).abs() < 1e-12, "{dt_s}");
            assert_eq!(coarse.of_trial(1).unwrap(), coarse, "coarse steps are not made longer again");
        }
    }

    #[test]
    fn a_deadlock_takes_at_least_one_step() {
        let swap = set(&paper(), "conflicts.resolver", "Swap(deadlock_steps: 1)");
        let coarse = set(&swap, "fidelity", "Coarse").of_trial(1).unwrap();
        assert!(matches!(
            coarse.conflicts.resolver,
            ResolverRule::Swap(RightOfWay { deadlock_steps: 1, .. })
        ));
    }

    #[test]
    fn control_steps_are_0_1_s_apart_but_for_fast_robots() {
        let steps = |path: &str, value: &str| set(&paper(), path, value).of_trial(1).unwrap().control_steps();
        assert_eq!((steps("dt_s", "0.02"), steps("dt_s", "0.03"), steps("fidelity", "Coarse")), (5, 3, 2));
        assert_eq!((steps("control_period_s", "0.001"), steps("control_period_s", "1.0")), (1, 5));
        assert_eq!(
            (steps("roles.carrier.speed_mps", "3.0"), steps("roles.carrier.speed_mps", "5.9")),
            (4, 2)
        );
    }

    #[test]
    fn a_robot_too_fast_for_coarse_steps_is_told() {
        let mut file = (*paper()).clone();
        file.set("roles.carrier.speed_mps", "3.0").unwrap();
        assert!(Scenario::try_from(file.clone()).is_ok());
        file.set("fidelity", "Coarse").unwrap();
        let problems = Scenario::try_from(file).unwrap_err();
        assert_eq!(
            problems[0].to_string(),
            "roles.carrier.speed_mps times the step of a coarse trial (0.05 s) must be at most 0.12 m where debris \
             can be pushed, or it is pushed into robots, found 3"
        );
    }
}
