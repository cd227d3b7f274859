//! The one utility of the policies OPTIMAL, GREEDY and GRAPE; KMEANS and SPECTRAL give groups to tasks by it.
//!
//! ```text
//! u_ij = quality * v_j * s_ij - distance * c_ij
//! ```
//!
//! - `s_ij`, the strength of member i, in [0, 1]: for each need the member's value over the largest in its
//!   role, as a mean weighted by the question. Needs of weight 0, and those that the whole role lacks, are
//!   left out. If task j `requires` needs, only these count (all, if none of them counts).
//! - `v_j`, the worth of task j, in [0, 1]: the rank of its difficulty among the distinct ones, from 1, over
//!   their number. If tasks state a `value` or the `rescuees` that wait, `v_j` is multiplied by the task's
//!   number over the largest one that is stated. A number that is not stated multiplies by 1.
//! - `c_ij`, the way, in [0, 1]: the distance from the member's home to the task's place, over the largest
//!   one in the question.
//!
//! Example: two members of a role with needs (8, 4) and (4, 4) and equal weights have strengths 1 and 0.75.
//! Of two tasks, the harder one has worth 1 and the other one 0.5. With `distance: 0`, the weaker member is
//! worth 0.75 at the harder task and 0.375 at the other one.

use teaming::error::PolicyError;
use teaming::question::{Member, Question, Task};

use crate::facts::{missing, squared_distance};

teaming::options! {
    /// Options of policies that need no more than the utility.
    #[derive(Copy)]
    pub struct UtilityOptions {
        /// How much strength at worthy tasks counts, from 0 to 100.
        pub quality: f64 = 1.0,
        /// How much the way to the task counts, from 0 to 100. With 0, no places are needed.
        pub distance: f64 = 1.0,
    }
}

/// The utility, as a policy uses it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Utility {
    policy: &'static str,
    options: UtilityOptions,
}

/// The two parts of the utility, for each member a number for each task.
pub(super) struct Parts {
    /// `quality * v_j * s_ij`.
    pub(super) gains: Vec<Vec<f64>>,
    /// `distance * c_ij`.
    pub(super) ways: Vec<Vec<f64>>,
}

impl Utility {
    /// Checks the options. Up to 100, sums over a team are exact as whole numbers of 2^-40.
    pub(super) fn new(policy: &'static str, options: UtilityOptions) -> Result<Self, &'static str> {
        let UtilityOptions { quality, distance } = options;
        match [quality, distance].map(|part| (0.0..=100.0).contains(&part)) {
            [false, _] => Err("quality must be from 0 to 100"),
            [_, false] => Err("distance must be from 0 to 100"),
            _ => Ok(Self { policy, options }),
        }
    }

    /// For each member, its utility at each task.
    pub(super) fn table(&self, question: &Question) -> Result<Vec<Vec<f64>>, PolicyError> {
        let Parts { gains, ways } = self.parts(question)?;
        let row = |(gains, ways): (Vec<f64>, Vec<f64>)| gains.iter().zip(ways).map(|(g, w)| g - w).collect();
        Ok(gains.into_iter().zip(ways).map(row).collect())
    }

    /// The parts of the utility.
    pub(super) fn parts(&self, question: &Question) -> Result<Parts, PolicyError> {
        let UtilityOptions { quality, distance } = self.options;
        let (scale, worths) = (Scale::of(question), worths(&question.tasks));
        let gains = |member: &Member| {
            let gain = |(task, worth): (&Task, &f64)| quality * worth * scale.strength_at(member, task);
            question.tasks.iter().zip(&worths).map(gain).collect()
        };
        let mut ways = vec![vec![0.0; question.tasks.len()]; question.members.len()];
        if distance > 0.0 {
            ways = self.ways(question)?;
        }
        let gains = question.members.iter().map(gains).collect();
        ways.iter_mut().flatten().for_each(|way| *way *= distance);
        Ok(Parts { gains, ways })
    }

    fn ways(&self, question: &Question) -> Result<Vec<Vec<f64>>, PolicyError> {
        let places: Option<Vec<[f64; 2]>> = question.tasks.iter().map(|task| task.place).collect();
        let places = places.ok_or_else(|| missing(self.policy, "the place of each task", None))?;
        let row = |member: &Member| {
            places.iter().map(|place| squared_distance(member.home, *place).sqrt()).collect::<Vec<f64>>()
        };
        let mut ways: Vec<Vec<f64>> = question.members.iter().map(row).collect();
        divide_by_largest(ways.iter_mut().flatten());
        Ok(ways)
    }
}

/// The strength of each member over all its needs.
pub(super) fn strengths(question: &Question) -> Vec<f64> {
    let scale = Scale::of(question);
    question.members.iter().map(|member| scale.strength(member, |_| true).unwrap_or(0.0)).collect()
}

/// The largest value of each need in each role.
struct Scale<'q> {
    question: &'q Question,
    largest: Vec<Vec<f64>>,
}

impl<'q> Scale<'q> {
    fn of(question: &'q Question) -> Self {
        let mut largest = vec![vec![0.0; question.needs.len()]; question.roles.len()];
        for member in &question.members {
            let of_role = largest[member.role.index()].iter_mut();
            of_role
                .zip(member.needs.values())
                .for_each(|(most, value): (&mut f64, _)| *most = most.max(*value));
        }
        Self { question, largest }
    }

    fn strength_at(&self, member: &Member, task: &Task) -> f64 {
        let required = self.strength(member, |need| task.requires.contains_key(need));
        required.or_else(|| self.strength(member, |_| true)).unwrap_or(0.0)
    }

