//! The columns of the tables that a sweep writes, and what a row of each is.

use scenario::NeedFile;
use tables::Kind::{Natural, Number, Text};
use tables::{About, Cell, Column, Columns, columns};
use teaming::decision::Protocol;
use teaming::question::{Member, Question};
use teaming::{Account, TaskId};
use usar_sim::event::ReturnCause;
use usar_sim::hash::Link;
use usar_sim::metrics::RoundRecord;
use usar_sim::record::{LinkRecord, RobotRecord, TrialRecord};
use usar_sim::robot::{ENERGY, HP};

use super::line::Finished;
use super::summary::Summary;
use crate::experiment::{Axis, Experiment};
use crate::metric::{Catalogue, Metric};
use crate::run::{Fault, Trial, TrialKey, series_times};

/// A row about a part of a trial.
pub(super) struct Of<'a, T> {
    key: &'a TrialKey,
    it: T,
}

/// A row of `trials.csv`.
pub(super) struct TrialRow<'a> {
    key: &'a TrialKey,
    result: Result<Summary, Fault>,
    /// Empty for a trial with numbers.
    replay: Option<String>,
}

/// A row of `rounds.csv`.
pub(super) type RoundRow<'a> = Of<'a, (&'a TrialRecord, &'a RoundRecord)>;

/// A row of `robots.csv`.
pub(super) type RobotRow<'a> = Of<'a, &'a RobotRecord>;

/// A robot that was grouped, with its needs as they really were.
pub(super) struct Grouped<'a> {
    question: &'a Question,
    task: TaskId,
    member: &'a Member,
}

/// A row of `groups.csv`.
pub(super) type GroupRow<'a> = Of<'a, Grouped<'a>>;

/// Rescuees delivered up to a time, from each task.
pub(super) struct Delivered {
    time_s: f64,
    of_tasks: Vec<usize>,
}

/// A row of `series.csv`.
pub(super) type MomentRow<'a> = Of<'a, Delivered>;

/// A row of `links.csv`.
pub(super) type RadioRow<'a> = Of<'a, &'a LinkRecord>;

/// A row of `hashes.csv`.
pub(super) type LinkRow<'a> = Of<'a, &'a Link>;

const POLICY: &str = "Label of the policy in the sweep.";
const TRIAL: &str = "Number of the trial, from 1. Trials of the same number have the same seed, whatever the \
    policy.";
const SEED: &str = "Seed of the trial: it decides everything that is drawn.";

/// The columns before all others in a table of a sweep with axes: the case, and the value of each axis.
pub(super) fn before(axes: &[Axis]) -> Vec<About> {
    let meaning = "Number of the case, from 1: a combination of the values of the axes.";
    let case = (!axes.is_empty()).then(|| About::new("case", Natural, "", meaning));
    let of_field = |axis: &Axis| {
        let are_numbers = axis.values.iter().all(|value| value.parse::<f64>().is_ok());
        let is_field = axis.variants.is_empty();
        let meaning = if is_field { "Value of this field of the scenario." } else { "Name of the variant." };
        About::new(&axis.path, if are_numbers { Number } else { Text }, "", meaning)
    };
    case.into_iter().chain(axes.iter().map(of_field)).collect()
}

