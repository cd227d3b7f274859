//! Every assignment that the quotas of a question allow. A policy chooses from these.
//!
//! If a quota binds, each task gets exactly its number of members of the role. If its numbers are the sizes
//! of parts, any task may get any part. If it is free, any task may get any member. No robot is left idle.

use rand::seq::{IndexedRandom, SliceRandom};
use rand::{Rng, RngExt};

use crate::decision::Assignment;
use crate::ids::TaskId;
use crate::question::{GroupSizes, Question, Quota};

/// The number of assignments that the quotas of a question allow; `u64::MAX` for that number and more.
///
/// A role with members `n` and parts of sizes `n_1 ... n_k` has `n! / (n_1! ... n_k!)` splits for each
/// distinct order of the sizes, and `tasks^n` if sizes are free; the roles multiply.
/// Six carriers, four suppliers and two observers over two tasks: 20 * 6 * 2 = 240.
#[must_use]
pub fn count(question: &Question) -> u64 {
    question.quotas.iter().map(splits_of).fold(1, u64::saturating_mul)
}

fn splits_of(quota: &Quota) -> u64 {
    let members: usize = quota.members.iter().sum();
    if quota.sizes == GroupSizes::Free {
        let members = u32::try_from(members).unwrap_or(u32::MAX);
        return (quota.members.len() as u64).saturating_pow(members);
    }
    let mut left = members;
    let mut splits = 1_u64;
    for size in &quota.members {
        splits = splits.saturating_mul(binomial(left, *size));
        left -= size;
    }
    splits.saturating_mul(orders_of(quota))
}

/// The number of distinct orders of the parts' sizes; 1 for a quota that binds.
fn orders_of(quota: &Quota) -> u64 {
    if quota.binds() {
        return 1;
    }
    let mut sizes = quota.members.clone();
    sizes.sort_unstable();
    let mut left = sizes.len();
    sizes
        .chunk_by(|a, b| a == b)
        .map(|equal| {
            let ways = binomial(left, equal.len());
            left -= equal.len();
            ways
        })
        .fold(1, u64::saturating_mul)
}

/// The binomial coefficient `n` over `k`, saturating.
fn binomial(n: usize, k: usize) -> u64 {
    let k = k.min(n - k);
    let mut ways = 1_u128;
    for i in 0..k {
        ways = ways * (n - i) as u128 / (i + 1) as u128;
        if ways > u128::from(u64::MAX) {
            return u64::MAX;
        }
    }
    ways as u64
}

/// Every assignment that the quotas allow, each once, in a fixed order: the first role varies slowest. Memory
/// and time grow with [`count`]; check that number first.
#[must_use]
pub fn all(question: &Question) -> Vec<Assignment> {
    let mut assignments = vec![vec![Vec::new(); question.tasks.len()]];
    for (role, quota) in question.role_ids().zip(&question.quotas) {
        let ids: Vec<u32> = question.of_role(role).map(|member| member.id).collect();
        let splits: Vec<Vec<Vec<u32>>> = orders(quota).iter().flat_map(|sizes| splits(&ids, sizes)).collect();
        let joined = |groups: &Vec<Vec<u32>>| {
            let join =
                |split: &Vec<Vec<u32>>| groups.iter().zip(split).map(|(a, b)| [&a[..], b].concat()).collect();
            splits.iter().map(join).collect::<Vec<Vec<Vec<u32>>>>()
        };
        assignments = assignments.iter().flat_map(joined).collect();
    }
    assignments.into_iter().map(Assignment::new).collect()
}

/// All ways to write `members` as a sum of `tasks` sizes.
fn compositions(members: usize, tasks: usize) -> Vec<Vec<usize>> {
    if tasks <= 1 {
        return vec![vec![members; tasks]];
    }
    let with_first = |first: usize| {
        compositions(members - first, tasks - 1).into_iter().map(move |rest| [&[first][..], &rest].concat())
    };
    (0..=members).flat_map(with_first).collect()
}

/// The distinct orders of a quota's sizes, the given order first; all sizes if they are free.
fn orders(quota: &Quota) -> Vec<Vec<usize>> {
    let mut orders = vec![quota.members.clone()];
    match quota.sizes {
        GroupSizes::Binding => return orders,
        GroupSizes::Free => return compositions(quota.members.iter().sum(), quota.members.len()),
        GroupSizes::Parts => {}
    }
    let mut sizes = quota.members.clone();
    sizes.sort_unstable();
    loop {
        if sizes != quota.members {
            orders.push(sizes.clone());
        }
        // The next order of the sizes, lexicographically.
        let Some(last) = sizes.windows(2).rposition(|pair| pair[0] < pair[1]) else { return orders };
        let Some(larger) = sizes.iter().rposition(|size| *size > sizes[last]) else { return orders };
        sizes.swap(last, larger);
        sizes[last + 1..].reverse();
    }
}

