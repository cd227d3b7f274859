//! The defaults of a scenario file. Robots, costs and rules are those of `scenarios/paper.ron`, which gives
//! and explains them all, except that a robot sees rescuees as far as debris; a test compares the two. There
//! is no default for the team, the arena, the duration and the tasks of a mission.

use rne_core::hierarchy::NeedLevel;
use teaming::GroupSizes;

use super::file::{
    BeliefSharing, ClaimRule, CostUnit, Costs, Decider, EmptyBattery, EmptyTasks, InitialLevels, LoadAtRest,
    Measure, MissionEnd, MissionRules, Movable, NeedFile, Normal, PlanningRules, RestAtHome, RestFills,
    RightOfWay, RoleFile, RoleKind, RoundEnd, TurnBack,
};
use crate::{Rates, Sight, WorkRates};

/// The format of a file that names none: the one that this program reads.
pub(super) fn format() -> u32 {
    super::FORMAT
}

/// Default time from one control step to the next, in seconds.
pub(super) fn control_period_s() -> f64 {
    0.1
}

/// One role, for scenarios in which all robots are alike.
pub(super) fn roles() -> Vec<RoleFile> {
    vec![RoleFile { name: "robot".to_owned(), ..RoleFile::default() }]
}

/// The seven needs of the paper: safety needs, a basic need, capability needs.
pub(super) fn needs() -> Vec<NeedFile> {
    let need =
        |name: &str, level, measures| NeedFile { name: name.to_owned(), level, measures, weight: weight() };
    vec![
        need("hp", NeedLevel::Safety, Measure::Health),
        need("v", NeedLevel::Safety, Measure::Speed),
        need("sen", NeedLevel::Safety, Measure::Sensing),
        need("eng", NeedLevel::Basic, Measure::Energy),
        need("res", NeedLevel::Capability, Measure::Resources),
        need("cap", NeedLevel::Capability, Measure::Capacity),
        need("obs", NeedLevel::Capability, Measure::Observing),
    ]
}

/// Default weight of a need.
pub(super) fn weight() -> f64 {
    1.0
}

impl Default for RoleFile {
    fn default() -> Self {
        Self {
            name: String::new(),
            kind: RoleKind::Ground,
            radius_m: 0.4,
            mass_kg: 50.0,
            hp: 100.0,
            energy: 150.0,
            speed_mps: 2.25,
            acceleration_mps2: 4.0,
            sensing_m: 3.0,
            observing_m: 3.0,
            sight: Sight::default(),
            capacity: 6,
            resources: 1,
            guides: false,
            constants: std::collections::BTreeMap::new(),
        }
    }
}

impl Default for InitialLevels {
    fn default() -> Self {
        Self { energy: Normal { mean: 80.0, sd: 20.0 }, hp: Normal { mean: 90.0, sd: 10.0 } }
    }
}

impl Default for Costs {
    fn default() -> Self {
        let per_step = |per_step| Rates { per_step, per_metre: 0.0, per_second: 0.0 };
        Self {
            unit: CostUnit::Percent,
            energy: per_step(0.0045),
            hp: per_step(0.0003),
            work: WorkRates::default(),
        }
    }
}

/// Time after which a team decides again of which nobody went, in seconds.
pub(crate) fn retry_s() -> f64 {
    30.0
}

/// Longest time in which robots talk before they go, in seconds.
pub(crate) fn deadline_s() -> f64 {
    30.0
}

/// Time after which a robot tells its claim again, in seconds.
pub(crate) fn claim_again_s() -> f64 {
    5.0
}

impl Default for MissionRules {
    fn default() -> Self {
        Self {
            energy_threshold: 30.0,
            hp_threshold: 30.0,
            energy_turn_back: TurnBack::AtOnce,
            hp_turn_back: TurnBack::AtOnce,
            empty_battery: EmptyBattery::Stops,
            rest_reserve: 1.5,
            rest_s: 30.0,
            rest_fills: RestFills::Both,
            rest_at_home: RestAtHome::DuringRound,
            load_at_rest: LoadAtRest::Delivered,
            decides: Decider::Base,
            round_end: RoundEnd::EverybodyHome,
            ends: MissionEnd::WhenDone,
            group_sizes: GroupSizes::Parts,
            may_idle: false,
            empty_tasks: EmptyTasks::GetNobody,
            belief_sharing: BeliefSharing::WithGroup,
            claims: ClaimRule::Known,
            resting_guides: true,
            loading_s: 2.0,
            reach_m: 1.0,
            area_margin_m: 4.0,
            blind_speed_loss: 0.3,
            load_speed_loss: 0.0,
            health_floor: 0.5,
            cut_off_s: 60.0,
        }
    }
}

impl Default for PlanningRules {
    fn default() -> Self {
        Self { clearance_m: 0.15, exposure_price_m: 2.0 }
    }
}

impl Default for RightOfWay {
    fn default() -> Self {
        Self { margin_m: 0.15, horizon_s: 0.8, deadlock_steps: 10 }
    }
}

impl Default for Movable {
    fn default() -> Self {
        Self { mass_kg: 40.0, friction: 0.5 }
    }
}
