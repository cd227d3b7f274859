//! Rounds as their policies found and split them: what a split amounts to, and how another policy would have split the same team.

mod blindness;
mod levels;
mod sorting;

use std::collections::BTreeMap;

use rne_core::{
    Difficulty, Grouping, GroupingPolicy, Member, NeedVector, NeedWeights, RneOptions, Role, Team,
};

pub use blindness::{Blindness, Example, Pair};
pub use levels::{GroupLevels, levels};
pub use sorting::{KEYS, Key, Likeness, Share, likeness};

use crate::failure::Failure;
use crate::sweep::folder::Folder;
use crate::sweep::{Grouped, Trial};

/// One round of one trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Round {
    /// Number of the trial, from 1.
    pub trial: u32,
    /// Seed of the trial.
    pub seed: u64,
    /// Number of the round, from 1.
    pub round: u32,
    /// The robots that were grouped, by id.
    pub robots: Vec<Grouped>,
    /// Their roles.
    pub roles: Vec<Role>,
}

/// The rounds of a trial.
#[must_use]
pub fn rounds_of(number: u32, trial: &Trial) -> Vec<Round> {
    let mut rounds: BTreeMap<u32, Vec<Grouped>> = BTreeMap::new();
    for robot in &trial.grouped {
        rounds.entry(robot.round).or_default().push(robot.clone());
    }
    let of_round = |(round, mut robots): (u32, Vec<Grouped>)| {
        robots.sort_by_key(|robot| robot.robot);
        let roles = robots.iter().map(|robot| trial.record.robots[robot.robot as usize].role).collect();
        Round { trial: number, seed: trial.record.seed, round, robots, roles }
    };
    rounds.into_iter().map(of_round).collect()
}

/// All rounds of one policy of a sweep.
///
/// # Errors
/// The journal cannot be read.
pub fn rounds_in(folder: &mut Folder, case: usize, policy: usize) -> Result<Vec<Round>, Failure> {
    let mut rounds = Vec::new();
    for place in folder.places(case, policy) {
        if let Ok(trial) = folder.outcome(place)?.result {
            rounds.extend(rounds_of(place.2, &trial));
        }
    }
    Ok(rounds)
}

impl Round {
    /// The team as the policy saw it, but for positions, which only distance-based policies look at.
    ///
    /// # Errors
    /// None: it was a team.
    pub fn team(&self) -> Result<Team, Failure> {
        let member = |(robot, role): (&Grouped, &Role)| {
            Ok(Member {
                id: robot.robot,
                role: *role,
                position: [0.0, 0.0],
                needs: NeedVector::new(robot.needs.clone()).map_err(Failure::run)?,
                energy_level: Some(robot.energy),
                hp_level: Some(robot.hp),
            })
        };
        let members = self.robots.iter().zip(&self.roles).map(member).collect::<Result<Vec<_>, Failure>>()?;
        Team::new(members, None).map_err(Failure::run)
    }

    /// How another policy, one that needs neither positions nor draws, would have grouped this team.
    ///
    /// # Errors
    /// It cannot.
    pub fn grouped_by(&self, policy: &dyn GroupingPolicy) -> Result<Grouping, Failure> {
        let mut draws =
            usar_sim::seed::stream(self.seed, usar_sim::seed::Purpose::Grouping, u64::from(self.round));
        policy.group(&self.team()?, &mut draws).map_err(Failure::run)
    }

    /// Ids of a task's group.
    #[must_use]
    pub fn group(&self, task: Difficulty) -> Vec<u32> {
        self.robots.iter().filter(|robot| robot.task == task).map(|robot| robot.robot).collect()
    }

    /// Whether a grouping is this round's: with the same tasks, and as a split, whichever half takes which task.
    #[must_use]
    pub fn is_as(&self, grouping: &Grouping) -> [bool; 2] {
        let (hard, easy) = (self.group(Difficulty::Hard), self.group(Difficulty::Easy));
        let same = hard == grouping.hard && easy == grouping.easy;
        [same, same || hard == grouping.easy && easy == grouping.hard]
    }
}

/// The weights that RNE gives to the needs of a team.
///
/// # Errors
/// Weights that cannot be used.
pub fn weights_of(robots: &[Grouped], options: &RneOptions) -> Result<NeedWeights, Failure> {
    let needs = robots.first().map_or(0, |robot| robot.needs.len());
    let mut weights = options.weights.clone().unwrap_or_else(|| vec![1.0; needs]);
    if options.scale {
        for (k, weight) in weights.iter_mut().enumerate() {
            let most = robots.iter().map(|robot| robot.needs[k]).fold(0.0, f64::max);
            *weight = if most > 0.0 { *weight / most } else { 0.0 };
        }
    }
    NeedWeights::new(weights).map_err(Failure::run)
}
