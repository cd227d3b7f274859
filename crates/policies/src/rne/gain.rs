//! What a swap of two robots can gain at most. Most swaps in a large team lose; this tells without a
//! logarithm, so that only the others are scored.
//!
//! A swap moves the shares of two parts, `P` to `P + p` and `Q` to `Q + q`, with entries of `p` and `q` that
//! add up to 0. Taylor's theorem for `x ln x` and `-ln x`, where no share moves by more than a quarter of
//! itself, gives the bound
//! `D(P + p || Q + q) - D(P || Q) <= sum [ln(P/Q) p - P/Q q + 2/3 p^2/P - p q/Q + 10/9 P q^2/Q^2]`,
//! and `-p q <= (p^2 + q^2) / 2`. For the Jensen-Shannon divergence, the entropy of the midpoint is concave
//! and lies below its tangent.

use super::options::ScoreDirection;
use rne_core::divergence::kullback_leibler;
use rne_core::needs::shares_of;

/// Greatest share of a part's sums by which one swap may change them, for the bound to hold: each share then
/// moves by less than a quarter of itself.
const LARGEST_CHANGE: f64 = 0.1;

/// The differences between robots: for each need, and for the sum of all, the largest that a swap makes.
pub(super) struct Spread {
    needs: Vec<f64>,
    whole: f64,
}

impl Spread {
    pub(super) fn of(rows: &[Vec<f64>]) -> Self {
        let spread = |value: &dyn Fn(&Vec<f64>) -> f64| {
            let most = rows.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
            most - rows.iter().map(value).fold(f64::INFINITY, f64::min)
        };
        let needs = (0..rows[0].len()).map(|k| spread(&|row| row[k])).collect();
        Self { needs, whole: spread(&|row| row.iter().sum()) }
    }

    /// With which each swap is scored.
    #[cfg(test)]
    pub(super) fn unknown() -> Self {
        Self { needs: Vec::new(), whole: f64::INFINITY }
    }

    /// Whether any swap changes these sums of a part by little.
    fn is_small_beside(&self, sums: &[f64]) -> bool {
        let is_small = |(spread, sum): (&f64, &f64)| *spread <= LARGEST_CHANGE * sum;
        self.needs.iter().zip(sums).all(is_small) && is_small((&self.whole, &sums.iter().sum()))
    }
}

/// Bounds on the gains of all swaps in one partition.
pub(super) struct Gains {
    parts: usize,
    needs: usize,
    /// For each part, the sum of all of its weighted needs.
    wholes: Vec<f64>,
    /// The gain of each pair of parts is the largest over so many divergences.
    ways: usize,
    /// Slopes of the divergences of parts `i` and `j` by the sums of `i`, times the sum of all of these:
    /// `needs` numbers at `((i * parts + j) * ways + way) * needs`.
    slopes: Vec<f64>,
    /// How far each divergence is below the largest of its pair, at `(i * parts + j) * ways + way`.
    below: Vec<f64>,
    /// For each part, what the square of a change adds at most: `needs` numbers, for each need.
    squares: Vec<f64>,
    /// The same for the change of the sum of all needs.
    whole_squares: Vec<f64>,
    change: Vec<f64>,
}

impl Gains {
    /// `None` where no bound holds: a part is too small, or lacks a need that others have.
    pub(super) fn new(sums: &[Vec<f64>], direction: ScoreDirection, spread: &Spread) -> Option<Self> {
        if !sums.iter().all(|sums| spread.is_small_beside(sums)) {
            return None;
        }
        let (parts, needs) = (sums.len(), sums[0].len());
        let shares: Vec<Vec<f64>> = sums.iter().map(|sums| shares_of(sums)).collect();
        let mut gains = Self {
            parts,
            needs,
            wholes: sums.iter().map(|sums| sums.iter().sum()).collect(),
            ways: if direction == ScoreDirection::MaxOfBoth { 2 } else { 1 },
            slopes: Vec::new(),
            below: Vec::new(),
            squares: vec![0.0; parts * needs],
            whole_squares: vec![0.0; parts],
            change: vec![0.0; needs],
        };
        for i in 0..parts {
            for j in 0..parts {
                gains.add_pair([i, j], &shares, direction);
            }
        }
        gains.weigh_squares(&shares);
        Some(gains)
    }

