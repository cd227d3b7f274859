//! A schedule that is being made: robots commit themselves to tasks, one after the other.

use std::cmp::Reverse;

use crate::problem::{Problem, Skills};

#[cfg(test)]
mod recorded;

/// Where the robots are and when they are free, and which tasks are covered.
#[derive(Debug, Clone)]
pub(crate) struct Schedule<'p> {
    pub(crate) problem: &'p Problem,
    /// The location of each robot: that of its last task, or where it begins.
    pub(crate) place: Vec<usize>,
    /// When each robot is free; of a robot that waits for others, when it has arrived.
    pub(crate) ready: Vec<f64>,
    /// Whether each robot is bound to a task that is not covered yet.
    pub(crate) is_bound: Vec<bool>,
    /// The robots of each task.
    pub(crate) teams: Vec<Vec<usize>>,
    /// When each covered task is over.
    pub(crate) ends: Vec<Option<f64>>,
}

/// A group for a task, and when the task could start with it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Team {
    pub(crate) task: usize,
    pub(crate) start: f64,
    /// The robots that join those that are bound to the task.
    pub(crate) joining: Vec<usize>,
}

impl<'p> Schedule<'p> {
    pub(crate) fn new(problem: &'p Problem) -> Self {
        let (robots, tasks) = (problem.robots.len(), problem.tasks.len());
        Self {
            problem,
            place: problem.robots.iter().map(|robot| robot.start).collect(),
            ready: vec![0.0; robots],
            is_bound: vec![false; robots],
            teams: vec![Vec::new(); tasks],
            ends: vec![None; tasks],
        }
    }

    /// The tasks whose predecessors are covered, and that are not covered themselves.
    pub(crate) fn open(&self) -> impl Iterator<Item = usize> + '_ {
        let is_covered = |task: &usize| self.ends[*task].is_some();
        let tasks = (0..self.ends.len()).filter(move |task| !is_covered(task));
        tasks.filter(move |task| self.problem.tasks[*task].after.iter().all(is_covered))
    }

    /// The skills that the group of a task still lacks.
    pub(crate) fn missing(&self, task: usize) -> Skills {
        self.problem.tasks[task].requires & !self.problem.skills_of(&self.teams[task])
    }

    /// When a robot that sets out at a time, or as soon as it is free, is at a task.
    pub(crate) fn arrival(&self, robot: usize, task: usize, now: f64) -> f64 {
        self.ready[robot].max(now) + self.problem.travel[self.place[robot]][task + 1]
    }

    /// A robot goes to a task. If that covers the task, its times are settled.
    pub(crate) fn commit(&mut self, robot: usize, task: usize, now: f64) {
        self.ready[robot] = self.arrival(robot, task, now);
        (self.place[robot], self.is_bound[robot]) = (task + 1, true);
        self.teams[task].push(robot);
        if self.missing(task) == 0 {
            let end = self.least_start(task) + self.problem.tasks[task].duration;
            self.ends[task] = Some(end);
            for member in &self.teams[task] {
                (self.ready[*member], self.is_bound[*member]) = (end, false);
            }
        }
    }

    /// The task starts no sooner: its predecessors are over, and the robots bound to it are there.
    fn least_start(&self, task: usize) -> f64 {
        let over = self.problem.tasks[task].after.iter().filter_map(|first| self.ends[*first]);
        self.teams[task].iter().map(|robot| self.ready[*robot]).chain(over).fold(0.0, f64::max)
    }

    /// The group with which a task starts the earliest, of robots that are bound to no other task; `None` if
    /// they lack a skill. Robots that cover more come first, then the sooner, then lower ids.
    pub(crate) fn team(&self, task: usize, now: f64) -> Option<Team> {
        let mut missing = self.missing(task);
        let useful = (0..self.ready.len())
            .filter(|robot| !self.is_bound[*robot] && self.problem.robots[*robot].skills & missing != 0);
        let mut useful: Vec<(f64, usize)> =
            useful.map(|robot| (self.arrival(robot, task, now), robot)).collect();
        useful.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (mut start, mut covered, mut count) = (self.least_start(task), 0, 0);
        while covered & missing != missing {
            let (arrival, robot) = useful.get(count)?;
            (start, covered, count) =
                (start.max(*arrival), covered | self.problem.robots[*robot].skills, count + 1);
        }
        let in_time = useful.iter().take_while(|(arrival, _)| *arrival <= start).count();
        useful.truncate(in_time);
        let mut joining = Vec::new();
        while missing != 0 {
            let most = |(rank, (_, robot)): &(usize, &(f64, usize))| {
                ((self.problem.robots[*robot].skills & missing).count_ones(), Reverse(*rank))
            };
            let (_, (_, robot)) = useful.iter().enumerate().max_by_key(most)?;
            joining.push(*robot);
            missing &= !self.problem.robots[*robot].skills;
        }
        self.drop_redundant(task, &mut joining);
        Some(Team { task, start, joining })
    }

    /// Leaves out robots whose skills the others have.
    fn drop_redundant(&self, task: usize, joining: &mut Vec<usize>) {
        let mut at = 0;
        while at < joining.len() {
            let mut others = joining.clone();
            others.remove(at);
            if self.missing(task) & !self.problem.skills_of(&others) == 0 {
                *joining = others;
            } else {
                at += 1;
            }
        }
    }

    /// Whether all tasks that robots are bound to could be covered one after the other: each by robots that
    /// are free or come free from those before (the banker's algorithm, Dijkstra 1965).
    pub(crate) fn is_safe(&self) -> bool {
        let free = (0..self.is_bound.len()).filter(|robot| !self.is_bound[*robot]).collect::<Vec<_>>();
        let mut pool = self.problem.skills_of(&free);
        let is_waiting = |task: &usize| self.ends[*task].is_none() && !self.teams[*task].is_empty();
        let mut waiting: Vec<usize> = (0..self.ends.len()).filter(is_waiting).collect();
        while let Some(at) = waiting.iter().position(|task| self.missing(*task) & !pool == 0) {
            pool |= self.problem.skills_of(&self.teams[waiting.swap_remove(at)]);
        }
        waiting.is_empty()
    }

    /// When the last robot is at its end. Robots without a task do not count.
    pub(crate) fn makespan(&self) -> f64 {
        let Problem { robots, travel, .. } = self.problem;
        let used = robots.iter().zip(&self.place).zip(&self.ready);
        let used = used.filter(|((robot, place), _)| robot.start != **place);
        used.map(|((robot, place), ready)| ready + travel[*place][robot.end]).fold(0.0, f64::max)
    }
}

/// The makespan of the rule that takes the task that can start the earliest, again and again, with the group
/// that makes it so. Of equal ones, the first in the table.
#[must_use]
pub fn earliest(problem: &Problem) -> f64 {
    let mut schedule = Schedule::new(problem);
    loop {
        let teams = schedule.open().filter_map(|task| schedule.team(task, 0.0));
        let Some(next) = teams.min_by(|a, b| a.start.total_cmp(&b.start)) else {
            return schedule.makespan();
        };
        next.joining.iter().for_each(|robot| schedule.commit(*robot, next.task, 0.0));
    }
}
