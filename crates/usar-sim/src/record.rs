//! The record of a trial: its results once it is over.

use serde::{Deserialize, Serialize};
use teaming::{Decision, Evidence, Extent, Member, Question, RoundOutcome};

use crate::conflict::Delay;
use crate::hash::HashChain;
use crate::invariant::Overlaps;
use crate::metrics::{Counts, CutOff, Finds, RoundRecord, TaskTotals};
pub use crate::mission::Join;
use crate::model::{Liar, Model, TelemetryModel};
use crate::robot::Condition;
use crate::tally::Tally;
use crate::telemetry::{Ends, Heard, Link, Telemetry, known, named};
use crate::world::Robot;

/// How a trial ended.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// The time was over.
    Completed,
    /// No robot that can carry was left before the time was over.
    NobodyCanCarry,
    /// Nobody was left to bring home, or all errands were done or given up, before the time was over.
    Finished,
    /// No round could begin and no robot got anywhere, before the time was over.
    Stalled,
    /// Something went wrong. The numbers go up to that moment and must not be used.
    Failed(String),
}

impl Status {
    /// The status as one word, for tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Completed => "completed",
            Self::NobodyCanCarry => "nobody_can_carry",
            Self::Finished => "finished",
            Self::Stalled => "stalled",
            Self::Failed(_) => "failed",
        }
    }
}

/// The results of one robot in a trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RobotRecord {
    /// Identity.
    pub robot: u32,
    /// Name of its role.
    pub role: String,
    /// Battery level at the start, in percent.
    pub initial_energy: f64,
    /// Health level at the start, in percent.
    pub initial_hp: f64,
    /// Battery level at the end, in percent.
    pub final_energy: f64,
    /// Health level at the end, in percent.
    pub final_hp: f64,
    /// Energy spent, in the unit of the scenario's costs.
    pub energy_spent: f64,
    /// HP lost, in the unit of the scenario's costs.
    pub hp_lost: f64,
    /// Distance travelled, in metres.
    pub distance_m: f64,
    /// Time in which it had a goal but yielded or was blocked, in seconds.
    pub waiting_s: f64,
    /// The longest time in which it had a goal and came no nearer to it, in seconds.
    pub longest_stall_s: f64,
    /// The most frequent cause of delay in that time, and the robot for which it waited last by this cause.
    pub stall: Delay,
    /// Whether it ended stranded (energy 0).
    pub stranded: bool,
    /// Whether it ended disabled (HP 0).
    pub disabled: bool,
}

impl RobotRecord {
    /// The record of a robot with these totals.
    pub(crate) fn of(robot: &Robot, tally: &Tally, model: &Model) -> Self {
        let seconds = |steps: u64| steps as f64 * model.dt_s();
        Self {
            robot: robot.id.0,
            role: model.roles[robot.role.index()].clone(),
            initial_energy: tally.initial[0],
            initial_hp: tally.initial[1],
            final_energy: robot.energy,
            final_hp: robot.hp,
            energy_spent: tally.spent[0],
            hp_lost: tally.spent[1],
            distance_m: tally.distance_m,
            waiting_s: seconds(tally.waiting_steps),
            longest_stall_s: seconds(tally.longest_stall.0 * model.control_steps),
            stall: tally.longest_stall.1,
            stranded: robot.condition == Condition::Stranded,
            disabled: robot.condition == Condition::Disabled,
        }
    }
}

/// The results of one task in a trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TaskRecord {
    /// Name of the task.
    pub task: String,
    /// Results and costs of the task.
    #[serde(flatten)]
    pub totals: TaskTotals,
}

/// One grouping of the team.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DecisionRecord {
    /// The question without its history. The history is in [`TrialRecord::ledger`], and
    /// [`TrialRecord::question`] restores it.
    pub question: Question,
    /// The answer.
    pub decision: Decision,
    /// The members as they really were; absent where the question had them as they were. See
    /// [`DecisionRecord::team`].
    pub truth: Option<Vec<Member>>,
    /// How each robot that took part decided, where robots did: the answer is then what came of it.
    #[serde(default)]
    pub joins: Vec<Join>,
}