    /// Adds the slopes and squares of a pair by the shares of its part `i`.
    fn add_pair(&mut self, [i, j]: [usize; 2], shares: &[Vec<f64>], direction: ScoreDirection) {
        let (p, q) = (&shares[i], &shares[j]);
        let both = [kullback_leibler(p, q), kullback_leibler(q, p)];
        let largest = both[0].max(both[1]);
        for way in 0..self.ways {
            // Both parts of a pair number its directions alike.
            let kind = Kind::of(direction, (way == 0) == (i < j));
            self.below.push(if self.ways == 1 {
                0.0
            } else {
                largest - both[usize::from(kind != Kind::First)]
            });
            let slopes: Vec<f64> = p.iter().zip(q).map(|(p, q)| kind.slope(*p, *q)).collect();
            let mean: f64 = slopes.iter().zip(p).map(|(slope, p)| slope * p).sum();
            self.slopes.extend(slopes.iter().map(|slope| slope - mean));
        }
        if i != j {
            for (k, (p, q)) in p.iter().zip(q).enumerate() {
                self.squares[i * self.needs + k] += Kind::square(direction, *p, *q);
            }
        }
    }

    /// From squares of changes of shares to squares of changes of sums: a share `P` changes by
    /// `(d - s P) / a`, for the changes `d` of its sum and `s` of the sum of all, which is then `a`; and
    /// `(x - y)^2 <= 2 x^2 + 2 y^2`.
    fn weigh_squares(&mut self, shares: &[Vec<f64>]) {
        for (part, shares) in shares.iter().enumerate() {
            let least = (1.0 - LARGEST_CHANGE) * self.wholes[part];
            for (square, share) in self.squares[part * self.needs..].iter_mut().zip(shares) {
                *square *= 2.0 / (least * least);
                self.whole_squares[part] += *square * share * share;
            }
        }
    }

    /// What the swap of a robot of part `low` for one of part `high`, with these weighted needs, adds to the
    /// score at most.
    pub(super) fn at_most(&mut self, [low, high]: [usize; 2], [out, into]: [&[f64]; 2]) -> f64 {
        let (mut whole, mut gain) = (0.0, 0.0);
        let squares = self.squares[low * self.needs..].iter().zip(&self.squares[high * self.needs..]);
        for (((change, out), into), (one, other)) in self.change.iter_mut().zip(out).zip(into).zip(squares) {
            *change = into - out;
            whole += *change;
            gain += *change * *change * (one + other);
        }
        gain += whole * whole * (self.whole_squares[low] + self.whole_squares[high]);
        let scales = [1.0 / (self.wholes[low] + whole), -1.0 / (self.wholes[high] - whole)];
        gain += self.pair_at_most([low, high], scales, true);
        for other in (0..self.parts).filter(|part| *part != low && *part != high) {
            gain += self.pair_at_most([low, other], scales, false);
            gain += self.pair_at_most([high, other], [scales[1], 0.0], false);
        }
        gain
    }

    /// The same for one pair, without the squares. The second part changes, too, if `both`.
    #[inline]
    fn pair_at_most(&self, [i, j]: [usize; 2], scales: [f64; 2], both: bool) -> f64 {
        let mut most = f64::NEG_INFINITY;
        for way in 0..self.ways {
            let mut gain =
                self.slope([i, j], way) * scales[0] - self.below[(i * self.parts + j) * self.ways + way];
            if both {
                gain += self.slope([j, i], way) * scales[1];
            }
            most = most.max(gain);
        }
        most
    }

    #[inline]
    fn slope(&self, [i, j]: [usize; 2], way: usize) -> f64 {
        let at = ((i * self.parts + j) * self.ways + way) * self.needs;
        self.slopes[at..].iter().zip(&self.change).map(|(slope, change)| slope * change).sum()
    }
}

/// A divergence as a function of the shares of one part of a pair.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// From this part to the other.
    First,
    /// From the other part to this one.
    Second,
    Sum,
    JensenShannon,
}

