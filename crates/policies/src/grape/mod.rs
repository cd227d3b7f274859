//! `GRAPE(reward, quality, distance)`: groups of selfish robots (Jang, Shin, Tsourdos 2018, *Anonymous
//! Hedonic Game for Task Allocation in a Large-Scale Multiple Agent System*, IEEE T-RO 34).
//!
//! A task has a reward, of which its p members of a role share equally, and each robot pays its own way:
//! `u = quality v_j s_ij f(p) / p - distance c_ij`, with the parts of the [utility](crate::utility). From
//! nobody placed, the lowest id that gains more than 1e-12 moves to its best task, until no robot gains: a
//! Nash stable partition. Robots of each role play among themselves, and do not know the sizes that the
//! question suggests. Where sizes are not free, only tasks with an open slot can be moved to: the game ends
//! when all slots are taken, and what comes out depends on the order of the ids.
//!
//! A move is one round in which the robot tells all others of its role the partition. Time: n m for each
//! move, for n members of a role and m tasks.
//!
//! Example, with `distance: 0` and free sizes: two equal robots, two tasks of worth 1 and 0.5. The first
//! robot takes the worthier task. There, the second one would get log2(3) / 2 = 0.79, which is more than 0.5
//! alone at the other task; so would the first one. Both stay.

mod game;

use serde::{Deserialize, Serialize};
use teaming::decision::{Account, Decision, Protocol};
use teaming::error::PolicyError;
use teaming::policy::Policy;
use teaming::question::{GroupSizes, Question};
use teaming::registry::PolicyKind;

use crate::assigning::of_role;
use crate::utility::{Parts, Utility, UtilityOptions};
use game::Game;

const NAME: &str = "GRAPE";

/// How the reward of a task grows with its members p, of n in the role, for m tasks: the authors' shapes. All
/// are 1 at n/m members, but for the constant one, which is always 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Reward {
    /// `log2(p + 1) / log2(n/m + 1)`: each further member adds less. The default.
    #[default]
    Logarithm,
    /// `(p m/n) exp(1 - p m/n)`: most at n/m members.
    Peaked,
    /// 1: further members add nothing.
    Constant,
}

teaming::options! {
    /// Options of `GRAPE`.
    #[derive(Copy)]
    pub struct Options {
        /// How the reward of a task grows with its members.
        pub reward: Reward = Reward::default(),
        /// How much strength at worthy tasks counts, from 0 to 100.
        pub quality: f64 = 1.0,
        /// How much the way to the task counts, from 0 to 100.
        pub distance: f64 = 1.0,
    }
}

/// Per role, a partition in which no robot gains by a move.
#[derive(Debug, Clone, Copy)]
pub struct Grape {
    reward: Reward,
    utility: Utility,
}

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::with_options(NAME, "each robot moves to its best task, until none gains", Grape::new)
        .from_sources(env!("SOURCES_GRAPE"))
}

impl Reward {
    /// The share of the reward that each of `p` members gets, `p` from 1 to `n`.
    fn shares(self, n: usize, m: usize) -> Vec<f64> {
        let equal = n as f64 / m as f64;
        let total = |p: f64| match self {
            Self::Logarithm => libm::log2(p + 1.0) / libm::log2(equal + 1.0),
            Self::Peaked => p / equal * libm::exp(1.0 - p / equal),
            Self::Constant => 1.0,
        };
        (1..=n).map(|p| total(p as f64) / p as f64).collect()
    }
}

impl Grape {
    fn new(options: Options) -> Result<Self, &'static str> {
        let Options { reward, quality, distance } = options;
        Ok(Self { reward, utility: Utility::new(NAME, UtilityOptions { quality, distance })? })
    }
}

impl Policy for Grape {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let Parts { gains, ways } = self.utility.parts(question)?;
        let hardest_first = question.hardest_first();
        let mut groups = vec![Vec::new(); question.tasks.len()];
        let mut sent = Protocol::default();
        for (role, quota) in question.role_ids().zip(&question.quotas) {
            let members = of_role(question, role);
            let ordered = |table: &[Vec<f64>]| -> Vec<Vec<f64>> {
                let row =
                    |member: &usize| hardest_first.iter().map(|task| table[*member][task.index()]).collect();
                members.iter().map(row).collect()
            };
            let room = |slots: usize| if quota.sizes == GroupSizes::Free { members.len() } else { slots };
            let game = Game {
                rewards: ordered(&gains),
                ways: ordered(&ways),
                shares: self.reward.shares(members.len(), hardest_first.len()),
                room: hardest_first.iter().map(|task| room(quota.members[task.index()])).collect(),
            };
            let played = game.play();
            sent = sent.beside(played.sent());
            let pairs = members.iter().zip(played.task_of);
            pairs.for_each(|(i, rank)| groups[hardest_first[rank].index()].push(question.members[*i].id));
        }
        let account = Account::Protocol(sent);
        Ok(Decision { proven_optimal: false, account, ..Decision::unscored(groups) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_up::with_needs;

    #[test]
    fn the_example_by_hand() {
        let mut question = with_needs(&[&[1.0], &[1.0]], &[2, 1]);
        question.quotas[0].sizes = GroupSizes::Free;
        let grape = Grape::new(Options { distance: 0.0, ..Options::default() }).unwrap();
        let decision = grape.decide(&question).unwrap();
        assert_eq!(decision.assignment.groups, [vec![0, 1], vec![]]);
        assert!(!decision.proven_optimal);
    }

    /// The first robot to choose is nearer to the first task, and is pushed out by the others.
    #[test]
    fn robots_move_on_while_slots_are_open() {
        let mut question = with_needs(&[&[1.0], &[1.0], &[1.0], &[1.0]], &[1, 1]);
        let homes = [49.0, 0.0, 50.0, 50.0];
        question.members.iter_mut().zip(homes).for_each(|(member, x)| member.home = [x, 0.0]);
        question.tasks.iter_mut().zip([0.0, 100.0]).for_each(|(task, x)| task.place = Some([x, 0.0]));
        let decision = Grape::new(Options::default()).unwrap().decide(&question).unwrap();
        assert_eq!(decision.assignment.groups, [[1, 2], [0, 3]]);
    }
}
