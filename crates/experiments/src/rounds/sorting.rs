//! How like a split is to one by sorting: each role sorted by a level, the upper half against the lower half.

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

/// Rounds of a policy against sorting by one key, as shares of the rounds.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Likeness {
    /// The whole split is that of sorting, whichever half takes which task.
    pub split: f64,
    /// So are the carriers.
    pub carriers: f64,
    /// So are the suppliers.
    pub suppliers: f64,
    /// The group of the hard task has the higher mean.
    pub hard_is_higher: f64,
    /// Rounds in which there are two groups.
    pub rounds: usize,
    /// Mean share in which the whole split would be that of sorting by chance.
    pub chance: f64,
}

/// How like these rounds are to sorting by a key. Rounds with an empty group are left out.
#[must_use]
pub fn likeness(rounds: &[Round], key: &Key) -> Likeness {
    let is_split = |round: &&Round| Difficulty::ALL.iter().all(|task| !round.group(*task).is_empty());
    let rounds: Vec<&Round> = rounds.iter().filter(is_split).collect();
    let count = rounds.len();
    let share = |is: &dyn Fn(&Round) -> bool| {
        if count == 0 { 0.0 } else { rounds.iter().filter(|round| is(round)).count() as f64 / count as f64 }
    };
    let chance: f64 = rounds.iter().map(|round| chance(round)).sum();
    Likeness {
        split: share(&|round| is_sorted(round, key, &Role::ALL)),
        carriers: share(&|round| is_sorted(round, key, &[Role::Carrier])),
        suppliers: share(&|round| is_sorted(round, key, &[Role::Supplier])),
        hard_is_higher: share(&|round| {
            mean(round, key, Difficulty::Hard) > mean(round, key, Difficulty::Easy)
        }),
        rounds: count,
        chance: if count == 0 { 0.0 } else { chance / count as f64 },
    }
}

fn members(round: &Round, role: Role) -> impl Iterator<Item = &Grouped> {
    round.robots.iter().zip(&round.roles).filter(move |(_, of)| **of == role).map(|(robot, _)| robot)
}

/// Whether one group holds the upper robots of each of these roles, and the other the lower ones.
fn is_sorted(round: &Round, key: &Key, roles: &[Role]) -> bool {
    let holds = |upper: Difficulty| {
        roles.iter().all(|role| {
            let values = |is_upper: bool| {
                let of = members(round, *role).filter(move |robot| (robot.task == upper) == is_upper);
                of.map(key.value)
            };
            let least = values(true).fold(f64::INFINITY, f64::min);
            let most = values(false).fold(f64::NEG_INFINITY, f64::max);
            least >= most
        })
    };
    holds(Difficulty::Hard) || holds(Difficulty::Easy)
}

/// The share of all splits into halves that are one given split.
fn chance(round: &Round) -> f64 {
    let splits: f64 = Role::ALL.iter().map(|role| halvings(members(round, *role).count())).product();
    (2.0 / splits).min(1.0)
}

/// Ways to choose half of so many robots.
fn halvings(count: usize) -> f64 {
    (0..count / 2).map(|i| (count - i) as f64 / (i + 1) as f64).product()
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

    #[test]
    fn a_split_by_sorting_is_one_whichever_half_takes_the_hard_task() {
        let sorted = [(90.0, 'h'), (20.0, 'e'), (80.0, 'h'), (30.0, 'e')];
        let turned = [(90.0, 'e'), (20.0, 'h'), (80.0, 'e'), (30.0, 'h')];
        let mixed = [(90.0, 'h'), (20.0, 'h'), (80.0, 'e'), (30.0, 'e')];
        let found = likeness(&[round(&sorted), round(&turned), round(&mixed), round(&mixed)], &KEYS[0]);
        assert!((found.split - 0.5).abs() < 1e-12 && (found.carriers - 0.5).abs() < 1e-12);
        assert!((found.hard_is_higher - 0.25).abs() < 1e-12, "{found:?}");
        assert!((found.chance - 1.0 / 3.0).abs() < 1e-12, "four carriers have three splits");
    }

    #[test]
    fn a_round_of_one_group_is_no_split() {
        assert_eq!(likeness(&[round(&[(90.0, 'e'), (20.0, 'e')])], &KEYS[0]).rounds, 0);
    }
}
