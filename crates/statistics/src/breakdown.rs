//! How many liars a policy bears: a set of numbers in which its breakdown point lies, with one confidence
//! for the whole statement.
//!
//! Where a policy is not shown to be better than a draw among honest robots there is nothing to break down,
//! and no point is named. Intervals are simultaneous over the numbers of liars: the largest studentised
//! deviation of all means is resampled by seeds (max-T; Westfall and Young 1993), so that differences of one
//! seed stay together.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use crate::bootstrap::quantile;
use crate::comparison::{Direction, Standing};

const RESAMPLES: usize = 4_000;
const SEED: u64 = 1;

/// What is known of the breakdown of a policy.
#[derive(Debug, Clone, PartialEq)]
pub struct Breakdown {
    /// What the pairs can say at all. Unless they are judged, there is no interval and no point.
    pub standing: Standing,
    /// The interval of the difference from a draw for each number of liars; `None` where all differences
    /// are equal or there are too few.
    pub intervals: Vec<Option<[f64; 2]>>,
    /// Whether the policy is shown to be better than a draw without liars. If not, the others are `None`.
    pub has_room: bool,
    /// The largest number of liars up to which the policy is shown to be better than a draw all along.
    pub safe: Option<usize>,
    /// The smallest number of liars, above that, with which it is shown not to be: worse than a draw, or
    /// within the margin of it.
    pub broken: Option<usize>,
}

impl Breakdown {
    /// From the differences between a policy and a draw, a row of pairs in the same order of seeds for each
    /// number of liars from 0 on. A difference within `margin` is none.
    pub fn of(differences: &[Vec<f64>], margin: f64, confidence: f64, direction: Direction) -> Self {
        let is_same = differences.iter().flatten().all(|difference| *difference == 0.0);
        let standing = Standing::of(differences.first().map_or(0, Vec::len), is_same);
        let intervals = match standing {
            Standing::Judged => simultaneous(differences, confidence),
            _ => vec![None; differences.len()],
        };
        let gain = |interval: &Option<[f64; 2]>| match direction {
            Direction::Lower => interval.map(|[low, high]| [-high, -low]),
            Direction::Higher | Direction::Neither => *interval,
        };
        let is_better = |interval: &Option<[f64; 2]>| gain(interval).is_some_and(|[low, _]| low > 0.0);
        let is_broken = |interval: &Option<[f64; 2]>| {
            gain(interval).is_some_and(|[low, high]| high < margin && (low > -margin || high < 0.0))
        };
        let kept = intervals.iter().take_while(|it| is_better(it)).count();
        let broken = intervals[kept..].iter().position(is_broken).map(|place| kept + place);
        let broken = broken.filter(|_| kept > 0);
        Self { standing, has_room: kept > 0, safe: kept.checked_sub(1), broken, intervals }
    }
}

/// Intervals of the means of rows of paired values that hold all at once at this confidence. `None` for rows
/// of fewer than two values or of equal ones.
///
/// # Panics
/// The rows have different lengths.
pub fn simultaneous(rows: &[Vec<f64>], confidence: f64) -> Vec<Option<[f64; 2]>> {
    let count = rows.first().map_or(0, Vec::len);
    assert!(rows.iter().all(|row| row.len() == count), "rows of pairs have one length");
    let moments: Vec<Option<[f64; 2]>> = rows.iter().map(|row| mean_and_error(row)).collect();
    if count < 2 {
        return vec![None; rows.len()];
    }
    let mut draws = ChaCha8Rng::seed_from_u64(SEED);
    let mut furthest: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let places: Vec<usize> =
                (0..count).map(|_| draws.random_range(0..count as u32) as usize).collect();
            let deviation = |(row, moments): (&Vec<f64>, &Option<[f64; 2]>)| {
                let [mean, _] = (*moments)?;
                let again: Vec<f64> = places.iter().map(|place| row[*place]).collect();
                let [other, error] = mean_and_error(&again)?;
                Some(((other - mean) / error).abs())
            };
            rows.iter().zip(&moments).filter_map(deviation).fold(0.0, f64::max)
        })
        .collect();
    furthest.sort_by(f64::total_cmp);
    let reach = quantile(&furthest, confidence);
    let interval = |[mean, error]: [f64; 2]| [mean - reach * error, mean + reach * error];
    moments.into_iter().map(|moments| moments.map(interval)).collect()
}

