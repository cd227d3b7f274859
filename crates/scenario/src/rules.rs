//! The rules of a scenario as they are written: costs, the mission, planning and right of way.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use teaming::{GroupSizes, Undecided};

use super::checker::Checker;
use super::file::ScenarioFile;
use crate::limits;
use crate::{Rates, WorkRates};

/// What moving, radiation and work cost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, from = "super::partial::Costs")]
#[schemars(!from, default)]
pub struct Costs {
    /// What the numbers below, and the costs in the results, count.
    pub unit: CostUnit,
    /// Battery.
    pub energy: Rates,
    /// Health, inside radiation zones.
    pub hp: Rates,
    /// Work, in addition.
    pub work: WorkRates,
}

/// What costs are counted in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum CostUnit {
    /// Percent of the robot's own maximum. The default.
    #[default]
    Percent,
    /// Points of the scale in which roles give their `energy` and `hp`: a robot with 150 of them lasts 1.5
    /// times as long as one with 100.
    Points,
}

impl CostUnit {
    /// Converts a cost to percent of the maximum of the robot that bears it.
    pub fn to_percent(self, cost: f64, maximum: f64) -> f64 {
        match self {
            Self::Percent => cost,
            Self::Points => cost * 100.0 / maximum,
        }
    }

    /// Converts a share of a robot's maximum, in percent, to a cost.
    pub fn of_percent(self, percent: f64, maximum: f64) -> f64 {
        match self {
            Self::Percent => percent,
            Self::Points => percent * maximum / 100.0,
        }
    }
}

/// When a robot below the threshold turns back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum TurnBack {
    /// At once, wherever it is. The default; the paper's words.
    #[default]
    AtOnce,
    /// Once it is home: the round is finished first.
    WhenHome,
    /// Before a round at whose end it would be below, judged by its costliest round so far.
    BeforeRound,
    /// Once it is home, and for energy nothing calls it back earlier: `rest_reserve` does not count.
    AfterRound,
}

/// What becomes of a robot whose battery is empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum EmptyBattery {
    /// It stops where it is, for good. The default.
    #[default]
    Stops,
    /// It goes on as before, and its level falls below 0. Needs of energy are never below 0.
    GoesOn,
}

/// What a rest restores.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum RestFills {
    /// Energy and HP, in one `rest_s`. The default.
    #[default]
    Both,
    /// The levels below their thresholds; the lower one if none is.
    Low,
    /// Energy, then HP: `rest_s` for each of them that is not full.
    InTurn,
}

/// When a robot that is at home with a low level rests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum RestAtHome {
    /// During the next round, which goes on without it. The default.
    #[default]
    DuringRound,
    /// Before the next round, which waits for it.
    BeforeRound,
}

/// Where the rescuees are delivered that a robot has on board when it goes to rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum LoadAtRest {
    /// At the rest place. The default.
    #[default]
    Delivered,
    /// At home, after the rest.
    Kept,
}

/// Who must be home before the next round begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum RoundEnd {
    /// Every robot that can still move. The default.
    #[default]
    EverybodyHome,
    /// All but those that rest, or are on their way to rest or back from it.
    WithoutResting,
}

/// When a trial with a mission ends, if not because no robot can carry or get anywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum MissionEnd {
    /// When a round ends with nobody left to bring home and no event to come: no other round begins, robots
    /// that are still out come home, and the trial is over. At `duration_s` at the latest. The default.
    #[default]
    WhenDone,
    /// At `duration_s`.
    AtDuration,
}

/// Who goes to a task of which the team knows that no rescuee waits there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum EmptyTasks {
    /// Nobody, as long as another task has work. The default.
    #[default]
    GetNobody,
    /// A group like that of any other task.
    GetGroups,
}

/// Who shares what a robot in the field has seen, before its group is home.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum BeliefSharing {
    /// Its whole group, at once. The default.
    #[default]
    WithGroup,
    /// Nobody: each robot acts on what it has seen itself.
    WithNobody,
    /// Its group-mates hear of it by the scenario's medium, late or never, and each robot acts on what it has
    /// seen and heard itself.
    ByRadio,
}

