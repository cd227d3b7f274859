//! Binding quotas: every policy keeps them task by task, and RNE finds the best groups that do.

use policies::RneOptions;
use proptest::prelude::*;
use teaming::{Assignment, GroupSizes, Question, Quota};

use crate::many_tasks::check_against_oracle;
use crate::support::{all_options, decide, drawn_team, names, question, rne};

/// A question whose roles have these quotas; each flag says whether the quota binds.
fn with_quotas(quotas: [(&[usize], bool); 3], difficulties: &[u32], seed: u64) -> Question {
    let counts = quotas.map(|(members, _)| members.iter().sum());
    let mut question = question(drawn_team(&counts, seed), difficulties);
    let sizes = |binds| if binds { GroupSizes::Binding } else { GroupSizes::Parts };
    let quota = |(members, binds): (&[usize], bool)| Quota { members: members.to_vec(), sizes: sizes(binds) };
    question.quotas = quotas.into_iter().map(quota).collect();
    question.checked().unwrap()
}

#[test]
fn binding_quotas_are_kept_and_the_groups_are_the_best_that_keep_them() {
    let cases: [[(&[usize], bool); 3]; 9] = [
        [(&[4, 1, 1], true), (&[2, 2, 0], true), (&[1, 0, 1], true)],
        [(&[4, 1, 1], true), (&[1, 1, 2], false), (&[0, 0, 2], true)],
        [(&[2, 2, 2], false), (&[0, 1, 3], true), (&[3, 1, 1], true)],
        [(&[1, 2, 3], true), (&[3, 2, 1], true), (&[2, 1, 3], true)],
        [(&[1, 1, 2], true), (&[2, 1, 1], true), (&[1, 1, 1], false)],
        [(&[2, 1, 1], true), (&[1, 1, 2], true), (&[0, 0, 0], true)],
        [(&[0, 5, 0], true), (&[2, 0, 2], true), (&[1, 1, 1], true)],
        [(&[6, 0, 0], true), (&[0, 4, 0], false), (&[0, 0, 2], true)],
        [(&[0, 0, 0], false), (&[3, 2, 1], false), (&[0, 1, 2], true)],
    ];
    for (number, quotas) in cases.into_iter().enumerate() {
        for difficulties in [[1, 2, 3], [3, 2, 1], [2, 2, 2]] {
            let question = with_quotas(quotas, &difficulties, number as u64);
            for policy in names() {
                decide(&policy, &question); // checks the quotas, those of the alternatives too
            }
            check_against_oracle(&question, &RneOptions::default());
        }
    }
}

#[test]
fn every_combination_of_options_keeps_binding_quotas() {
    for (seed, options) in all_options().iter().enumerate() {
        let quotas: [(&[usize], bool); 3] = [(&[1, 1, 2], true), (&[2, 2, 1], false), (&[2, 1, 1], true)];
        check_against_oracle(&with_quotas(quotas, &[1, 3, 2], seed as u64), options);
    }
}

/// Any quotas of three roles for this many tasks.
fn any_quotas() -> impl Strategy<Value = Vec<(Vec<usize>, bool)>> {
    (2..5_usize).prop_flat_map(|tasks| {
        let quota = (proptest::collection::vec(0..3_usize, tasks), any::<bool>());
        proptest::collection::vec(quota, 3)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn any_quotas_are_kept(quotas in any_quotas(), seed in 0..1000_u64) {
        let [a, b, c] = [0, 1, 2].map(|role: usize| (&quotas[role].0[..], quotas[role].1));
        let question = with_quotas([a, b, c], &[2, 1, 4, 3][..a.0.len()], seed);
        for policy in names() {
            decide(&policy, &question);
        }
        check_against_oracle(&question, &RneOptions::default());
    }
}

#[test]
fn an_answer_that_breaks_a_binding_quota_is_refused_by_name() {
    let question = with_quotas([(&[4, 1, 1], true), (&[1, 1, 0], false), (&[0, 0, 0], false)], &[1, 2, 3], 1);
    let groups = decide("ENG", &question).assignment.groups;
    let refused = |change: &dyn Fn(&mut Vec<Vec<u32>>)| {
        let mut groups = groups.clone();
        change(&mut groups);
        Assignment::new(groups).check(&question).unwrap_err().to_string()
    };
    assert_eq!(
        refused(&|groups| groups.swap(0, 1)),
        "task \"easy\" must get 4 members of role \"Carrier\", found 1"
    );
    assert_eq!(
        refused(&|groups| groups.truncate(2)),
        "an assignment must have a group for each of the 3 tasks, found 2"
    );
    assert_eq!(
        refused(&|groups| groups[0].push(7)),
        "robot 7 is not a member of the team that was to be grouped"
    );
    let first = groups[0][0];
    assert_eq!(
        refused(&|groups| groups[1].push(first)),
        format!("robot {first} must be in exactly one group, found it twice")
    );
    assert_eq!(
        refused(&|groups| groups[0].retain(|id| *id != first)),
        format!("robot {first} must be in exactly one group, found it in none")
    );
}

#[test]
fn more_tasks_than_are_matched_exactly_keep_binding_quotas_too() {
    let mut question = question(drawn_team(&[12, 10, 9], 2), &[1, 2, 3, 4, 5, 6, 7, 8, 9]);
    let quotas = [[4, 1, 1, 1, 1, 1, 1, 1, 1], [2, 1, 1, 1, 1, 1, 1, 1, 1], [0, 1, 2, 1, 1, 1, 1, 1, 1]];
    for (quota, members) in question.quotas.iter_mut().zip(quotas) {
        *quota = Quota { members: members.to_vec(), sizes: GroupSizes::Binding };
    }
    for policy in names().into_iter().chain([rne(&all_options()[70])]) {
        let unproven = ["RNE", "GREEDY", "GRAPE", "BALANCE", "SIMILAR", "KMEANS", "SPECTRAL"];
        let is_exact = !unproven.iter().any(|search| policy.starts_with(search));
        assert_eq!(decide(&policy, &question).proven_optimal, is_exact, "{policy}");
    }
}
