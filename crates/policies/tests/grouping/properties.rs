//! Properties of every answer of every policy.

use proptest::prelude::*;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;
use teaming::Member;

use crate::support::{all_options, any_team, decide, drawn_team, names, question, rne, team, two_tasks};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    // `decide` checks that all answers are partitions with the sizes of the quotas.

    #[test]
    fn every_policy_forms_halves_of_every_role(members in any_team(6)) {
        let question = two_tasks(members);
        for quota in &question.quotas {
            prop_assert!(quota.members[0].abs_diff(quota.members[1]) <= 1, "{quota:?} are no halves");
        }
        for policy in names() {
            decide(&policy, &question);
        }
        for options in all_options() {
            decide(&rne(&options), &question);
        }
    }

    #[test]
    fn every_policy_forms_equal_parts_of_every_role(
        members in any_team(5),
        difficulties in proptest::collection::vec(0..3_u32, 1..5),
    ) {
        let question = question(members, &difficulties);
        for quota in &question.quotas {
            let in_order: Vec<usize> =
                question.hardest_first().iter().map(|task| quota.members[task.index()]).collect();
            prop_assert!(in_order.is_sorted_by(|a, b| a >= b), "the harder tasks get the extra robots");
            prop_assert!(in_order[0] - in_order[in_order.len() - 1] <= 1);
        }
        for policy in names() {
            decide(&policy, &question);
        }
        for options in all_options().iter().step_by(5) {
            decide(&rne(options), &question);
        }
    }

    #[test]
    fn the_order_in_which_robots_are_listed_decides_nothing(
        members in any_team(6),
        tasks in 2..5_usize,
        seed in 0..1000_u64,
    ) {
        let mut shuffled = members.clone();
        shuffled.shuffle(&mut ChaCha8Rng::seed_from_u64(seed));
        let [one, other] = [members, shuffled].map(|members| question(members, &[3, 1, 4, 1][..tasks]));
        for policy in names() {
            prop_assert_eq!(decide(&policy, &one), decide(&policy, &other));
        }
    }

    #[test]
    fn scaling_all_weights_changes_no_group(
        members in any_team(5),
        tasks in 2..4_usize,
        factor in 0.01..100.0_f64,
    ) {
        let weights = [6.0, 4.0, 2.0, 3.0, 1.0, 5.0, 2.5];
        let mut question = question(members, &[1, 2, 3][..tasks]);
        let mut groups = |factor: f64| {
            let scaled = weights.map(|weight| weight * factor);
            let by_options = decide(&format!("RNE(weights: {scaled:?})"), &question).assignment;
            question.needs.iter_mut().zip(scaled).for_each(|(need, weight)| need.weight = weight);
            let by_question = decide("RNE", &question).assignment;
            assert_eq!(by_options, by_question, "weights of the question and of the options do the same");
            by_question
        };
        prop_assert_eq!(groups(1.0), groups(factor));
    }
}

const LEVELS: [(f64, f64); 4] = [(80.0, 90.0), (50.0, 60.0), (20.0, 99.0), (33.0, 44.0)];

#[test]
fn the_team_of_nobody_and_the_team_of_one() {
    for difficulties in [&[1, 2][..], &[1], &[2, 1, 3], &[1, 1, 1, 1]] {
        for policy in names() {
            let nobody = decide(&policy, &question(Vec::new(), difficulties));
            assert_eq!(nobody.assignment.groups, vec![Vec::<u32>::new(); difficulties.len()], "{policy}");
            for counts in [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 1, 1], [1, 0, 3]] {
                let question = question(team(counts, &LEVELS), difficulties);
                let decision = decide(&policy, &question);
                if counts == [1, 0, 0] {
                    let hardest = question.hardest_first()[0];
                    assert_eq!(decision.assignment.of(hardest), [0], "{policy}: one robot takes the hardest");
                    assert_eq!(decision.assignment.task_of(0), Some(hardest));
                    assert_eq!(decision.score, None);
                }
            }
        }
    }
}

#[test]
fn a_single_task_gets_the_whole_team() {
    let question = question(team([2, 1, 1], &LEVELS), &[7]);
    for policy in names() {
        let decision = decide(&policy, &question);
        assert_eq!(decision.assignment.groups, [[0, 1, 2, 3]], "{policy}");
        assert!(decision.score.is_none() && decision.alternatives.is_empty(), "{policy}");
    }
}

#[test]
fn missing_facts_are_named_with_their_robot() {
    let without = |forget: fn(&mut Member)| {
        let mut members = team([2, 1, 1], &LEVELS);
        forget(&mut members[2]);
        two_tasks(members)
    };
    let no_energy = without(|member| member.levels[0] = None);
    let no_hp = without(|member| member.levels[1] = None);
    let mut no_place = without(|_| ());
    no_place.tasks[1].place = None;
    let mut no_needs = without(|_| ());
    no_needs.needs.iter_mut().for_each(|need| need.weight = 0.0);
    let registry = policies::standard();
    for (question, policy, message) in [
        (&no_energy, "ENG", "policy ENG needs the energy level, which is missing for robot 2"),
        (
            &no_energy,
            "RNE(hard_rule: MeanEnergy)",
            "policy RNE needs the energy level, which is missing for robot 2",
        ),
        (&no_hp, "HP_DIS", "policy HP_DIS needs the HP level, which is missing for robot 2"),
        (&no_hp, "RNE(hard_rule: MeanHp)", "policy RNE needs the HP level, which is missing for robot 2"),
        (&no_place, "DIS", "policy DIS needs the place of each task, which is missing"),
        (&no_needs, "RNE", "robot 0: weighted needs must have at least one entry above 0, found only zeros"),
        (&no_hp, "RNE(weights: [1, 2])", "options of the policy: weights must have 7 entries, found 2"),
    ] {
        let error = registry.parse(policy).unwrap().decide(question).unwrap_err();
        assert_eq!(error.to_string(), message, "{policy}");
    }
}

#[test]
fn every_policys_decision_is_read_as_it_was_written() {
    let question = question(drawn_team(&[5, 3, 2], 4), &[1, 2]);
    let registry = policies::standard();
    let with_options = ["RNE(score: JensenShannon)", "RNE(merge: Together, sort: true, hard_rule: MeanHp)"];
    for policy in registry.names().into_iter().chain(with_options) {
        let decision = registry.parse(policy).unwrap().decide(&question).unwrap();
        decision.assignment.check(&question).unwrap();
        let text = serde_json::to_string(&decision).unwrap();
        assert_eq!(teaming::Decision::from_json(&text).unwrap(), decision, "{policy}");
    }
}
