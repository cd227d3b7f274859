//! Rows of the tables that a sweep writes. Undefined values are empty cells.

use rne_core::TaskId;
use serde::Serialize;
use usar_sim::record::{DecisionRecord, TrialRecord};
use usar_sim::scenario::NeedFile;

use super::line::Finished;
use super::summary::Summary;
use crate::experiment::Experiment;
use crate::metric::{Catalogue, Metric};
use crate::run::{Trial, TrialKey, series_times};

/// The columns of `trials.csv`: the trial, every metric, and the other results. `method` and `policy` have
/// the same content. `method` allows the authors' files to be stacked with ours, and `policy` is this
/// project's term.
#[must_use]
pub fn trial_columns(metrics: &Catalogue) -> Vec<String> {
    let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    let mut columns = names(&["method", "trial", "policy", "seed", "status"]);
    columns.extend(metrics.iter().map(Metric::column));
    columns.extend(names(&["state_hash", "failure", "replay"]));
    columns
}

/// Number of columns of `trials.csv` before the metrics, without the axes.
pub(super) const FIRST_METRIC: usize = 5;

/// A row of `trials.csv`. Numbers are printed so that they read back exactly.
pub(super) fn trial_row(finished: &Finished, experiment: &Experiment) -> Vec<String> {
    let TrialKey { label, trial, seed, .. } = &finished.key;
    let before = |status: &str| {
        vec![label.clone(), trial.to_string(), label.clone(), seed.to_string(), status.to_owned()]
    };
    match finished.summary(experiment) {
        Ok(Summary { status, metrics, state_hash }) => {
            let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
            let after = [state_hash, String::new(), String::new()];
            before(&status).into_iter().chain(metrics.into_iter().map(number)).chain(after).collect()
        }
        Err(fault) => {
            let mut row = before(fault.kind.name());
            row.resize(FIRST_METRIC + experiment.metrics.len() + 1, String::new());
            row.extend([fault.reason, experiment.replay_command(&finished.key)]);
            row
        }
    }
}

/// A row of `rounds.csv`: one group in one round.
#[derive(Serialize, Default)]
pub(super) struct RoundRow<'a> {
    policy: &'a str,
    trial: u32,
    seed: u64,
    round: u32,
    task: &'a str,
    start_s: f64,
    end_s: Option<f64>,
    members: String,
    secured: u32,
    rescued: u32,
    energy: f64,
    hp: f64,
    turned_back: u32,
    return_cause: Option<&'a str>,
}

impl<'a> RoundRow<'a> {
    pub(super) fn of(key: &'a TrialKey, record: &'a TrialRecord) -> impl Iterator<Item = Self> {
        record.rounds.iter().map(|round| Self {
            policy: &key.label,
            trial: key.trial,
            seed: key.seed,
            round: round.round,
            task: &record.tasks[round.task.index()].task,
            start_s: round.start_s,
            end_s: round.end_s,
            members: round.members.iter().map(|member| member.id.to_string()).collect::<Vec<_>>().join(" "),
            secured: round.secured,
            rescued: round.rescued,
            energy: round.energy,
            hp: round.hp,
            turned_back: round.turned_back,
            return_cause: round.return_cause.map(usar_sim::event::ReturnCause::name),
        })
    }
}

/// A row of `robots.csv`: one robot in one trial, with its initial levels.
#[derive(Serialize, Default)]
pub(super) struct RobotRow<'a> {
    policy: &'a str,
    trial: u32,
    seed: u64,
    robot: u32,
    role: &'a str,
    initial_energy: f64,
    initial_hp: f64,
    final_energy: f64,
    final_hp: f64,
    energy_spent: f64,
    hp_lost: f64,
    distance_m: f64,
    waiting_s: f64,
    longest_stall_s: f64,
    stall_cause: &'a str,
    stall_waits_for: Option<u32>,
    stranded: bool,
    disabled: bool,
}

impl<'a> RobotRow<'a> {
    pub(super) fn of(key: &'a TrialKey, record: &'a TrialRecord) -> impl Iterator<Item = Self> {
        record.robots.iter().map(|robot| Self {
            policy: &key.label,
            trial: key.trial,
            seed: key.seed,
            robot: robot.robot,
            role: &robot.role,
            initial_energy: robot.initial_energy,
            initial_hp: robot.initial_hp,
            final_energy: robot.final_energy,
            final_hp: robot.final_hp,
            energy_spent: robot.energy_spent,
            hp_lost: robot.hp_lost,
            distance_m: robot.distance_m,
            waiting_s: robot.waiting_s,
            longest_stall_s: robot.longest_stall_s,
            stall_cause: robot.stall.cause.name(),
            stall_waits_for: robot.stall.waits_for.map(|robot| robot.0),
            stranded: robot.stranded,
            disabled: robot.disabled,
        })
    }
}

/// The columns of `groups.csv`: a robot at the time of grouping, with its needs as they really were.
pub(super) fn group_columns(needs: &[NeedFile]) -> Vec<String> {
    let first = ["policy", "trial", "seed", "round", "robot", "role", "task", "energy", "hp"];
    let needs = needs.iter().map(|need| format!("need_{}", need.name));
    first.into_iter().map(str::to_owned).chain(needs).collect()
}

/// The rows of `groups.csv` of one trial.
pub(super) fn group_rows<'a>(
    key: &'a TrialKey,
    record: &'a TrialRecord,
) -> impl Iterator<Item = Vec<String>> + 'a {
    let of_task = |asked, task| group_of(key, asked, task);
    record
        .decisions
        .iter()
        .flat_map(move |asked| asked.question.task_ids().flat_map(move |task| of_task(asked, task)))
}

fn group_of<'a>(
    key: &'a TrialKey,
    asked: &'a DecisionRecord,
    task: TaskId,
) -> impl Iterator<Item = Vec<String>> + 'a {
    let TrialKey { label, trial, seed, .. } = key;
    let (question, group) = (&asked.question, asked.decision.assignment.of(task));
    let level = |level: Option<f64>| level.map_or(String::new(), |level| level.to_string());
    asked.team().iter().filter(|member| group.contains(&member.id)).map(move |member| {
        let mut row = vec![label.clone(), trial.to_string(), seed.to_string(), question.round.to_string()];
        row.push(member.id.to_string());
        row.push(question.roles[member.role.index()].clone());
        row.push(question.tasks[task.index()].name.clone());
        row.extend([level(member.energy_level), level(member.hp_level)]);
        row.extend(member.needs.values().iter().map(f64::to_string));
        row
    })
}

/// The columns of `series.csv`: the deliveries up to a time, from all tasks and from each task.
pub(super) fn series_columns(metrics: &Catalogue) -> Vec<String> {
    let rescuees = metrics.declared("rescuees").into_iter().map(|place| metrics[place].column());
    ["policy", "trial", "seed", "time_s"].into_iter().map(str::to_owned).chain(rescuees).collect()
}

/// The rows of `series.csv` of a trial.
pub(super) fn series_rows(
    key: &TrialKey,
    found: &Trial,
    duration_s: f64,
) -> impl Iterator<Item = Vec<String>> {
    let TrialKey { label, trial, seed, .. } = key;
    let row = move |time_s: f64| {
        let delivered = found.delivered(time_s);
        let mut row = vec![label.clone(), trial.to_string(), seed.to_string(), time_s.to_string()];
        row.push(delivered.iter().sum::<usize>().to_string());
        row.extend(delivered.iter().map(usize::to_string));
        row
    };
    series_times(duration_s).map(row)
}
