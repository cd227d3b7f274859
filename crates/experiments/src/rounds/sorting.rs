//! How similar splits are to sorting: each role sorted by a level, the upper half against the lower half.

use teaming::{Member, RoleId, TaskId};

use super::{Round, energy, hp};

/// A quantity by which robots may be sorted.
pub struct Key {
    /// Name in words.
    pub name: &'static str,
    value: fn(&Member) -> f64,
}

/// Battery level, health level, and their ratio.
pub const KEYS: [Key; 3] = [
    Key { name: "energy", value: energy },
    Key { name: "HP", value: hp },
    Key { name: "energy : HP", value: |robot| energy(robot) / hp(robot).max(f64::MIN_POSITIVE) },
];

/// How often something was true, and how often it would be by chance.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Share {
    times: f64,
    by_chance: f64,
    of: f64,
}

impl Share {
    fn add(&mut self, is: bool, chance: f64) {
        self.times += f64::from(u8::from(is));
        self.by_chance += chance;
        self.of += 1.0;
    }

    /// The observed share; `None` without observations.
    pub fn share(&self) -> Option<f64> {
        (self.of > 0.0).then(|| self.times / self.of)
    }

    /// The share expected by chance; `None` without observations.
    pub fn chance(&self) -> Option<f64> {
        (self.of > 0.0).then(|| self.by_chance / self.of)
    }
}

/// A policy's rounds with two groups, compared with sorting by one key. A tie counts as sorted in either
/// order, also in the chance.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SortingAgreement {
    /// Rounds in which the whole split equals sorting, regardless of which group takes which task.
    pub split: Share,
    /// The same for each role alone, in rounds in which both groups have members of the role.
    pub roles: Vec<RoleShare>,
    /// Rounds in which the group of the harder task has the higher mean; one half by chance.
    pub harder_is_higher: Share,
}

/// One role, compared with sorting by one key.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RoleShare {
    /// Name of the role.
    pub role: String,
    /// Largest number of members that it had in a round. A role with two members has only one split.
    pub most: usize,
    /// How often the role's split equals sorting.
    pub share: Share,
}

impl SortingAgreement {
    /// Adds a round, if it has two groups.
    pub fn add(&mut self, round: &Round, key: &Key) {
        let Ok(tasks) = <[TaskId; 2]>::try_from(round.tasks()) else { return };
        let roles: Vec<RoleId> = round.question.role_ids().collect();
        self.split.add(is_sorted(round, tasks, key, &roles), chance(round, tasks, key, &roles));
        self.roles.resize(roles.len(), RoleShare::default());
        for (role, of_role) in roles.iter().zip(&mut self.roles) {
            of_role.role.clone_from(&round.question.roles[role.index()]);
            of_role.most = of_role.most.max(round.of_role(*role).count());
            if tasks.iter().all(|task| members(round, *task, *role).next().is_some()) {
                let chance = chance(round, tasks, key, &[*role]);
                of_role.share.add(is_sorted(round, tasks, key, &[*role]), chance);
            }
        }
        self.harder_is_higher.add(mean(round, key, tasks[0]) > mean(round, key, tasks[1]), 0.5);
    }

    /// The roles that had more than two members in some round.
    pub fn splittable_roles(&self) -> impl Iterator<Item = &RoleShare> {
        self.roles.iter().filter(|role| role.most > 2)
    }

    /// Number of rounds with two groups.
    pub fn rounds(&self) -> usize {
        self.split.of as usize
    }
}

/// How similar these rounds are to sorting by each of [`KEYS`].
pub fn agreement<'r>(rounds: impl IntoIterator<Item = &'r Round>) -> [SortingAgreement; 3] {
    let mut all: [SortingAgreement; 3] = Default::default();
    for round in rounds {
        all.iter_mut().zip(&KEYS).for_each(|(agreement, key)| agreement.add(round, key));
    }
    all
}

fn members(round: &Round, task: TaskId, role: RoleId) -> impl Iterator<Item = &Member> {
    round.group(task).filter(move |member| member.role == role)
}

/// Whether one group holds the upper robots of each of these roles, and the other group the lower robots.
fn is_sorted(round: &Round, [a, b]: [TaskId; 2], key: &Key, roles: &[RoleId]) -> bool {
    let holds = |upper: TaskId, lower: TaskId| {
        roles.iter().all(|role| {
            let least = members(round, upper, *role).map(key.value).fold(f64::INFINITY, f64::min);
            let most = members(round, lower, *role).map(key.value).fold(f64::NEG_INFINITY, f64::max);
            least >= most
        })
    };
    holds(a, b) || holds(b, a)
}

