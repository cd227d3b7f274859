//! How fast a robot was seen to go, in terms of what it had said: one number a round.

use teaming::{Evidence, Member, Question, Rating};

use super::last_said::member_of;
use super::medians::by_round;

/// The share of what it had said that was seen of each member, in the rounds in which it was rated.
pub(super) fn ratios(question: &Question, evidence: &Evidence) -> Vec<Vec<f64>> {
    let of_one = |seen: Vec<(u32, f64)>| seen.into_iter().map(|(_, ratio)| ratio).collect();
    rated(question, evidence).into_iter().map(of_one).collect()
}

/// The same for all rounds that are over since the base knows the member; none for one in which it was not
/// rated.
pub(super) fn by_question_round(question: &Question, evidence: &Evidence) -> Vec<Vec<Option<f64>>> {
    let of_one = |(member, seen): (&Member, Vec<(u32, f64)>)| {
        let since = evidence.known_since.get(&member.id).copied().unwrap_or(0);
        let rounds = question.history.iter().map(|round| round.round).filter(|round| *round >= since);
        let ratio = |round| seen.binary_search_by_key(&round, |(round, _)| *round).ok().map(|at| seen[at].1);
        rounds.map(ratio).collect()
    };
    question.members.iter().zip(rated(question, evidence)).map(of_one).collect()
}

/// The rounds in which each member was rated, each with the median share.
fn rated(question: &Question, evidence: &Evidence) -> Vec<Vec<(u32, f64)>> {
    let mut seen: Vec<Vec<(u32, f64)>> = vec![Vec::new(); question.members.len()];
    for rating in &evidence.ratings {
        let Rating { of, round, speed_mps, said_mps, .. } = *rating;
        if let Some(member) = member_of(question, of).filter(|_| said_mps > 0.0) {
            seen[member].push((round, speed_mps / said_mps));
        }
    }
    seen.into_iter().map(by_round).collect()
}
