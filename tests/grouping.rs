//! Grouping policies: properties of every partition, and brute force for small teams.

use proptest::prelude::*;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::grouping::EXACT_ROLE_SIZE;
use rne_core::grouping::rne::{HardRule, MergeReading, ScoreDirection};
use rne_core::{
    Grouping, Member, NeedDistribution, NeedVector, NeedWeights, RneOptions, Role, RoleQuota, TaskPositions,
    Team, policy_named, policy_names, relative_entropy,
};

const TASKS: TaskPositions = TaskPositions { easy: [70.0, 50.0], hard: [15.0, 60.0] };

fn group(policy: &str, options: &RneOptions, members: &[Member]) -> Grouping {
    let team = Team::new(members.to_vec(), Some(TASKS)).unwrap();
    policy_named(policy, options).unwrap().group(&team, &mut ChaCha8Rng::seed_from_u64(5)).unwrap()
}

/// Robots of the paper's kinds with these levels (energy, HP) in percent, in order of roles.
fn team(counts: [usize; 3], levels: &[(f64, f64)]) -> Vec<Member> {
    let roles = Role::ALL.into_iter().zip(counts).flat_map(|(role, count)| vec![role; count]);
    roles
        .zip(levels)
        .enumerate()
        .map(|(id, (role, (energy, hp)))| {
            let [hp_max, v, sen, eng, res, cap, obs] = match role {
                Role::Carrier => [100.0, 2.25, 3.0, 150.0, 1.0, 6.0, 0.006],
                Role::Supplier => [100.0, 2.25, 3.0, 150.0, 10.0, 1.0, 0.006],
                Role::Observer => [50.0, 1.5, 18.0, 100.0, 0.0, 0.0, 6.0],
            };
            let factor = 0.5 + 0.5 * hp / 100.0;
            let needs = vec![
                hp_max * hp / 100.0,
                v * factor,
                sen * factor,
                eng * energy / 100.0,
                res,
                cap,
                obs * factor,
            ];
            Member {
                id: id as u32,
                role,
                position: [40.0 + 2.0 * id as f64, 15.0],
                needs: NeedVector::new(needs).unwrap(),
                energy_level: Some(*energy),
                hp_level: Some(*hp),
            }
        })
        .collect()
}

fn any_team(most: usize) -> impl Strategy<Value = Vec<Member>> {
    ([0..=most, 0..=most, 0..=most]).prop_flat_map(|counts| {
        let levels =
            proptest::collection::vec((1.0..100.0_f64, 1.0..100.0_f64), counts.iter().sum::<usize>());
        levels.prop_map(move |levels| team(counts, &levels))
    })
}

fn all_options() -> Vec<RneOptions> {
    let mut all = Vec::new();
    for score in [
        ScoreDirection::MaxOfBoth,
        ScoreDirection::FirstToSecond,
        ScoreDirection::Sum,
        ScoreDirection::JensenShannon,
    ] {
        for merge in [MergeReading::Apart, MergeReading::Together] {
            for hard_rule in
                [HardRule::IntraGroupTrust, HardRule::Capability, HardRule::MeanEnergy, HardRule::MeanHp]
            {
                for (sort, scale) in [(false, true), (true, true), (false, false)] {
                    all.push(RneOptions { score, merge, hard_rule, sort, scale, ..RneOptions::default() });
                }
            }
        }
    }
    all
}

