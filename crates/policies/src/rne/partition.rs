//! The split of one role into parts with the largest RNE between them (the paper's Algorithms 1, 2 and 3, for
//! any number of tasks).
//!
//! The search is exact for up to [`EXACT_PARTITIONS`] partitions. It visits each partition once and grows the
//! sums along the branch, so that rounding does not depend on the path. For more partitions, [`super::local`]
//! takes over.

use super::local;
use super::parts::{Partition, distinct_orders, in_order};
use super::scorer::{Scorer, TIE_TOLERANCE};

/// Greatest number of partitions of one role for which all are searched. It suffices for 20 robots and two
/// tasks (92,378), 13 and three, 12 and four.
pub const EXACT_PARTITIONS: f64 = 1e5;

/// The best partition of the robots whose weighted needs are `rows` into parts of these sizes, in any order.
pub(super) fn best_partition(rows: &[Vec<f64>], sizes: &[usize], scorer: &mut Scorer) -> Partition {
    let mut filled: Vec<usize> = sizes.iter().copied().filter(|size| *size > 0).collect();
    filled.sort_unstable();
    let mut partition = if filled.len() < 2 {
        only_partition(rows.len(), filled.len())
    } else if partitions(&filled) <= EXACT_PARTITIONS {
        exact(rows, &filled, scorer)
    } else {
        local::search(rows, &filled, scorer)
    };
    partition.parts.resize(sizes.len(), Vec::new());
    if let Some((parts, _)) = &mut partition.runner_up {
        parts.resize(sizes.len(), Vec::new());
    }
    partition
}

fn only_partition(robots: usize, parts: usize) -> Partition {
    Partition {
        parts: vec![(0..robots).collect(); parts],
        runner_up: None,
        searched: 1,
        proven_optimal: true,
    }
}

/// Number of partitions into parts of these sizes, ascending: the multinomial coefficient over the orders of
/// equal sizes.
#[must_use]
pub(super) fn partitions(sizes: &[usize]) -> f64 {
    let (mut count, mut chosen) = (1.0, 0);
    for (place, size) in sizes.iter().enumerate() {
        for i in 1..=*size {
            chosen += 1;
            count *= chosen as f64 / i as f64;
        }
        let equal = sizes[..=place].iter().filter(|other| *other == size).count();
        count /= equal as f64;
    }
    count.round()
}

/// Depth-first search over all partitions, in lexicographic order of the parts with the smallest members.
struct ExactSearch<'a> {
    rows: &'a [Vec<f64>],
    scorer: &'a mut Scorer,
    /// For each part, its sums at each depth, `(rows + 1) x needs`.
    sums: Vec<Vec<f64>>,
    /// Places left in each part.
    room: Vec<usize>,
    /// Members of each part so far.
    count: Vec<usize>,
    part_of: Vec<usize>,
    best: Vec<usize>,
    best_score: f64,
    second: Option<(Vec<usize>, f64)>,
    searched: u64,
}

fn exact(rows: &[Vec<f64>], sizes: &[usize], scorer: &mut Scorer) -> Partition {
    let mut search = ExactSearch {
        rows,
        scorer,
        sums: vec![vec![0.0; (rows.len() + 1) * rows[0].len()]; sizes.len()],
        room: Vec::new(),
        count: vec![0; sizes.len()],
        part_of: vec![0; rows.len()],
        best: vec![0; rows.len()],
        best_score: f64::NEG_INFINITY,
        second: None,
        searched: 0,
    };
    for order in distinct_orders(sizes) {
        search.room = order;
        search.place(0);
    }
    Partition {
        parts: in_order(&search.best, sizes.len()),
        runner_up: search.second.map(|(part_of, score)| (in_order(&part_of, sizes.len()), score)),
        searched: search.searched,
        proven_optimal: true,
    }
}

impl ExactSearch<'_> {
    /// Puts robot `at` into each part that has room, and continues with the next robot. A part is opened only
    /// when all parts before it are open.
    fn place(&mut self, at: usize) {
        if at == self.rows.len() {
            return self.judge();
        }
        for part in 0..self.room.len() {
            if part > 0 && self.count[part - 1] == 0 {
                return;
            }
            if self.room[part] > 0 {
                self.grow(at, part);
                self.part_of[at] = part;
                self.room[part] -= 1;
                self.count[part] += 1;
                self.place(at + 1);
                self.room[part] += 1;
                self.count[part] -= 1;
            }
        }
    }

    /// The sums at the next depth, with robot `at` in `part`.
    fn grow(&mut self, at: usize, part: usize) {
        let needs = self.rows[at].len();
        for (other, sums) in self.sums.iter_mut().enumerate() {
            let (done, rest) = sums.split_at_mut((at + 1) * needs);
            let before = &done[at * needs..];
            if other == part {
                let grown = before.iter().zip(&self.rows[at]).map(|(before, need)| before + need);
                rest.iter_mut().zip(grown).for_each(|(sum, grown)| *sum = grown);
            } else {
                rest[..needs].copy_from_slice(before);
            }
        }
    }

    fn judge(&mut self) {
        let end = self.rows.len() * self.rows[0].len();
        let score = self.scorer.total(&self.sums, end);
        self.searched += 1;
        if score > self.best_score + TIE_TOLERANCE || self.best_score == f64::NEG_INFINITY {
            if self.searched > 1 {
                self.second = Some((self.best.clone(), self.best_score));
            }
            self.best_score = score;
            self.best.copy_from_slice(&self.part_of);
        } else if self.second.as_ref().is_none_or(|(_, second)| score > *second) {
            self.second = Some((self.part_of.clone(), score));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn partitions_are_counted() {
        let counts: [(&[usize], u64); 6] = [
            (&[3, 3], 10),
            (&[2, 3], 10),
            (&[10, 10], 92_378),
            (&[2, 2, 2], 15),
            (&[1, 1, 2], 6),
            (&[4, 4, 5], 45_045),
        ];
        for (sizes, count) in counts {
            assert_eq!(partitions(sizes) as u64, count, "{sizes:?}");
        }
        assert!(partitions(&[5000, 5000]) > EXACT_PARTITIONS);
    }

    #[test]
    fn every_partition_is_looked_at_once() {
        let rows: Vec<Vec<f64>> = (0..6).map(|i| vec![1.0 + f64::from(i * i), 7.0]).collect();
        for sizes in [vec![3, 3], vec![2, 4], vec![2, 2, 2], vec![1, 2, 3], vec![1, 1, 2, 2]] {
            let mut scorer = Scorer::new(crate::rne::ScoreDirection::MaxOfBoth, false);
            let found = best_partition(&rows, &sizes, &mut scorer);
            assert!((found.searched as f64 - partitions(&sizes)).abs() < 0.5, "{sizes:?}");
            assert!(found.runner_up.is_some_and(|(parts, _)| parts != found.parts), "{sizes:?}");
        }
    }
}
