//! The assignment with the largest sum of values, by the sizes of the question.
//!
//! Each role is a transport problem of its own: its members, and its slots at the tasks. It is solved exactly
//! on whole numbers of 2^-40, so that no rounding decides. All members begin at their favourite tasks. While
//! a task has too many, a chain of members moves one task on each, to an open slot: the chain that loses the
//! least (successive shortest paths; Ahuja, Magnanti, Orlin 1993, *Network Flows*, section 9.7). Each chain
//! takes time of the order of the members of the role, and the cube of the tasks at most; there are fewer
//! chains than members.
//!
//! Example: two members with values (3, 2) and (3, 0) at two tasks of one slot each. The first one at its
//! favourite task leaves 0 for the second one, 3 in all; crossed they have 2 + 3 = 5.

use std::cmp::Reverse;

use teaming::ids::RoleId;
use teaming::question::Question;

/// Values are rounded to whole numbers of this part of 1.
const STEPS: f64 = 1_099_511_627_776.0; // 2^40

/// The task of each member, by its row in the table of tasks. `values` has a row for each member and, in
/// it, a number for each task; between -200 and 200.
///
/// If two members of a role could be swapped at no cost, the lower id has the harder task.
pub(super) fn best(question: &Question, values: &[Vec<f64>]) -> Vec<usize> {
    let mut task_of = vec![0; question.members.len()];
    for role in question.role_ids() {
        let members = of_role(question, role);
        let rows: Vec<Vec<i64>> = members.iter().map(|member| whole(&values[*member])).collect();
        for (member, task) in members.iter().zip(best_of_role(&rows, &slots(question, role))) {
            task_of[*member] = task;
        }
    }
    task_of
}

/// The columns of a square table of values, one for each row, with the largest sum.
pub(super) fn matching(values: &[Vec<f64>]) -> Vec<usize> {
    let rows: Vec<Vec<i64>> = values.iter().map(|row| whole(row)).collect();
    best_of_role(&rows, &(0..values.len()).collect::<Vec<usize>>())
}

fn whole(values: &[f64]) -> Vec<i64> {
    values.iter().map(|value| libm::round(value * STEPS) as i64).collect()
}

/// The members of a role, by their rows in the list of members.
pub(super) fn of_role(question: &Question, role: RoleId) -> Vec<usize> {
    (0..question.members.len()).filter(|member| question.members[*member].role == role).collect()
}

/// The task of each slot that a role has, the hardest first.
pub(super) fn slots(question: &Question, role: RoleId) -> Vec<usize> {
    let quota = &question.quotas[role.index()].members;
    let tasks = question.hardest_first().into_iter();
    tasks.flat_map(|task| std::iter::repeat_n(task.index(), quota[task.index()])).collect()
}

/// The ids of each task's group.
pub(super) fn groups(question: &Question, task_of: &[usize]) -> Vec<Vec<u32>> {
    let mut groups = vec![Vec::new(); question.tasks.len()];
    question.members.iter().zip(task_of).for_each(|(member, task)| groups[*task].push(member.id));
    groups
}

/// `rows` are members, and `slots` the tasks of as many slots.
fn best_of_role(rows: &[Vec<i64>], slots: &[usize]) -> Vec<usize> {
    let mut hardest_first = slots.to_vec();
    hardest_first.dedup();
    let mut task_of = transported(rows, slots, &hardest_first);
    while settle_ties(rows, &hardest_first, &mut task_of) {}
    task_of
}

/// The task of each member in an assignment with the largest sum.
fn transported(rows: &[Vec<i64>], slots: &[usize], hardest_first: &[usize]) -> Vec<usize> {
    let easiest_first = || hardest_first.iter().rev().copied();
    let favourite = |row: &Vec<i64>| easiest_first().max_by_key(|task| row[*task]).unwrap_or(0);
    let mut task_of: Vec<usize> = rows.iter().map(favourite).collect();
    let tasks = rows.first().map_or(0, Vec::len);
    let mut open = vec![0_isize; tasks];
    slots.iter().for_each(|task| open[*task] += 1);
    task_of.iter().for_each(|task| open[*task] -= 1);
    let mut steps: Vec<Vec<Step>> = (0..tasks).map(|from| steps_from(from, rows, &task_of)).collect();
    while open.iter().any(|open| *open < 0) {
        let path = best_path(&open, &steps, easiest_first());
        for pair in path.windows(2) {
            steps[pair[0]][pair[1]].iter().for_each(|(_, Reverse(member))| task_of[*member] = pair[1]);
        }
        path.first().into_iter().for_each(|first| open[*first] += 1);
        path.last().into_iter().for_each(|last| open[*last] -= 1);
        path.iter().for_each(|from| steps[*from] = steps_from(*from, rows, &task_of));
    }
    task_of
}

/// What a step from one task to another one gains, with the member that gains the most.
type Step = Option<(i64, Reverse<usize>)>;

/// The best step from a task to each task.
fn steps_from(from: usize, rows: &[Vec<i64>], task_of: &[usize]) -> Vec<Step> {
    let there: Vec<usize> = (0..rows.len()).filter(|member| task_of[*member] == from).collect();
    let step = |to: usize| there.iter().map(|i| (rows[*i][to] - rows[*i][from], Reverse(*i))).max();
    (0..rows.first().map_or(0, Vec::len)).map(step).collect()
}

