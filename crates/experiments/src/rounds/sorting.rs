//! How like splits are to sorting: each role sorted by a level, the upper half against the lower half.

use rne_core::{Difficulty, Role};

use super::Round;
use crate::sweep::Grouped;

/// What robots may be sorted by.
pub struct Key {
    /// In words.
    pub name: &'static str,
    value: fn(&Grouped) -> f64,
}

/// Battery level, health level, and their ratio.
pub const KEYS: [Key; 3] = [
    Key { name: "energy", value: |robot| robot.energy },
    Key { name: "HP", value: |robot| robot.hp },
    Key { name: "energy : HP", value: |robot| robot.energy / robot.hp.max(f64::MIN_POSITIVE) },
];

/// How often something was so, beside how often chance would have it so.
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

    /// The share; `None` where nothing was looked at.
    #[must_use]
    pub fn share(&self) -> Option<f64> {
        (self.of > 0.0).then(|| self.times / self.of)
    }

    /// The share by chance.
    #[must_use]
    pub fn chance(&self) -> Option<f64> {
        (self.of > 0.0).then(|| self.by_chance / self.of)
    }
}

/// Rounds of a policy against sorting by one key. Ties count as sorted either way, by chance as well.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Likeness {
    /// The whole split is that of sorting, whichever half takes which task.
    pub split: Share,
    /// So are the carriers, of rounds in which both groups have some.
    pub carriers: Share,
    /// So are the suppliers, likewise.
    pub suppliers: Share,
    /// The group of the hard task has the higher mean; by chance, half of them.
    pub hard_is_higher: Share,
}

impl Likeness {
    /// Takes a round into account, unless one of its groups is empty.
    pub fn add(&mut self, round: &Round, key: &Key) {
        let is_split = |role: Option<Role>| {
            Difficulty::ALL.iter().all(|task| members(round, role).any(|robot| robot.task == *task))
        };
        if !is_split(None) {
            return;
        }
        self.split.add(is_sorted(round, key, &Role::ALL), chance(round, key, &Role::ALL));
        for (role, share) in [(Role::Carrier, &mut self.carriers), (Role::Supplier, &mut self.suppliers)] {
            if is_split(Some(role)) {
                share.add(is_sorted(round, key, &[role]), chance(round, key, &[role]));
            }
        }
        let higher = mean(round, key, Difficulty::Hard) > mean(round, key, Difficulty::Easy);
        self.hard_is_higher.add(higher, 0.5);
    }

    /// Rounds with two groups.
    #[must_use]
    pub fn rounds(&self) -> usize {
        self.split.of as usize
    }
}

/// How like these rounds are to sorting by each of [`KEYS`].
pub fn likeness<'r>(rounds: impl IntoIterator<Item = &'r Round>) -> [Likeness; 3] {
    let mut all = [Likeness::default(); 3];
    for round in rounds {
        all.iter_mut().zip(&KEYS).for_each(|(likeness, key)| likeness.add(round, key));
    }
    all
}

fn members(round: &Round, role: Option<Role>) -> impl Iterator<Item = &Grouped> {
    let of_role = move |(_, of): &(&Grouped, &Role)| role.is_none_or(|role| **of == role);
    round.robots.iter().zip(&round.roles).filter(of_role).map(|(robot, _)| robot)
}

/// Whether one group holds the upper robots of each of these roles, and the other the lower ones.
fn is_sorted(round: &Round, key: &Key, roles: &[Role]) -> bool {
    let holds = |upper: Difficulty| {
        roles.iter().all(|role| {
            let values = |is_upper: bool| {
                let of = members(round, Some(*role)).filter(move |robot| (robot.task == upper) == is_upper);
                of.map(key.value)
            };
            let least = values(true).fold(f64::INFINITY, f64::min);
            let most = values(false).fold(f64::NEG_INFINITY, f64::max);
            least >= most
        })
    };
    holds(Difficulty::Hard) || holds(Difficulty::Easy)
}