/// The mean of values and its standard error; `None` if they are equal or fewer than two.
fn mean_and_error(values: &[f64]) -> Option<[f64; 2]> {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let error = (squares / (count - 1.0) / count).sqrt();
    (values.len() > 1 && error > 0.0).then_some([mean, error])
}

#[cfg(test)]
mod tests {
    use rand_distr::{Distribution, Normal};

    use super::*;

    /// Differences of 60 seeds whose true means fall from 6 with 0 liars by 2 a liar: with 3 liars the
    /// policy is a draw, with more it is worse. Seeds have a part in common.
    fn differences(seed: u64) -> Vec<Vec<f64>> {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let normal = Normal::new(0.0, 3.0).unwrap();
        let shared: Vec<f64> = (0..60).map(|_| normal.sample(&mut draws)).collect();
        let mean = |liars: u32| 6.0 - 2.0 * f64::from(liars);
        (0..7)
            .map(|liars| shared.iter().map(|it| it + mean(liars) + normal.sample(&mut draws)).collect())
            .collect()
    }

    /// The statement "up to `safe` liars it is better, with `broken` it is not" is wrong in at most 5 % of
    /// the experiments, and says something in most.
    #[test]
    fn the_statement_is_seldom_wrong() {
        let found: Vec<Breakdown> =
            (0..200).map(|seed| Breakdown::of(&differences(seed), 1.0, 0.95, Direction::Higher)).collect();
        let wrong =
            found.iter().filter(|it| it.safe.is_some_and(|k| k >= 3) || it.broken.is_some_and(|k| k < 3));
        let wrong = wrong.count();
        assert!(wrong <= 16, "{wrong} of 200: more than 5 % and three standard errors");
        let sharp = found.iter().filter(|it| it.safe == Some(2) && it.broken == Some(4)).count();
        assert!(sharp > 100, "{sharp} of 200 name 2 and 4");
    }

    /// An interval between 0 and the margin is shown to be better, and is not counted as broken as well.
    #[test]
    fn better_by_less_than_the_margin_is_better() {
        let found = Breakdown::of(&differences(1)[..3], 100.0, 0.95, Direction::Higher);
        assert_eq!((found.safe, found.broken), (Some(2), None));
    }

    #[test]
    fn without_room_no_point_is_named() {
        let worse: Vec<Vec<f64>> = differences(1)[4..].to_vec();
        let found = Breakdown::of(&worse, 1.0, 0.95, Direction::Higher);
        assert_eq!((found.has_room, found.safe, found.broken), (false, None, None));
        assert!(found.intervals.iter().all(Option::is_some));
    }

    #[test]
    fn less_of_a_cost_is_better() {
        let of = |differences: &[Vec<f64>]| Breakdown::of(differences, 1.0, 0.95, Direction::Lower);
        let opposite: Vec<Vec<f64>> =
            differences(1).iter().map(|row| row.iter().map(|it| -it).collect()).collect();
        assert!(of(&opposite).safe >= Some(1) && !of(&differences(1)[..1]).has_room);
    }

    #[test]
    fn few_pairs_or_equal_ones_name_no_point() {
        let of = |differences: &[Vec<f64>]| Breakdown::of(differences, 1.0, 0.95, Direction::Higher);
        let few = of(&[vec![9.0, 9.5], vec![8.0, 9.0]]);
        assert_eq!((few.standing, few.safe), (Standing::TooFew { distinct: 2 }, None));
        assert_eq!(few.intervals, [None, None]);
        assert_eq!(of(&[vec![0.0; 9]]).standing, Standing::Same);
    }

    #[test]
    fn equal_differences_have_no_interval() {
        let found = Breakdown::of(&[vec![2.0; 9], vec![2.0; 9]], 1.0, 0.95, Direction::Higher);
        assert_eq!(found.intervals, [None, None]);
        assert!(simultaneous(&[], 0.95).is_empty());
    }
}
