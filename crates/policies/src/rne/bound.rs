//! An upper bound on the score of any grouping, whatever search finds it.
//!
//! For each need, a group's share lies between the least and the greatest share that any choice of members by
//! the quotas has. The mean of the groups' shares, weighted by the sums of their needs, is the share of the
//! whole team. The score of a pair is a sum over needs of terms like `p ln(p/q) - p + q`, each >= 0 and
//! convex in both shares together, so that the sum over all pairs is largest at a corner of what is allowed:
//! all groups but one at the least or the greatest share, and one at what the mean leaves for it. These
//! largest values, added up over the needs, bound the score.

use super::options::ScoreDirection;
use super::scorer::Scorer;
use rne_core::trust::RelativeNeedsEntropy;

/// Steps towards the greatest share of a need; three to six suffice.
const STEPS: usize = 20;

/// By how much more than its value a bound is, relatively, so that rounding never takes it below a score.
const ROUNDING: f64 = 1e-9;

/// The robots of a role, and how many of them a group may have.
pub(super) struct Choice<'a> {
    rows: Vec<&'a [f64]>,
    least: usize,
    most: usize,
    filled: usize,
}

impl<'a> Choice<'a> {
    /// Of robots with these weighted needs, in parts of these sizes.
    pub(super) fn new(rows: impl IntoIterator<Item = &'a [f64]>, sizes: &[usize]) -> Self {
        Self {
            rows: rows.into_iter().collect(),
            least: sizes.iter().copied().min().unwrap_or(0),
            most: sizes.iter().copied().max().unwrap_or(0),
            filled: sizes.iter().filter(|size| **size > 0).count(),
        }
    }

    /// The places of the members of a group with the largest sum of these values, one for each robot.
    fn best(&self, values: &[f64]) -> Vec<usize> {
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_unstable_by(|a, b| values[*b].total_cmp(&values[*a]).then(a.cmp(b)));
        let positive = order.iter().filter(|robot| values[**robot] > 0.0).count();
        order.truncate(positive.clamp(self.least, self.most));
        order
    }
}

/// No grouping has a larger score than this. There are so many tasks; each role has some members.
pub(super) fn upper_bound(roles: &[Choice<'_>], tasks: usize, scorer: &Scorer) -> f64 {
    let team = Team { roles };
    let fewest = roles.iter().map(|role| role.filled).max().unwrap_or(0);
    let most = tasks.min(roles.iter().map(|role| role.filled).sum());
    let mut shares: Vec<Shares> = (0..team.needs()).map(|need| team.shares(need)).collect();
    let mut wholes = [team.most(|row| -whole(row)).abs(), team.most(whole)];
    if scorer.sort {
        // The i-th least share of a group lies between the i-th least of the bounds. Its mean is not known.
        let mut ends = [0, 1].map(|end| shares.iter().map(|shares| shares.ends[end]).collect::<Vec<f64>>());
        ends.iter_mut().for_each(|ends| ends.sort_by(f64::total_cmp));
        let sorted = ends[0].iter().zip(&ends[1]).map(|(low, high)| [*low, *high]);
        shares.iter_mut().zip(sorted).for_each(|(shares, ends)| shares.ends = ends);
        wholes = [0.0, f64::INFINITY];
    }
    let of = |groups: usize| {
        let terms = shares.iter().map(|shares| shares.largest(groups, wholes, scorer.direction));
        let sum: f64 = terms.sum::<f64>() * (1.0 + ROUNDING);
        match scorer.direction {
            ScoreDirection::JensenShannon => sum.min(pairs(groups) * std::f64::consts::LN_2),
            _ => sum,
        }
    };
    (fewest.max(2)..=most).map(of).fold(0.0, f64::max)
}

/// How far a score can be below the best one, in per cent of the bound: 0 where nothing is better.
pub(super) fn gap_percent(score: RelativeNeedsEntropy, bound: RelativeNeedsEntropy) -> f64 {
    match (score.nats(), bound.nats()) {
        (Some(_), None) => 100.0,
        (Some(score), Some(bound)) if score < bound => 100.0 * (bound - score) / bound,
        _ => 0.0,
    }
}

fn pairs(groups: usize) -> f64 {
    (groups * (groups - 1) / 2) as f64
}

fn whole(row: &[f64]) -> f64 {
    row.iter().sum()
}

/// All robots.
struct Team<'a> {
    roles: &'a [Choice<'a>],
}

