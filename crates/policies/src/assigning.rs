//! The assignment with the largest sum of values, by the sizes of the question.
//!
//! Each role is an assignment problem of its own: its members and its slots at the tasks. It is solved
//! exactly by the Hungarian method (Kuhn 1955, *The Hungarian Method for the Assignment Problem*; Munkres
//! 1957) of the crate pathfinding, on whole numbers of 2^-40, so that no rounding decides. It takes time of
//! the order of the cube of a role's members.
//!
//! Example: two members with values (3, 2) and (3, 0) at two tasks of one slot each. The first one at its
//! favourite task leaves 0 for the second one, 3 in all; crossed they have 2 + 3 = 5.

use pathfinding::kuhn_munkres::kuhn_munkres;
use pathfinding::matrix::Matrix;
use rne_core::ids::RoleId;
use rne_core::question::Question;

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
    let values = Matrix::from_fn(rows.len(), slots.len(), |(row, slot)| rows[row][slots[slot]]);
    let (_, slot_of) = kuhn_munkres(&values);
    let mut task_of: Vec<usize> = slot_of.iter().map(|slot| slots[*slot]).collect();
    let mut rank = slots.to_vec();
    rank.dedup();
    while settle_ties(rows, &rank, &mut task_of) {}
    task_of
}

/// Swaps members where that costs nothing and the lower one gets the harder task. Returns
/// whether any did. `hardest_first` has the tasks.
fn settle_ties(rows: &[Vec<i64>], hardest_first: &[usize], task_of: &mut [usize]) -> bool {
    let mut changed = false;
    for low in 0..task_of.len() {
        for high in low + 1..task_of.len() {
            let [mine, other] = [task_of[low], task_of[high]];
            let is_equal = rows[low][mine] + rows[high][other] == rows[low][other] + rows[high][mine];
            let first = || hardest_first.iter().find(|task| [mine, other].contains(task));
            if mine != other && is_equal && first() == Some(&other) {
                task_of.swap(low, high);
                changed = true;
            }
        }
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_by_hand() {
        assert_eq!(matching(&[vec![3.0, 2.0], vec![3.0, 0.0]]), [1, 0]);
    }

    #[test]
    fn among_equals_the_first_gets_the_first_place() {
        assert_eq!(matching(&vec![vec![1.0; 5]; 5]), [0, 1, 2, 3, 4]);
        assert_eq!(matching(&[]), [] as [usize; 0]);
    }
}