/// The columns of `trials.csv`: the trial, every metric, and the other results. `method` and `policy` have
/// the same content. `method` allows the authors' files to be stacked with ours, and `policy` is this
/// project's term.
pub(super) fn trials<'a>(metrics: &Catalogue) -> Columns<TrialRow<'a>> {
    let method = "The same as policy, under the name that the paper's authors use.";
    let status = "How the trial ended: completed, nobody_can_carry, finished, stalled, failed, panicked \
        or timed_out.";
    let hash = "Hash of the whole course of the trial: equal hashes, equal trials, bit for bit.";
    let mut columns = columns! { TrialRow:
        "method", Text, "", method, |row| row.key.label.clone();
        "trial", Natural, "", TRIAL, |row| row.key.trial;
        "policy", Text, "", POLICY, |row| row.key.label.clone();
        "seed", Natural, "", SEED, |row| row.key.seed;
        "status", Text, "", status, |row| match &row.result {
            Ok(summary) => summary.status.clone(),
            Err(fault) => fault.kind.name().to_owned(),
        };
    };
    let of_metric = |(place, metric): (usize, &Metric)| {
        Column::new(about(metric, ""), move |row: &TrialRow| {
            Cell::short(row.result.as_ref().ok().and_then(|summary| summary.metrics[place]))
        })
    };
    columns.extend(metrics.iter().enumerate().map(of_metric));
    let failure = "Why the trial gave no numbers; empty where it did.";
    let replay = "The command that runs a failed trial alone; empty for others.";
    columns.extend(columns! { TrialRow:
        "state_hash", Text, "", hash,
            |row| row.result.as_ref().ok().map(|summary| summary.state_hash.clone());
        "failure", Text, "", failure, |row| row.result.as_ref().err().map(|fault| fault.reason.clone());
        "replay", Text, "", replay, |row| row.replay.clone();
    });
    columns
}

/// What a table says of the column of a metric; `until` ends its meaning.
fn about(metric: &Metric, until: &str) -> About {
    let is_whole = metric.part().is_empty() || metric.is_total();
    let of = if is_whole { String::new() } else { format!(" Of the task {:?} alone.", metric.part()) };
    About::new(metric.column(), Number, metric.unit, format!("{}{of}{until}", metric.meaning))
}

/// Names of the columns of `trials.csv`, without the axes.
pub fn trial_columns(metrics: &Catalogue) -> Vec<String> {
    trials(metrics).into_iter().map(|column| column.about.name).collect()
}

/// Number of columns of `trials.csv` before the metrics, without the axes.
pub(super) const FIRST_METRIC: usize = 5;

impl<'a> TrialRow<'a> {
    pub(super) fn of(finished: &'a Finished, experiment: &Experiment) -> Self {
        let (key, result) = (&finished.key, finished.summary(experiment));
        let replay = result.is_err().then(|| experiment.replay_command(key));
        Self { key, result, replay }
    }
}

/// Rows about parts of a trial.
pub(super) fn of<T>(key: &TrialKey, parts: impl IntoIterator<Item = T>) -> impl Iterator<Item = Of<'_, T>> {
    parts.into_iter().map(move |it| Of { key, it })
}

