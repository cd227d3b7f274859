//! Right of way, compiled: the constants of both rules, with times in control steps, which are called steps
//! here.

use parry2d::math::Vector;
use scenario::shapes::vector;
use scenario::{PriorityRule, ResolverRule, Scenario};

/// How long a deadlocked set backs off, in seconds.
const BACK_OFF_S: f64 = 1.0;

/// How long the head of a set may move without coming nearer before it loses its turn, in seconds.
const LIVELOCK_S: f64 = 2.0;

/// How long a robot tries to reach the place where it makes room without coming nearer to it, in seconds.
const RETREAT_PATIENCE_S: f64 = 3.0;

/// How long a robot keeps making room at its place while the other robot stands still, in seconds.
const ROOM_PATIENCE_S: f64 = 15.0;

/// How long a robot is not asked again after a retreat that failed, in seconds.
const RESPITE_S: f64 = 3.0;

/// Share of its top speed at which a robot retreats under the paper's rule.
const RETREAT_SPEED: f32 = 0.8;

/// Under the default rule, a robot that made room goes on as soon as its route is clear of the other robot's
/// for this distance, in metres.
const GOES_ON_WITHIN_M: f32 = 3.0;

/// How often a robot asks again for room while it is blocked or comes no nearer, in seconds.
const ASK_AGAIN_S: f64 = 0.5;

/// A robot that has come no nearer for this long, in seconds, is stuck.
const STUCK_S: f64 = 4.0;

/// A robot that has waited this long before a passage, in seconds, ends the turn of the other direction.
const TURN_S: f64 = 10.0;

/// A robot that has come no nearer for this long, in seconds, holds up no robot behind it. At the least wish
/// a robot may count as such for a moment; then the robot behind closes up.
const HOLDS_QUEUE_S: f64 = 2.0;

/// A robot that makes room and gets no nearer to its place for this long, in seconds, is let out by the robot
/// for which it does so.
const LET_OUT_S: f64 = 2.0;

/// Right of way in one trial.
#[derive(Debug, Clone)]
pub struct RightOfWayModel {
    /// Who has the right of way.
    pub priority: PriorityRule,
    /// The rule that resolves conflicts.
    pub rule: RuleKind,
    /// The constants of the default rule.
    pub reciprocal: ReciprocalModel,
    /// The constants of the paper's rule.
    pub sets: SetsModel,
}

/// The rule that resolves conflicts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RuleKind {
    /// The default rule.
    Reciprocal,
    /// The paper's rule.
    Sets,
    /// None: robots drive as they wish.
    None,
}

/// The constants of the default rule.
#[derive(Debug, Clone)]
pub struct ReciprocalModel {
    /// How robots make room.
    pub retreats: RetreatModel,
    /// Steps between two requests for room.
    pub ask_again: u32,
    /// Steps without coming nearer after which a robot is stuck.
    pub stuck: u32,
    /// Steps of waiting before a passage after which a robot ends the turn of the other direction.
    pub turn: u32,
    /// Steps without coming nearer after which a robot no longer holds up the robots behind it.
    pub holds_queue: u32,
    /// Steps without coming nearer after which a robot that makes room is let out.
    pub let_out: u32,
}

/// The constants of the paper's rule.
#[derive(Debug, Clone)]
pub struct SetsModel {
    /// How robots make room.
    pub retreats: RetreatModel,
    /// Steps between two requests for room.
    pub ask_again: u32,
    /// How far ahead a conflict is predicted, in seconds.
    pub horizon: f32,
    /// How long a set may make no progress.
    pub patience: Patience,
    /// Whether the head of a deadlocked set changes places with others; otherwise it goes to the tail.
    pub swaps: bool,
}

/// How long a conflict set may make no progress, in steps.
#[derive(Debug, Clone, Copy)]
pub struct Patience {
    /// Without motion of any member.
    pub deadlock: u32,
    /// Without the head coming nearer.
    pub livelock: u32,
    /// How long a set backs off.
    pub back_off: u32,
}

/// How robots make room under a rule.
#[derive(Debug, Clone)]
pub struct RetreatModel {
    /// Steps on the way to the place without coming nearer to it after which a retreat ends.
    pub underway: u32,
    /// Steps at the place while the other robot stands after which a retreat ends.
    pub at_place: u32,
    /// Steps after a retreat that failed, before the robot is asked again.
    pub respite: u32,
    /// Distance that robots keep from one another, beyond their radii, in metres.
    pub margin: f32,
    /// Share of its top speed at which a robot retreats.
    pub speed: f32,
    /// A robot goes on as soon as its own route ahead is clear of the other robot's for this distance, in
    /// metres; `None` if the other robot has to pass the whole line of the retreat.
    pub goes_on_within: Option<f32>,
    /// Whether an obstacle that a robot is too close to, near a corner, is left out of the search for a
    /// place. The paper's rule does so: its published results were made that way. A place may then be in a
    /// wall.
    pub leaves_out_corners: bool,
    /// Width and height of the arena, in metres.
    pub arena: Vector,
}

impl RightOfWayModel {
    /// Compiles the rules of a scenario.
    pub fn compile(scenario: &Scenario) -> Self {
        let control_steps = scenario.control_steps() as u32;
        let control_s = f64::from(control_steps) * scenario.dt_s;
        let steps = |seconds: f64| (seconds / control_s).round() as u32;
        let values = scenario.conflicts.right_of_way();
        let ask_again = steps(ASK_AGAIN_S).max(1);
        let retreats = RetreatModel {
            underway: steps(RETREAT_PATIENCE_S),
            at_place: steps(ROOM_PATIENCE_S),
            respite: steps(RESPITE_S),
            margin: values.margin_m as f32,
            speed: 1.0,
            goes_on_within: Some(GOES_ON_WITHIN_M),
            leaves_out_corners: false,
            arena: vector(scenario.arena_m),
        };
        Self {
            priority: scenario.conflicts.priority,
            rule: match scenario.conflicts.resolver {
                ResolverRule::Reciprocal => RuleKind::Reciprocal,
                ResolverRule::Rotation(_) | ResolverRule::Swap(_) => RuleKind::Sets,
                ResolverRule::None => RuleKind::None,
            },
            sets: SetsModel {
                retreats: RetreatModel {
                    speed: RETREAT_SPEED,
                    goes_on_within: None,
                    leaves_out_corners: true,
                    ..retreats.clone()
                },
                ask_again,
                horizon: values.horizon_s as f32,
                patience: Patience {
                    deadlock: values.deadlock_steps.div_ceil(control_steps),
                    livelock: steps(LIVELOCK_S),
                    back_off: steps(BACK_OFF_S),
                },
                swaps: matches!(scenario.conflicts.resolver, ResolverRule::Swap(_)),
            },
            reciprocal: ReciprocalModel {
                retreats,
                ask_again,
                stuck: steps(STUCK_S),
                turn: steps(TURN_S),
                holds_queue: steps(HOLDS_QUEUE_S),
                let_out: steps(LET_OUT_S),
            },
        }
    }
}
