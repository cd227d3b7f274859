//! Reports of robots about themselves, and the medium that carries them, as they are written.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::{Checker, meant, shown};
use super::file::{Point, ScenarioFile};
use super::rules::{BeliefSharing, ClaimRule};

/// How robots report their levels, and who goes by the reports. Without this section, without a medium and
/// without deceit, everybody knows how every robot is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ReportRules {
    /// Time between two reports of a robot, in seconds. Robots at home report when a round is to begin, too.
    pub every_s: f64,
    /// The gauges of a role, by its name; those of other roles are exact.
    pub sensors: BTreeMap<String, Gauges>,
    /// How robots look at their group-mates.
    pub witness: Witness,
    /// By what the base decides who must rest before a round.
    pub fitness: LevelSource,
    /// By what the right of way knows the levels of robots, where its priority uses them.
    pub priority: LevelSource,
    /// Whether needs count at most as much as those of a fresh robot of the role.
    pub clip: bool,
}

impl Default for ReportRules {
    fn default() -> Self {
        Self {
            every_s: 10.0,
            sensors: BTreeMap::new(),
            witness: Witness::default(),
            fitness: LevelSource::Truth,
            priority: LevelSource::Truth,
            clip: true,
        }
    }
}

/// What is taken for the level of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum LevelSource {
    /// The true level. The default.
    #[default]
    Truth,
    /// What was heard of it last.
    Reports,
}

/// The two gauges of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Gauges {
    /// The gauge of the battery.
    pub energy: Gauge,
    /// The gauge of health.
    pub hp: Gauge,
}

/// A gauge of a level. What it shows lies between 0 and 100 %.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Gauge {
    /// Standard deviation of a reading, in percent points.
    pub sd: f64,
    /// Error of all readings, in percent points.
    pub bias: f64,
    /// Error that grows with time, in percent points an hour.
    pub drift_per_h: f64,
    /// Probability that a reading fails; the report then has the last one.
    pub dropout: f64,
    /// Readings are multiples of this, in percent points; 0 for any value.
    pub quantum: f64,
}

/// How robots look at their group-mates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Witness {
    /// Standard deviation of the highest speed seen in a round, as a share of it.
    pub sd: f64,
    /// Fewest looks in a round for a rating. Robots look in every control step.
    pub least_looks: u32,
}

impl Default for Witness {
    fn default() -> Self {
        Self { sd: 0.02, least_looks: 25 }
    }
}

/// The medium between robots and the base, and between group-mates where `mission.belief_sharing` is
/// `ByRadio`: which messages are heard, and when. Without this section all are heard at once.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MediumRules {
    /// Messages are heard up to this distance, in metres; without it, at any.
    pub range_m: Option<f64>,
    /// Loss of messages in bursts.
    pub loss: Loss,
    /// Time that every message takes, in seconds.
    pub delay_s: f64,
    /// Capacity of the channel that all share, in kilobits a second; without it, no message waits for
    /// another.
    pub kbps: Option<f64>,
    /// Length of a message, in bytes.
    pub bytes: u32,
    /// Time that a message occupies the channel in addition, in milliseconds.
    pub overhead_ms: f64,
    /// Loss by distance and walls.
    pub path: Option<PathLoss>,
    /// Places and times at which nothing can be sent or heard.
    pub blackouts: Vec<Blackout>,
    /// How robots at home are heard.
    pub at_home: AtHome,
    /// Whether a lost message is sent again.
    #[serde(skip_serializing_if = "Resend::is_never")]
    pub resend: Resend,
    /// What each message costs its sender, in the unit of the scenario's costs of energy; nothing at a rest
    /// place. One that is sent again costs it again.
    #[serde(skip_serializing_if = "is_nothing")]
    pub energy_per_message: f64,
}

/// What a sender does about a lost message. It knows at once that the message is lost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Resend {
    /// How often it sends the message again, at most. 0 is best effort.
    pub times: u32,
    /// Time between two sendings, in seconds.
    pub after_s: f64,
}