/// The steps that gain the most in all, from a task with too many members to one with an open slot (Bellman,
/// Ford).
fn best_path(open: &[isize], steps: &[Vec<Step>], tasks: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut gains: Vec<Option<i64>> = open.iter().map(|open| (*open < 0).then_some(0)).collect();
    let mut came_from = vec![None; open.len()];
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for (from, to) in (0..open.len()).flat_map(|from| (0..open.len()).map(move |to| (from, to))) {
            let (Some(gain), Some((step, _))) = (gains[from], steps[from][to]) else { continue };
            if gains[to].is_none_or(|known| known < gain + step) {
                (gains[to], came_from[to], changed) = (Some(gain + step), Some(from), true);
            }
        }
    }
    let last = tasks.filter(|task| open[*task] > 0).max_by_key(|task| gains[*task]);
    let mut path: Vec<usize> = std::iter::successors(last, |task| came_from[*task]).collect();
    path.reverse();
    path
}

/// Swaps members where that costs nothing and the lower one gets the harder task. Returns
/// whether any did.
fn settle_ties(rows: &[Vec<i64>], hardest_first: &[usize], task_of: &mut [usize]) -> bool {
    let before = task_of.to_vec();
    for (rank, harder) in hardest_first.iter().enumerate() {
        for easier in &hardest_first[rank + 1..] {
            let gain = |member: &usize| rows[*member][*harder] - rows[*member][*easier];
            let mut there: Vec<usize> =
                (0..rows.len()).filter(|member| [harder, easier].contains(&&task_of[*member])).collect();
            there.sort_by_key(|member| (gain(member), *member));
            for equals in there.chunk_by(|a, b| gain(a) == gain(b)) {
                let count = equals.iter().filter(|member| task_of[**member] == *harder).count();
                let tasks = std::iter::repeat_n(*harder, count).chain(std::iter::repeat(*easier));
                equals.iter().zip(tasks).for_each(|(member, task)| task_of[*member] = task);
            }
        }
    }
    before != task_of
}

#[cfg(test)]
mod tests {
    use pathfinding::kuhn_munkres::kuhn_munkres;
    use pathfinding::matrix::Matrix;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    use super::*;

    #[test]
    fn the_example_by_hand() {
        assert_eq!(matching(&[vec![3.0, 2.0], vec![3.0, 0.0]]), [1, 0]);
    }

    /// The Hungarian method is an independent program for the same sum.
    #[test]
    fn sums_of_1_000_instances_are_those_of_the_hungarian_method() {
        let mut draws = ChaCha8Rng::seed_from_u64(3);
        for turn in 0..1_000 {
            let [tasks, members] = [draws.random_range(1..6), draws.random_range(1..12)];
            let most = if turn % 2 == 0 { 3 } else { 1 << 40 };
            let mut row = |_| (0..tasks).map(|_| draws.random_range(-most..=most)).collect();
            let rows: Vec<Vec<i64>> = (0..members).map(&mut row).collect();
            let mut slots: Vec<usize> = (0..members).map(|_| draws.random_range(0..tasks)).collect();
            slots.sort_by_key(|task| (task % 2, *task));
            let value = |(member, slot): (usize, usize)| rows[member][slots[slot]];
            let (sum, slot_of) = kuhn_munkres(&Matrix::from_fn(members, members, value));
            let found = best_of_role(&rows, &slots);
            assert_eq!(rows.iter().zip(&found).map(|(row, task)| row[*task]).sum::<i64>(), sum);
            let [mut sizes, expected] =
                [found.clone(), slot_of.iter().map(|slot| slots[*slot]).collect::<Vec<usize>>()];
            if most > 3 {
                assert_eq!(found, expected, "the best of drawn instances is the only one");
            }
            sizes.sort_by_key(|task| (task % 2, *task));
            assert_eq!(sizes, slots);
        }
    }

    /// With few values there are many equal assignments. No two members could be swapped for a better order.
    #[test]
    fn of_members_that_are_equal_the_lower_id_has_the_harder_task() {
        let mut draws = ChaCha8Rng::seed_from_u64(5);
        for _ in 0..1_000 {
            let mut row = |_| (0..3).map(|_| draws.random_range(0..3)).collect();
            let rows: Vec<Vec<i64>> = (0..9).map(&mut row).collect();
            let found = best_of_role(&rows, &[2, 2, 2, 0, 0, 0, 1, 1, 1]);
            let rank = |task: usize| [2, 0, 1].iter().position(|of| *of == task);
            for (low, high) in (0..9).flat_map(|low| (low + 1..9).map(move |high| (low, high))) {
                let [mine, other] = [found[low], found[high]];
                let lost = rows[low][mine] + rows[high][other] - rows[low][other] - rows[high][mine];
                assert!(lost > 0 || rank(mine) <= rank(other), "{rows:?} {found:?}");
            }
        }
    }

    #[test]
    fn among_equals_the_first_gets_the_first_place() {
        assert_eq!(matching(&vec![vec![1.0; 5]; 5]), [0, 1, 2, 3, 4]);
        assert_eq!(matching(&[]), [] as [usize; 0]);
    }
}
