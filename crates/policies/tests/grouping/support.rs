//! Teams and questions.

use policies::RneOptions;
use policies::rne::{HardRule, MergeReading, ScoreDirection};
use proptest::prelude::*;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::NeedVector;
use teaming::question::hardest_first;
use teaming::{Decision, Level, Member, Need, Question, Quota, RandomSeed, RoleId, Task};

pub const ROLES: [&str; 3] = ["Carrier", "Supplier", "Observer"];

/// Of two tasks, `easy` stands first in the table and `hard` second.
pub const EASY: usize = 0;
pub const HARD: usize = 1;

const PLACES: [[f64; 2]; 4] = [[70.0, 50.0], [15.0, 60.0], [40.0, 80.0], [5.0, 20.0]];

/// Robots of the paper's kinds with these levels (energy, HP) in percent, in order of roles.
pub fn team(counts: [usize; 3], levels: &[(f64, f64)]) -> Vec<Member> {
    let roles = (0..3).zip(counts).flat_map(|(role, count)| vec![role; count]);
    let robots = roles.zip(levels).enumerate();
    robots
        .map(|(id, (role, (energy, hp)))| {
            let [hp_max, v, sen, eng, res, cap, obs] = match role {
                0 => [100.0, 2.25, 3.0, 150.0, 1.0, 6.0, 0.006],
                1 => [100.0, 2.25, 3.0, 150.0, 10.0, 1.0, 0.006],
                _ => [50.0, 1.5, 18.0, 100.0, 0.0, 0.0, 6.0],
            };
            let factor = 0.5 + 0.5 * hp / 100.0;
            let (hp_now, energy_now) = (hp_max * hp / 100.0, eng * energy / 100.0);
            let needs = vec![hp_now, v * factor, sen * factor, energy_now, res, cap, obs * factor];
            Member {
                id: id as u32,
                role: RoleId(role),
                home: [40.0 + 2.0 * id as f64, 15.0],
                needs: NeedVector::new(needs).unwrap(),
                levels: vec![Some(*energy), Some(*hp)],
            }
        })
        .collect()
}

/// Robots whose needs are drawn one by one, so that no two groups have the same score.
pub fn drawn_team(counts: &[usize], seed: u64) -> Vec<Member> {
    let mut draws = ChaCha8Rng::seed_from_u64(seed);
    let mut draw = move || draws.random_range(1.0..100.0);
    let roles = (0..).zip(counts).flat_map(|(role, count)| vec![role; *count]);
    let robots = roles.enumerate();
    robots
        .map(|(place, role)| Member {
            id: 100 - place as u32, // the last robot of the list comes first
            role: RoleId(role),
            home: [draw(), draw()],
            needs: NeedVector::new((0..5).map(|_| draw()).collect()).unwrap(),
            levels: vec![Some(draw()), Some(draw())],
        })
        .collect()
}

pub fn any_team(most: usize) -> impl Strategy<Value = Vec<Member>> {
    ([0..=most, 0..=most, 0..=most]).prop_flat_map(|counts| {
        let level = || 1.0..100.0_f64;
        let levels = proptest::collection::vec((level(), level()), counts.iter().sum::<usize>());
        levels.prop_map(move |levels| team(counts, &levels))
    })
}

/// A question with these members and tasks of these ranks, quotas as equal as possible, and weights 1.
pub fn question(members: Vec<Member>, difficulties: &[u32]) -> Question {
    let names = ["easy", "hard", "third", "fourth"].map(str::to_owned).into_iter();
    let names = names.chain((5..).map(|number| format!("task {number}")));
    let places = PLACES.into_iter().chain((5..).map(|x| [f64::from(x), 90.0]));
    let task = |((name, place), difficulty): ((String, [f64; 2]), &u32)| Task {
        place: Some(place),
        ..Task::new(&name, *difficulty)
    };
    let count = |role| members.iter().filter(|member| member.role == RoleId(role)).count();
    let counts: Vec<usize> = (0..3).map(count).collect();
    let needs = members.first().map_or(7, |member| member.needs.values().len());
    let question = Question {
        roles: ROLES.map(str::to_owned).to_vec(),
        needs: (1..=needs).map(|k| Need { name: format!("need {k}"), weight: 1.0 }).collect(),
        tasks: names.zip(places).zip(difficulties).map(task).collect(),
        quotas: Quota::equal(&counts, &hardest_first(difficulties.iter().copied())),
        members,
        levels: Level::energy_and_hp(),
        random_seed: RandomSeed::from(5),
        ..Question::default()
    };
    question.checked().unwrap()
}

/// A question with an easy and a hard task.
pub fn two_tasks(members: Vec<Member>) -> Question {
    question(members, &[1, 2])
}

/// The decision of a policy, given in RON. Panics if it does not answer the question.
#[track_caller]
pub fn decide(policy: &str, question: &Question) -> Decision {
    let decision = policies::standard().parse(policy).unwrap().decide(question).unwrap();
    let alternatives = decision.alternatives.iter().map(|other| &other.assignment);
    for assignment in std::iter::once(&decision.assignment).chain(alternatives) {
        assignment.check(question).unwrap_or_else(|error| panic!("{policy}: {error}"));
        check_sizes(policy, question, &assignment.groups);
    }
    decision
}

/// Checks that the parts of a role have the sizes of its quota: task by task, except under the RNE policy.
#[track_caller]
fn check_sizes(policy: &str, question: &Question, groups: &[Vec<u32>]) {
    for (role, quota) in question.role_ids().zip(&question.quotas) {
        let is_of_role = |id: &&u32| question.members.iter().any(|m| m.id == **id && m.role == role);
        let mut found: Vec<usize> = groups.iter().map(|ids| ids.iter().filter(is_of_role).count()).collect();
        let mut expected = quota.members.clone();
        if policy.starts_with("RNE") {
            found.sort_unstable();
            expected.sort_unstable();
        }
        assert_eq!(found, expected, "{policy}: sizes of role {role:?}");
    }
}

pub fn names() -> Vec<String> {
    policies::standard().names().into_iter().map(str::to_owned).collect()
}

/// The RNE policy with these options, as a text.
pub fn rne(options: &RneOptions) -> String {
    let RneOptions { score, merge, hard_rule, sort, scale, .. } = options;
    format!("RNE(score: {score:?}, merge: {merge:?}, hard_rule: {hard_rule:?}, sort: {sort}, scale: {scale})")
}

pub const SCORES: [ScoreDirection; 4] = [
    ScoreDirection::MaxOfBoth,
    ScoreDirection::FirstToSecond,
    ScoreDirection::Sum,
    ScoreDirection::JensenShannon,
];

/// Every combination of the RNE policy's options.
pub fn all_options() -> Vec<RneOptions> {
    use HardRule::{Capability, IntraGroupTrust, MeanEnergy, MeanHp};
    let mut all = Vec::new();
    for score in SCORES {
        for merge in [MergeReading::Apart, MergeReading::Together] {
            for hard_rule in [IntraGroupTrust, Capability, MeanEnergy, MeanHp] {
                for (sort, scale) in [(false, true), (true, true), (false, false), (true, false)] {
                    all.push(RneOptions { score, merge, hard_rule, sort, scale, ..RneOptions::default() });
                }
            }
        }
    }
    all
}