impl DecisionRecord {
    /// The members as they really were, by id.
    pub fn team(&self) -> &[Member] {
        self.truth.as_ref().unwrap_or(&self.question.members)
    }
}

/// What the base heard in a trial, where it did not know how every robot is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HeardRecord {
    /// The rounds, with the costs as they were said. Questions have them as their history.
    pub history: Vec<RoundOutcome>,
    /// All reports, ratings and rounds, in the order in which they were heard, and what the base knows of the
    /// robots without them. The truth stands beside each decision.
    pub evidence: Evidence,
    /// How much of the evidence each question had.
    pub extents: Vec<Extent>,
    /// The links on which anything was sent.
    pub links: Vec<LinkRecord>,
    /// The robots that tell a lie, sooner or later.
    pub liars: Vec<Liar>,
}

/// A question with its history and its evidence, of which it was recorded without.
pub(crate) fn whole_question(
    made: &DecisionRecord,
    ledger: &[RoundOutcome],
    heard: Option<&HeardRecord>,
) -> Question {
    let asked = &made.question;
    let rounds = heard.map_or(ledger, |heard| &heard.history);
    let history = rounds.iter().filter(|round| round.round < asked.round).cloned().collect();
    let known = heard.and_then(|heard| {
        let extent = heard.extents.iter().find(|extent| extent.round == asked.round)?;
        Some((heard, extent))
    });
    let Some((heard, extent)) = known else { return Question { history, ..asked.clone() } };
    let history = named(&history, &extent.known_since);
    Question { history, evidence: Some(heard.evidence.as_of(extent)), ..asked.clone() }
}

/// A link in a trial: from a robot to the base or to a group-mate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LinkRecord {
    /// The sender.
    pub from: u32,
    /// Who was to hear it; absent for the base.
    pub to: Option<u32>,
    /// Messages over the medium.
    pub sent: u64,
    /// Those that were heard; others were lost, or are under way.
    pub heard: u64,
    /// Their mean delay, in seconds; absent if there were none.
    pub delay_s: Option<f64>,
}

impl HeardRecord {
    pub(crate) fn of(telemetry: &Telemetry, model: &Model) -> Self {
        let Heard { history, log, extents, .. } = telemetry.heard();
        let link = |(ends, link): (&Ends, &Link)| LinkRecord {
            from: ends.from.0,
            to: ends.to.map(|to| to.0),
            sent: link.sent,
            heard: link.heard,
            delay_s: link.mean_delay_s(),
        };
        Self {
            history: history.clone(),
            evidence: known(model, log.evidence()),
            extents: extents.clone(),
            links: telemetry.links().map(link).collect(),
            liars: model.telemetry.as_ref().map(TelemetryModel::liars).unwrap_or_default(),
        }
    }
}

/// One trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrialRecord {
    /// Seed of the trial.
    pub seed: u64,
    /// How it ended.
    pub status: Status,
    /// Simulated time, in seconds.
    pub time_s: f64,
    /// Results and costs of each task, in the order of the table of tasks.
    pub tasks: Vec<TaskRecord>,
    /// People of the scenario: those who were there at the start, and those who were to appear.
    #[serde(default)]
    pub people: u32,
    /// When each rescuee was delivered, in seconds, ascending.
    #[serde(default)]
    pub delivered_s: Vec<f64>,
    /// Energy spent outside any group, in the unit of the scenario's costs.
    pub ungrouped_energy: f64,
    /// HP lost outside any group, in the unit of the scenario's costs.
    pub ungrouped_hp: f64,
    /// Rounds that ended before the trial did.
    pub completed_rounds: u32,
    /// Rounds, each with one record per task.
    pub rounds: Vec<RoundRecord>,
    /// The rounds that ended before the trial did as the base knew them: what it witnessed, and the costs
    /// that robots reported. Questions have them as their history.
    #[serde(default)]
    pub ledger: Vec<RoundOutcome>,
    /// What the base heard, where it did not know how every robot is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub heard: Option<HeardRecord>,
    /// How the team was grouped, round by round.
    pub decisions: Vec<DecisionRecord>,
    /// Robots, by id.
    pub robots: Vec<RobotRecord>,
    /// How often things happened.
    pub counts: Counts,
    /// How often robots came for rescuees in vain.
    #[serde(default)]
    pub finds: Finds,
    /// Robots that stood at the end: they could act, had something to do, and did not get there.
    #[serde(default)]
    pub stalled: u32,
    /// Robots that the watchdog cut off. Absent if there were none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cut_off: Vec<CutOff>,
    /// How deep bodies overlapped, in a checked trial.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub overlaps: Option<Overlaps>,
    /// Last digest of the hash chain over the whole state, as 32 hexadecimal digits: equal hashes, equal
    /// trials.
    pub state_hash: String,
    /// The hash chain.
    #[serde(skip)]
    pub chain: HashChain,
}

