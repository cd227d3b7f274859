//! The assignment with the least loss, where only whole assignments have one: exact for few assignments, and
//! by swaps for more.

use rne_core::GroupSizes;
use rne_core::assignments;
use rne_core::question::Question;

use crate::assigning::of_role;

/// Most assignments that are looked at one by one.
pub(super) const EXACT_ASSIGNMENTS: u64 = 100_000;

/// Most swaps that are weighed where there are more assignments.
const MAX_SWAPS: u64 = 2_000_000;

/// Losses that differ by less are equal.
const TIE: f64 = 1e-12;

/// What an assignment loses. Members and tasks go by their places in the question.
pub(super) trait Loss {
    /// Begins at an assignment: the task of each member.
    fn begin(&mut self, task_of: &[usize]);

    /// The loss of the assignment.
    fn loss(&self, task_of: &[usize]) -> f64;

    /// How much the loss falls if two members of different tasks change places.
    fn gain(&self, task_of: &[usize], pair: [usize; 2]) -> f64;

    /// Two members change places; `task_of` is before.
    fn swap(&mut self, task_of: &[usize], pair: [usize; 2]);
}

/// The task of each member in an assignment with the least loss that has the sizes of the question, and
/// whether all were looked at. Where they are too many, swaps of two members of a role improve `start`.
pub(super) fn least(question: &Question, loss: &mut impl Loss, start: Vec<usize>) -> (Vec<usize>, bool) {
    let mut bound = question.clone();
    bound.quotas.iter_mut().for_each(|quota| quota.sizes = GroupSizes::Binding);
    if assignments::count(&bound) > EXACT_ASSIGNMENTS {
        return (by_swaps(question, loss, start), false);
    }
    (exactly(&bound, loss).unwrap_or(start), true)
}

/// Of equal losses, the assignment that sends the lower ids to the harder tasks.
fn exactly(question: &Question, loss: &mut impl Loss) -> Option<Vec<usize>> {
    let mut rank = vec![0; question.tasks.len()];
    question.hardest_first().iter().enumerate().for_each(|(at, task)| rank[task.index()] = at);
    let mut best: Option<(f64, Vec<usize>, Vec<usize>)> = None;
    for assignment in assignments::all(question) {
        let mut task_of = vec![0; question.members.len()];
        for (task, group) in assignment.groups.iter().enumerate() {
            for id in group {
                let member = question.members.binary_search_by_key(id, |member| member.id);
                task_of[member.unwrap_or_default()] = task;
            }
        }
        loss.begin(&task_of);
        let found = loss.loss(&task_of);
        let ranks: Vec<usize> = task_of.iter().map(|task| rank[*task]).collect();
        let is_better = best
            .as_ref()
            .is_none_or(|(least, order, _)| found < least - TIE || (found < least + TIE && ranks < *order));
        if is_better {
            best = Some((found, ranks, task_of));
        }
    }
    best.map(|(.., task_of)| task_of)
}

/// Swaps of two members of a role improve an assignment as long as any does.
pub(super) fn by_swaps(question: &Question, loss: &mut impl Loss, mut task_of: Vec<usize>) -> Vec<usize> {
    loss.begin(&task_of);
    let roles: Vec<Vec<usize>> = question.role_ids().map(|role| of_role(question, role)).collect();
    let (mut weighed, mut improved) = (0, true);
    while std::mem::take(&mut improved) {
        for members in &roles {
            let pairs = members.iter().enumerate();
            for (a, b) in pairs.flat_map(|(at, a)| members[at + 1..].iter().map(move |b| (*a, *b))) {
                if task_of[a] == task_of[b] {
                    continue;
                }
                weighed += 1;
                if weighed > MAX_SWAPS {
                    return task_of;
                }
                if loss.gain(&task_of, [a, b]) > TIE {
                    loss.swap(&task_of, [a, b]);
                    task_of.swap(a, b);
                    improved = true;
                }
            }
        }
    }
    task_of
}