impl Team<'_> {
    fn needs(&self) -> usize {
        self.roles.first().and_then(|role| role.rows.first()).map_or(0, |row| row.len())
    }

    fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.roles.iter().flat_map(|role| role.rows.iter().copied())
    }

    /// The shares of a need.
    fn shares(&self, need: usize) -> Shares {
        let all: f64 = self.rows().map(|row| row[need]).sum();
        let mean = all / self.rows().map(whole).sum::<f64>();
        let high = self.largest_ratio(|row| row[need]);
        let low = -self.largest_ratio(|row| -row[need]);
        Shares { ends: [low.clamp(0.0, mean), high.clamp(mean, 1.0)], mean }
    }

    /// The members of a group with the largest sum of a value; not nobody.
    fn group(&self, value: impl Fn(&[f64]) -> f64) -> Vec<&[f64]> {
        let mut group = Vec::new();
        for role in self.roles {
            let values: Vec<f64> = role.rows.iter().map(|row| value(row)).collect();
            group.extend(role.best(&values).into_iter().map(|robot| role.rows[robot]));
        }
        if group.is_empty() {
            group.extend(self.rows().max_by(|a, b| value(a).total_cmp(&value(b))));
        }
        group
    }

    fn most(&self, value: impl Fn(&[f64]) -> f64) -> f64 {
        self.group(&value).into_iter().map(value).sum()
    }

    /// No group has a larger ratio of the sum of a value to the sum of all needs: Dinkelbach's method. Where
    /// it stops early, what a group can still gain over the ratio so far is added.
    fn largest_ratio(&self, value: impl Fn(&[f64]) -> f64) -> f64 {
        let least = self.most(|row| -whole(row)).abs();
        let ratio_of = |group: &[&[f64]]| {
            let sum: f64 = group.iter().map(|row| value(row)).sum();
            sum / group.iter().map(|row| whole(row)).sum::<f64>()
        };
        let mut ratio = ratio_of(&self.group(&value));
        let mut above = 0.0;
        for _ in 0..STEPS {
            let gain = |row: &[f64]| value(row) - ratio * whole(row);
            let group = self.group(gain);
            above = group.iter().map(|row| gain(row)).sum::<f64>().max(0.0) / least;
            let next = ratio_of(&group);
            if next <= ratio {
                break;
            }
            ratio = next;
        }
        ratio + above
    }
}

/// The shares that a group may have of a need, and the share of the whole team.
struct Shares {
    ends: [f64; 2],
    mean: f64,
}

impl Shares {
    /// The largest value of this need's terms over all pairs of so many groups. Each group's sum of all needs
    /// lies between `wholes`.
    fn largest(&self, groups: usize, wholes: [f64; 2], direction: ScoreDirection) -> f64 {
        let [low, high] = self.ends;
        let at_ends = term(direction, high, low);
        let mut largest: f64 = 0.0;
        for highs in 0..groups {
            let lows = groups - 1 - highs;
            let Some(rest) = self.rest([lows, highs], wholes) else { continue };
            for share in rest {
                let [lows, highs] = [lows as f64, highs as f64];
                let mut sum = 0.0; // nothing times infinite is nothing
                for (count, value) in [
                    (lows * highs, at_ends),
                    (lows, term(direction, low, share)),
                    (highs, term(direction, high, share)),
                ] {
                    sum += if count > 0.0 { count * value } else { 0.0 };
                }
                largest = largest.max(sum);
            }
        }
        largest
    }

