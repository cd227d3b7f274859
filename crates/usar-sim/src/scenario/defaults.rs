//! What a scenario file need not say. Robots, costs and rules are those of `scenarios/paper.ron`, which gives them all and explains
//! each; a test compares the two. There is no default for the team, the arena and the duration.

use super::file::{
    ConflictRules, Costs, InitialLevels, MissionRules, Normal, PlanningRules, PriorityRule, ResolverRule,
    RoleSpec, Roles, SweepDefaults, TaskFile, Tasks, TurnBack,
};
use crate::vitals::Rates;

impl Default for SweepDefaults {
    fn default() -> Self {
        Self { policies: vec!["RNE".to_owned()], trials: 1, first_seed: 1 }
    }
}

impl Default for Roles {
    fn default() -> Self {
        let carrier = RoleSpec {
            radius_m: 0.4,
            mass_kg: 50.0,
            hp: 100.0,
            energy: 150.0,
            speed_mps: 2.25,
            acceleration_mps2: 4.0,
            sensing_m: 3.0,
            observing_m: 0.006,
            capacity: 6,
            resources: 1,
        };
        let observer = RoleSpec {
            mass_kg: 5.0,
            hp: 50.0,
            energy: 100.0,
            speed_mps: 1.5,
            sensing_m: 18.0,
            observing_m: 6.0,
            capacity: 0,
            resources: 0,
            ..carrier
        };
        Self { carrier, supplier: RoleSpec { capacity: 1, resources: 10, ..carrier }, observer }
    }
}

impl Default for InitialLevels {
    fn default() -> Self {
        Self { energy: Normal { mean: 80.0, sd: 20.0 }, hp: Normal { mean: 90.0, sd: 10.0 } }
    }
}

/// Nobody to rescue: for scenarios with errands.
impl Default for Tasks {
    fn default() -> Self {
        let nobody = TaskFile { center: [1.0, 1.0], size_m: [0.0, 0.0], grid: [0, 0], rest: [1.0, 1.0] };
        Self { hard: nobody, easy: nobody }
    }
}

impl Default for Costs {
    fn default() -> Self {
        let per_step = |per_step| Rates { per_step, per_metre: 0.0, per_second: 0.0 };
        Self { energy: per_step(0.0045), hp: per_step(0.0003) }
    }
}

impl Default for MissionRules {
    fn default() -> Self {
        Self {
            energy_threshold: 30.0,
            hp_threshold: 30.0,
            energy_turn_back: TurnBack::AtOnce,
            hp_turn_back: TurnBack::AtOnce,
            rest_reserve: 1.5,
            rest_s: 30.0,
            loading_s: 2.0,
            reach_m: 1.0,
            area_margin_m: 4.0,
            blind_speed_loss: 0.3,
            health_floor: 0.5,
        }
    }
}

impl Default for PlanningRules {
    fn default() -> Self {
        Self { clearance_m: 0.15, exposure_price_m: 2.0 }
    }
}

impl Default for ConflictRules {
    fn default() -> Self {
        Self {
            margin_m: 0.15,
            horizon_s: 0.8,
            deadlock_steps: 10,
            priority: PriorityRule::LowestEnergyFirst,
            resolver: ResolverRule::Rotation,
        }
    }
}