impl Default for Resend {
    fn default() -> Self {
        Self { times: 0, after_s: 0.5 }
    }
}

impl Resend {
    fn is_never(&self) -> bool {
        self.times == 0
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a field by reference")]
fn is_nothing(cost: &f64) -> bool {
    *cost == 0.0
}

impl Default for MediumRules {
    fn default() -> Self {
        Self {
            range_m: None,
            loss: Loss::None,
            delay_s: 0.0,
            kbps: None,
            bytes: 64,
            overhead_ms: 0.0,
            path: None,
            blackouts: Vec::new(),
            at_home: AtHome::Perfect,
            resend: Resend::default(),
            energy_per_message: 0.0,
        }
    }
}

/// Loss of messages.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub enum Loss {
    /// None. The default.
    #[default]
    None,
    /// A chain of two states for each link, which takes one step a message (Gilbert 1960; Elliott 1963). It
    /// begins in the good state.
    GilbertElliott {
        /// Probability of a step from good to bad.
        p: f64,
        /// Probability of a step from bad to good.
        r: f64,
        /// Probability that a message is lost in the good state.
        good: f64,
        /// Probability that a message is lost in the bad state.
        bad: f64,
    },
}

/// Loss by distance and walls: a log-distance path with normal shadowing. A message is heard if the loss of
/// its path is at most the budget.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathLoss {
    /// Greatest loss at which a message is heard, in dB.
    pub budget_db: f64,
    /// Loss at 1 m, in dB.
    pub pl0_db: f64,
    /// Path loss exponent: 2 in free space.
    pub n: f64,
    /// Loss of each wall and fixed piece of debris on the way, in dB.
    pub wall_db: f64,
    /// Standard deviation of the shadowing, in dB.
    pub sigma_db: f64,
}

/// A disc in which nothing can be sent or heard for a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Blackout {
    /// Its centre.
    pub at: Point,
    /// Its radius, in metres.
    pub radius_m: f64,
    /// When it begins, in seconds.
    pub from_s: f64,
    /// When it ends, in seconds.
    pub to_s: f64,
}

/// How robots at home are heard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum AtHome {
    /// At once and always. The default.
    #[default]
    Perfect,
    /// By the medium, as everywhere.
    Medium,
}

/// Checks reports and medium.
pub(super) fn telemetry(check: &mut Checker, file: &ScenarioFile) {
    if let Some(rules) = &file.reports {
        reports(check, file, rules);
    }
    if let Some(rules) = &file.medium {
        medium(check, rules);
    } else if file.mission.belief_sharing == BeliefSharing::ByRadio {
        check.fail(
            "mission.belief_sharing",
            "must not be ByRadio without a medium, such as medium: ()",
            "ByRadio",
        );
    }
    let shared = file.mission.belief_sharing;
    if file.mission.claims != ClaimRule::Known && shared != BeliefSharing::ByRadio {
        let rule = "must be ByRadio, with a medium such as medium: (), where claims go by radio";
        check.fail("mission.belief_sharing", rule, format!("{shared:?}"));
    }
}

fn reports(check: &mut Checker, file: &ScenarioFile, rules: &ReportRules) {
    for role in rules.sensors.keys() {
        if !file.roles.iter().any(|known| known.name == *role) {
            let hint = meant(role, file.roles.iter().map(|role| role.name.as_str()));
            check.fail_with("reports.sensors", "must name roles of the scenario", hint, shown(role));
        }
    }
}

fn medium(check: &mut Checker, rules: &MediumRules) {
    if let Loss::GilbertElliott { p, r, .. } = rules.loss
        && p + r == 0.0
    {
        check.fail("medium.loss", "must have p + r above 0, or it stays in one state", "0");
    }
    for (i, blackout) in rules.blackouts.iter().enumerate() {
        let field = format!("medium.blackouts[{i}]");
        check.inside(format!("{field}.at"), blackout.at, 0.0);
        if blackout.from_s > blackout.to_s {
            check.fail(format!("{field}.to_s"), "must not be before from_s", blackout.to_s);
        }
    }
}
