//! Questions about teams of any size with needs drawn at random, for measurements of grouping alone.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::NeedVector;
use teaming::question::hardest_first;
use teaming::{Level, Member, Need, Question, Quota, RandomSeed, RoleId, Task};

/// A question about a team of carriers, suppliers and observers, to be split over so many tasks, at most
/// three. Their needs are as in the paper's scenario, drawn at random.
pub fn question(counts: [u32; 3], tasks: usize) -> Question {
    let mut draws = ChaCha8Rng::seed_from_u64(7);
    let of_role = (0..).zip(counts).flat_map(|(role, count)| (0..count).map(move |_| RoleId(role)));
    let members = of_role.zip(0..).map(|(role, id)| {
        let level =
            |mean: f64, draws: &mut ChaCha8Rng| (mean + draws.random_range(-20.0..20.0_f64)).min(100.0);
        let (energy, hp) = (level(80.0, &mut draws), level(90.0, &mut draws));
        let [capacity, resources, observing] =
            [[10.0, 0.0, 5.0], [0.0, 20.0, 5.0], [0.0, 0.0, 30.0]][role.index()];
        let needs = [hp, 2.0 * hp / 100.0, 5.0 * hp / 100.0, energy, resources, capacity, observing];
        Member {
            id,
            role,
            home: [draws.random_range(0.0..100.0), 5.0],
            needs: NeedVector::new(needs.to_vec()).expect("valid needs"),
            levels: vec![Some(energy), Some(hp)],
        }
    });
    let members = members.collect();
    let task = |(name, difficulty, x)| Task { place: Some([x, 80.0]), ..Task::new(name, difficulty) };
    let places = [("hard", 3, 20.0), ("easy", 2, 80.0), ("third", 1, 50.0)];
    let tasks: Vec<Task> = places.into_iter().take(tasks).map(task).collect();
    let order = hardest_first(tasks.iter().map(|task| task.difficulty));
    let question = Question {
        roles: ["carrier", "supplier", "observer"].map(str::to_owned).to_vec(),
        needs: ["hp", "v", "sen", "eng", "res", "cap", "obs"]
            .map(|name| Need { name: name.to_owned(), weight: 1.0 })
            .to_vec(),
        tasks,
        quotas: Quota::equal(&counts.map(|count| count as usize), &order),
        members,
        levels: Level::energy_and_hp(),
        random_seed: RandomSeed::from(1),
        ..Question::default()
    };
    question.checked().expect("a question")
}
