//! Rows of the tables that a sweep writes. Undefined values are empty cells.

use serde::Serialize;
use usar_sim::record::TrialRecord;

use super::trial::{Outcome, TrialKey, series_times};
use crate::experiment::Experiment;

/// A row of `trials.csv`: the authors' columns first, under their names, then ours. `method` and `policy` say the same; the one is
/// there so that the authors' files and ours can be stacked, the other for the words of this project.
#[derive(Serialize, Default)]
pub(super) struct TrialRow<'a> {
    method: &'a str,
    trial: u32,
    time_s: Option<f64>,
    rescuees_total: Option<u32>,
    rescuees_hard: Option<u32>,
    rescuees_easy: Option<u32>,
    energy_hard: Option<f64>,
    energy_easy: Option<f64>,
    energy_total: Option<f64>,
    hp_hard: Option<f64>,
    hp_easy: Option<f64>,
    hp_total: Option<f64>,
    rounds: Option<u32>,
    policy: &'a str,
    seed: u64,
    status: &'a str,
    energy_ungrouped: Option<f64>,
    hp_ungrouped: Option<f64>,
    secured_total: Option<u32>,
    secured_hard: Option<u32>,
    secured_easy: Option<u32>,
    turned_back: Option<u32>,
    stranded: Option<usize>,
    disabled: Option<usize>,
    distance_m: Option<f64>,
    waiting_s: Option<f64>,
    longest_stall_s: Option<f64>,
    conflicts: Option<u32>,
    deadlocks: Option<u32>,
    rotations: Option<u32>,
    retreats: Option<u32>,
    back_offs: Option<u32>,
    unreachable: Option<u32>,
    errands_done: Option<u32>,
    state_hash: &'a str,
    failure: Option<&'a str>,
    replay: Option<String>,
}

impl<'a> TrialRow<'a> {
    pub(super) fn new(outcome: &'a Outcome, experiment: &Experiment) -> Self {
        let record = outcome.record();
        let TrialKey { label, trial, seed, .. } = &outcome.key;
        let fault = outcome.result.as_ref().err();
        Self {
            method: label,
            trial: *trial,
            time_s: record.map(|r| r.time_s),
            rescuees_total: record.map(TrialRecord::rescued),
            rescuees_hard: record.map(|r| r.hard.rescued),
            rescuees_easy: record.map(|r| r.easy.rescued),
            energy_hard: record.map(|r| r.hard.energy),
            energy_easy: record.map(|r| r.easy.energy),
            energy_total: record.map(TrialRecord::energy),
            hp_hard: record.map(|r| r.hard.hp),
            hp_easy: record.map(|r| r.easy.hp),
            hp_total: record.map(TrialRecord::hp),
            rounds: record.map(|r| r.completed_rounds),
            policy: label,
            seed: *seed,
            status: outcome.status(),
            energy_ungrouped: record.map(|r| r.ungrouped_energy),
            hp_ungrouped: record.map(|r| r.ungrouped_hp),
            secured_total: record.map(|r| r.hard.secured + r.easy.secured),
            secured_hard: record.map(|r| r.hard.secured),
            secured_easy: record.map(|r| r.easy.secured),
            turned_back: record.map(|r| r.turned_back),
            stranded: record.map(TrialRecord::stranded),
            disabled: record.map(TrialRecord::disabled),
            distance_m: record.map(TrialRecord::distance_m),
            waiting_s: record.map(TrialRecord::waiting_s),
            longest_stall_s: record.map(TrialRecord::longest_stall_s),
            conflicts: record.map(|r| r.conflicts),
            deadlocks: record.map(|r| r.deadlocks),
            rotations: record.map(|r| r.rotations),
            retreats: record.map(|r| r.retreats),
            back_offs: record.map(|r| r.back_offs),
            unreachable: record.map(|r| r.unreachable),
            errands_done: record.map(|r| r.errands_done),
            state_hash: record.map_or("", |r| &r.state_hash),
            failure: fault.map(|fault| fault.reason.as_str()),
            replay: fault.map(|_| experiment.replay_command(&outcome.key)),
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
    pub(super) fn of(outcome: &'a Outcome) -> impl Iterator<Item = Self> {
        outcome.record().into_iter().flat_map(|record| &record.rounds).map(|round| Self {
            policy: &outcome.key.label,
            trial: outcome.key.trial,
            seed: outcome.key.seed,
            round: round.round,
            task: round.task.name(),
            start_s: round.start_s,
            end_s: round.end_s,
            members: round.members.iter().map(u32::to_string).collect::<Vec<_>>().join(" "),
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
    pub(super) fn of(outcome: &'a Outcome) -> impl Iterator<Item = Self> {
        outcome.record().into_iter().flat_map(|record| &record.robots).map(|robot| Self {
            policy: &outcome.key.label,
            trial: outcome.key.trial,
            seed: outcome.key.seed,
            robot: robot.robot,
            role: robot.role.name(),
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

/// A row of `groups.csv`: one robot when it was grouped, with the needs that the policy saw.
#[derive(Serialize, Default)]
pub(super) struct GroupRow<'a> {
    policy: &'a str,
    trial: u32,
    seed: u64,
    round: u32,
    robot: u32,
    role: &'a str,
    task: &'a str,
    energy: f64,
    hp: f64,
    need_hp: f64,
    need_v: f64,
    need_sen: f64,
    need_eng: f64,
    need_res: f64,
    need_cap: f64,
    need_obs: f64,
}

impl<'a> GroupRow<'a> {
    pub(super) fn of(outcome: &'a Outcome) -> impl Iterator<Item = Self> {
        let trial = outcome.result.as_ref().ok();
        trial.into_iter().flat_map(|trial| trial.grouped.iter().map(move |robot| (trial, robot))).filter_map(
            |(trial, robot)| {
                let [need_hp, need_v, need_sen, need_eng, need_res, need_cap, need_obs] =
                    *robot.needs.as_slice()
                else {
                    return None;
                };
                Some(Self {
                    policy: &outcome.key.label,
                    trial: outcome.key.trial,
                    seed: outcome.key.seed,
                    round: robot.round,
                    robot: robot.robot,
                    role: trial.record.robots[robot.robot as usize].role.name(),
                    task: robot.task.name(),
                    energy: robot.energy,
                    hp: robot.hp,
                    need_hp,
                    need_v,
                    need_sen,
                    need_eng,
                    need_res,
                    need_cap,
                    need_obs,
                })
            },
        )
    }
}

/// A row of `series.csv`: what was delivered up to a time.
#[derive(Serialize, Default)]
pub(super) struct SeriesRow<'a> {
    policy: &'a str,
    trial: u32,
    seed: u64,
    time_s: f64,
    rescuees_total: usize,
    rescuees_hard: usize,
    rescuees_easy: usize,
}

impl<'a> SeriesRow<'a> {
    pub(super) fn of(outcome: &'a Outcome, duration_s: f64) -> impl Iterator<Item = Self> {
        let rows = move |trial: &'a super::Trial| {
            series_times(duration_s).map(move |time_s| {
                let [hard, easy] = trial.delivered(time_s);
                Self {
                    policy: &outcome.key.label,
                    trial: outcome.key.trial,
                    seed: outcome.key.seed,
                    time_s,
                    rescuees_total: hard + easy,
                    rescuees_hard: hard,
                    rescuees_easy: easy,
                }
            })
        };
        outcome.result.as_ref().ok().into_iter().flat_map(rows)
    }
}
