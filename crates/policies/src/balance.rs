//! `BALANCE`: groups as equally strong as can be: the least difference between the largest and the smallest
//! sum of strengths.
//!
//! The balanced number partitioning problem (Korf 2010, *Objective Functions for Multi-Way Number
//! Partitioning*); the rule for many robots is Graham's longest processing time first (1969, *Bounds on
//! Multiprocessing Timing Anomalies*), followed by swaps. Strength is that of the [utility](crate::utility);
//! tasks that get nobody do not count. Exact up to 100,000 assignments, which takes time in proportion to
//! them; above that time n^2 for each pass of swaps.
//!
//! Example: robots with strengths 4, 3, 2, 1 and two tasks of two slots: 4 + 1 and 3 + 2, a difference of 0.

use teaming::decision::Decision;
use teaming::error::PolicyError;
use teaming::ids::TaskId;
use teaming::policy::Policy;
use teaming::question::Question;
use teaming::registry::PolicyKind;

use crate::assigning::groups;
use crate::searching::{Loss, least};
use crate::utility::strengths;

/// The least difference between the strengths of groups. Of equal ones, the lower ids go to the harder tasks.
#[derive(Debug, Clone, Copy)]
pub struct Balance;

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::plain("BALANCE", "groups as equally strong as can be", Balance)
        .from_sources(env!("SOURCES_BALANCE"))
}

impl Policy for Balance {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let strengths = strengths(question);
        let start = strongest_first(question, &strengths);
        let (task_of, proven_optimal) = least(question, &mut Spread::new(question, strengths), start);
        Ok(Decision { proven_optimal, ..Decision::unscored(groups(question, &task_of)) })
    }
}

/// The strongest member first, each to the weakest group that has a slot for its role.
fn strongest_first(question: &Question, strengths: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..strengths.len()).collect();
    order.sort_by(|a, b| strengths[*b].total_cmp(&strengths[*a]).then(a.cmp(b)));
    let mut open: Vec<Vec<usize>> = question.quotas.iter().map(|quota| quota.members.clone()).collect();
    let mut sums = vec![0.0_f64; question.tasks.len()];
    let mut task_of = vec![0; strengths.len()];
    for member in order {
        let open = &mut open[question.members[member].role.index()];
        let tasks = question.hardest_first().into_iter().map(TaskId::index);
        let weakest = tasks.filter(|task| open[*task] > 0).min_by(|a, b| sums[*a].total_cmp(&sums[*b]));
        let Some(task) = weakest else { continue };
        open[task] -= 1;
        sums[task] += strengths[member];
        task_of[member] = task;
    }
    task_of
}

/// The difference between the strongest and the weakest group.
struct Spread {
    strengths: Vec<f64>,
    /// The sum of each task's group.
    sums: Vec<f64>,
    /// The tasks that get members.
    used: Vec<usize>,
}

impl Spread {
    fn new(question: &Question, strengths: Vec<f64>) -> Self {
        let gets = |task: &usize| question.quotas.iter().any(|quota| quota.members[*task] > 0);
        let used = (0..question.tasks.len()).filter(gets).collect();
        Self { strengths, sums: vec![0.0; question.tasks.len()], used }
    }

    fn spread(&self, sum: impl Fn(usize) -> f64) -> f64 {
        let sums = self.used.iter().map(|task| sum(*task));
        let ends =
            sums.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], sum| [low.min(sum), high.max(sum)]);
        if self.used.is_empty() { 0.0 } else { ends[1] - ends[0] }
    }
}

impl Loss for Spread {
    fn begin(&mut self, task_of: &[usize]) {
        self.sums.fill(0.0);
        self.strengths.iter().zip(task_of).for_each(|(strength, task)| self.sums[*task] += strength);
    }

    fn loss(&self, _: &[usize]) -> f64 {
        self.spread(|task| self.sums[task])
    }

    fn gain(&self, task_of: &[usize], [a, b]: [usize; 2]) -> f64 {
        let moved = self.strengths[b] - self.strengths[a];
        self.loss(task_of)
            - self.spread(|task| match task {
                task if task == task_of[a] => self.sums[task] + moved,
                task if task == task_of[b] => self.sums[task] - moved,
                task => self.sums[task],
            })
    }

    fn swap(&mut self, task_of: &[usize], [a, b]: [usize; 2]) {
        let moved = self.strengths[b] - self.strengths[a];
        self.sums[task_of[a]] += moved;
        self.sums[task_of[b]] -= moved;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_up::with_needs;

    #[test]
    fn the_example_by_hand() {
        let question = with_needs(&[&[4.0], &[3.0], &[2.0], &[1.0]], &[1, 1]);
        let decision = Balance.decide(&question).unwrap();
        assert_eq!(decision.assignment.groups, [[0, 3], [1, 2]]);
        assert!(decision.proven_optimal);
    }
}
