//! The rules of a mission, compiled.

use std::ops::Deref;

use parry2d::math::Vector;
use scenario::shapes::vector;
use scenario::{EmptyBattery, Errand, MissionRules, TurnBack};

use crate::ids::RobotId;

/// A robot is late, and no longer gets on, once this share of its time is over. Whenever a robot for which it
/// waits gets on, the rest of its time begins anew.
pub(crate) const LATE_SHARE: f64 = 0.5;

/// When a robot with a low level needs rest.
#[derive(Debug, Clone, Copy)]
pub struct LowLevel {
    /// It needs rest below this level, in percent.
    pub threshold: f64,
    /// When it turns back.
    pub turn_back: TurnBack,
}

/// The rules of a mission, with what follows from them.
#[derive(Debug, Clone, Copy)]
pub struct MissionModel {
    /// As they are written; they are read as if they stood here.
    rules: MissionRules,
    /// When a robot with little energy needs rest.
    pub low_energy: LowLevel,
    /// When a robot with little HP needs rest.
    pub low_hp: LowLevel,
    /// Whether a robot goes on when its battery is empty.
    pub goes_on_empty: bool,
    /// Steps of a rest, and of a rest twice as long.
    pub rest_steps: [u64; 2],
    /// Steps of loading one rescuee.
    pub loading_steps: u64,
    /// Distance from its centre within which a robot can load a rescuee, in metres.
    pub reach: f32,
    /// Share of its speed that a robot keeps when its group has no guide that can act.
    pub blind_speed: f64,
    /// After so many control steps without coming nearer to its goal a robot is late: see `LATE_SHARE`.
    pub late_steps: u64,
}

impl Deref for MissionModel {
    type Target = MissionRules;

    fn deref(&self) -> &MissionRules {
        &self.rules
    }
}

impl MissionModel {
    /// Compiles rules for steps of `dt_s` seconds and control steps `control_s` seconds apart.
    pub fn compile(rules: &MissionRules, dt_s: f64, control_s: f64) -> Self {
        let steps = |seconds: f64| (seconds / dt_s).round() as u64;
        Self {
            low_energy: LowLevel { threshold: rules.energy_threshold, turn_back: rules.energy_turn_back },
            low_hp: LowLevel { threshold: rules.hp_threshold, turn_back: rules.hp_turn_back },
            goes_on_empty: rules.empty_battery == EmptyBattery::GoesOn,
            rest_steps: [steps(rules.rest_s), steps(2.0 * rules.rest_s)],
            loading_steps: steps(rules.loading_s),
            reach: rules.reach_m as f32,
            blind_speed: 1.0 - rules.blind_speed_loss,
            late_steps: (LATE_SHARE * rules.cut_off_s / control_s).round() as u64,
            rules: *rules,
        }
    }
}

/// The places that one robot is to go to.
#[derive(Debug, Clone)]
pub struct ErrandModel {
    /// The robot.
    pub robot: RobotId,
    /// The places, in order.
    pub to: Vec<Vector>,
}

impl ErrandModel {
    pub(super) fn compile(errand: &Errand) -> Self {
        Self { robot: RobotId(errand.robot), to: errand.to.iter().copied().map(vector).collect() }
    }
}
