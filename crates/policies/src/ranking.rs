//! Ranking: the first robots of each role go to the hardest task, the next robots to the next hardest.

use std::cmp::Ordering;

use teaming::decision::{Account, Decision, Ranked, Ranking};
use teaming::error::PolicyError;
use teaming::question::{Member, Question};

/// Per role, sorts by `better_first` and deals the members out over the tasks, the hardest first; ties by id.
/// `key_name` says what the members are sorted by. `value` is the part of a key that the account shows.
pub(super) fn deal_by_rank<K>(
    question: &Question,
    key_name: &str,
    value: impl Fn(&K) -> f64,
    key: impl Fn(&Member) -> Result<K, PolicyError>,
    better_first: impl Fn(&K, &K) -> Ordering,
) -> Result<Decision, PolicyError> {
    let ranking = rank(question, key_name, value, key, better_first)?;
    let ids = |ranked: &Vec<Ranked>| ranked.iter().map(|robot| robot.id).collect();
    let orders: Vec<Vec<u32>> = ranking.roles.iter().map(ids).collect();
    Ok(Decision { account: Account::Ranking(ranking), ..deal(question, &orders) })
}

/// Sorts the members of each role, see [`deal_by_rank`].
pub(super) fn rank<K>(
    question: &Question,
    key_name: &str,
    value: impl Fn(&K) -> f64,
    key: impl Fn(&Member) -> Result<K, PolicyError>,
    better_first: impl Fn(&K, &K) -> Ordering,
) -> Result<Ranking, PolicyError> {
    let of_role = |role| {
        let keyed = question.of_role(role).map(|member| Ok((key(member)?, member.id)));
        let mut ranked = keyed.collect::<Result<Vec<_>, PolicyError>>()?;
        ranked.sort_by(|a, b| better_first(&a.0, &b.0).then(a.1.cmp(&b.1)));
        Ok(ranked.iter().map(|(key, id)| Ranked { id: *id, value: value(key) }).collect())
    };
    let roles = question.role_ids().map(of_role).collect::<Result<_, PolicyError>>()?;
    Ok(Ranking { key: key_name.to_owned(), roles })
}

/// Deals the members of each role out over the tasks by their quotas. The members keep the given order; the
/// hardest task comes first.
pub(super) fn deal(question: &Question, orders: &[Vec<u32>]) -> Decision {
    let mut groups = vec![Vec::new(); question.tasks.len()];
    let hardest_first = question.hardest_first();
    for (order, quota) in orders.iter().zip(&question.quotas) {
        let mut rest = order.as_slice();
        for task in &hardest_first {
            let (dealt, left) = rest.split_at(quota.members[task.index()]);
            groups[task.index()].extend(dealt);
            rest = left;
        }
    }
    Decision::unscored(groups)
}
