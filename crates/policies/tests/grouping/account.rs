//! The RNE policy's account of itself agrees with its answer.

use policies::RneOptions;
use policies::rne::MergeReading;
use proptest::prelude::*;
use teaming::decision::RneAccount;
use teaming::{Account, GroupSizes, Question};

use crate::oracle::{Oracle, as_set, is_close, nats};
use crate::support::{all_options, decide, drawn_team, question, rne};

/// The scores in descending order, with duplicates.
fn descending(mut scores: Vec<f64>) -> Vec<f64> {
    scores.sort_by(|a, b| b.total_cmp(a));
    scores
}

fn check_splits(oracle: &Oracle, account: &RneAccount, groups: &[Vec<u32>]) {
    let with_members: Vec<_> =
        oracle.question.role_ids().filter(|role| oracle.question.of_role(*role).count() > 0).collect();
    let roles: Vec<_> = account.splits.iter().map(|split| split.role).collect();
    assert_eq!(roles, with_members);
    for split in &account.splits {
        let all = oracle.splits(split.role);
        assert_eq!(split.parts, as_set(&split.parts), "parts stand in the order of their smallest ids");
        assert!(all.iter().any(|(parts, _)| *parts == split.parts), "the parts are a split by the quota");
        for part in &split.parts {
            assert!(groups.iter().any(|group| part.iter().all(|id| group.contains(id))), "{part:?} was torn");
        }
        assert_eq!(split.searched, all.len() as u64);
        assert!(split.proven_optimal);
        let best = descending(all.iter().map(|(_, score)| *score).collect());
        assert!(is_close(nats(split.score), best[0]));
        match &split.runner_up {
            None => assert_eq!(all.len(), 1),
            Some(second) => {
                assert_ne!(second.parts, split.parts);
                assert!(nats(second.score) <= nats(split.score) + 1e-12);
                assert!(is_close(nats(second.score), best[1]));
                assert!(is_close(oracle.total(&second.parts), best[1]));
            }
        }
    }
}

fn joined(groups: &[Vec<u32>], parts: &[Vec<u32>], matching: &[usize]) -> Vec<Vec<u32>> {
    groups.iter().zip(matching).map(|(group, part)| [&group[..], &parts[*part]].concat()).collect()
}

/// Follows the merges; returns the groups of the last merge's runner-up.
fn check_merges(oracle: &Oracle, account: &RneAccount, chosen: &[Vec<u32>]) -> Option<Vec<Vec<u32>>> {
    assert_eq!(account.merges.len() + 1, account.splits.len());
    let mut groups = account.splits[0].parts.clone();
    let mut other = None;
    for (merge, split) in account.merges.iter().zip(&account.splits[1..]) {
        assert_eq!(merge.role, split.role);
        assert!(merge.proven_optimal);
        let all = oracle.matchings(&groups, &split.parts);
        let merged = joined(&groups, &split.parts, &merge.matching);
        let best = descending(all.iter().map(|(_, score)| *score).collect());
        assert!(is_close(nats(merge.score), best[0]), "{merge:?}");
        if oracle.options.merge == MergeReading::Apart {
            assert!(is_close(oracle.total(&merged), best[0]));
        }
        let mut distinct: Vec<_> = all.iter().map(|(groups, _)| as_set(groups)).collect();
        distinct.sort();
        distinct.dedup();
        other = merge.runner_up.as_ref().map(|second| {
            assert!(nats(second.score) <= nats(merge.score) + 1e-12);
            joined(&groups, &split.parts, &second.matching)
        });
        assert_eq!(other.is_some(), distinct.len() > 1, "there is a runner-up where there is a choice");
        if let Some(other) = &other {
            assert_ne!(as_set(other), as_set(&merged), "the runner-up comes to other groups");
            let rest = all.iter().filter(|(groups, _)| as_set(groups) != as_set(&merged));
            let second = descending(rest.map(|(_, score)| *score).collect())[0];
            let runner_up = merge.runner_up.as_ref().unwrap();
            assert!(is_close(nats(runner_up.score), second));
        }
        groups = merged;
    }
    assert_eq!(as_set(&groups), as_set(chosen));
    other
}

fn check_account(question: &Question, options: &RneOptions) {
    let decision = decide(&rne(options), question); // checks the alternatives, their quotas too
    let oracle = Oracle::new(question, options.clone());
    let chosen = &decision.assignment.groups;
    let Account::Rne(account) = &decision.account else {
        assert!(question.members.is_empty() && decision.account == Account::None);
        return;
    };
    assert!(
        account.weights.iter().zip(oracle.weights.values()).all(|(found, weight)| is_close(*found, *weight))
    );
    check_splits(&oracle, account, chosen);
    let other = check_merges(&oracle, account, chosen);

    assert_eq!(decision.alternatives.len(), usize::from(other.is_some()));
    for (alternative, groups) in decision.alternatives.iter().zip(other) {
        assert_eq!(as_set(&alternative.assignment.groups), as_set(&groups));
        assert_eq!(alternative.assignment.groups, oracle.by_task(&groups));
        assert!(is_close(nats(alternative.score), oracle.total(&groups)));
        if options.merge == MergeReading::Apart {
            assert!(nats(alternative.score) <= nats(decision.score) + 1e-12);
        }
    }

    let tasks: Vec<_> = account.suitability.iter().map(|suitability| suitability.task).collect();
    assert_eq!(tasks, question.task_ids().collect::<Vec<_>>());
    for suitability in &account.suitability {
        let group = decision.assignment.of(suitability.task);
        match suitability.value {
            None => assert!(group.is_empty()),
            Some(value) => assert!(is_close(value, oracle.suitability(group))),
        }
    }
    if question.quotas.iter().all(|quota| !quota.binds()) {
        let value = |task: &teaming::TaskId| account.suitability[task.index()].value.unwrap_or(f64::MIN);
        let from_the_hardest: Vec<f64> = question.hardest_first().iter().map(value).collect();
        assert!(from_the_hardest.windows(2).all(|pair| pair[0] >= pair[1] - 1e-12), "{from_the_hardest:?}");
    }
}

#[test]
fn the_account_agrees_with_the_answer_for_every_combination_of_options() {
    for (number, options) in all_options().iter().enumerate() {
        let tasks = 2 + number % 3;
        check_account(&question(drawn_team(&[5, 4, 3], number as u64), &[2, 1, 2, 3][..tasks]), options);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn the_account_agrees_with_the_answer_for_teams_of_every_shape(
        counts in [0..6_usize, 0..5_usize, 0..4_usize],
        binding in [any::<bool>(), any::<bool>(), any::<bool>()],
        tasks in 1..5_usize,
        seed in 0..1000_u64,
    ) {
        let mut question = question(drawn_team(&counts, seed), &[2, 1, 2, 3][..tasks]);
        for (quota, binds) in question.quotas.iter_mut().zip(binding) {
            quota.sizes = if binds { GroupSizes::Binding } else { GroupSizes::Parts };
        }
        check_account(&question, &RneOptions::default());
    }
}
