//! The assignment with the least loss, where only whole assignments have one: exact for few assignments, and
//! by swaps for more.

use teaming::GroupSizes;
use teaming::assignments;
use teaming::question::Question;

use crate::assigning::of_role;

/// Most assignments that are looked at one by one.
const EXACT_ASSIGNMENTS: u64 = 100_000;

/// Most members whose assignments are looked at one by one, and most steps that this may take.
const EXACT_MEMBERS: usize = 1_000;
const EXACT_STEPS: u64 = 100_000_000;

/// Most swaps that are weighed where there are more assignments.
const MAX_SWAPS: u64 = 2_000_000;

/// Losses that differ by less are equal.
const TIE: f64 = 1e-12;

/// What an assignment loses. Members and tasks go by their rows in the question.
pub(super) trait Loss {
    /// Steps of a beginning, for so many members.
    fn steps(members: u64) -> u64 {
        members
    }

    /// Begins at an assignment: the task of each member.
    fn begin(&mut self, task_of: &[usize]);

    /// The loss of the assignment.
    fn loss(&self, task_of: &[usize]) -> f64;

    /// How much the loss falls if two members of different tasks are swapped.
    fn gain(&self, task_of: &[usize], pair: [usize; 2]) -> f64;

    /// Two members are swapped; `task_of` is before.
    fn swap(&mut self, task_of: &[usize], pair: [usize; 2]);
}

/// The task of each member in an assignment with the least loss that has the sizes of the question, and
/// whether all were looked at. Where they are too many, swaps of two members of a role improve `start`. Of
/// equal losses, the one that sends the lower ids to the harder tasks.
pub(super) fn least<L: Loss>(question: &Question, loss: &mut L, start: Vec<usize>) -> (Vec<usize>, bool) {
    let mut bound = question.clone();
    bound.quotas.iter_mut().for_each(|quota| quota.sizes = GroupSizes::Binding);
    let count = assignments::count(&bound);
    let steps = count.saturating_mul(L::steps(question.members.len() as u64));
    if count > EXACT_ASSIGNMENTS || question.members.len() > EXACT_MEMBERS || steps > EXACT_STEPS {
        return (by_swaps(question, loss, start), false);
    }
    let open = question.quotas.iter().map(|quota| quota.members.clone()).collect();
    let tasks = question.hardest_first().iter().map(|task| task.index()).collect();
    let mut all =
        All { question, tasks, open, task_of: vec![0; start.len()], best: start, least: f64::INFINITY };
    all.from(0, loss);
    (all.best, true)
}

/// A look at all assignments, member by member.
struct All<'q> {
    question: &'q Question,
    /// From the hardest to the easiest.
    tasks: Vec<usize>,
    /// For each role and task, the slots that are left.
    open: Vec<Vec<usize>>,
    task_of: Vec<usize>,
    best: Vec<usize>,
    least: f64,
}

impl All<'_> {
    /// All choices for this member and those after it.
    fn from(&mut self, member: usize, loss: &mut impl Loss) {
        let Some(of) = self.question.members.get(member) else {
            loss.begin(&self.task_of);
            let found = loss.loss(&self.task_of);
            if found < self.least - TIE {
                self.least = found;
                self.best.clone_from(&self.task_of);
            }
            return;
        };
        let role = of.role.index();
        for at in 0..self.tasks.len() {
            let task = self.tasks[at];
            if self.open[role][task] > 0 {
                self.open[role][task] -= 1;
                self.task_of[member] = task;
                self.from(member + 1, loss);
                self.open[role][task] += 1;
            }
        }
    }
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