/// Version of the layout of a [`NamedRecord`].
const NAMED_VERSION: u32 = 1;

/// A record with the names of its scenario and policy, as programs print it.
#[derive(Debug, Clone, Serialize)]
pub struct NamedRecord<'a> {
    schema_version: u32,
    scenario: &'a str,
    policy: &'a str,
    rescuees: u32,
    #[serde(flatten)]
    record: &'a TrialRecord,
}

impl TrialRecord {
    /// The record with the names of its scenario and policy.
    pub fn named<'a>(&'a self, scenario: &'a str, policy: &'a str) -> NamedRecord<'a> {
        let rescuees = self.rescued();
        NamedRecord { schema_version: NAMED_VERSION, scenario, policy, rescuees, record: self }
    }

    /// The question as it was asked, with its history.
    pub fn question(&self, asked: &DecisionRecord) -> Question {
        whole_question(asked, &self.ledger, self.heard.as_ref())
    }

    /// Results and costs of the task of this name.
    pub fn task(&self, name: &str) -> Option<&TaskTotals> {
        self.tasks.iter().find(|task| task.task == name).map(|task| &task.totals)
    }

    /// Rescuees taken on board, delivered or not, all tasks.
    pub fn secured(&self) -> u32 {
        self.tasks.iter().map(|task| task.totals.secured).sum()
    }

    /// Rescuees delivered, all tasks.
    pub fn rescued(&self) -> u32 {
        self.tasks.iter().map(|task| task.totals.rescued).sum()
    }

    /// When so large a share of all people had been delivered, in seconds; `None` if they never were.
    pub fn time_to_share_s(&self, share: f64) -> Option<f64> {
        let least = (share * f64::from(self.people)).ceil().max(1.0) as usize;
        self.delivered_s.get(least - 1).copied()
    }

    /// Energy spent by the whole team, in the unit of the scenario's costs.
    pub fn energy(&self) -> f64 {
        self.tasks.iter().fold(0.0, |sum, task| sum + task.totals.energy) + self.ungrouped_energy
    }

    /// HP lost by the whole team, in the unit of the scenario's costs.
    pub fn hp(&self) -> f64 {
        self.tasks.iter().fold(0.0, |sum, task| sum + task.totals.hp) + self.ungrouped_hp
    }

    /// Distance travelled by all robots together, in metres.
    pub fn distance_m(&self) -> f64 {
        self.robots.iter().map(|robot| robot.distance_m).sum()
    }

    /// Time that all robots together yielded or were blocked, in seconds.
    pub fn waiting_s(&self) -> f64 {
        self.robots.iter().map(|robot| robot.waiting_s).sum()
    }

    /// The longest time in which any robot had a goal and came no nearer to it, in seconds.
    pub fn longest_stall_s(&self) -> f64 {
        self.robots.iter().map(|robot| robot.longest_stall_s).fold(0.0, f64::max)
    }

    /// Robots that ended stranded.
    pub fn stranded(&self) -> usize {
        self.robots.iter().filter(|robot| robot.stranded).count()
    }

    /// Robots that ended disabled.
    pub fn disabled(&self) -> usize {
        self.robots.iter().filter(|robot| robot.disabled).count()
    }
}
