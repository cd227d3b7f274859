//! The members as they were said last: the levels of every estimator that judges trust alone.

use teaming::estimate::as_said;
use teaming::ids::place_of;
use teaming::{Estimate, Evidence, Level, PolicyError, Question};

/// The members as they were said last, with the standard deviations of their gauges, believed. A robot that
/// was never heard has the deviations that the base expects.
pub(super) fn last_said(question: &Question) -> Result<Vec<Estimate>, PolicyError> {
    let mut estimates = as_said(question)?;
    let Some(evidence) = &question.evidence else { return Ok(estimates) };
    let expected = |level: &Level| level.expected.map_or(0.0, |expected| expected.sd);
    let never_heard: Vec<f64> = question.levels.iter().map(expected).collect();
    for (estimate, last) in estimates.iter_mut().zip(last_reports(question, evidence)) {
        estimate.sd.clone_from(last.map_or(&never_heard, |last| &evidence.reports[last].sd));
    }
    Ok(estimates)
}

/// The same, each with its trust in the order of the members.
pub(super) fn last_said_with(
    question: &Question,
    trust: impl IntoIterator<Item = f64>,
) -> Result<Vec<Estimate>, PolicyError> {
    let mut estimates = last_said(question)?;
    estimates.iter_mut().zip(trust).for_each(|(estimate, trust)| estimate.trust = trust);
    Ok(estimates)
}

/// For each member, the place of the report that was sent last, of those that were heard.
fn last_reports(question: &Question, evidence: &Evidence) -> Vec<Option<usize>> {
    let mut last: Vec<Option<usize>> = vec![None; question.members.len()];
    for (place, report) in evidence.reports.iter().enumerate() {
        let Some(member) = member_of(question, report.of) else { continue };
        let is_older = |before: usize| report.sent_s < evidence.reports[before].sent_s;
        if !last[member].is_some_and(is_older) {
            last[member] = Some(place);
        }
    }
    last
}

/// The place of a robot among the members.
pub(super) fn member_of(question: &Question, robot: u32) -> Option<usize> {
    place_of(&question.members, robot, |member| member.id)
}
