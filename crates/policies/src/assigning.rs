//! The assignment with the largest sum of values, by the sizes of the question.
//!
//! Each role is an assignment problem of its own: its members and its places at the tasks. It is solved
//! exactly by the Hungarian method (Kuhn 1955, *The Hungarian Method for the Assignment Problem*; Munkres
//! 1957) of the crate pathfinding, on whole numbers of 2^-40, so that no rounding decides. It takes time of
//! the order of the cube of a role's members.
//!
//! Example: two members with values (3, 2) and (3, 0) at two tasks of one place each. The first one at its
//! favourite task leaves 0 for the second one, 3 in all; crossed they have 2 + 3 = 5.

use pathfinding::kuhn_munkres::{Weights, kuhn_munkres};
use rne_core::ids::RoleId;
use rne_core::question::Question;

/// Values are rounded to whole numbers of this part of 1.
const STEPS: f64 = (1_u64 << 40) as f64;

/// The task of each member, by its place in the table of tasks. `values` has a row for each member and, in
/// it, a number for each task; between -200 and 200.
///
/// If two members of a role could change places at no cost, the lower id has the harder task.
pub(super) fn best(question: &Question, values: &[Vec<f64>]) -> Vec<usize> {
    let mut task_of = vec![0; question.members.len()];
    for role in question.role_ids() {
        let members = of_role(question, role);
        let rows = members.iter().map(|member| whole(&values[*member])).collect();
        let places = places(question, role);
        for (member, task) in members.iter().zip(best_of_role(rows, places)) {
            task_of[*member] = task;
        }
    }
    task_of
}

/// The columns of a square table of values, one for each row, with the largest sum.
pub(super) fn matching(values: &[Vec<f64>]) -> Vec<usize> {
    best_of_role(values.iter().map(|row| whole(row)).collect(), (0..values.len()).collect())
}

fn whole(values: &[f64]) -> Vec<i64> {
    values.iter().map(|value| libm::round(value * STEPS) as i64).collect()
}

/// The members of a role, by their places in the list of members.
pub(super) fn of_role(question: &Question, role: RoleId) -> Vec<usize> {
    (0..question.members.len()).filter(|member| question.members[*member].role == role).collect()
}

/// The task of each place that a role has, the hardest first.
pub(super) fn places(question: &Question, role: RoleId) -> Vec<usize> {
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

/// Rows of members and the tasks of as many places.
struct Values {
    rows: Vec<Vec<i64>>,
    places: Vec<usize>,
}

impl Weights<i64> for Values {
    fn rows(&self) -> usize {
        self.rows.len()
    }

    fn columns(&self) -> usize {
        self.places.len()
    }

    fn at(&self, row: usize, column: usize) -> i64 {
        self.rows[row][self.places[column]]
    }

    fn neg(&self) -> Self {
        let negated = |row: &Vec<i64>| row.iter().map(|value| -value).collect();
        Self { rows: self.rows.iter().map(negated).collect(), places: self.places.clone() }
    }
}

fn best_of_role(rows: Vec<Vec<i64>>, places: Vec<usize>) -> Vec<usize> {
    let values = Values { rows, places };
    let (_, mut place_of) = kuhn_munkres(&values);
    while settle_ties(&values, &mut place_of) {}
    place_of.iter().map(|place| values.places[*place]).collect()
}

/// Lets members change places where that costs nothing and the lower one gets the harder task. Returns
/// whether any did.
fn settle_ties(values: &Values, place_of: &mut [usize]) -> bool {
    let mut changed = false;
    for low in 0..place_of.len() {
        for high in low + 1..place_of.len() {
            let [mine, other] = [place_of[low], place_of[high]];
            let is_harder = other < mine && values.places[other] != values.places[mine];
            let sum = |a: usize, b: usize| values.at(low, a) + values.at(high, b);
            if is_harder && sum(mine, other) == sum(other, mine) {
                place_of.swap(low, high);
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
