//! How fast a robot was seen to go, in terms of what it had said: one number a round.

use rne_core::{Evidence, Question, Rating};

use super::last_said::member_of;

/// The ratings of each member with a speed that was said, by round and then by the share of it that was seen.
pub(super) fn ratios(question: &Question, evidence: &Evidence) -> Vec<Vec<f64>> {
    let mut seen: Vec<Vec<(u32, f64)>> = vec![Vec::new(); question.members.len()];
    for rating in &evidence.ratings {
        let Rating { of, round, speed_mps, said_mps, .. } = *rating;
        if let Some(member) = member_of(question, of).filter(|_| said_mps > 0.0) {
            seen[member].push((round, speed_mps / said_mps));
        }
    }
    seen.into_iter().map(by_round).collect()
}

/// The median of each round, in the order of the rounds. A liar among the mates moves it little.
fn by_round(mut seen: Vec<(u32, f64)>) -> Vec<f64> {
    seen.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let median = |round: &[(u32, f64)]| {
        let at = |place: usize| round[place].1;
        let middle = round.len() / 2;
        if round.len() % 2 == 1 { at(middle) } else { f64::midpoint(at(middle - 1), at(middle)) }
    };
    seen.chunk_by(|a, b| a.0 == b.0).map(median).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_round_counts_with_the_median_of_its_looks() {
        let seen = vec![(2, 0.5), (1, 1.0), (2, 0.7), (2, 2.0), (1, 0.9)];
        let found = by_round(seen);
        assert!((found[0] - 0.95).abs() < 1e-12 && (found[1] - 0.7).abs() < 1e-12, "{found:?}");
    }
}
