//! Two tasks, the paper's case: brute force over halves, written independently of the oracle for any number
//! of tasks.

use policies::RneOptions;
use policies::rne::{HardRule, ScoreDirection};
use proptest::prelude::*;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::{
    NeedDistribution, NeedVector, NeedWeights, RelativeNeedsEntropy, jeffreys, jensen_shannon,
    relative_entropy,
};
use teaming::{Member, RoleId};

use crate::oracle::{Oracle, as_set, is_close, nats};
use crate::support::{EASY, HARD, all_options, decide, rne, team, two_tasks};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn rne_splits_a_role_as_brute_force_does(
        levels in proptest::collection::vec((1.0..100.0_f64, 1.0..100.0_f64), 2..9)
    ) {
        let members = team([levels.len(), 0, 0], &levels);
        let found = nats(decide("RNE", &two_tasks(members.clone())).score);
        let best = best_split_by_brute_force(&members);
        prop_assert!((found - best).abs() < 1e-11, "found {found}, brute force {best}");
    }
}

/// Over all subsets of half the robots, with weights 1 / maximum: the largest RNE of either direction.
fn best_split_by_brute_force(members: &[Member]) -> f64 {
    let weights = scaled_weights(members);
    let half = members.len() / 2;
    (0..1_u32 << members.len())
        .filter(|chosen| chosen.count_ones() as usize == half)
        .flat_map(|chosen| {
            let [p, q] = [true, false].map(|inside| side(members, chosen, inside, &weights));
            [relative_entropy(&p, &q).unwrap(), relative_entropy(&q, &p).unwrap()]
        })
        .map(|rne| rne.nats().unwrap())
        .fold(0.0, f64::max)
}

/// The distribution of the members whose bits are set, or of the other members.
fn side(members: &[Member], chosen: u32, inside: bool, weights: &NeedWeights) -> NeedDistribution {
    let of_side = (0..members.len()).filter(|i| (chosen >> i & 1 == 1) == inside);
    let needs: Vec<NeedVector> = of_side.map(|i| members[i].needs.clone()).collect();
    NeedDistribution::of_group(&needs, weights).unwrap()
}

/// Compares with all merges of the best halves, for the default reading.
#[test]
fn rne_merges_as_brute_force_does() {
    for seed in 0..20 {
        let members = random_team(seed);
        let found = decide("RNE", &two_tasks(members.clone()));
        let (one, other, score) = merge_by_brute_force(&members);
        assert!((nats(found.score) - score).abs() < 1e-11, "seed {seed}");
        let more_trust = mean_rne_within(&members, &one) < mean_rne_within(&members, &other);
        let hard = if more_trust { &one } else { &other };
        let found = &found.assignment.groups[HARD];
        assert_eq!(found, hard, "seed {seed}: the group with the lower mean RNE within takes the hard task");
    }
}

/// A number of one robot.
type Level<'a> = &'a dyn Fn(&Member) -> f64;

/// The other hard rules, from their definitions.
#[test]
fn each_hard_rule_sends_the_group_that_it_names() {
    for seed in 0..10 {
        let members = random_team(seed);
        let mean = |ids: &[u32], level: Level| {
            ids.iter().map(|id| level(&members[*id as usize])).sum::<f64>() / ids.len() as f64
        };
        let maximum = |k: usize| members.iter().map(|m| m.needs.values()[k]).fold(0.0, f64::max);
        let capability = |m: &Member| (0..7).map(|k| m.needs.values()[k] / maximum(k)).sum::<f64>();
        let rules: [(HardRule, Level); 3] = [
            (HardRule::MeanEnergy, &|m| m.levels[0].unwrap()),
            (HardRule::MeanHp, &|m| m.levels[1].unwrap()),
            (HardRule::Capability, &capability),
        ];
        for (hard_rule, level) in rules {
            let policy = rne(&RneOptions { hard_rule, ..RneOptions::default() });
            let groups = decide(&policy, &two_tasks(members.clone())).assignment.groups;
            assert!(mean(&groups[HARD], level) >= mean(&groups[EASY], level), "seed {seed}, {hard_rule:?}");
        }
    }
}

