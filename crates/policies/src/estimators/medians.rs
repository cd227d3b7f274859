//! Medians of what was measured, round by round.

/// The median of each round, in the order of the rounds. A liar among the mates moves it little.
pub(super) fn by_round(mut seen: Vec<(u32, f64)>) -> Vec<(u32, f64)> {
    seen.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let median = |round: &[(u32, f64)]| {
        let at = |place: usize| round[place].1;
        let middle = round.len() / 2;
        let median =
            if round.len() % 2 == 1 { at(middle) } else { f64::midpoint(at(middle - 1), at(middle)) };
        (round[0].0, median)
    };
    seen.chunk_by(|a, b| a.0 == b.0).map(median).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_counts_with_the_median_of_its_looks() {
        let found = by_round(vec![(2, 0.5), (1, 1.0), (2, 0.75), (2, 2.0), (1, 0.5)]);
        assert_eq!(found, [(1, 0.75), (2, 0.75)]);
    }
}
