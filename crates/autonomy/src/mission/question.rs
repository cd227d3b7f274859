//! The question to the policy: how the fit robots are to be grouped.

use teaming::{GroupSizes, Level, Member, Question, Quota, RandomSeed, Rest, SCHEMA_VERSION, Task, TaskId};

use crate::belief::Belief;
use crate::model::{Model, NeedModel, TaskModel};
use scenario::seed::{Purpose, stream};
use scenario::{EmptyTasks, RestFills};

/// The question how these robots are to be grouped.
pub(super) fn question(model: &Model, round: u32, belief: &Belief, members: Vec<Member>) -> Question {
    let need = |need: &NeedModel| need.asked.clone();
    let tasks = tasks(model, belief);
    let count = |role: usize| members.iter().filter(|member| member.role.index() == role).count();
    let is_open = open_tasks(belief, &tasks, model.mission.empty_tasks);
    let quota = |role: usize| {
        let (asked, sizes) = (asked(model, role, &is_open), model.mission.group_sizes);
        let mut quota = Quota::share(count(role), &asked, &model.hardest_first, sizes);
        if sizes == GroupSizes::Free && model.tasks.iter().all(|task| task.quota[role].is_none()) {
            quota.sizes = sizes; // that a task is closed binds parts; free sizes stay a suggestion
        }
        quota
    };
    Question {
        schema_version: SCHEMA_VERSION,
        round,
        asker: None,
        roles: model.roles.clone(),
        needs: model.needs.iter().map(need).collect(),
        levels: levels(model),
        rest: if model.mission.rest_fills == RestFills::Low { Rest::Low } else { Rest::All },
        quotas: (0..model.roles.len()).map(quota).collect(),
        tasks,
        members,
        may_idle: model.mission.may_idle,
        history: Vec::new(),
        random_seed: RandomSeed(stream(model.seed, Purpose::Grouping, u64::from(round)).get_seed()),
        evidence: None,
    }
}

/// The levels, in the order of [`ENERGY`](crate::robot::ENERGY) and [`HP`](crate::robot::HP).
fn levels(model: &Model) -> Vec<Level> {
    let low = [model.mission.low_energy, model.mission.low_hp];
    let level = |(at, level): (usize, Level)| {
        let expected = model.telemetry.as_ref().map(|telemetry| telemetry.initial[at]);
        Level { threshold: low[at].threshold, expected, ..level }
    };
    Level::energy_and_hp().into_iter().enumerate().map(level).collect()
}

/// The tasks, and how many rescuees wait there by this belief.
fn tasks(model: &Model, belief: &Belief) -> Vec<Task> {
    let task = |(task, id): (&TaskModel, TaskId)| Task {
        rescuees: belief.waiting(id, task.rescuees.clone()),
        ..task.asked.clone()
    };
    model.tasks.iter().zip(model.task_ids()).map(task).collect()
}

/// For each task, whether it gets robots: whether it has begun and not ended and, if the rules ask for it and
/// another task has, whether it has work that the team knows of.
fn open_tasks(belief: &Belief, tasks: &[Task], rule: EmptyTasks) -> Vec<bool> {
    let has_begun = |number: usize| belief.tasks.get(number).is_none_or(|task| task.open);
    let is_empty = |task: &Task| rule == EmptyTasks::GetNobody && task.rescuees == Some(0);
    let has_begun: Vec<bool> = (0..tasks.len()).map(has_begun).collect();
    let has_work: Vec<bool> =
        has_begun.iter().zip(tasks).map(|(begun, task)| *begun && !is_empty(task)).collect();
    if has_work.contains(&true) { has_work } else { has_begun }
}

/// The number of robots of a role for which each task asks.
fn asked(model: &Model, role: usize, is_open: &[bool]) -> Vec<Option<usize>> {
    let mut asked: Vec<Option<usize>> = model.tasks.iter().map(|task| task.quota[role]).collect();
    // A task that is not open asks for no robot; an open one takes the robots that are left.
    if is_open.contains(&false) {
        let takes_the_rest = (0..asked.len()).any(|number| is_open[number] && asked[number].is_none());
        for (asked, is_open) in asked.iter_mut().zip(is_open) {
            *asked = if *is_open { asked.filter(|_| takes_the_rest) } else { Some(0) };
        }
    }
    asked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_question_that_waits_keeps_in_bytes_who_asks() {
        let question = |asker| Question { asker, levels: Level::energy_and_hp(), ..Question::default() };
        for asked in [question(None), question(Some(7))] {
            let bytes = postcard::to_stdvec(&asked).unwrap();
            assert_eq!(postcard::from_bytes::<Question>(&bytes).unwrap(), asked);
        }
    }
}