    /// The strength in some needs; `None` if none of them counts.
    fn strength(&self, member: &Member, counts: impl Fn(&str) -> bool) -> Option<f64> {
        let (mut sum, mut weights) = (0.0, 0.0);
        let values = member.needs.values().iter().zip(&self.largest[member.role.index()]);
        for (need, (value, largest)) in self.question.needs.iter().zip(values) {
            if need.weight > 0.0 && *largest > 0.0 && counts(&need.name) {
                sum += need.weight * (value / largest);
                weights += need.weight;
            }
        }
        (weights > 0.0).then(|| sum / weights)
    }
}

/// The worth of each task.
fn worths(tasks: &[Task]) -> Vec<f64> {
    let mut ranks: Vec<u32> = tasks.iter().map(|task| task.difficulty).collect();
    ranks.sort_unstable();
    ranks.dedup();
    let rank =
        |task: &Task| ranks.partition_point(|rank| *rank <= task.difficulty) as f64 / ranks.len() as f64;
    let values = over_largest(tasks, |task| task.value);
    let waiting = over_largest(tasks, |task| task.rescuees.map(f64::from));
    tasks
        .iter()
        .map(rank)
        .zip(values)
        .zip(waiting)
        .map(|((rank, value), waiting)| rank * value * waiting)
        .collect()
}

/// A number of each task over the largest one; 1 where it is not stated.
fn over_largest(tasks: &[Task], number: impl Fn(&Task) -> Option<f64>) -> Vec<f64> {
    let mut numbers: Vec<Option<f64>> = tasks.iter().map(number).collect();
    divide_by_largest(numbers.iter_mut().flatten());
    numbers.into_iter().map(|number| number.unwrap_or(1.0)).collect()
}

/// Divides numbers >= 0 by the largest of them; if that is 0, they stay.
fn divide_by_largest<'a>(numbers: impl Iterator<Item = &'a mut f64>) {
    let numbers: Vec<&mut f64> = numbers.collect();
    let largest = numbers.iter().fold(0.0, |largest: f64, number| largest.max(**number));
    if largest > 0.0 {
        numbers.into_iter().for_each(|number| *number /= largest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_up::{question, with_needs};

    fn table(question: &Question, quality: f64, distance: f64) -> Vec<Vec<f64>> {
        let options = UtilityOptions { quality, distance };
        Utility::new("OPTIMAL", options).unwrap().table(question).unwrap()
    }

    #[test]
    fn the_example_by_hand() {
        let question = with_needs(&[&[8.0, 4.0], &[4.0, 4.0]], &[2, 1]);
        assert_eq!(strengths(&question), [1.0, 0.75]);
        assert_eq!(table(&question, 1.0, 0.0), [[1.0, 0.5], [0.75, 0.375]]);
    }

    #[test]
    fn needs_that_a_role_lacks_or_that_weigh_nothing_do_not_count() {
        let mut question = with_needs(&[&[8.0, 0.0, 3.0], &[4.0, 0.0, 9.0]], &[1]);
        question.needs[2].weight = 0.0;
        assert_eq!(strengths(&question), [1.0, 0.5]);
    }

    #[test]
    fn a_task_that_states_value_rescuees_or_required_needs_is_taken_at_its_word() {
        let mut question = with_needs(&[&[8.0, 4.0], &[4.0, 4.0]], &[1, 1, 1]);
        question.tasks[0].value = Some(3.0);
        question.tasks[1].value = Some(6.0);
        question.tasks[0].rescuees = Some(10);
        question.tasks[1].rescuees = Some(5);
        question.tasks[2].requires = [("need 0".to_owned(), 5.0)].into();
        assert_eq!(table(&question, 1.0, 0.0), [[0.5, 0.5, 1.0], [0.375, 0.375, 0.5]]);
    }

    #[test]
    fn the_way_counts_by_the_longest_one_and_a_missing_place_is_named() {
        let mut question = with_needs(&[&[1.0], &[1.0]], &[2, 1]);
        question.members[1].home = [3.0, 4.0];
        question.tasks[0].place = Some([0.0, 0.0]);
        question.tasks[1].place = Some([6.0, 8.0]);
        assert_eq!(table(&question, 0.0, 2.0), [[0.0, -2.0], [-1.0, -1.0]]);
        question.tasks[1].place = None;
        let utility = Utility::new("OPTIMAL", UtilityOptions::default()).unwrap();
        let error = utility.table(&question).unwrap_err();
        assert_eq!(error.to_string(), "policy OPTIMAL needs the place of each task, which is missing");
        assert_eq!(table(&question, 1.0, 0.0), [[1.0, 0.5]; 2]);
    }

    /// The team of `docs/policies.md`, `robots.csv`, for the tasks `near,1,20,30` and `far,2,70,50`. The
    /// figures were computed by an independent program.
    #[test]
    fn the_table_of_six_robots_is_that_of_another_program() {
        let found = table(&question(), 1.0, 1.0);
        let expected = [
            [-0.046_557_366_122_403_8, 0.0],
            [-0.177_818_353_183_891_44, -0.120_140_545_074_951_09],
            [-0.111_442_202_080_063_61, 0.099_433_491_390_073_74],
            [-0.220_567_680_736_446_73, -0.019_064_479_828_541_536],
            [-0.111_069_712_126_467_88, 0.146_420_800_447_360_17],
            [-0.267_119_647_604_71, -0.114_171_080_637_789_8],
        ];
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }
}