/// Who knows which robot claims which rescuee.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum ClaimRule {
    /// Its whole group, at once. The default.
    #[default]
    Known,
    /// Those whom its radio reaches: each robot goes by the claims that it heard of. Of two on their way to
    /// one rescuee the nearer keeps its claim, then the one with the lower number.
    ByRadio {
        /// Time after which a robot tells its claim again, in seconds. One that was not heard for three times
        /// as long counts no longer.
        #[serde(default = "crate::defaults::claim_again_s")]
        again_s: f64,
    },
}

impl ClaimRule {
    fn is_known(&self) -> bool {
        *self == Self::Known
    }
}

/// Who decides which robot goes to which task.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Decider {
    /// The base, for all robots, by what it heard of them. The default.
    #[default]
    Base,
    /// Each robot for itself, by what it knows of the others: it groups the team as the policy says, and
    /// joins the group that it would be in. What robots say of themselves, they say to all.
    Robots {
        /// Whose draws a policy makes that draws.
        #[serde(default)]
        coin: Coin,
        /// Longest time in which robots talk before they go, in seconds. How they talk stands behind `by` in
        /// the policy.
        #[serde(default = "crate::defaults::deadline_s")]
        deadline_s: f64,
        /// What becomes of a robot that has not decided by then.
        #[serde(default)]
        undecided: Undecided,
        /// A team of which nobody went decides again after this time, in seconds.
        #[serde(default = "crate::defaults::retry_s")]
        retry_s: f64,
    },
}

impl Decider {
    /// Whether the base decides.
    #[must_use]
    pub fn is_base(&self) -> bool {
        matches!(self, Self::Base)
    }
}

/// Whose draws a policy makes where robots decide.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum Coin {
    /// Each robot has draws of its own. The default.
    #[default]
    Own,
    /// All robots have the draws of the base, as if they had agreed on a number before.
    Common,
}

/// Rules of the mission.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MissionRules {
    /// Battery level below which a robot needs rest, in percent.
    pub energy_threshold: f64,
    /// Health level below which a robot needs rest, in percent.
    pub hp_threshold: f64,
    /// When a robot with little energy turns back.
    pub energy_turn_back: TurnBack,
    /// When a robot with little health turns back.
    pub hp_turn_back: TurnBack,
    /// What becomes of a robot whose battery is empty.
    pub empty_battery: EmptyBattery,
    /// A robot also turns back when its energy is less than this many times what the straight way to its rest
    /// place costs; not if `energy_turn_back` is `AfterRound`.
    pub rest_reserve: f64,
    /// Time at a rest place, in seconds.
    pub rest_s: f64,
    /// What a rest restores.
    pub rest_fills: RestFills,
    /// When a robot that is at home with a low level rests.
    pub rest_at_home: RestAtHome,
    /// Where the load of a robot that goes to rest is delivered.
    pub load_at_rest: LoadAtRest,
    /// Who decides which robot goes to which task.
    #[serde(skip_serializing_if = "Decider::is_base")]
    pub decides: Decider,
    /// Who must be home before the next round begins.
    pub round_end: RoundEnd,
    /// When the mission ends.
    pub ends: MissionEnd,
    /// How far groups must have the sizes that the question says, where no quota of a task binds.
    pub group_sizes: GroupSizes,
    /// Whether a policy may leave robots idle at home.
    pub may_idle: bool,
    /// Who goes to a task of which the team knows that no rescuee waits there.
    pub empty_tasks: EmptyTasks,
    /// Who shares what a robot in the field has seen. When a round ends, all hear everything.
    pub belief_sharing: BeliefSharing,
    /// Who knows which robot claims which rescuee.
    #[serde(skip_serializing_if = "ClaimRule::is_known")]
    pub claims: ClaimRule,
    /// Whether a robot that rests, or is on its way to rest, still guides its group.
    pub resting_guides: bool,
    /// Time to load one rescuee, in seconds.
    pub loading_s: f64,
    /// Distance from its centre within which a robot can load a rescuee, in metres.
    pub reach_m: f64,
    /// How far a task's area extends beyond its block of rescuees, in metres. Resources are shared within it.
    pub area_margin_m: f64,
    /// Share of its speed that a robot loses when its group has no guide that can act.
    pub blind_speed_loss: f64,
    /// Share of its speed that a robot loses with a full load; with less in proportion.
    pub load_speed_loss: f64,
    /// Factor on speed, sensing and observing range at health 0 %; it rises linearly to 1 at 100 %.
    pub health_floor: f64,
    /// A robot that comes no nearer to its home, its rest place or its work for this long, in seconds, gives
    /// up on the place: the team does not wait for it. A detour adds the time that it takes, and a robot
    /// slower than 1 m/s takes in proportion longer. Whenever a robot for which it waits gets on, the second
    /// half of the time begins anew.
    pub cut_off_s: f64,
}