impl Kind {
    fn of(direction: ScoreDirection, is_first: bool) -> Self {
        match direction {
            ScoreDirection::Sum => Self::Sum,
            ScoreDirection::JensenShannon => Self::JensenShannon,
            ScoreDirection::MaxOfBoth | ScoreDirection::FirstToSecond if is_first => Self::First,
            ScoreDirection::MaxOfBoth | ScoreDirection::FirstToSecond => Self::Second,
        }
    }

    /// The slope by this part's share `p`. A need that nobody has, has none.
    fn slope(self, p: f64, q: f64) -> f64 {
        if p == 0.0 {
            return 0.0;
        }
        match self {
            Self::First => libm::log(p / q),
            Self::Second => -q / p,
            Self::Sum => libm::log(p / q) - q / p,
            Self::JensenShannon => 0.5 * libm::log(p / f64::midpoint(p, q)),
        }
    }

    /// What the square of a change of `p` adds at most.
    fn square(direction: ScoreDirection, p: f64, q: f64) -> f64 {
        if p == 0.0 {
            return 0.0;
        }
        let first = 2.0 / (3.0 * p) + 0.5 / q;
        let second = 10.0 * q / (9.0 * p * p) + 0.5 / p;
        match direction {
            ScoreDirection::MaxOfBoth | ScoreDirection::FirstToSecond => first.max(second),
            ScoreDirection::Sum => first + second,
            ScoreDirection::JensenShannon => 1.0 / (3.0 * p),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rne::scorer::{Scorer, part_sums};
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn no_swap_gains_more_than_its_bound() {
        let mut draws = ChaCha8Rng::seed_from_u64(2);
        let directions = [
            ScoreDirection::MaxOfBoth,
            ScoreDirection::FirstToSecond,
            ScoreDirection::Sum,
            ScoreDirection::JensenShannon,
        ];
        let mut dismissed = 0;
        for (turn, direction) in directions.into_iter().cycle().take(60).enumerate() {
            let (parts, least) = (2 + turn % 4, [0.5, 10.0, 39.0][turn % 3]);
            let mut row = || (0..4).map(|_| draws.random_range(least..40.0)).collect::<Vec<f64>>();
            let mut rows: Vec<Vec<f64>> = (0..60 * parts).map(|_| row()).collect();
            if turn % 8 < 4 {
                rows.sort_by(|a, b| a[0].total_cmp(&b[0])); // parts that differ much
            }
            let mut scorer = Scorer::new(direction, false);
            let mut total = |part_of: &[usize]| scorer.total(&part_sums(&rows, part_of, parts), 0);
            let mut part_of: Vec<usize> = (0..rows.len()).map(|robot| robot / 60).collect();
            let sums = part_sums(&rows, &part_of, parts);
            let Some(mut gains) = Gains::new(&sums, direction, &Spread::of(&rows)) else { continue };
            let before = total(&part_of);
            for i in 0..60 {
                for j in (60..rows.len()).step_by(7) {
                    let swap = [part_of[i], part_of[j]];
                    let most = gains.at_most(swap, [&rows[i], &rows[j]]);
                    part_of.swap(i, j);
                    let gain = total(&part_of) - before;
                    part_of.swap(i, j);
                    assert!(gain <= most + 1e-13, "{direction:?}: {gain} is above {most}");
                    dismissed += u32::from(most <= 0.0);
                }
            }
        }
        assert!(dismissed > 20_000, "the bound is of use: {dismissed}");
    }

    #[test]
    fn small_parts_and_needs_that_some_lack_are_scored() {
        let rows = |count: usize, least: f64| -> Vec<Vec<f64>> {
            (0..count).map(|i| vec![least + (i % 3) as f64, 5.0, 0.0]).collect()
        };
        let is_bounded = |rows: &[Vec<f64>]| {
            let part_of: Vec<usize> = (0..rows.len()).map(|robot| robot % 2).collect();
            let sums = part_sums(rows, &part_of, 2);
            Gains::new(&sums, ScoreDirection::MaxOfBoth, &Spread::of(rows)).is_some()
        };
        assert!(is_bounded(&rows(60, 1.0)) && !is_bounded(&rows(6, 1.0)));
        let mut lacking = rows(60, 1.0);
        lacking.iter_mut().step_by(2).for_each(|row| row[2] = 1.0);
        assert!(!is_bounded(&lacking));
    }
}
