//! Random questions, for checks of policies: one to four roles, one to four tasks, sizes of all kinds.

mod evidence;

pub use evidence::with_evidence;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::NeedVector;
use teaming::question::hardest_first;
use teaming::{GroupSizes, Level, Member, Need, Question, Quota, RandomSeed, RoleId, Task};

/// Names of the needs.
const NEEDS: [&str; 4] = ["hp", "v", "eng", "cap"];

/// Largest number of roles, of tasks, and of members of a role.
const MOST: [usize; 3] = [4, 4, 6];

/// The question of a seed. Every fact is given that a policy may look at, but for history and evidence.
#[must_use]
pub fn question(seed: u64) -> Question {
    let mut draws = ChaCha8Rng::seed_from_u64(seed);
    let tasks = tasks(&mut draws);
    let mut members = Vec::new();
    for role in 0..draws.random_range(1..=MOST[0]) {
        for _ in 0..draws.random_range(0..=MOST[2]) {
            members.push(member(role as u16, &mut draws));
        }
    }
    if members.is_empty() {
        members.push(member(0, &mut draws));
    }
    let roles = members.iter().map(|member| member.role.index() + 1).max().unwrap_or(1);
    for (member, id) in members.iter_mut().zip(ids(&mut draws)) {
        member.id = id;
    }
    let order = hardest_first(tasks.iter().map(|task| task.difficulty));
    let quota = |role: usize, draws: &mut ChaCha8Rng| {
        let count = members.iter().filter(|member| member.role.index() == role).count();
        let sizes = [GroupSizes::Parts, GroupSizes::Free][draws.random_range(0..2)];
        let asks = draws.random_bool(0.3);
        let asked = |draws: &mut ChaCha8Rng| draws.random_bool(0.5).then(|| draws.random_range(0..4));
        let asked: Vec<Option<usize>> = tasks.iter().map(|_| asks.then(|| asked(draws)).flatten()).collect();
        Quota::share(count, &asked, &order, sizes)
    };
    let quotas = (0..roles).map(|role| quota(role, &mut draws)).collect();
    let question = Question {
        roles: (0..roles).map(|role| format!("role {role}")).collect(),
        needs: NEEDS.map(|name| Need { name: name.to_owned(), weight: 1.0 }).to_vec(),
        levels: Level::energy_and_hp(),
        tasks,
        quotas,
        members,
        may_idle: draws.random_bool(0.2),
        random_seed: RandomSeed::from(seed),
        ..Question::default()
    };
    question.clone().checked().unwrap_or(question) // its ids are sorted
}

fn tasks(draws: &mut ChaCha8Rng) -> Vec<Task> {
    let count = draws.random_range(1..=MOST[1]);
    let task = |number: usize| Task {
        place: Some([draws.random_range(0.0..100.0), draws.random_range(0.0..100.0)]),
        rescuees: Some(draws.random_range(0..30)),
        ..Task::new(&format!("task {number}"), draws.random_range(1..5))
    };
    (0..count).map(task).collect()
}

fn member(role: u16, draws: &mut ChaCha8Rng) -> Member {
    // Some robots have the same level, so that ties are met.
    let level = |draws: &mut ChaCha8Rng| match draws.random_range(0..4) {
        0 => f64::from(draws.random_range(0..3)) * 50.0,
        _ => draws.random_range(0.0..100.0),
    };
    let (energy, hp) = (level(draws), level(draws));
    let needs = [hp, draws.random_range(0.5..3.0), energy, f64::from(draws.random_range(1..8))];
    Member {
        id: 0,
        role: RoleId(role),
        home: [draws.random_range(0.0..100.0), draws.random_range(0.0..100.0)],
        needs: NeedVector::new(needs.to_vec()).expect("finite and above 0"),
        levels: vec![Some(energy), Some(hp)],
    }
}

/// Ids with gaps, ascending.
fn ids(draws: &mut ChaCha8Rng) -> impl Iterator<Item = u32> {
    let gap = draws.random_range(1..4);
    (draws.random_range(0..3)..).step_by(gap)
}
