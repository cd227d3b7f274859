//! How fast a robot was seen to go, in terms of what it had said: one number a round.

use teaming::{Evidence, Question, Rating};

use super::last_said::member_of;
use super::medians::by_round;

/// The ratings of each member with a speed that was said, by round and then by the share of it that was seen.
pub(super) fn ratios(question: &Question, evidence: &Evidence) -> Vec<Vec<f64>> {
    let mut seen: Vec<Vec<(u32, f64)>> = vec![Vec::new(); question.members.len()];
    for rating in &evidence.ratings {
        let Rating { of, round, speed_mps, said_mps, .. } = *rating;
        if let Some(member) = member_of(question, of).filter(|_| said_mps > 0.0) {
            seen[member].push((round, speed_mps / said_mps));
        }
    }
    let of_one = |seen| by_round(seen).into_iter().map(|(_, ratio)| ratio).collect();
    seen.into_iter().map(of_one).collect()
}