/// Rules of route planning.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PlanningRules {
    /// Distance that routes keep from known debris and walls, beyond the robot's radius, in metres.
    pub clearance_m: f64,
    /// Price of one second inside one radiation zone, in metres of detour.
    pub exposure_price_m: f64,
}

/// Rules of right of way.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ConflictRules {
    /// Who has the right of way.
    pub priority: PriorityRule,
    /// What resolves conflicts and deadlocks.
    pub resolver: ResolverRule,
}

/// Who has the right of way in a conflict set; ties go to the lowest id.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum PriorityRule {
    /// The robot with the lowest battery level. The default.
    #[default]
    LowestEnergyFirst,
    /// Robots of the hardest task, then of the next, and at last those without a group; among them the lowest
    /// battery level.
    TaskThenEnergy,
    /// The robot with the highest battery level.
    HighestEnergyFirst,
    /// The robot with the lowest health level.
    LowestHpFirst,
}

/// What resolves conflicts and deadlocks.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
pub enum ResolverRule {
    /// Reciprocal avoidance in the open, right of way in narrow passages, and pushing where a robot is stuck.
    /// The default. It keeps margins and horizons of its own.
    #[default]
    Reciprocal,
    /// The paper's rule: the head of a conflict set goes, the others stop. The order of a deadlocked set is
    /// rotated, head to tail. Written `Rotation`, or `Rotation(margin_m: 0.2)` with the values that differ
    /// from the defaults.
    Rotation(RightOfWay),
    /// The paper's rule; the head of a deadlocked set changes places with the next in line, then with the one
    /// after: the paper's Algorithm 6, literally. Written like `Rotation`.
    Swap(RightOfWay),
    /// Nothing: robots drive as they wish and bump into each other. For comparison.
    None,
}

/// Values of the paper's rule.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RightOfWay {
    /// Distance that robots keep from one another, beyond their radii, in metres.
    pub margin_m: f64,
    /// How far ahead a conflict is predicted, in seconds.
    pub horizon_s: f64,
    /// Steps without motion after which a conflict set counts as deadlocked.
    pub deadlock_steps: u32,
}

/// Checks what the rules ask of robots and arena.
pub(super) fn rules(check: &mut Checker, file: &ScenarioFile) {
    let least_reach = if file.errands.is_empty() { file.least_reach_m() } else { 0.0 };
    check.at_least("mission.reach_m", file.mission.reach_m, least_reach, limits::REACH_M);
    check.at_least("mission.area_margin_m", file.mission.area_margin_m, least_reach, limits::AREA_MARGIN_M);
    leaves_room(check, file);
}

/// Checks that routes that keep clear of the walls of the arena leave room in it for the largest robot.
fn leaves_room(check: &mut Checker, file: &ScenarioFile) {
    let largest = file.bodies().map(|(body, _)| body.radius_m).fold(0.0, f64::max);
    let side = f64::min(file.arena_m[0], file.arena_m[1]);
    let taken = 2.0 * (largest + file.planning.clearance_m);
    if taken >= side && limits::ROBOT_RADIUS_M.range().contains(&largest) {
        let rule = format!(
            "must leave room in the arena of {side} m: with the radius of the largest robot ({largest} m), \
             less than half of it"
        );
        check.fail("planning.clearance_m", rule, file.planning.clearance_m);
    }
}

impl ScenarioFile {
    /// Least reach that lets a robot load a rescuee next to another robot: its own radius.
    fn least_reach_m(&self) -> f64 {
        let bodies = self.team.iter().filter_map(|row| self.body_of(row));
        let roles = self.roles.iter().cloned().chain(bodies);
        let carrying = roles.filter(|role| role.capacity > 0);
        carrying.map(|role| role.radius_m).fold(0.0, f64::max)
    }
}