/// Columns behind those with the trial of a row.
fn with_trial<'a, T: 'a>(own: impl IntoIterator<Item = Column<Of<'a, T>>>) -> Columns<Of<'a, T>> {
    let mut columns = columns! { Of<T>:
        "policy", Text, "", POLICY, |row| row.key.label.clone();
        "trial", Natural, "", TRIAL, |row| row.key.trial;
        "seed", Natural, "", SEED, |row| row.key.seed;
    };
    columns.extend(own);
    columns
}

const ROUND: &str = "Number of the round, from 1.";
const TASK: &str = "Name of the task.";
const ROBOT: &str = "Number of the robot, from 0, in the order of the scenario's team.";
const ROLE: &str = "Role of the robot.";

/// The columns of `rounds.csv`.
pub(super) fn rounds<'a>() -> Columns<RoundRow<'a>> {
    let end = "Simulated time when the group was home again; empty where the trial ended before.";
    let members =
        "Numbers of the robots in the group, with blanks between them; groups.csv has them one a row.";
    let secured = "Rescuees that the group took on board in the round.";
    let rescued = "Rescuees of the task that were delivered in the round.";
    let turned_back = "Members that left for a rest place in the round.";
    let exchanges = "Rounds of messages until the robots had agreed on all groups of the round; empty where \
        they would not talk.";
    let messages = "Messages of this agreement, for all groups together.";
    let bytes = "Bytes of these messages, without headers.";
    with_trial(columns! { RoundRow:
        "round", Natural, "", ROUND, |row| row.it.1.round;
        "task", Text, "", TASK, |row| {
            let (record, round) = row.it;
            record.tasks[round.task.index()].task.clone()
        };
        "start_s", Number, "s", "Simulated time when the round began.", |row| row.it.1.start_s;
        "end_s", Number, "s", end, |row| row.it.1.end_s;
        "members", Text, "", members,
            |row| row.it.1.members.iter().map(|member| member.id.to_string()).collect::<Vec<_>>().join(" ");
        "secured", Natural, "rescuees", secured, |row| row.it.1.secured;
        "rescued", Natural, "rescuees", rescued, |row| row.it.1.rescued;
        "energy", Number, "points", "Energy that the group spent in the round.", |row| row.it.1.energy;
        "hp", Number, "points", "HP that the group lost in the round.", |row| row.it.1.hp;
        "turned_back", Natural, "robots", turned_back, |row| row.it.1.turned_back;
        "return_cause", Text, "", "Why the group went home; empty where it did not.",
            |row| row.it.1.return_cause.map(ReturnCause::name);
        "exchanges", Natural, "", exchanges, |row| protocol(row).map(|sent| sent.rounds);
        "messages", Natural, "", messages, |row| protocol(row).map(|sent| sent.messages);
        "bytes", Natural, "B", bytes, |row| protocol(row).map(|sent| sent.bytes);
    })
}

/// What the robots would have sent to group the team for the round, under a policy that says so.
fn protocol(row: &RoundRow) -> Option<Protocol> {
    let (record, round) = row.it;
    let decided = record.decisions.iter().find(|decided| decided.question.round == round.round)?;
    match decided.decision.account {
        Account::Protocol(protocol) => Some(protocol),
        _ => None,
    }
}

/// The columns of `robots.csv`.
pub(super) fn robots<'a>() -> Columns<RobotRow<'a>> {
    let waiting = "Time in which the robot stood because of others.";
    let stall = "The longest time in which the robot had a goal and came no nearer to it.";
    let waits_for = "The robot that it waited for then; empty for none.";
    with_trial(columns! { RobotRow:
        "robot", Natural, "", ROBOT, |row| row.it.robot;
        "role", Text, "", ROLE, |row| row.it.role.clone();
        "initial_energy", Number, "%", "Battery level when the trial began.", |row| row.it.initial_energy;
        "initial_hp", Number, "%", "Health level when the trial began.", |row| row.it.initial_hp;
        "final_energy", Number, "%", "Battery level when the trial was over.", |row| row.it.final_energy;
        "final_hp", Number, "%", "Health level when the trial was over.", |row| row.it.final_hp;
        "energy_spent", Number, "points", "Energy that the robot spent.", |row| row.it.energy_spent;
        "hp_lost", Number, "points", "HP that the robot lost.", |row| row.it.hp_lost;
        "distance_m", Number, "m", "Way that the robot travelled.", |row| row.it.distance_m;
        "waiting_s", Number, "s", waiting, |row| row.it.waiting_s;
        "longest_stall_s", Number, "s", stall, |row| row.it.longest_stall_s;
        "stall_cause", Text, "", "What took the most of that time.", |row| row.it.stall.cause.name();
        "stall_waits_for", Natural, "", waits_for, |row| row.it.stall.waits_for.map(|robot| robot.0);
        "stranded", Truth, "", "Whether the robot ended with no energy.", |row| row.it.stranded;
        "disabled", Truth, "", "Whether the robot ended with no HP.", |row| row.it.disabled;
    })
}

/// The columns of `groups.csv`.
pub(super) fn groups<'a>(needs: &[NeedFile]) -> Columns<GroupRow<'a>> {
    let energy = "Battery level when the robot was grouped.";
    let hp = "Health level when the robot was grouped.";
    let mut columns = with_trial(columns! { GroupRow:
        "round", Natural, "", ROUND, |row| row.it.question.round;
        "robot", Natural, "", ROBOT, |row| row.it.member.id;
        "role", Text, "", ROLE, |row| row.it.question.roles[row.it.member.role.index()].clone();
        "task", Text, "", TASK, |row| row.it.question.tasks[row.it.task.index()].name.clone();
        "energy", Number, "%", energy, |row| Cell::short(row.it.member.level(ENERGY));
        "hp", Number, "%", hp, |row| Cell::short(row.it.member.level(HP));
    });
    columns.extend(needs.iter().enumerate().map(|(place, need)| {
        let meaning = format!("The need {:?} as it really was, in the units of the scenario.", need.name);
        let about = About::new(format!("need_{}", need.name), Number, "", meaning);
        Column::new(about, move |row: &GroupRow| {
            Cell::short(row.it.member.needs.values().get(place).copied())
        })
    }));
    columns
}

/// The robots of a trial each time that they were grouped.
pub(super) fn grouped(record: &TrialRecord) -> impl Iterator<Item = Grouped<'_>> {
    record.decisions.iter().flat_map(move |decided| {
        let question = &decided.question;
        question.task_ids().flat_map(move |task| {
            let group = decided.decision.assignment.of(task);
            let members = decided.team().iter().filter(move |member| group.contains(&member.id));
            members.map(move |member| Grouped { question, task, member })
        })
    })
}

