//! Two, three and four tasks against the oracle.

use policies::RneOptions;
use rne_core::NeedVector;
use teaming::Question;

use crate::oracle::{Oracle, as_set, is_close, nats};
use crate::support::{all_options, decide, drawn_team, question, rne};

/// The answer is the oracle's: the score, the groups, and which task each gets.
#[track_caller]
pub fn check_against_oracle(question: &Question, options: &RneOptions) {
    let found = decide(&rne(options), question);
    let oracle = Oracle::new(question, options.clone());
    let groups = oracle.groups();
    let (score, best) = (nats(found.score), oracle.total(&groups));
    assert!(is_close(score, best), "{options:?}: found {score}, brute force {best}");
    assert_eq!(as_set(&found.assignment.groups), as_set(&groups), "{options:?}");
    assert_eq!(found.assignment.groups, oracle.by_task(&groups), "{options:?}: who takes which task");
    assert!(found.proven_optimal);
}

const DIFFICULTIES: [u32; 4] = [2, 5, 5, 1];

#[test]
fn teams_of_every_shape_are_grouped_as_brute_force_does() {
    let shapes: [&[usize]; 9] =
        [&[6, 4, 2], &[5, 3], &[7, 2, 1], &[4, 4, 4], &[8], &[1, 2, 3], &[0, 6, 0], &[2, 0, 2], &[9, 1, 1]];
    for seed in 0..50 {
        for tasks in 2..=4 {
            let counts = shapes[seed % shapes.len()];
            let question = question(drawn_team(counts, seed as u64), &DIFFICULTIES[..tasks]);
            check_against_oracle(&question, &RneOptions::default());
        }
    }
}

#[test]
fn every_combination_of_options_groups_as_brute_force_does() {
    for (number, options) in all_options().iter().enumerate() {
        for tasks in 2..=4 {
            let seed = (number * 10 + tasks) as u64;
            let question = question(drawn_team(&[6, 4, 3], seed), &DIFFICULTIES[..tasks]);
            check_against_oracle(&question, options);
        }
    }
}

#[test]
fn a_need_that_a_group_lacks_makes_the_score_infinite_and_not_undefined() {
    let mut members = drawn_team(&[4, 2], 9);
    for member in &mut members[4..] {
        let mut needs = member.needs.values().to_vec();
        needs[0] = 0.0;
        member.needs = NeedVector::new(needs).unwrap();
    }
    let mut question = question(members, &[1, 2, 3]);
    question.members.retain(|member| member.role.index() == 1 || member.id == 100);
    question.quotas[0].members = vec![0, 0, 1];
    let question = question.checked().unwrap();
    let found = decide("RNE", &question);
    assert!(found.score.unwrap().is_infinite());
    let found = decide("RNE(score: JensenShannon)", &question);
    assert!(found.score.unwrap().nats().unwrap() <= 3.0 * std::f64::consts::LN_2);
}
