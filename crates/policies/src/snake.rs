//! `SNAKE`: the strongest robots are dealt out in turns, from the hardest task to the easiest and back.
//!
//! The draft of sports leagues, known as a snake or serpentine draft, and as picking in the order ABBA in the
//! fair division of items (Brams, Taylor 1999, *The Win-Win Solution*). Strength is that of the
//! [utility](crate::utility). Time: n log n.
//!
//! Example: robots with strengths 4, 3, 2, 1 and two tasks of two slots. The harder task gets 4, the other
//! one 3 and 2, the harder one 1: a sum of 5 each.

use teaming::decision::{Account, Decision};
use teaming::error::PolicyError;
use teaming::ids::TaskId;
use teaming::policy::Policy;
use teaming::question::Question;
use teaming::registry::PolicyKind;

use crate::ranking::rank;
use crate::utility::strengths;

/// Per role, sorts by strength and deals the members out in turns; full tasks are skipped. Ties go to the
/// lower id.
#[derive(Debug, Clone, Copy)]
pub struct Snake;

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::plain("SNAKE", "the strongest robots are dealt out in turns, to and fro", Snake)
        .from_sources(env!("SOURCES_SNAKE"))
}

impl Policy for Snake {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let strengths = strengths(question);
        let strength =
            |id: u32| question.members.binary_search_by_key(&id, |member| member.id).map(|at| strengths[at]);
        let key = |id: u32| Ok(strength(id).unwrap_or(0.0));
        let ranking =
            rank(question, "strength", |value: &f64| *value, |member| key(member.id), |a, b| b.total_cmp(a))?;
        let hardest_first = question.hardest_first();
        let mut groups = vec![Vec::new(); question.tasks.len()];
        for (ranked, quota) in ranking.roles.iter().zip(&question.quotas) {
            for (robot, task) in ranked.iter().zip(turns(&quota.members, &hardest_first)) {
                groups[task.index()].push(robot.id);
            }
        }
        Ok(Decision { account: Account::Ranking(ranking), ..Decision::unscored(groups) })
    }
}

/// The tasks in the order of their turns, each as often as it has slots.
fn turns(quota: &[usize], hardest_first: &[TaskId]) -> Vec<TaskId> {
    let most = quota.iter().copied().max().unwrap_or(0);
    let mut turns = Vec::new();
    for row in 0..most {
        let open = hardest_first.iter().copied().filter(|task| quota[task.index()] > row);
        let from = turns.len();
        turns.extend(open);
        if row % 2 == 1 {
            turns[from..].reverse();
        }
    }
    turns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_up::with_needs;

    #[test]
    fn the_example_by_hand_and_full_tasks_are_skipped() {
        let mut question = with_needs(&[&[1.0], &[4.0], &[3.0], &[2.0]], &[1, 2]);
        let groups = |question: &Question| Snake.decide(question).unwrap().assignment.groups;
        assert_eq!(groups(&question), [[2, 3], [0, 1]]);
        question.quotas[0].members = vec![3, 1];
        assert_eq!(groups(&question), [vec![0, 2, 3], vec![1]]);
        let tasks = [TaskId(0), TaskId(1), TaskId(2)];
        assert_eq!(turns(&[1, 3, 2], &tasks), [0, 1, 2, 2, 1, 1].map(TaskId));
    }
}