/// The share of all splits into groups of these sizes for which [`is_sorted`] is true.
fn chance(round: &Round, [a, _]: [TaskId; 2], key: &Key, roles: &[RoleId]) -> f64 {
    let (mut all, mut first_up, mut second_up, mut both) = (1.0, 1.0, 1.0, 1.0);
    for role in roles {
        let mut values: Vec<f64> = round.of_role(*role).map(key.value).collect();
        values.sort_by(|a, b| b.total_cmp(a));
        let first = members(round, a, *role).count();
        let splits = choose(values.len(), first);
        all *= splits;
        first_up *= ways(&values, first);
        second_up *= ways(&values, values.len() - first);
        let is_one_value = values.windows(2).all(|pair| pair[0].total_cmp(&pair[1]).is_eq());
        let is_one_group = first == 0 || first == values.len();
        both *= if is_one_value || is_one_group { splits } else { 0.0 };
    }
    (first_up + second_up - both) / all
}

/// Number of ways to choose the `upper` highest of values in falling order. There is more than one way if
/// values are tied at the border.
fn ways(values: &[f64], upper: usize) -> f64 {
    if upper == 0 || upper == values.len() {
        return 1.0;
    }
    let is_tied = |value: &&f64| value.total_cmp(&values[upper - 1]).is_eq();
    let (all, above) =
        (values.iter().filter(is_tied).count(), values[..upper].iter().filter(is_tied).count());
    choose(all, above)
}

/// Number of ways to choose `count` of `of`.
fn choose(of: usize, count: usize) -> f64 {
    (0..count).map(|i| (of - i) as f64 / (i + 1) as f64).product::<f64>().round()
}

fn mean(round: &Round, key: &Key, task: TaskId) -> f64 {
    let values: Vec<f64> = round.group(task).map(key.value).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Robots of one role with these battery levels; `h` takes the harder task.
    fn round(robots: &[(f64, char)]) -> Round {
        let robots: Vec<(f64, f64, usize)> =
            robots.iter().map(|(energy, task)| (*energy, 50.0, usize::from(*task != 'h'))).collect();
        super::super::testing::round(&robots)
    }

    fn is(share: Option<f64>, expected: f64) -> bool {
        share.is_some_and(|share| (share - expected).abs() < 1e-12)
    }

    #[test]
    fn a_split_by_sorting_is_one_whichever_group_takes_the_harder_task() {
        let sorted = [(90.0, 'h'), (20.0, 'e'), (80.0, 'h'), (30.0, 'e')];
        let turned = [(90.0, 'e'), (20.0, 'h'), (80.0, 'e'), (30.0, 'h')];
        let mixed = [(90.0, 'h'), (20.0, 'h'), (80.0, 'e'), (30.0, 'e')];
        let [found, ..] = agreement(&[round(&sorted), round(&turned), round(&mixed), round(&mixed)]);
        assert!(is(found.split.share(), 0.5) && is(found.roles[0].share.share(), 0.5));
        assert!(is(found.harder_is_higher.share(), 0.25), "{found:?}");
        assert!(is(found.split.chance(), 1.0 / 3.0), "four robots have three splits");
        assert_eq!(found.splittable_roles().count(), 1);
    }

    /// Counts all splits one by one.
    #[test]
    fn the_chance_counts_ties_as_the_share_does() {
        for levels in [[90.0, 80.0, 80.0, 80.0, 20.0, 10.0], [50.0; 6], [90.0, 90.0, 90.0, 10.0, 10.0, 10.0]]
        {
            let splits = (0_u32..64).filter(|split| split.count_ones() == 3).map(|split| {
                let task = |i: usize| if split >> i & 1 == 1 { 'h' } else { 'e' };
                round(&(0..6).map(|i| (levels[i], task(i))).collect::<Vec<_>>())
            });
            let splits: Vec<Round> = splits.collect();
            let [found, ..] = agreement(&splits);
            assert!(is(found.split.share(), found.split.chance().unwrap()), "{levels:?}: {found:?}");
        }
    }

    #[test]
    fn a_round_of_one_group_is_no_split() {
        assert_eq!(agreement(&[round(&[(90.0, 'e'), (20.0, 'e')])])[0].rounds(), 0);
    }
}
