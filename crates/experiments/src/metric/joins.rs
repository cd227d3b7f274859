//! How far robots that decide for themselves agreed, and what they knew of each other.

use super::belief::mean;
use teaming::Question;
use usar_sim::record::{DecisionRecord, Join, TrialRecord};

/// Mean share of pairs of robots that saw the same groups.
pub(super) fn agreement(record: &TrialRecord) -> Option<f64> {
    mean(record.decisions.iter().filter_map(|made| share(pairs(made).filter_map(|(a, b)| a.agrees_with(b)))))
}

fn pairs(made: &DecisionRecord) -> impl Iterator<Item = (&Join, &Join)> {
    let joins = &made.joins;
    joins.iter().enumerate().flat_map(|(i, a)| joins[i + 1..].iter().map(move |b| (a, b)))
}

/// Mean number of robots in a group too many.
pub(super) fn sizes_missed(record: &TrialRecord) -> Option<f64> {
    let decided = record.decisions.iter().filter(|made| !made.joins.is_empty());
    mean(decided.map(|made| excess(&made.question, made) as f64))
}

fn excess(question: &Question, made: &DecisionRecord) -> usize {
    let of_role = |role| {
        let ids: Vec<u32> = question.of_role(role).map(|member| member.id).collect();
        let groups = made.decision.assignment.groups.iter();
        let found = groups.map(move |group| group.iter().filter(|id| ids.contains(id)).count());
        found
            .zip(question.quotas[role.index()].members.clone())
            .map(|(found, size)| found.saturating_sub(size))
    };
    question.role_ids().flat_map(of_role).sum()
}

/// Mean age of what robots had heard of each other, in seconds.
pub(super) fn belief_age(record: &TrialRecord) -> Option<f64> {
    mean(joins(record).flat_map(|join| join.ages_s.values().flatten().copied()))
}

/// Mean share of others of which a robot had never heard.
pub(super) fn never_heard(record: &TrialRecord) -> Option<f64> {
    share(joins(record).flat_map(|join| join.ages_s.values().map(Option::is_none)))
}

/// Mean time in which robots agreed on all groups, in seconds, over the decisions in which they did.
pub(super) fn time_to_agree(record: &TrialRecord) -> Option<f64> {
    let agreed = |made: &&DecisionRecord| {
        let mut both = pairs(made).filter_map(|(a, b)| a.agrees_with(b)).peekable();
        both.peek().is_some() && both.all(|agree| agree)
    };
    let last = |made: &DecisionRecord| made.joins.iter().map(|join| join.after_s).reduce(f64::max);
    mean(record.decisions.iter().filter(agreed).filter_map(last))
}

/// Mean share of robots that were out of time when they decided.
pub(super) fn decided_late(record: &TrialRecord) -> Option<f64> {
    share(joins(record).map(|join| join.is_late))
}

/// Messages over the medium.
pub(super) fn messages(record: &TrialRecord) -> Option<f64> {
    let links = &record.heard.as_ref()?.links;
    Some(links.iter().map(|link| link.sent).sum::<u64>() as f64)
}

/// Messages over the medium that were not heard.
pub(super) fn messages_lost(record: &TrialRecord) -> Option<f64> {
    let links = &record.heard.as_ref()?.links;
    Some(links.iter().map(|link| link.sent - link.heard).sum::<u64>() as f64)
}

fn joins(record: &TrialRecord) -> impl Iterator<Item = &Join> {
    record.decisions.iter().flat_map(|made| &made.joins)
}

fn share(facts: impl Iterator<Item = bool>) -> Option<f64> {
    mean(facts.map(|fact| f64::from(u8::from(fact))))
}