/// The columns of `series.csv`: the deliveries up to a time, from all tasks and from each task.
pub(super) fn series<'a>(metrics: &Catalogue) -> Columns<MomentRow<'a>> {
    let rescuees = metrics.declared("rescuees").into_iter().enumerate().map(|(place, metric)| {
        Column::new(about(&metrics[metric], " Up to this time."), move |row: &MomentRow| {
            let tasks = &row.it.of_tasks;
            if place == 0 { tasks.iter().sum::<usize>() as u64 } else { tasks[place - 1] as u64 }
        })
    });
    let time = columns! { MomentRow:
        "time_s", Number, "s", "Simulated time.", |row| Cell::short(row.it.time_s);
    };
    with_trial(time.into_iter().chain(rescuees))
}

/// The deliveries of a trial over time.
pub(super) fn delivered(trial: &Trial, duration_s: f64) -> impl Iterator<Item = Delivered> + '_ {
    series_times(duration_s).map(|time_s| Delivered { time_s, of_tasks: trial.delivered(time_s) })
}

/// The columns of `hashes.csv`: a link of a trial's hash chain.
pub(super) fn links<'a>() -> Columns<LinkRow<'a>> {
    let digest = "Hash of everything up to this step, 32 hexadecimal digits.";
    let parts = "Hashes of the parts of the state, four hexadecimal digits each; docs/determinism.md lists \
        the parts.";
    let mut columns = with_trial(columns! { LinkRow:
        "step", Natural, "steps", "Number of the simulation step.", |row| row.it.step;
        "digest", Text, "", digest, |row| format!("{:032x}", row.it.digest);
        "parts", Text, "", parts, |row| row.it.parts.map(|part| format!("{part:04x}")).concat();
    });
    columns.retain(|column| column.about.name != "seed");
    columns
}

/// The columns of `links.csv`: a link over the medium.
pub(super) fn radio<'a>() -> Columns<RadioRow<'a>> {
    let to = "The group-mate that was to hear it; empty for the base.";
    let delay = "Mean delay of the messages that were heard; empty if there were none.";
    with_trial(columns! { RadioRow:
        "from", Natural, "", "The robot that sent.", |row| row.it.from;
        "to", Natural, "", to, |row| row.it.to;
        "sent", Natural, "", "Messages that went over the medium.", |row| row.it.sent;
        "heard", Natural, "", "Messages that were not lost.", |row| row.it.heard;
        "delay_s", Number, "s", delay, |row| row.it.delay_s;
    })
}
