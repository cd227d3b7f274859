//! Teams that are too large for an exhaustive search: the answer says so.

use policies::RneOptions;
use policies::rne::EXACT_TASKS;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::NeedVector;
use teaming::decision::RneAccount;
use teaming::{Account, Decision};

use crate::oracle::{Oracle, nats};
use crate::support::{SCORES, decide, drawn_team, names, question, rne, team, two_tasks};

fn account(decision: &Decision) -> &RneAccount {
    match &decision.account {
        Account::Rne(account) => account,
        other => panic!("{other:?}"),
    }
}

fn levels(count: usize) -> Vec<(f64, f64)> {
    let mut draws = ChaCha8Rng::seed_from_u64(11);
    (0..count).map(|_| (draws.random_range(5.0..100.0), draws.random_range(5.0..100.0))).collect()
}

#[test]
fn twenty_robots_are_searched_exactly_and_more_by_local_search_that_says_so() {
    let exact = decide("RNE", &two_tasks(team([20, 0, 0], &levels(20))));
    assert!(exact.proven_optimal);
    assert_eq!(account(&exact).splits[0].searched, 92_378);
    let question = two_tasks(team([21, 3, 2], &levels(26)));
    let local = decide("RNE", &question);
    assert!(!local.proven_optimal);
    let proven: Vec<bool> = account(&local).splits.iter().map(|split| split.proven_optimal).collect();
    assert_eq!(proven, [false, true, true]);
    assert_eq!(local, decide("RNE", &question), "the local search is deterministic");
}

#[test]
fn three_tasks_are_searched_exactly_for_13_robots_of_a_role_and_four_for_12() {
    for (tasks, robots) in [(3, 13), (4, 12)] {
        let decision = |robots| decide("RNE", &question(drawn_team(&[robots], 3), &[1, 2, 3, 4][..tasks]));
        assert!(decision(robots).proven_optimal);
        assert!(!decision(robots + 1).proven_optimal);
    }
}

#[test]
fn the_score_of_a_local_search_is_that_of_its_parts() {
    for seed in 0..12 {
        for score in SCORES {
            for tasks in [2, 3, 4] {
                let question = question(drawn_team(&[26 + seed, 2], seed as u64), &[1, 2, 3, 4][..tasks]);
                let options = RneOptions { score, sort: seed % 3 == 0, ..RneOptions::default() };
                let decision = decide(&rne(&options), &question);
                assert!(!decision.proven_optimal);
                let split = &account(&decision).splits[0];
                let found = nats(split.score);
                let exact = Oracle::new(&question, options).total(&split.parts);
                assert!(
                    (found - exact).abs() < 1e-11,
                    "{score:?}, {tasks} tasks: the score is that of the parts"
                );
            }
        }
    }
}

#[test]
fn a_need_that_a_part_lacks_makes_the_score_infinite() {
    let mut members = drawn_team(&[30], 1);
    for member in &mut members[..10] {
        let mut needs = member.needs.values().to_vec();
        needs[0] = 0.0;
        member.needs = NeedVector::new(needs).unwrap();
    }
    let decision = decide("RNE", &question(members, &[1, 2, 3]));
    assert!(decision.score.unwrap().is_infinite());
}

#[test]
fn the_local_search_is_not_far_from_the_best_where_both_are_known() {
    // 14 robots and three tasks: over the limit, and still few enough for the oracle.
    let question = question(drawn_team(&[14], 8), &[1, 2, 3]);
    let decision = decide("RNE", &question);
    let found = decision.score.unwrap().nats().unwrap();
    let oracle = Oracle::new(&question, RneOptions::default());
    let best = oracle.splits(question.members[0].role).iter().map(|split| split.1).fold(0.0, f64::max);
    assert!(found <= best + 1e-11);
    assert!(found > 0.9 * best, "found {found}, the best is {best}");
}

#[test]
fn many_tasks_are_matched_by_exchange_that_says_so() {
    for tasks in [EXACT_TASKS, EXACT_TASKS + 1, 16] {
        let difficulties: Vec<u32> = (0..).take(tasks).collect();
        let question = question(drawn_team(&[tasks, tasks, 1], 4), &difficulties);
        for policy in names() {
            let decision = decide(&policy, &question);
            if policy == "RNE" {
                assert_eq!(decision.proven_optimal, tasks <= EXACT_TASKS, "{tasks} tasks");
            }
        }
    }
}
