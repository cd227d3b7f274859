//! The merge of one role's parts with the groups so far: the matching with the largest score.

use super::group::Group;
use super::options::MergeReading;
use super::quotas::Sizes;
use super::scorer::{Scorer, TIE_TOLERANCE};

/// Greatest number of tasks for which all matchings are searched: 5,040 matchings for seven tasks.
pub const EXACT_TASKS: usize = 7;

/// For each group, the part that joins it.
pub(super) type Matching = Vec<usize>;

/// The best matching, its score, the runner-up, and whether the matching is proven optimal.
pub(super) struct Merge {
    pub(super) matching: Matching,
    pub(super) score: f64,
    pub(super) runner_up: Option<(Matching, f64)>,
    pub(super) proven_optimal: bool,
}

/// Scores matchings of the groups with the parts of one role.
pub(super) struct Merger<'a> {
    pub(super) groups: &'a [Group],
    pub(super) parts: &'a [Group],
    pub(super) reading: MergeReading,
    /// Sizes that groups must have if quotas bind.
    pub(super) sizes: &'a Sizes,
}

impl Merger<'_> {
    /// The matching with the largest score; among equals, the first in lexicographic order. Up to
    /// [`EXACT_TASKS`] groups, every matching is searched. Above that, parts of two groups are exchanged as
    /// long as that improves the score.
    pub(super) fn best(&self, scorer: &mut Scorer) -> Merge {
        let is_exact = self.groups.len() <= EXACT_TASKS;
        let mut matching: Matching = (0..self.groups.len()).collect();
        if is_exact {
            while !self.admits(&matching) && advance(&mut matching) {}
        } else {
            matching = self.sizes.start(self.groups, self.parts);
        }
        let score = self.score(&matching, scorer);
        let mut best = Merge { matching: matching.clone(), score, runner_up: None, proven_optimal: is_exact };
        if is_exact {
            while advance(&mut matching) {
                self.consider(matching.clone(), &mut best, scorer);
            }
        } else {
            while self.exchange(&mut best, scorer) {}
        }
        best
    }

    fn admits(&self, matching: &[usize]) -> bool {
        self.sizes.admit(self.groups, self.parts, matching)
    }

    /// Takes the matching if it is better, and returns whether it is. A matching that leads to the same
    /// groups is not a candidate.
    fn consider(&self, matching: Matching, best: &mut Merge, scorer: &mut Scorer) -> bool {
        if !self.admits(&matching) || self.pairs(&matching) == self.pairs(&best.matching) {
            return false;
        }
        let score = self.score(&matching, scorer);
        if score > best.score + TIE_TOLERANCE {
            let before = std::mem::replace(&mut best.matching, matching);
            best.runner_up = Some((before, best.score));
            best.score = score;
            return true;
        }
        if best.runner_up.as_ref().is_none_or(|(_, second)| score > *second) {
            best.runner_up = Some((matching, score));
        }
        false
    }

    /// The pairs of a group and its part, in ascending order. All empty groups count as one, and so do all
    /// empty parts.
    fn pairs(&self, matching: &[usize]) -> Vec<[usize; 2]> {
        let one = |list: &[Group], i: usize| if list[i].members.is_empty() { usize::MAX } else { i };
        let pair = |(group, part): (usize, &usize)| [one(self.groups, group), one(self.parts, *part)];
        let mut pairs: Vec<[usize; 2]> = matching.iter().enumerate().map(pair).collect();
        pairs.sort_unstable();
        pairs
    }

    /// Exchanges the parts of each pair of groups once if that improves the score. Returns whether any
    /// exchange did.
    fn exchange(&self, best: &mut Merge, scorer: &mut Scorer) -> bool {
        let mut improved = false;
        for i in 0..self.groups.len() {
            for j in i + 1..self.groups.len() {
                let mut matching = best.matching.clone();
                matching.swap(i, j);
                improved |= self.consider(matching, best, scorer);
            }
        }
        improved
    }

    fn score(&self, matching: &[usize], scorer: &mut Scorer) -> f64 {
        match self.reading {
            MergeReading::Apart => {
                let merged = self.merged(matching);
                scorer.total(&merged.iter().map(|group| &group.sum).collect::<Vec<_>>(), 0)
            }
            MergeReading::Together => {
                let pairs = self.groups.iter().zip(matching);
                pairs
                    .map(|(group, part)| scorer.score(&group.sum, &self.parts[*part].sum))
                    .fold(f64::NEG_INFINITY, f64::max)
            }
        }
    }

    /// The groups with the parts that join them.
    pub(super) fn merged(&self, matching: &[usize]) -> Vec<Group> {
        self.groups.iter().zip(matching).map(|(group, part)| group.joined(&self.parts[*part])).collect()
    }
}

/// The next permutation in lexicographic order; `false` after the last.
fn advance(order: &mut [usize]) -> bool {
    let Some(pivot) = (1..order.len()).rev().find(|i| order[i - 1] < order[*i]).map(|i| i - 1) else {
        return false;
    };
    let larger = (pivot + 1..order.len()).rev().find(|i| order[*i] > order[pivot]).unwrap_or(pivot);
    order.swap(pivot, larger);
    order[pivot + 1..].reverse();
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn permutations_come_in_lexicographic_order() {
        let mut order = vec![0, 1, 2];
        let mut all = vec![order.clone()];
        while advance(&mut order) {
            all.push(order.clone());
        }
        assert_eq!(all, [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]]);
    }
}