/// All splits of these ids into parts of these sizes.
fn splits(ids: &[u32], sizes: &[usize]) -> Vec<Vec<Vec<u32>>> {
    let Some((first, rest)) = sizes.split_first() else { return vec![Vec::new()] };
    let mut found = Vec::new();
    for chosen in combinations(ids, *first) {
        let left: Vec<u32> = ids.iter().filter(|id| !chosen.contains(id)).copied().collect();
        for mut others in splits(&left, rest) {
            others.insert(0, chosen.clone());
            found.push(others);
        }
    }
    found
}

/// All subsets of this size, in lexicographic order.
fn combinations(ids: &[u32], size: usize) -> Vec<Vec<u32>> {
    if size == 0 {
        return vec![Vec::new()];
    }
    let mut found = Vec::new();
    for (at, id) in ids.iter().enumerate().take((ids.len() + 1).saturating_sub(size)) {
        for rest in combinations(&ids[at + 1..], size - 1) {
            found.push([&[*id], &rest[..]].concat());
        }
    }
    found
}

/// An assignment drawn uniformly from those that the quotas allow.
#[must_use]
pub fn draw(question: &Question, draws: &mut impl Rng) -> Assignment {
    let mut groups = vec![Vec::new(); question.tasks.len()];
    for (role, quota) in question.role_ids().zip(&question.quotas) {
        let mut ids: Vec<u32> = question.of_role(role).map(|member| member.id).collect();
        if quota.sizes == GroupSizes::Free {
            ids.iter().for_each(|id| groups[draws.random_range(0..question.tasks.len())].push(*id));
            continue;
        }
        ids.shuffle(draws);
        let orders = orders(quota);
        let Some(sizes) = orders.choose(draws) else { continue };
        let mut rest = ids.as_slice();
        for (group, size) in groups.iter_mut().zip(sizes) {
            let (part, left) = rest.split_at(*size);
            group.extend(part);
            rest = left;
        }
    }
    Assignment::new(groups)
}

/// The assignments that result from this one if two robots of one role change places or, where sizes are
/// free, if one robot goes to another task.
#[must_use]
pub fn neighbours(question: &Question, assignment: &Assignment) -> Vec<Assignment> {
    let mut found = Vec::new();
    for (role, quota) in question.role_ids().zip(&question.quotas) {
        let ids: Vec<u32> = question.of_role(role).map(|member| member.id).collect();
        if quota.sizes == GroupSizes::Free {
            let moves = ids.iter().flat_map(|id| question.task_ids().map(move |task| (*id, task)));
            let moves = moves.filter(|(id, task)| assignment.task_of(*id) != Some(*task));
            found.extend(moves.map(|(id, task)| moved(assignment, id, task)));
        }
        for (at, first) in ids.iter().enumerate() {
            for second in &ids[at + 1..] {
                if assignment.task_of(*first) != assignment.task_of(*second) {
                    found.push(exchanged(assignment, [*first, *second]));
                }
            }
        }
    }
    found
}

fn moved(assignment: &Assignment, id: u32, to: TaskId) -> Assignment {
    let mut moved = assignment.clone();
    moved.groups.iter_mut().chain([&mut moved.idle]).for_each(|group| group.retain(|other| *other != id));
    moved.groups[to.index()].push(id);
    moved.sorted()
}