/// The share of all splits into groups of these sizes of which [`is_sorted`] would say so.
fn chance(round: &Round, key: &Key, roles: &[Role]) -> f64 {
    let (mut all, mut hard_up, mut easy_up, mut both) = (1.0, 1.0, 1.0, 1.0);
    for role in roles {
        let mut values: Vec<f64> = members(round, Some(*role)).map(key.value).collect();
        values.sort_by(|a, b| b.total_cmp(a));
        let hard = members(round, Some(*role)).filter(|robot| robot.task == Difficulty::Hard).count();
        let splits = choose(values.len(), hard);
        all *= splits;
        hard_up *= ways(&values, hard);
        easy_up *= ways(&values, values.len() - hard);
        let is_one_value = values.windows(2).all(|pair| pair[0].total_cmp(&pair[1]).is_eq());
        let is_one_group = hard == 0 || hard == values.len();
        both *= if is_one_value || is_one_group { splits } else { 0.0 };
    }
    (hard_up + easy_up - both) / all
}

/// Ways to choose the upper `upper` of values in falling order: more than one where values are tied at the border.
fn ways(values: &[f64], upper: usize) -> f64 {
    if upper == 0 || upper == values.len() {
        return 1.0;
    }
    let is_tied = |value: &&f64| value.total_cmp(&values[upper - 1]).is_eq();
    let (all, above) =
        (values.iter().filter(is_tied).count(), values[..upper].iter().filter(is_tied).count());
    choose(all, above)
}

/// Ways to choose so many of a number.
fn choose(of: usize, count: usize) -> f64 {
    (0..count).map(|i| (of - i) as f64 / (i + 1) as f64).product::<f64>().round()
}

fn mean(round: &Round, key: &Key, task: Difficulty) -> f64 {
    let values: Vec<f64> = round.robots.iter().filter(|robot| robot.task == task).map(key.value).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Carriers of these battery levels; `h` takes the hard task.
    fn round(robots: &[(f64, char)]) -> Round {
        let robot = |(i, (energy, task)): (usize, &(f64, char))| Grouped {
            round: 1,
            robot: i as u32,
            task: if *task == 'h' { Difficulty::Hard } else { Difficulty::Easy },
            energy: *energy,
            hp: 50.0,
            needs: vec![1.0],
        };
        let robots: Vec<Grouped> = robots.iter().enumerate().map(robot).collect();
        Round { trial: 1, seed: 1, round: 1, roles: vec![Role::Carrier; robots.len()], robots }
    }

    fn is(share: Option<f64>, expected: f64) -> bool {
        share.is_some_and(|share| (share - expected).abs() < 1e-12)
    }

    #[test]
    fn a_split_by_sorting_is_one_whichever_half_takes_the_hard_task() {
        let sorted = [(90.0, 'h'), (20.0, 'e'), (80.0, 'h'), (30.0, 'e')];
        let turned = [(90.0, 'e'), (20.0, 'h'), (80.0, 'e'), (30.0, 'h')];
        let mixed = [(90.0, 'h'), (20.0, 'h'), (80.0, 'e'), (30.0, 'e')];
        let [found, ..] = likeness(&[round(&sorted), round(&turned), round(&mixed), round(&mixed)]);
        assert!(is(found.split.share(), 0.5) && is(found.carriers.share(), 0.5));
        assert!(is(found.hard_is_higher.share(), 0.25), "{found:?}");
        assert!(is(found.split.chance(), 1.0 / 3.0), "four carriers have three splits");
        assert_eq!(found.suppliers.share(), None, "there are none");
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
            let [found, ..] = likeness(&splits);
            assert!(is(found.split.share(), found.split.chance().unwrap()), "{levels:?}: {found:?}");
        }
    }

    #[test]
    fn a_round_of_one_group_is_no_split() {
        assert_eq!(likeness(&[round(&[(90.0, 'e'), (20.0, 'e')])])[0].rounds(), 0);
    }
}
