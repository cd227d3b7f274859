//! The rules of a mission, compiled.

use parry2d::math::Vector;
use rne_core::GroupSizes;

use crate::geometry::vector;
use crate::ids::RobotId;
use crate::scenario::{
    BeliefSharing, EmptyBattery, EmptyTasks, Errand, LoadAtRest, MissionRules, RestAtHome, RestFills,
    RoundEnd, TurnBack,
};

/// When a robot with a low level needs rest.
#[derive(Debug, Clone, Copy)]
pub struct LowLevel {
    /// It needs rest below this level, in percent.
    pub threshold: f64,
    /// When it turns back.
    pub turn_back: TurnBack,
}

/// The rules of a mission.
#[derive(Debug, Clone, Copy)]
pub struct MissionModel {
    /// When a robot with little energy needs rest.
    pub low_energy: LowLevel,
    /// When a robot with little HP needs rest.
    pub low_hp: LowLevel,
    /// Whether a robot goes on when its battery is empty.
    pub goes_on_empty: bool,
    /// A robot turns back when its energy is less than this many times what the way to its rest place costs.
    pub rest_reserve: f64,
    /// Steps of a rest, and of a rest twice as long.
    pub rest_steps: [u64; 2],
    /// What a rest restores.
    pub rest_fills: RestFills,
    /// When a robot that is at home with a low level rests.
    pub rest_at_home: RestAtHome,
    /// Where the load of a robot that goes to rest is delivered.
    pub load_at_rest: LoadAtRest,
    /// Who must be home before the next round begins.
    pub round_end: RoundEnd,
    /// How far groups must have the sizes that the question says.
    pub group_sizes: GroupSizes,
    /// Whether a policy may leave robots idle at home.
    pub may_idle: bool,
    /// Who goes to a task of which the team knows that no rescuee waits there.
    pub empty_tasks: EmptyTasks,
    /// Who shares what a robot in the field has seen.
    pub belief_sharing: BeliefSharing,
    /// Whether a robot that rests, or is on its way to rest, still guides its group.
    pub resting_guides: bool,
    /// Steps of loading one rescuee.
    pub loading_steps: u64,
    /// Distance from its centre within which a robot can load a rescuee, in metres.
    pub reach: f32,
    /// Share of its speed that a robot keeps when its group has no guide that can act.
    pub blind_speed: f64,
    /// Share of its speed that a robot loses with a full load; with less in proportion.
    pub load_speed_loss: f64,
    /// A robot that comes no nearer to its goal for this long, in seconds, gives up on it. A detour adds the
    /// time that it takes.
    pub cut_off_s: f64,
    /// The same, in steps.
    pub cut_off_steps: u64,
}

impl MissionModel {
    /// Compiles rules for steps of `dt_s` seconds.
    pub fn compile(rules: &MissionRules, dt_s: f64) -> Self {
        let steps = |seconds: f64| (seconds / dt_s).round() as u64;
        Self {
            low_energy: LowLevel { threshold: rules.energy_threshold, turn_back: rules.energy_turn_back },
            low_hp: LowLevel { threshold: rules.hp_threshold, turn_back: rules.hp_turn_back },
            goes_on_empty: rules.empty_battery == EmptyBattery::GoesOn,
            rest_reserve: rules.rest_reserve,
            rest_steps: [steps(rules.rest_s), steps(2.0 * rules.rest_s)],
            rest_fills: rules.rest_fills,
            rest_at_home: rules.rest_at_home,
            load_at_rest: rules.load_at_rest,
            round_end: rules.round_end,
            group_sizes: rules.group_sizes,
            may_idle: rules.may_idle,
            empty_tasks: rules.empty_tasks,
            belief_sharing: rules.belief_sharing,
            resting_guides: rules.resting_guides,
            loading_steps: steps(rules.loading_s),
            reach: rules.reach_m as f32,
            blind_speed: 1.0 - rules.blind_speed_loss,
            load_speed_loss: rules.load_speed_loss,
            cut_off_s: rules.cut_off_s,
            cut_off_steps: (rules.cut_off_s / dt_s).round() as u64,
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
