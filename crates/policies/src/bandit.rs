//! `BANDIT(width)`: learns from earlier rounds how much each robot rescues at each task.
//!
//! Combinatorial upper confidence bounds (Chen, Wang, Yuan 2013, *Combinatorial Multi-Armed Bandit: General
//! Framework and Applications*, ICML): a pair of a member and a task that was tried n times in t rounds
//! counts with `mean + width * sqrt(3 ln t / (2 n))`, where the mean of what the member rescued there goes
//! over the most that any member rescued in a round. A pair that was never tried counts more than any other.
//! The assignment with the largest sum is that of OPTIMAL on these numbers. Time: the square of a
//! role's members at most.
//!
//! Example: of two robots and two tasks of one slot each, the first robot goes to the harder task in round 1,
//! and they are swapped in round 2. With 4 and 1 rescued in round 1, and 2 and 2 in round 2, the means over
//! 4 are (1, 0.5) for the first and (0.5, 0.25) for the second; the bounds are equally wide. All sums are
//! 1.25 and 1: in round 3 the first one goes to the harder task.

use teaming::decision::Decision;
use teaming::error::PolicyError;
use teaming::policy::Policy;
use teaming::question::Question;
use teaming::registry::PolicyKind;

use crate::assigning::{best, groups};

teaming::options! {
    /// Options of `BANDIT`.
    #[derive(Copy)]
    pub struct Options {
        /// How much being unsure counts, from 0 to 10; 1 is the authors' choice.
        pub width: f64 = 1.0,
    }
}

/// Per role, the largest sum of what members may rescue.
#[derive(Debug, Clone, Copy)]
pub struct Bandit {
    options: Options,
}

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::with_options("BANDIT", "learns how much each robot rescues at each task", Bandit::new)
        .from_sources(env!("SOURCES_BANDIT"))
}

impl Bandit {
    fn new(options: Options) -> Result<Self, &'static str> {
        let is_width = (0.0..=10.0).contains(&options.width);
        if is_width { Ok(Self { options }) } else { Err("width must be from 0 to 10") }
    }
}

impl Policy for Bandit {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let tried = tried(question);
        let most = tried.iter().flatten().fold(1.0, |most: f64, pair| most.max(pair.most));
        let rounds = question.history.len().max(1) as f64;
        let width = |times: f64| self.options.width * (1.5 * libm::log(rounds) / times).sqrt();
        let value = |pair: &Tried| match pair.times {
            0.0 => 2.0 + width(1.0),
            times => pair.rescued / times / most + width(times),
        };
        let values: Vec<Vec<f64>> = tried.iter().map(|row| row.iter().map(value).collect()).collect();
        Ok(Decision::unscored(groups(question, &best(question, &values))))
    }
}

/// What a member did at a task in earlier rounds.
#[derive(Debug, Clone, Copy, Default)]
struct Tried {
    times: f64,
    rescued: f64,
    /// The most in one round.
    most: f64,
}

/// For each member, what it did at each task.
fn tried(question: &Question) -> Vec<Vec<Tried>> {
    let mut tried = vec![vec![Tried::default(); question.tasks.len()]; question.members.len()];
    for group in question.history.iter().flat_map(|round| &round.groups) {
        for outcome in &group.members {
            let member = question.members.binary_search_by_key(&outcome.id, |member| member.id);
            let Some(pair) = member.ok().and_then(|at| tried[at].get_mut(group.task.index())) else {
                continue;
            };
            let rescued = f64::from(outcome.rescued);
            *pair = Tried {
                times: pair.times + 1.0,
                rescued: pair.rescued + rescued,
                most: pair.most.max(rescued),
            };
        }
    }
    tried
}

#[cfg(test)]
mod tests {
    use rand::RngExt;
    use teaming::{GroupOutcome, MemberOutcome, RandomSeed, RoundOutcome, TaskId};

    use super::*;
    use crate::made_up::{question, with_needs};

    /// The outcome of a round in which each of the members rescued so many.
    fn round(number: u32, groups: &[Vec<u32>], rescued: &mut impl FnMut(u32, usize) -> u32) -> RoundOutcome {
        let mut group = |(task, ids): (usize, &Vec<u32>)| GroupOutcome {
            task: TaskId(task as u16),
            rescued: 0,
            energy: 0.0,
            hp: 0.0,
            members: ids
                .iter()
                .map(|id| MemberOutcome { id: *id, rescued: rescued(*id, task), ..MemberOutcome::default() })
                .collect(),
        };
        RoundOutcome {
            round: number,
            duration_s: 1.0,
            groups: groups.iter().enumerate().map(&mut group).collect(),
        }
    }

    #[test]
    fn the_example_by_hand() {
        let mut question = with_needs(&[&[1.0], &[1.0]], &[2, 1]);
        let bandit = Bandit::new(Options::default()).unwrap();
        let answer = |question: &Question| bandit.decide(question).unwrap().assignment.groups;
        let rescued = [[4, 2], [2, 1]];
        for (number, expected) in [(1, [[0], [1]]), (2, [[1], [0]])] {
            assert_eq!(answer(&question), expected);
            let outcome = round(number, &answer(&question), &mut |id, task| rescued[id as usize][task]);
            question.history.push(outcome);
        }
        assert_eq!(answer(&question), [[0], [1]]);
        assert_eq!(answer(&question), answer(&question.clone()), "the same question has the same answer");
    }

    /// A world in which each robot rescues Poisson-like numbers around a mean of its own at each task.
    #[test]
    fn regret_stays_below_that_of_random_in_a_world_with_known_means() {
        let means: [[f64; 2]; 6] = [[5.0, 1.0], [2.0, 4.0], [3.0, 3.0], [1.0, 4.0], [6.0, 2.0], [2.0, 3.0]];
        let best = 5.0 + 4.0 + 3.0 + 4.0 + 6.0 + 3.0; // robots 1 and 2, 3 and 4, 5 and 6 share a role
        let expected = |groups: &[Vec<u32>]| -> f64 {
            let of_task = |(task, ids): (usize, &Vec<u32>)| {
                ids.iter().map(|id| means[*id as usize - 1][task]).sum::<f64>()
            };
            groups.iter().enumerate().map(of_task).sum()
        };
        let regret = |policy: &dyn Policy| {
            let mut question = question();
            let mut draws = question.draws();
            let mut lost = Vec::new();
            for number in 1..=200 {
                question.random_seed = RandomSeed::from(u64::from(number));
                let groups = policy.decide(&question).unwrap().assignment.groups;
                lost.push(best - expected(&groups));
                let mut rescued = |id: u32, task: usize| {
                    let most = (2.0 * means[id as usize - 1][task]) as u32;
                    draws.random_range(0..=most)
                };
                question.history.push(round(number, &groups, &mut rescued));
            }
            [lost.iter().sum::<f64>(), lost[100..].iter().sum::<f64>()]
        };
        let [of_bandit, late] = regret(&Bandit::new(Options::default()).unwrap());
        let [of_random, late_random] = regret(&crate::random::Random);
        println!("{of_bandit} {late}, RANDOM {of_random} {late_random}");
        assert!(of_bandit >= 0.0 && of_bandit < of_random / 2.0, "{of_bandit} {of_random}");
        assert!(late < late_random / 2.0, "{late} {late_random}");
    }
}
