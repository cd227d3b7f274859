//! What the base heard of each member, question by question: one report a round, and what its group-mates
//! said that the round before cost them.

use teaming::said::is_after;
use teaming::{Evidence, Level, Question, SaidRounds};

use super::last_said::member_of;

/// One member at the question of one round.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Seen<'e> {
    /// What it said last, of what was heard since the question before and not sent before what was heard
    /// then.
    pub(super) said: Option<Said<'e>>,
    /// The median of what its fit group-mates said that they spent of each level in the round before, in
    /// percent points; none where nobody can tell. Nothing in the first round and at home.
    pub(super) used: Option<Vec<f64>>,
    /// Whether it rested since the question before.
    pub(super) rested: bool,
}

/// What a robot said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Said<'e> {
    /// Its levels, in the order of the table of levels.
    pub(super) levels: &'e [f64],
    /// Standard deviations of the gauges, in percent points.
    pub(super) sd: &'e [f64],
}

/// For each member, its questions from the first since which the base knows it.
pub(super) fn rounds<'e>(question: &Question, evidence: &'e Evidence) -> Vec<Vec<Seen<'e>>> {
    let said = SaidRounds::new(question, evidence);
    let count = question.history.len() + 1;
    let nothing = Seen { used: Some(Vec::new()), ..Seen::default() };
    let mut seen = vec![vec![nothing; count]; question.members.len()];
    let mut takes_part = vec![vec![false; count]; question.members.len()];
    for (before, round) in question.history.iter().enumerate() {
        for used in said.used(round) {
            let Some(member) = member_of(question, used.robot) else { continue };
            let next = &mut seen[member][before + 1];
            takes_part[member][before + 1] = true;
            next.used = used.points;
            next.rested = said.entry(used.robot, round.round).is_some_and(|entry| entry.rested);
        }
    }
    hear(question, evidence, &said, &mut seen);
    for ((member, seen), takes_part) in question.members.iter().zip(&mut seen).zip(takes_part) {
        stay_at_home(&question.levels, seen, &takes_part);
        let since = evidence.known_since.get(&member.id).copied().unwrap_or(0);
        let unknown = question.history.iter().filter(|round| round.round < since).count();
        seen.drain(..unknown);
    }
    seen
}

/// Sorts the reports into the questions before which they were heard.
fn hear<'e>(question: &Question, evidence: &'e Evidence, said: &SaidRounds<'_>, seen: &mut [Vec<Seen<'e>>]) {
    let left_s = |number: usize| {
        let round = &question.history[number];
        let mut members = round.groups.iter().flat_map(|group| &group.members);
        members.find_map(|member| Some(said.entry(member.id, round.round)?.left_s))
    };
    let mut starts: Vec<f64> =
        (0..question.history.len()).map(|number| left_s(number).unwrap_or(0.0)).collect();
    for number in 1..starts.len() {
        starts[number] = starts[number].max(starts[number - 1]); // a round without a trace
    }
    let mut last_s = vec![f64::NEG_INFINITY; seen.len()];
    for report in &evidence.reports {
        let Some(member) = member_of(question, report.of) else { continue };
        if report.sent_s < last_s[member] {
            continue;
        }
        last_s[member] = report.sent_s;
        let number = starts.partition_point(|start| is_after(report.heard_s, *start));
        seen[member][number].said = Some(Said { levels: &report.levels, sd: &report.sd });
    }
}

/// A robot that was in no group of a round stayed at home. It rested if it had said that it is tired.
fn stay_at_home(levels: &[Level], seen: &mut [Seen<'_>], takes_part: &[bool]) {
    let is_tired =
        |said: Said<'_>| said.levels.iter().zip(levels).any(|(said, level)| *said < level.threshold);
    let mut last = None;
    for (seen, takes_part) in seen.iter_mut().zip(takes_part) {
        seen.rested |= !takes_part && last.is_some_and(is_tired);
        last = seen.said.or(last);
    }
}