fn exchanged(assignment: &Assignment, [first, second]: [u32; 2]) -> Assignment {
    let mut exchanged = assignment.clone();
    for id in exchanged.groups.iter_mut().chain([&mut exchanged.idle]).flatten() {
        *id = match *id {
            id if id == first => second,
            id if id == second => first,
            id => id,
        };
    }
    exchanged.sorted()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use rand::SeedableRng;
    use rand::rngs::ChaCha8Rng;

    use super::*;
    use crate::ids::RoleId;
    use crate::question::{Member, Need, RandomSeed, Task, hardest_first};
    use rne_core::needs::NeedVector;

    /// A question about robots over two tasks. Only the number of robots in each role matters.
    fn example(counts: &[usize]) -> Question {
        let roles = (0..).zip(counts).flat_map(|(role, count)| vec![RoleId(role); *count]);
        let member = |(id, role): (u32, RoleId)| Member {
            id,
            role,
            home: [0.0, 0.0],
            needs: NeedVector::new(vec![1.0]).unwrap(),
            levels: Vec::new(),
        };
        let tasks = [("hard", 2), ("easy", 1)];
        let order = hardest_first(tasks.iter().map(|task| task.1));
        Question {
            roles: (0..counts.len()).map(|role| format!("role {role}")).collect(),
            needs: vec![Need { name: "constant".to_owned(), weight: 1.0 }],
            tasks: tasks.map(|(name, difficulty)| Task::new(name, difficulty)).to_vec(),
            quotas: Quota::equal(counts, &order),
            members: (0..).zip(roles).map(member).collect(),
            random_seed: RandomSeed::from(1),
            ..Question::default()
        }
    }

    /// All assignments of a task to each robot, filtered by the sizes that the quotas allow: slow and plain.
    fn by_brute_force(question: &Question) -> BTreeSet<Vec<Vec<u32>>> {
        let (robots, tasks) = (question.members.len() as u32, question.tasks.len());
        let choices = (0..tasks.pow(robots)).map(|code| {
            let mut groups = vec![Vec::new(); tasks];
            (0..robots).for_each(|id| groups[code / tasks.pow(id) % tasks].push(id));
            groups
        });
        let sizes = |groups: &Vec<Vec<u32>>, role| {
            let of_role: BTreeSet<u32> = question.of_role(role).map(|member| member.id).collect();
            groups
                .iter()
                .map(|group| group.iter().filter(|id| of_role.contains(id)).count())
                .collect::<Vec<_>>()
        };
        let fits = |groups: &Vec<Vec<u32>>| {
            question.role_ids().zip(&question.quotas).all(|(role, quota)| {
                let (mut found, mut wanted) = (sizes(groups, role), quota.members.clone());
                if quota.sizes == GroupSizes::Parts {
                    found.sort_unstable();
                    wanted.sort_unstable();
                }
                quota.sizes == GroupSizes::Free || found == wanted
            })
        };
        let (fitting, others): (Vec<_>, Vec<_>) = choices.partition(fits);
        let is_allowed = |groups: &Vec<Vec<u32>>| Assignment::new(groups.clone()).check(question).is_ok();
        assert!(fitting.iter().all(is_allowed) && !others.iter().any(is_allowed));
        fitting.into_iter().collect()
    }

    fn groups(assignments: &[Assignment]) -> BTreeSet<Vec<Vec<u32>>> {
        assignments.iter().map(|assignment| assignment.groups.clone()).collect()
    }

    #[test]
    fn all_assignments_are_those_of_brute_force_each_once() {
        for counts in [&[6, 4][..], &[3, 2, 1], &[5], &[0, 2], &[1, 1, 1]] {
            for sizes in [GroupSizes::Binding, GroupSizes::Parts, GroupSizes::Free] {
                let mut question = example(counts);
                question.quotas.iter_mut().for_each(|quota| quota.sizes = sizes);
                let found = all(&question);
                assert_eq!(found.len() as u64, count(&question), "{counts:?} {sizes:?}");
                assert_eq!(groups(&found), by_brute_force(&question), "{counts:?} {sizes:?}");
                assert_eq!(groups(&found).len(), found.len(), "{counts:?} {sizes:?}");
            }
        }
    }

    #[test]
    fn three_tasks_share_a_role_in_every_order_of_their_sizes() {
        let mut question = example(&[4]);
        question.tasks.push(question.tasks[0].clone());
        question.quotas[0].members = vec![2, 1, 1];
        assert_eq!(count(&question), 12 * 3);
        assert_eq!(groups(&all(&question)), by_brute_force(&question));
    }

    #[test]
    fn a_count_that_no_number_holds_is_the_largest_number() {
        assert_eq!(count(&example(&[200, 200])), u64::MAX);
        assert_eq!(count(&example(&[20])), 184_756);
    }

    #[test]
    fn draws_and_neighbours_are_assignments_that_the_quotas_allow() {
        let question = example(&[5, 2]);
        let allowed = groups(&all(&question));
        let mut draws = ChaCha8Rng::seed_from_u64(1);
        let sample: Vec<Assignment> = (0..2_000).map(|_| draw(&question, &mut draws)).collect();
        assert_eq!(groups(&sample), allowed, "2,000 draws find all {}", allowed.len());
        for assignment in &sample[..20] {
            let near = neighbours(&question, assignment);
            assert_eq!(near.len(), 2 * 3 + 1);
            assert!(groups(&near).is_subset(&allowed));
            assert!(!near.contains(assignment));
        }
    }
}
