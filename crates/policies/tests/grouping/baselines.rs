//! DIS, ENG, HP_DIS and RANDOM by their definitions, for any number of tasks.

use proptest::prelude::*;
use teaming::{Account, GroupSizes, Member, Question, Quota, RandomSeed, RoleId};

use crate::support::{any_team, decide, drawn_team, question, two_tasks};

/// Ranks of two to four tasks, with ties.
fn any_tasks() -> impl Strategy<Value = Vec<u32>> {
    proptest::collection::vec(0..4_u32, 2..5)
}

fn member(question: &Question, id: u32) -> &Member {
    question.members.iter().find(|member| member.id == id).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn eng_and_hp_dis_send_the_better_robots_of_each_role_to_the_harder_tasks(
        members in any_team(7),
        difficulties in any_tasks(),
    ) {
        let question = question(members, &difficulties);
        for policy in ["ENG", "HP_DIS"] {
            let level = |id: &u32| {
                let member = member(&question, *id);
                member.levels[usize::from(policy == "HP_DIS")].unwrap()
            };
            let decision = decide(policy, &question);
            for role in question.role_ids() {
                let of_role = |ids: &[u32]| {
                    ids.iter().filter(|id| member(&question, **id).role == role).map(level).collect()
                };
                let hardest_first = question.hardest_first().into_iter();
                let by_hardness: Vec<Vec<f64>> =
                    hardest_first.map(|task| of_role(decision.assignment.of(task))).collect();
                for pair in by_hardness.windows(2) {
                    let worst = pair[0].iter().copied().fold(f64::INFINITY, f64::min);
                    prop_assert!(pair[1].iter().all(|level| *level <= worst), "{policy}: {by_hardness:?}");
                }
            }
            let Account::Ranking(ranking) = &decision.account else { panic!("{:?}", decision.account) };
            prop_assert_eq!(ranking.roles.len(), 3);
            for ranked in ranking.roles.iter().flatten() {
                prop_assert_eq!(ranked.value.to_bits(), level(&ranked.id).to_bits());
            }
        }
    }

    #[test]
    fn dis_takes_the_nearest_pair_first(members in any_team(7), difficulties in any_tasks()) {
        let question = question(members, &difficulties);
        prop_assert_eq!(distance_by_brute_force(&question), decide("DIS", &question).assignment.groups);
    }

    #[test]
    fn baselines_keep_uneven_quotas_task_by_task(seed in 0..1000_u64) {
        let mut question = question(drawn_team(&[6, 3, 4], seed), &[1, 3, 2]);
        for (quota, members) in question.quotas.iter_mut().zip([[1, 1, 4], [0, 0, 3], [3, 0, 1]]) {
            *quota = Quota { members: members.to_vec(), sizes: GroupSizes::Parts };
        }
        for policy in ["DIS", "ENG", "HP_DIS", "RANDOM"] {
            decide(policy, &question); // checks the sizes
        }
        prop_assert_eq!(distance_by_brute_force(&question), decide("DIS", &question).assignment.groups);
    }
}

/// Repeatedly takes the nearest open pair of robot and task; among equals, the robot with the lower id, then
/// the harder task.
fn distance_by_brute_force(question: &Question) -> Vec<Vec<u32>> {
    let mut groups = vec![Vec::new(); question.tasks.len()];
    for (role, quota) in question.role_ids().zip(&question.quotas) {
        let mut waiting: Vec<&Member> = question.of_role(role).collect();
        let mut open = quota.members.clone();
        while !waiting.is_empty() {
            let mut best: Option<(f64, usize, usize)> = None;
            for (i, member) in waiting.iter().enumerate() {
                for task in question.hardest_first().iter().map(|task| task.index()) {
                    let place = question.tasks[task].place.unwrap();
                    let distance = (member.home[0] - place[0]).powi(2) + (member.home[1] - place[1]).powi(2);
                    if open[task] > 0 && best.is_none_or(|best| distance < best.0) {
                        best = Some((distance, i, task));
                    }
                }
            }
            let (_, i, task) = best.unwrap();
            open[task] -= 1;
            groups[task].push(waiting.remove(i).id);
        }
    }
    groups.iter_mut().for_each(|group| group.sort_unstable());
    groups
}

#[test]
fn of_robots_of_the_same_health_the_one_nearest_to_the_hardest_task_goes_there() {
    let mut members = drawn_team(&[6], 3);
    members.iter_mut().for_each(|member| member.levels[1] = Some(50.0));
    let question = question(members, &[1, 2, 3]);
    let place = question.tasks[2].place.unwrap();
    let distance = |id: &u32| {
        let home = member(&question, *id).home;
        (home[0] - place[0]).powi(2) + (home[1] - place[1]).powi(2)
    };
    let mut nearest_first: Vec<u32> = question.members.iter().map(|member| member.id).collect();
    nearest_first.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    let groups = decide("HP_DIS", &question).assignment.groups;
    for (group, ids) in groups.iter().rev().zip(nearest_first.chunks(2)) {
        let mut ids = ids.to_vec();
        ids.sort_unstable();
        assert_eq!(*group, ids);
    }
}

#[test]
fn random_is_a_function_of_the_seed_and_fair() {
    let mut question = question(drawn_team(&[6, 3], 1), &[1, 2, 3]);
    let mut drawn = |seed: u64| {
        question.random_seed = RandomSeed::from(seed);
        decide("RANDOM", &question).assignment
    };
    assert_eq!(drawn(1), drawn(1));
    let mut counts = vec![[0_u32; 3]; 101];
    for seed in 0..900 {
        for (task, group) in drawn(seed).groups.iter().enumerate() {
            group.iter().for_each(|id| counts[*id as usize][task] += 1);
        }
    }
    // A third of 900 draws; 90 is more than six standard deviations.
    for (id, counts) in counts.iter().enumerate().skip(92) {
        assert!(counts.iter().all(|count| count.abs_diff(300) < 90), "robot {id}: {counts:?}");
    }
}

#[test]
fn two_robots_at_the_same_distance_go_by_id_and_the_hard_task_comes_first() {
    let mut members = drawn_team(&[2], 1);
    members.iter_mut().for_each(|member| member.home = [10.0, 10.0]);
    let mut question = two_tasks(members);
    question.tasks.iter_mut().for_each(|task| task.place = Some([20.0, 20.0]));
    assert_eq!(question.of_role(RoleId(0)).map(|member| member.id).collect::<Vec<_>>(), [99, 100]);
    assert_eq!(decide("DIS", &question).assignment.groups, [[100], [99]]);
}
