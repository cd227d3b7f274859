//! The rivals of RNE by brute force over small teams, with a utility that is written here anew.

use policies::utility::UtilityOptions;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::{NeedDistribution, NeedWeights, relative_entropy};
use teaming::{Account, Assignment, GroupSizes, Member, Question, Quota, assignments};

use crate::support::{decide, drawn_team, question};

/// Teams of up to nine robots of three roles, over one to three tasks of any sizes.
fn drawn_question(seed: u64) -> Question {
    let mut draws = ChaCha8Rng::seed_from_u64(seed);
    let counts = [draws.random_range(0..5), draws.random_range(0..3), draws.random_range(0..3)];
    let difficulties: Vec<u32> = (0..draws.random_range(1..4)).map(|_| draws.random_range(1..4)).collect();
    let mut question = question(drawn_team(&counts, seed), &difficulties);
    for (quota, count) in question.quotas.iter_mut().zip(counts) {
        let mut members = vec![0; difficulties.len()];
        (0..count).for_each(|_| members[draws.random_range(0..difficulties.len())] += 1);
        *quota = Quota { members, sizes: GroupSizes::Binding };
    }
    question.checked().unwrap()
}

pub fn strength(question: &Question, member: &Member) -> f64 {
    let ratio = |k: usize| {
        let of_role = question.of_role(member.role).map(|other| other.needs.values()[k]);
        let largest = of_role.fold(0.0, f64::max);
        (largest > 0.0).then(|| member.needs.values()[k] / largest)
    };
    let ratios: Vec<f64> = (0..question.needs.len()).filter_map(ratio).collect();
    ratios.iter().sum::<f64>() / ratios.len() as f64
}

/// The utility of a robot at a task, for weights of 1.
pub fn utility(question: &Question, id: u32, task: usize) -> f64 {
    let mut ranks: Vec<u32> = question.tasks.iter().map(|task| task.difficulty).collect();
    ranks.sort_unstable();
    ranks.dedup();
    let rank = ranks.iter().position(|rank| *rank == question.tasks[task].difficulty).unwrap() + 1;
    let member = question.members.iter().find(|member| member.id == id).unwrap();
    let worth = rank as f64 / ranks.len() as f64;
    worth * strength(question, member) - way(question, member, task)
}

/// The way of a robot to a task, over the largest one in the question.
fn way(question: &Question, member: &Member, task: usize) -> f64 {
    let way = |home: [f64; 2], task: usize| {
        let place = question.tasks[task].place.unwrap();
        libm::hypot(home[0] - place[0], home[1] - place[1])
    };
    let tasks = || 0..question.tasks.len();
    let ways = question.members.iter().flat_map(|member| tasks().map(|task| way(member.home, task)));
    way(member.home, task) / ways.fold(0.0, f64::max)
}

pub fn total(question: &Question, assignment: &Assignment) -> f64 {
    let groups = assignment.groups.iter().enumerate();
    groups.flat_map(|(task, ids)| ids.iter().map(move |id| utility(question, *id, task))).sum()
}

/// The difference between the strongest and the weakest group that gets robots.
pub fn spread(question: &Question, assignment: &Assignment) -> f64 {
    let of = |id: &u32| strength(question, question.members.iter().find(|member| member.id == *id).unwrap());
    let groups = assignment.groups.iter().filter(|group| !group.is_empty());
    let sums: Vec<f64> = groups.map(|group| group.iter().map(of).sum()).collect();
    sums.iter().copied().fold(0.0, f64::max) - sums.iter().copied().reduce(f64::min).unwrap_or(0.0)
}

/// The sum over pairs of one role in one group of the mean of both relative entropies.
pub fn distrust(question: &Question, assignment: &Assignment) -> f64 {
    let weights = NeedWeights::new(question.weights()).unwrap();
    let shares = |member: &Member| NeedDistribution::of_agent(&member.needs, &weights).unwrap();
    let mut sum = 0.0;
    for (at, a) in question.members.iter().enumerate() {
        for b in &question.members[at + 1..] {
            let together = assignment.task_of(a.id) == assignment.task_of(b.id);
            if together && a.role == b.role {
                let towards = |a, b| relative_entropy(&shares(a), &shares(b)).unwrap().nats().unwrap();
                sum += f64::midpoint(towards(a, b), towards(b, a));
            }
        }
    }
    sum
}

#[test]
fn optimal_balance_and_similar_are_the_best_of_all_assignments_of_1_000_teams() {
    type Measure = fn(&Question, &Assignment) -> f64;
    let lost: Measure = |question, assignment| -total(question, assignment);
    for seed in 0..1_000 {
        let question = drawn_question(seed);
        let all = assignments::all(&question);
        for (policy, measure) in [("OPTIMAL", lost), ("BALANCE", spread), ("SIMILAR", distrust)] {
            let decision = decide(policy, &question);
            assert!(decision.proven_optimal);
            let least = all.iter().map(|assignment| measure(&question, assignment)).fold(f64::MAX, f64::min);
            let found = measure(&question, &decision.assignment);
            assert!((found - least).abs() < 1e-9, "{policy}, seed {seed}: {found}, brute force {least}");
            if let Account::Text(text) = decision.account {
                let sum: f64 = text.rsplit(' ').next().unwrap().parse().unwrap();
                assert!((sum + found).abs() < 1e-9, "{text}");
            }
        }
    }
}