    /// The least and the greatest share of the one group that is left, if so many have the lowest and the
    /// highest share.
    fn rest(&self, [lows, highs]: [usize; 2], [light, heavy]: [f64; 2]) -> Option<[f64; 2]> {
        let [low, high] = self.ends;
        if light == 0.0 {
            return Some(self.ends);
        }
        let [under, over] = [lows as f64 * (self.mean - low), highs as f64 * (high - self.mean)];
        let by = |left: f64, for_positive: f64, for_negative: f64| {
            self.mean + left / if left > 0.0 { for_positive } else { for_negative }
        };
        let least = by(under * light - over * heavy, heavy, light);
        let most = by(under * heavy - over * light, light, heavy);
        let slack = ROUNDING * (high - low);
        let is_possible = least <= high + slack && most >= low - slack;
        is_possible.then(|| [least.clamp(low, high), most.clamp(low, high)])
    }
}

/// One need's part of the score of two groups with these shares of it: never below 0, and convex.
fn term(direction: ScoreDirection, p: f64, q: f64) -> f64 {
    let directed = |p: f64, q: f64| match (p > 0.0, q > 0.0) {
        (false, _) => q,
        (true, false) => f64::INFINITY,
        (true, true) => (p * libm::log(p / q) - p + q).max(0.0),
    };
    let [one, other] = [directed(p, q), directed(q, p)];
    match direction {
        // Of which of two groups the ids are lower is not known.
        ScoreDirection::MaxOfBoth | ScoreDirection::FirstToSecond => one.max(other),
        ScoreDirection::Sum => one + other,
        ScoreDirection::JensenShannon => {
            let middle = f64::midpoint(p, q);
            0.5 * (directed(p, middle) + directed(q, middle))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rne::partition::best_partition;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    const DIRECTIONS: [ScoreDirection; 4] = [
        ScoreDirection::MaxOfBoth,
        ScoreDirection::FirstToSecond,
        ScoreDirection::Sum,
        ScoreDirection::JensenShannon,
    ];

    fn drawn(robots: usize, draws: &mut ChaCha8Rng) -> Vec<Vec<f64>> {
        let (needs, least) = (draws.random_range(1..6), draws.random_range(0.1..50.0));
        (0..robots).map(|_| (0..needs).map(|_| draws.random_range(least..60.0)).collect()).collect()
    }

    /// All scores of the groups that these rows can join; each row has its role.
    fn best_of_all(
        rows: &[[&[f64]; 2]],
        groups: &mut Vec<Vec<f64>>,
        room: &mut [[usize; 2]],
        scorer: &mut Scorer,
    ) -> f64 {
        let Some(([row, role], rest)) = rows.split_first() else {
            let filled: Vec<&Vec<f64>> = groups.iter().filter(|sums| whole(sums) > 0.0).collect();
            return scorer.total(&filled, 0);
        };
        let role = usize::from(!role.is_empty());
        let mut best = f64::NEG_INFINITY;
        for group in 0..groups.len() {
            if room[group][role] == 0 {
                continue;
            }
            let before = groups[group].clone();
            room[group][role] -= 1;
            crate::rne::scorer::add(&mut groups[group], row);
            best = best.max(best_of_all(rest, groups, room, scorer));
            room[group][role] += 1;
            groups[group] = before;
        }
        best
    }

    #[test]
    fn the_best_split_of_small_teams_is_never_above_the_bound() {
        let mut draws = ChaCha8Rng::seed_from_u64(3);
        let shapes: [&[usize]; 8] =
            [&[4, 4], &[2, 6], &[5, 6], &[3, 3, 3], &[1, 2, 5], &[1, 1, 1], &[2, 2, 2, 2], &[1, 1, 2, 3]];
        for turn in 0..60 {
            for sizes in shapes {
                let rows = drawn(sizes.iter().sum(), &mut draws);
                for direction in DIRECTIONS {
                    let mut scorer = Scorer::new(direction, turn % 3 == 0);
                    let parts = best_partition(&rows, sizes, &mut scorer).parts;
                    let sum = |part: &Vec<usize>| {
                        let of_need = |k: usize| part.iter().map(|robot| rows[*robot][k]).sum();
                        (0..rows[0].len()).map(of_need).collect::<Vec<f64>>()
                    };
                    let best = scorer.total(&parts.iter().map(sum).collect::<Vec<_>>(), 0);
                    let team = [Choice::new(rows.iter().map(Vec::as_slice), sizes)];
                    let bound = upper_bound(&team, sizes.len(), &scorer);
                    assert!(best <= bound, "{direction:?}, {sizes:?}: {best} is above {bound}");
                }
            }
        }
    }

    #[test]
    fn the_best_groups_of_two_roles_are_never_above_the_bound() {
        let mut draws = ChaCha8Rng::seed_from_u64(4);
        let shapes: [&[[usize; 2]]; 5] = [
            &[[3, 2], [3, 2]],
            &[[1, 2], [4, 1]],
            &[[2, 1], [2, 1], [2, 1]],
            &[[1, 0], [2, 1], [2, 2]],
            &[[2, 0], [0, 3]],
        ];
        for turn in 0..24 {
            for sizes in shapes {
                let of_role = |role: usize| sizes.iter().map(|group| group[role]).collect::<Vec<_>>();
                let [ones, others] = [0, 1].map(|role| of_role(role).iter().sum::<usize>());
                let rows = drawn(ones + others, &mut draws);
                let marks: [&[f64]; 2] = [&[], &[1.0]];
                let all: Vec<[&[f64]; 2]> = rows
                    .iter()
                    .enumerate()
                    .map(|(robot, row)| [row.as_slice(), marks[usize::from(robot >= ones)]])
                    .collect();
                let (one, other) = rows.split_at(ones);
                let team = [(one, 0), (other, 1)]
                    .map(|(rows, role)| Choice::new(rows.iter().map(Vec::as_slice), &of_role(role)));
                for direction in DIRECTIONS {
                    let mut scorer = Scorer::new(direction, turn % 4 == 0);
                    let mut groups = vec![vec![0.0; rows[0].len()]; sizes.len()];
                    let best = best_of_all(&all, &mut groups, &mut sizes.to_vec(), &mut scorer);
                    let bound = upper_bound(&team, sizes.len(), &scorer);
                    assert!(best <= bound, "{direction:?}, {sizes:?}: {best} is above {bound}");
                }
            }
        }
    }

    /// Shares of two needs are one number, and robots of equal weight leave nothing open: the bound is the
    /// score of the best split.
    #[test]
    fn two_needs_of_robots_of_equal_weight_are_bounded_exactly() {
        let rows: Vec<Vec<f64>> = (1..=12).map(|i| vec![f64::from(i), 40.0 - f64::from(i)]).collect();
        let mut scorer = Scorer::new(ScoreDirection::Sum, false);
        let halves = [[21.0, 219.0], [57.0, 183.0]];
        let best = scorer.total(&halves, 0);
        let bound = upper_bound(&[Choice::new(rows.iter().map(Vec::as_slice), &[6, 6])], 2, &scorer);
        assert!(best <= bound && bound < best * (1.0 + 1e-8), "{best}, {bound}");
    }

    #[test]
    fn the_gap_is_a_share_of_the_bound() {
        use RelativeNeedsEntropy::{Finite, Infinite};
        let cases = [
            (Finite(0.3), Finite(0.4), 100.0 * (0.4 - 0.3) / 0.4),
            (Finite(0.0), Finite(0.0), 0.0),
            (Finite(2.0), Infinite, 100.0),
            (Infinite, Infinite, 0.0),
        ];
        for (score, bound, gap) in cases {
            assert_eq!(Some(gap_percent(score, bound)), Some(gap));
        }
    }
}