#[track_caller]
fn check_partition(members: &[Member], grouping: &Grouping) {
    let mut ids: Vec<u32> = grouping.easy.iter().chain(&grouping.hard).copied().collect();
    ids.sort_unstable();
    let all: Vec<u32> = members.iter().map(|member| member.id).collect();
    assert_eq!(ids, all, "every robot is in exactly one group");
    for role in Role::ALL {
        let of_role = |ids: &[u32]| ids.iter().filter(|id| members[**id as usize].role == role).count();
        let (easy, hard) = (of_role(&grouping.easy), of_role(&grouping.hard));
        assert!(easy.abs_diff(hard) <= 1, "{role:?}: {easy} and {hard} are not halves");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_policy_forms_halves_of_every_role(members in any_team(6)) {
        for policy in policy_names() {
            check_partition(&members, &group(policy, &RneOptions::default(), &members));
        }
        for options in all_options() {
            check_partition(&members, &group("RNE", &options, &members));
        }
    }

    #[test]
    fn the_order_in_which_robots_are_listed_decides_nothing(members in any_team(6), seed in 0..1000_u64) {
        use rand::seq::SliceRandom;
        let mut shuffled = members.clone();
        shuffled.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
        for policy in policy_names() {
            let options = RneOptions::default();
            prop_assert_eq!(group(policy, &options, &members), group(policy, &options, &shuffled));
        }
    }

    #[test]
    fn scaling_all_weights_changes_no_group(members in any_team(5), factor in 0.01..100.0_f64) {
        let with = |weight: f64| {
            let weights = [6.0, 4.0, 2.0, 3.0, 1.0, 5.0, 2.5].map(|w| w * weight).to_vec();
            group("RNE", &RneOptions { weights: Some(weights), ..RneOptions::default() }, &members)
        };
        let (one, other) = (with(1.0), with(factor));
        prop_assert_eq!((one.easy, one.hard), (other.easy, other.hard));
    }

    #[test]
    fn rne_splits_a_role_as_brute_force_does(levels in proptest::collection::vec((1.0..100.0_f64, 1.0..100.0_f64), 2..9)) {
        let members = team([levels.len(), 0, 0], &levels);
        let found = group("RNE", &RneOptions::default(), &members).score.unwrap().nats().unwrap();
        let best = best_split_by_brute_force(&members);
        prop_assert!((found - best).abs() < 1e-11, "found {found}, brute force {best}");
    }

    #[test]
    fn baselines_send_the_better_half_of_each_role_to_the_hard_task(members in any_team(7)) {
        let level = |policy: &str, id: u32| {
            let member = &members[id as usize];
            if policy == "ENG" { member.energy_level.unwrap() } else { member.hp_level.unwrap() }
        };
        for policy in ["ENG", "HP_DIS"] {
            let grouping = group(policy, &RneOptions::default(), &members);
            for role in Role::ALL {
                let of_role = |ids: &[u32]| -> Vec<f64> {
                    let of_role = ids.iter().filter(|id| members[**id as usize].role == role);
                    of_role.map(|id| level(policy, *id)).collect()
                };
                let (hard, easy) = (of_role(&grouping.hard), of_role(&grouping.easy));
                prop_assert_eq!(hard.len(), RoleQuota::halves(hard.len() + easy.len()).hard);
                let worst_hard = hard.into_iter().fold(f64::INFINITY, f64::min);
                prop_assert!(easy.into_iter().all(|level| level <= worst_hard));
            }
        }
    }

    #[test]
    fn dis_takes_the_nearest_pair_first(members in any_team(7)) {
        let grouping = group("DIS", &RneOptions::default(), &members);
        prop_assert_eq!(distance_by_brute_force(&members), (grouping.easy, grouping.hard));
    }
}

/// Over all subsets of half the robots, with weights 1 / maximum: the largest RNE of either direction.
fn best_split_by_brute_force(members: &[Member]) -> f64 {
    let needs: Vec<NeedVector> = members.iter().map(|member| member.needs.clone()).collect();
    let maximum = |k: usize| needs.iter().map(|needs| needs.values()[k]).fold(0.0, f64::max);
    let weights = NeedWeights::new((0..7).map(|k| 1.0 / maximum(k)).collect()).unwrap();
    let of = |chosen: u32, inside: bool| {
        let side: Vec<NeedVector> =
            (0..needs.len()).filter(|i| (chosen >> i & 1 == 1) == inside).map(|i| needs[i].clone()).collect();
        NeedDistribution::of_group(&side, &weights).unwrap()
    };
    let half = needs.len() / 2;
    (0..1_u32 << needs.len())
        .filter(|chosen| chosen.count_ones() as usize == half)
        .flat_map(|chosen| {
            let (p, q) = (of(chosen, true), of(chosen, false));
            [relative_entropy(&p, &q).unwrap(), relative_entropy(&q, &p).unwrap()]
        })
        .map(|rne| rne.nats().unwrap())
        .fold(0.0, f64::max)
}

/// Takes the nearest open pair of robot and task again and again.
fn distance_by_brute_force(members: &[Member]) -> (Vec<u32>, Vec<u32>) {
    let (mut easy, mut hard) = (Vec::new(), Vec::new());
    for role in Role::ALL {
        let mut waiting: Vec<&Member> = members.iter().filter(|member| member.role == role).collect();
        let mut quota = RoleQuota::halves(waiting.len());
        while !waiting.is_empty() {
            let distance = |member: &Member, task: [f64; 2]| {
                (member.position[0] - task[0]).powi(2) + (member.position[1] - task[1]).powi(2)
            };
            let mut best: Option<(f64, usize, bool)> = None;
            for (i, member) in waiting.iter().enumerate() {
                for (open, to_hard, task) in [(quota.hard, true, TASKS.hard), (quota.easy, false, TASKS.easy)]
                {
                    let candidate = (distance(member, task), i, to_hard);
                    if open > 0 && best.is_none_or(|best| candidate.0 < best.0) {
                        best = Some(candidate);
                    }
                }
            }
            let (_, i, to_hard) = best.unwrap();
            let id = waiting.remove(i).id;
            if to_hard {
                quota.hard -= 1;
                hard.push(id);
            } else {
                quota.easy -= 1;
                easy.push(id);
            }
        }
    }
    easy.sort_unstable();
    hard.sort_unstable();
    (easy, hard)
}

/// All the ways to merge the best halves, for the default reading.
#[test]
fn rne_merges_as_brute_force_does() {
    for seed in 0..20 {
        let members = random_team(seed);
        let found = group("RNE", &RneOptions::default(), &members);
        let (one, other, score) = merge_by_brute_force(&members);
        assert!((found.score.unwrap().nats().unwrap() - score).abs() < 1e-11, "seed {seed}");
        let hard = if mean_trust_within(&members, &one) < mean_trust_within(&members, &other) {
            &one
        } else {
            &other
        };
        assert_eq!(
            &found.hard, hard,
            "seed {seed}: the group with the lower mean RNE within takes the hard task"
        );
    }
}

/// A number of one robot.
type Level<'a> = &'a dyn Fn(&Member) -> f64;

/// The other hard rules, from their definitions.
#[test]
fn each_hard_rule_sends_the_group_that_it_names() {
    for seed in 0..10 {
        let members = random_team(seed);
        let mean = |ids: &[u32], level: &dyn Fn(&Member) -> f64| {
            ids.iter().map(|id| level(&members[*id as usize])).sum::<f64>() / ids.len() as f64
        };
        let maximum = |k: usize| members.iter().map(|m| m.needs.values()[k]).fold(0.0, f64::max);
        let capability = |m: &Member| (0..7).map(|k| m.needs.values()[k] / maximum(k)).sum::<f64>();
        let rules: [(HardRule, Level); 3] = [
            (HardRule::MeanEnergy, &|m| m.energy_level.unwrap()),
            (HardRule::MeanHp, &|m| m.hp_level.unwrap()),
            (HardRule::Capability, &capability),
        ];
        for (hard_rule, level) in rules {
            let found = group("RNE", &RneOptions { hard_rule, ..RneOptions::default() }, &members);
            assert!(mean(&found.hard, level) >= mean(&found.easy, level), "seed {seed}, {hard_rule:?}");
        }
    }
}

/// Each score direction finds the largest value of its own definition, among all splits of a role.
#[test]
fn each_score_is_the_largest_of_its_definition() {
    for seed in 0..5 {
        let members: Vec<Member> =
            random_team(seed).into_iter().filter(|m| m.role == Role::Carrier).collect();
        let weights = scaled_weights(&members);
        for score in [ScoreDirection::Sum, ScoreDirection::JensenShannon, ScoreDirection::FirstToSecond] {
            let best = (0..1_u32 << members.len())
                .filter(|c| c.count_ones() as usize == members.len() / 2 && c & 1 == 1)
                .map(|chosen| {
                    let side = |inside: bool| {
                        let of = (0..members.len()).filter(|i| (chosen >> i & 1 == 1) == inside);
                        let needs: Vec<NeedVector> = of.map(|i| members[i].needs.clone()).collect();
                        NeedDistribution::of_group(&needs, &weights).unwrap()
                    };
                    let (p, q) = (side(true), side(false));
                    match score {
                        ScoreDirection::Sum => rne_core::jeffreys(&p, &q).unwrap().nats().unwrap(),
                        ScoreDirection::JensenShannon => rne_core::jensen_shannon(&p, &q).unwrap(),
                        _ => relative_entropy(&p, &q).unwrap().nats().unwrap(),
                    }
                })
                .fold(0.0, f64::max);
            let found = group("RNE", &RneOptions { score, ..RneOptions::default() }, &members);
            assert!((found.score.unwrap().nats().unwrap() - best).abs() < 1e-11, "seed {seed}, {score:?}");
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

/// Definition 2, averaged: the mean RNE of the members to their own group's distribution.
fn mean_trust_within(members: &[Member], ids: &[u32]) -> f64 {
    let weights = scaled_weights(members);
    let needs: Vec<NeedVector> = ids.iter().map(|id| members[*id as usize].needs.clone()).collect();
    let whole = NeedDistribution::of_group(&needs, &weights).unwrap();
    let own = needs.iter().map(|needs| NeedDistribution::of_agent(needs, &weights).unwrap());
    own.map(|own| relative_entropy(&own, &whole).unwrap().nats().unwrap()).sum::<f64>() / ids.len() as f64
}

fn merge_by_brute_force(members: &[Member]) -> (Vec<u32>, Vec<u32>, f64) {
    let weights = scaled_weights(members);
    let score = |one: &[u32], other: &[u32]| {
        let of = |ids: &[u32]| {
            let needs: Vec<NeedVector> = ids.iter().map(|id| members[*id as usize].needs.clone()).collect();
            NeedDistribution::of_group(&needs, &weights).unwrap()
        };
        let (p, q) = (of(one), of(other));
        let value = |rne: rne_core::RelativeNeedsEntropy| rne.nats().unwrap_or(f64::INFINITY);
        value(relative_entropy(&p, &q).unwrap()).max(value(relative_entropy(&q, &p).unwrap()))
    };
    let mut merged: Option<(Vec<u32>, Vec<u32>)> = None;
    let mut best = 0.0;
    for role in Role::ALL {
        let ids: Vec<u32> = members.iter().filter(|m| m.role == role).map(|m| m.id).collect();
        let halves =
            (0..1_u32 << ids.len()).filter(|c| c.count_ones() as usize == ids.len() / 2).map(|chosen| {
                let side = |inside: bool| -> Vec<u32> {
                    ids.iter()
                        .enumerate()
                        .filter(|(i, _)| (chosen >> i & 1 == 1) == inside)
                        .map(|(_, id)| *id)
                        .collect()
                };
                (side(true), side(false))
            });
        let (a, b) = halves.max_by(|x, y| score(&x.0, &x.1).total_cmp(&score(&y.0, &y.1))).unwrap();
        merged = Some(match merged {
            None => (a, b),
            Some((p, q)) => {
                let join = |x: &[u32], y: &[u32]| [x, y].concat();
                let straight = (join(&p, &a), join(&q, &b));
                let crossed = (join(&p, &b), join(&q, &a));
                if score(&straight.0, &straight.1) >= score(&crossed.0, &crossed.1) {
                    straight
                } else {
                    crossed
                }
            }
        });
        let (p, q) = merged.as_ref().unwrap();
        best = score(p, q);
    }
    let (mut one, mut other) = merged.unwrap();
    one.sort_unstable();
    other.sort_unstable();
    (one, other, best)
}

#[test]
fn twenty_robots_are_searched_exactly_and_more_by_local_search_that_says_so() {
    let mut draws = ChaCha8Rng::seed_from_u64(11);
    let mut levels = |count: usize| -> Vec<(f64, f64)> {
        (0..count).map(|_| (draws.random_range(5.0..100.0), draws.random_range(5.0..100.0))).collect()
    };
    let exact =
        group("RNE", &RneOptions::default(), &team([EXACT_ROLE_SIZE, 0, 0], &levels(EXACT_ROLE_SIZE)));
    assert!(exact.proven_optimal);
    let members = team([EXACT_ROLE_SIZE + 1, 3, 2], &levels(EXACT_ROLE_SIZE + 6));
    let local = group("RNE", &RneOptions::default(), &members);
    assert!(!local.proven_optimal);
    check_partition(&members, &local);
    assert_eq!(local, group("RNE", &RneOptions::default(), &members), "the local search is deterministic");
}

#[test]
fn the_team_of_nobody_and_the_team_of_one() {
    for policy in policy_names() {
        let nobody = group(policy, &RneOptions::default(), &[]);
        assert_eq!((nobody.easy.len(), nobody.hard.len()), (0, 0), "{policy}");
        for counts in [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 1, 1], [1, 0, 3]] {
            let members = team(counts, &[(80.0, 90.0), (50.0, 60.0), (20.0, 99.0), (33.0, 44.0)]);
            check_partition(&members, &group(policy, &RneOptions::default(), &members));
        }
    }
}