#[test]
fn all_protocols_and_graphs_of_greedy_have_one_answer_on_1_000_teams() {
    for seed in 0..1_000 {
        let question = drawn_question(seed);
        let central = decide("GREEDY", &question);
        assert_eq!(central.account, Account::None);
        for protocol in ["Ssi", "Cbba"] {
            for graph in ["Full", "Ring", "Line"] {
                let policy = format!("GREEDY(protocol: {protocol}, graph: {graph})");
                let decision = decide(&policy, &question);
                assert_eq!(decision.assignment, central.assignment, "{policy}, seed {seed}");
                let Account::Protocol(sent) = decision.account else { panic!("{:?}", decision.account) };
                let diameter = |robots: usize| match graph {
                    "Full" => robots.saturating_sub(1).min(1),
                    "Ring" => robots / 2,
                    _ => robots.saturating_sub(1),
                };
                let of_role = |role| question.of_role(role).count();
                let most = question.role_ids().map(|role| of_role(role) * diameter(of_role(role)) + 1).max();
                assert!(sent.rounds <= most.unwrap() as u64, "{policy}, seed {seed}: {sent:?}");
            }
        }
        let nearest = decide("GREEDY(quality: 0)", &question).assignment;
        assert_eq!(nearest, decide("DIS", &question).assignment, "seed {seed}");
        assert!(
            total(&question, &central.assignment)
                <= total(&question, &decide("OPTIMAL", &question).assignment) + 1e-9
        );
    }
}

#[test]
fn equal_robots_go_by_their_ids() {
    let mut members = drawn_team(&[4], 1);
    let first = members[0].clone();
    members.iter_mut().for_each(|member| *member = Member { id: member.id, ..first.clone() });
    let question = question(members, &[1, 2]);
    for policy in ["OPTIMAL", "GREEDY(protocol: Cbba, graph: Line)", "SNAKE", "BALANCE", "SIMILAR"] {
        let expected = if policy == "SNAKE" { [[98, 99], [97, 100]] } else { [[99, 100], [97, 98]] };
        assert_eq!(decide(policy, &question).assignment.groups, expected, "{policy}");
    }
}

#[test]
fn larger_teams_are_searched_by_swaps_and_say_so() {
    let question = question(drawn_team(&[12, 8, 4], 2), &[1, 2, 3]);
    for (policy, measure) in [("BALANCE", spread as fn(&Question, &Assignment) -> f64), ("SIMILAR", distrust)]
    {
        let decision = decide(policy, &question);
        assert!(!decision.proven_optimal);
        let found = measure(&question, &decision.assignment);
        let better = assignments::neighbours(&question, &decision.assignment)
            .iter()
            .map(|other| measure(&question, other))
            .fold(f64::MAX, f64::min);
        assert!(found <= better + 1e-9, "{policy}: {found}, a swap away {better}");
        assert!(found < measure(&question, &decide("RANDOM", &question).assignment));
    }
}

/// No robot gains by a move to another task, by the utility that is written here anew.
#[test]
fn grape_is_stable_in_ten_thousand_teams() {
    let grape = policies::standard().parse("GRAPE").unwrap();
    for seed in 0..10_000 {
        let mut question = drawn_question(seed);
        question.quotas.iter_mut().for_each(|quota| quota.sizes = GroupSizes::Free);
        let groups = grape.decide(&question).unwrap().assignment.groups;
        let tasks = question.tasks.len();
        for member in &question.members {
            let of_role = question.of_role(member.role).count() as f64;
            let own = groups.iter().position(|ids| ids.contains(&member.id)).unwrap();
            let gets = |task: usize| {
                let is_mate = |id: &&u32| {
                    **id != member.id && question.of_role(member.role).any(|other| other.id == **id)
                };
                let count = groups[task].iter().filter(is_mate).count() as f64 + 1.0;
                let share = libm::log2(count + 1.0) / libm::log2(of_role / tasks as f64 + 1.0) / count;
                let way = way(&question, member, task);
                (utility(&question, member.id, task) + way) * share - way
            };
            let best = (0..tasks).map(gets).fold(f64::MIN, f64::max);
            assert!(gets(own) >= best - 1e-9, "seed {seed}, robot {}", member.id);
        }
    }
}

#[test]
fn a_missing_place_is_named_unless_the_way_does_not_count() {
    let mut question = question(drawn_team(&[4, 3, 1], 6), &[1, 2]);
    question.tasks[0].place = None;
    let registry = policies::standard();
    for policy in ["OPTIMAL", "GREEDY", "GRAPE", "KMEANS", "SPECTRAL"] {
        let error = registry.parse(policy).unwrap().decide(&question).unwrap_err();
        let expected = format!("policy {policy} needs the place of each task, which is missing");
        assert_eq!(error.to_string(), expected);
        decide(&format!("{policy}(distance: 0)"), &question);
    }
    ["SNAKE", "BALANCE", "SIMILAR", "BANDIT"].iter().for_each(|policy| drop(decide(policy, &question)));
}

#[test]
fn options_out_of_range_are_refused() {
    let registry = policies::standard();
    let refused = |text: &str| registry.parse(text).unwrap_err().to_string();
    for policy in ["OPTIMAL", "GREEDY", "GRAPE", "KMEANS", "SPECTRAL"] {
        let error = refused(&format!("{policy}(quality: -1)"));
        assert!(
            error.starts_with(&format!("policy {policy}: quality must be from 0 to 100, found")),
            "{error}"
        );
        let error = refused(&format!("{policy}(distance: 1e300)"));
        assert!(error.contains("distance must be from 0 to 100"), "{error}");
    }
    assert!(refused("BANDIT(width: -0.5)").contains("width must be from 0 to 10"));
    assert!(refused("GREEDY(protocol: Auction)").contains("policy GREEDY: "));
    assert!(refused("GRAPE(reward: Convex)").contains("policy GRAPE: "));
    assert_eq!(refused("SNAKE(quality: 1)"), "policy SNAKE: it has no options, found \"(quality: 1)\"");
    assert_eq!(UtilityOptions::default(), UtilityOptions { quality: 1.0, distance: 1.0 });
}