/// Each score direction finds the largest value of its own definition, among all splits of a role.
#[test]
fn each_score_is_the_largest_of_its_definition() {
    for seed in 0..5 {
        let members: Vec<Member> = random_team(seed).into_iter().filter(|m| m.role == RoleId(0)).collect();
        let weights = scaled_weights(&members);
        for score in [ScoreDirection::Sum, ScoreDirection::JensenShannon, ScoreDirection::FirstToSecond] {
            let best = (0..1_u32 << members.len())
                .filter(|chosen| chosen.count_ones() as usize == members.len() / 2 && chosen & 1 == 1)
                .map(|chosen| {
                    let [p, q] = [true, false].map(|inside| side(&members, chosen, inside, &weights));
                    match score {
                        ScoreDirection::Sum => jeffreys(&p, &q).unwrap().nats().unwrap(),
                        ScoreDirection::JensenShannon => jensen_shannon(&p, &q).unwrap(),
                        _ => relative_entropy(&p, &q).unwrap().nats().unwrap(),
                    }
                })
                .fold(0.0, f64::max);
            let policy = rne(&RneOptions { score, ..RneOptions::default() });
            let found = nats(decide(&policy, &two_tasks(members.clone())).score);
            assert!((found - best).abs() < 1e-11, "seed {seed}, {score:?}");
        }
    }
}

#[test]
fn every_combination_of_options_finds_what_its_definition_says() {
    for seed in 0..4 {
        let question = two_tasks(random_team(seed));
        for options in all_options() {
            let found = decide(&rne(&options), &question);
            let oracle = Oracle::new(&question, options.clone());
            let groups = oracle.groups();
            assert_eq!(found.assignment.groups, oracle.by_task(&groups), "seed {seed}, {options:?}");
            assert_eq!(as_set(&found.assignment.groups), as_set(&groups));
            let (found, best) = (nats(found.score), oracle.total(&groups));
            assert!(is_close(found, best), "seed {seed}, {options:?}: found {found}, brute force {best}");
        }
    }
}

fn random_team(seed: u64) -> Vec<Member> {
    let mut draws = ChaCha8Rng::seed_from_u64(seed);
    let mut level = || draws.random_range(5.0..100.0);
    let levels: Vec<(f64, f64)> = (0..12).map(|_| (level(), level())).collect();
    team([6, 4, 2], &levels)
}

fn scaled_weights(members: &[Member]) -> NeedWeights {
    let maximum = |k: usize| members.iter().map(|m| m.needs.values()[k]).fold(0.0, f64::max);
    NeedWeights::new((0..7).map(|k| 1.0 / maximum(k)).collect()).unwrap()
}

fn needs_of(members: &[Member], ids: &[u32]) -> Vec<NeedVector> {
    ids.iter().map(|id| members[*id as usize].needs.clone()).collect()
}

/// Definition 2, averaged: the mean RNE of the members to their own group's distribution.
fn mean_rne_within(members: &[Member], ids: &[u32]) -> f64 {
    let weights = scaled_weights(members);
    let needs = needs_of(members, ids);
    let whole = NeedDistribution::of_group(&needs, &weights).unwrap();
    let own = needs.iter().map(|needs| NeedDistribution::of_agent(needs, &weights).unwrap());
    own.map(|own| relative_entropy(&own, &whole).unwrap().nats().unwrap()).sum::<f64>() / ids.len() as f64
}

fn merge_by_brute_force(members: &[Member]) -> (Vec<u32>, Vec<u32>, f64) {
    let weights = scaled_weights(members);
    let score = |one: &[u32], other: &[u32]| {
        let [p, q] =
            [one, other].map(|ids| NeedDistribution::of_group(&needs_of(members, ids), &weights).unwrap());
        let value = |rne: RelativeNeedsEntropy| rne.nats().unwrap_or(f64::INFINITY);
        value(relative_entropy(&p, &q).unwrap()).max(value(relative_entropy(&q, &p).unwrap()))
    };
    let mut merged: Option<(Vec<u32>, Vec<u32>)> = None;
    for role in [0, 1, 2].map(RoleId) {
        let ids: Vec<u32> = members.iter().filter(|m| m.role == role).map(|m| m.id).collect();
        let halves = (0..1_u32 << ids.len()).filter(|chosen| chosen.count_ones() as usize == ids.len() / 2);
        let sides = halves.map(|chosen| {
            let of_side = |inside: bool| {
                let places = (0..ids.len()).filter(|i| (chosen >> i & 1 == 1) == inside);
                places.map(|i| ids[i]).collect::<Vec<u32>>()
            };
            (of_side(true), of_side(false))
        });
        let (a, b) = sides.max_by(|x, y| score(&x.0, &x.1).total_cmp(&score(&y.0, &y.1))).unwrap();
        merged = Some(match merged {
            None => (a, b),
            Some((p, q)) => {
                let straight = ([&p[..], &a].concat(), [&q[..], &b].concat());
                let crossed = ([p, b].concat(), [q, a].concat());
                let is_straight = score(&straight.0, &straight.1) >= score(&crossed.0, &crossed.1);
                if is_straight { straight } else { crossed }
            }
        });
    }
    let (mut one, mut other) = merged.unwrap();
    let best = score(&one, &other);
    one.sort_unstable();
    other.sort_unstable();
    (one, other, best)
}
