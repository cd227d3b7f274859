//! Questions for tests.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::NeedVector;
use teaming::question::{Need, RandomSeed, hardest_first};
use teaming::{GroupSizes, Member, Question, Quota, RoleId, Task};

/// Robots of one role at one place, by their needs of weight 1, and tasks of these ranks without places.
pub(crate) fn with_needs(needs: &[&[f64]], difficulties: &[u32]) -> Question {
    let member = |(id, needs): (u32, &&[f64])| Member {
        id,
        role: RoleId(0),
        home: [0.0, 0.0],
        needs: NeedVector::new(needs.to_vec()).unwrap(),
        levels: Vec::new(),
    };
    let task = |(number, difficulty): (usize, &u32)| Task::new(&format!("task {number}"), *difficulty);
    let order = hardest_first(difficulties.iter().copied());
    let question = Question {
        roles: vec!["role".to_owned()],
        needs: (0..needs[0].len()).map(|k| Need { name: format!("need {k}"), weight: 1.0 }).collect(),
        tasks: difficulties.iter().enumerate().map(task).collect(),
        quotas: Quota::equal(&[needs.len()], &order),
        members: (0..).zip(needs).map(member).collect(),
        ..Question::default()
    };
    question.checked().unwrap()
}

/// The six robots of `docs/policies.md`, for two tasks: `near,1,20,30` and `far,2,70,50`.
pub(crate) fn question() -> Question {
    let rows: [(u32, u16, [f64; 2], [f64; 7]); 6] = [
        (1, 0, [40.0, 14.0], [90.0, 2.1, 2.8, 120.0, 1.0, 6.0, 0.006]),
        (2, 0, [43.0, 14.0], [60.0, 1.8, 2.4, 60.0, 1.0, 6.0, 0.006]),
        (3, 1, [45.0, 16.0], [95.0, 2.2, 2.9, 140.0, 10.0, 1.0, 0.006]),
        (4, 1, [47.0, 16.0], [70.0, 1.9, 2.5, 75.0, 10.0, 1.0, 0.006]),
        (5, 2, [46.0, 18.0], [45.0, 1.4, 17.0, 90.0, 0.0, 0.0, 5.7]),
        (6, 2, [47.0, 18.0], [30.0, 1.2, 14.0, 40.0, 0.0, 0.0, 4.8]),
    ];
    let needs: Vec<&[f64]> = rows.iter().map(|(.., needs)| &needs[..]).collect();
    let mut question = with_needs(&needs, &[1, 2]);
    question.roles = (0..3).map(|role| format!("role {role}")).collect();
    question.quotas = vec![Quota { members: vec![1, 1], sizes: GroupSizes::Parts }; 3];
    for (member, (id, role, home, _)) in question.members.iter_mut().zip(rows) {
        (member.id, member.role, member.home) = (id, RoleId(role), home);
    }
    let places = [[20.0, 30.0], [70.0, 50.0]];
    question.tasks.iter_mut().zip(places).for_each(|(task, place)| task.place = Some(place));
    question.checked().unwrap()
}

/// A team of at most ten robots of up to three roles with drawn needs, for two or three tasks.
pub(crate) fn drawn(seed: u64) -> Question {
    let mut draws = ChaCha8Rng::seed_from_u64(seed);
    let counts = [draws.random_range(2..6), draws.random_range(0..4), draws.random_range(0..3)];
    let robots: usize = counts.iter().sum();
    let needs: Vec<Vec<f64>> =
        (0..robots).map(|_| (0..4).map(|_| draws.random_range(1.0..100.0)).collect()).collect();
    let needs: Vec<&[f64]> = needs.iter().map(Vec::as_slice).collect();
    let mut question = with_needs(&needs, &[1, 2, 3][..draws.random_range(2..4)]);
    question.roles = (0..3).map(|role| format!("role {role}")).collect();
    let roles = (0..3).zip(counts).flat_map(|(role, count)| std::iter::repeat_n(RoleId(role), count));
    question.members.iter_mut().zip(roles).for_each(|(member, role)| member.role = role);
    question.quotas = Quota::equal(&counts, &question.hardest_first());
    question.random_seed = RandomSeed::from(seed);
    question.checked().unwrap()
}
