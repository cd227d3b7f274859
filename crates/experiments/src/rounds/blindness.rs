//! Relative entropy compares proportions: robots that differ in everything can trust each other fully. An example from real trials.

use rne_core::{NeedDistribution, NeedVector, RneOptions, relative_entropy};

use super::{Round, weights_of};
use crate::failure::Failure;
use crate::sweep::Grouped;

/// Entropies below this, in nats, are rounding.
const LEAST_NATS: f64 = 1e-9;

/// Levels that are nearer than this, in percent points, are the same.
const LEAST_POINTS: f64 = 2.0;

/// Two robots of one role in one round.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The one that trusts.
    pub from: Grouped,
    /// The one that is trusted.
    pub to: Grouped,
    /// Relative needs entropy, in nats.
    pub rne: f64,
}

impl Pair {
    /// How far their levels are apart: the distance of (energy, HP), in percent points.
    #[must_use]
    pub fn apart(&self) -> f64 {
        (self.from.energy - self.to.energy).hypot(self.from.hp - self.to.hp)
    }
}

/// Two pairs of one round: far apart and full of trust, and near each other and less so.
#[derive(Debug, Clone, PartialEq)]
pub struct Blindness {
    /// Number of the trial.
    pub trial: u32,
    /// Its seed.
    pub seed: u64,
    /// Number of the round.
    pub round: u32,
    /// The role of all of them.
    pub role: &'static str,
    /// The one is far apart in its levels.
    pub unlike: Pair,
    /// The other is of the same role and round and nearer to each other, but has the higher entropy.
    pub alike: Pair,
    /// Share of the pairs of pairs of one role and round in which the one with levels nearer to each other has the higher entropy.
    pub misjudged: f64,
}

/// The plainest example in these rounds: the one pair is as many times as far apart as the other, and the other has as many times the entropy, or
/// more. `None` where no pair with levels farther apart has the lower entropy.
///
/// # Errors
/// Needs or weights that cannot be used.
pub fn blindness(rounds: &[Round], options: &RneOptions) -> Result<Option<Blindness>, Failure> {
    let mut teams: Vec<(usize, &'static str, Vec<Pair>)> = Vec::new();
    for (place, round) in rounds.iter().enumerate() {
        let weights = weights_of(&round.robots, options)?;
        for role in rne_core::Role::ALL {
            let members: Vec<&Grouped> = round
                .robots
                .iter()
                .zip(&round.roles)
                .filter(|(_, of)| **of == role)
                .map(|(robot, _)| robot)
                .collect();
            let distribution = |robot: &&Grouped| {
                let needs = NeedVector::new(robot.needs.clone());
                needs.and_then(|needs| NeedDistribution::of_agent(&needs, &weights)).map_err(Failure::run)
            };
            let shares = members.iter().map(distribution).collect::<Result<Vec<_>, _>>()?;
            let mut pairs = Vec::new();
            for i in 0..members.len() {
                for j in (0..members.len()).filter(|j| *j != i) {
                    let rne = relative_entropy(&shares[i], &shares[j]).map_err(Failure::run)?;
                    let Some(rne) = rne.nats() else { continue };
                    pairs.push(Pair { from: members[i].clone(), to: members[j].clone(), rne });
                }
            }
            teams.push((place, role.name(), pairs));
        }
    }
    let misjudged = misjudged(&teams);
    let mut best: Option<(f64, usize, &'static str, &Pair, &Pair)> = None;
    for (place, role, pairs) in &teams {
        for unlike in pairs.iter().filter(|pair| pair.rne > LEAST_NATS) {
            for alike in pairs.iter().filter(|pair| pair.apart() > LEAST_POINTS) {
                let plain = (unlike.apart() / alike.apart()).min(alike.rne / unlike.rne);
                if plain > best.map_or(1.0, |(most, ..)| most) {
                    best = Some((plain, *place, role, unlike, alike));
                }
            }
        }
    }
    Ok(best.map(|(_, place, role, unlike, alike)| Blindness {
        trial: rounds[place].trial,
        seed: rounds[place].seed,
        round: rounds[place].round,
        role,
        unlike: unlike.clone(),
        alike: alike.clone(),
        misjudged,
    }))
}

fn misjudged(teams: &[(usize, &'static str, Vec<Pair>)]) -> f64 {
    let (mut wrong, mut all) = (0_u64, 0_u64);
    for (_, _, pairs) in teams {
        for (i, a) in pairs.iter().enumerate() {
            for b in &pairs[i + 1..] {
                all += 1;
                wrong += u64::from((a.apart() < b.apart()) != (a.rne < b.rne));
            }
        }
    }
    if all == 0 { 0.0 } else { wrong as f64 / all as f64 }
}

#[cfg(test)]
mod tests {
    use rne_core::{Difficulty, Role};

    use super::*;

    #[test]
    fn proportional_needs_are_full_trust_however_far_apart() {
        let robot = |id: u32, energy: f64, hp: f64| Grouped {
            round: 1,
            robot: id,
            task: Difficulty::Hard,
            energy,
            hp,
            needs: vec![hp, energy],
        };
        let robots = vec![robot(0, 90.0, 80.0), robot(1, 45.0, 40.02), robot(2, 90.0, 60.0)];
        let rounds = [Round { trial: 3, seed: 7, round: 1, roles: vec![Role::Carrier; 3], robots }];
        let found = blindness(&rounds, &RneOptions::default()).unwrap().unwrap();
        let mut ids = [found.unlike.from.robot, found.unlike.to.robot];
        ids.sort_unstable();
        assert_eq!(ids, [0, 1]);
        assert!(found.unlike.rne < 1e-6 && found.alike.rne > 1e-3);
        assert!(found.alike.apart() < found.unlike.apart());
    }
}
