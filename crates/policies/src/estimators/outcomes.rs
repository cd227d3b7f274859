//! Outcomes: how far what robots said was borne out, by the base's own look and by the ratings of mates.

use std::ops::Range;

use teaming::{Evidence, Question, Rating, SaidRounds};

use super::counts::Counts;

/// How far from what was said a speed may be until it counts as false, as a share of top speed, where an
/// estimator has no option for it.
pub(super) const TOLERANCE: f64 = 0.2;

/// One outcome.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outcome {
    /// The robot that it is about.
    pub(super) of: u32,
    /// The robot that rated it; `None` for the base, which compares what robots say that they spent.
    pub(super) by: Option<u32>,
    /// The round.
    pub(super) round: u32,
    /// From 0 (false) to 1 (true).
    pub(super) outcome: f64,
}

/// All outcomes: those about a robot stand together, round by round, the base's first.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Outcomes(Vec<Outcome>);

impl Outcomes {
    /// The outcomes of some evidence. A speed that is `tolerance` of top speed from what was said is an
    /// outcome of 0. Ratings of a robot whose body is not known do not count.
    pub(super) fn of(question: &Question, evidence: &Evidence, tolerance: f64) -> Self {
        let own = SaidRounds::new(question, evidence).energy_outcomes(&question.history).into_iter();
        let mut all: Vec<Outcome> = own
            .map(|own| Outcome { of: own.robot, by: None, round: own.round, outcome: own.outcome })
            .collect();
        let rated = |rating: &Rating| {
            let top_mps = evidence.body(rating.of)?.top_mps;
            let Rating { of, by, round, .. } = *rating;
            Some(Outcome { of, by: Some(by), round, outcome: rating.outcome(tolerance, top_mps) })
        };
        all.extend(evidence.ratings.iter().filter_map(rated));
        all.sort_by(|a, b| {
            let by = |by: Option<u32>| by.map_or(0, |by| u64::from(by) + 1);
            let key = |outcome: &Outcome| {
                (u64::from(outcome.of) << u32::BITS | u64::from(outcome.round), by(outcome.by))
            };
            key(a).cmp(&key(b)).then(a.outcome.total_cmp(&b.outcome))
        });
        Self(all)
    }

    /// The outcomes about a robot, round by round.
    pub(super) fn about(&self, robot: u32) -> &[Outcome] {
        &self.0[self.range(robot)]
    }

    /// All outcomes.
    pub(super) fn all(&self) -> &[Outcome] {
        &self.0
    }

    fn range(&self, robot: u32) -> Range<usize> {
        let start = self.0.partition_point(|outcome| outcome.of < robot);
        start..start + self.0[start..].partition_point(|outcome| outcome.of == robot)
    }
}

/// The base's own counts of the outcomes about one robot, and those of each rater, by id.
pub(super) fn by_rater(outcomes: &[Outcome]) -> (Counts, Vec<(u32, Counts)>) {
    let (mut own, mut raters) = (Counts::default(), Vec::new());
    let mut rated: Vec<(u32, f64)> = Vec::with_capacity(outcomes.len());
    for outcome in outcomes {
        match outcome.by {
            None => own.add(outcome.outcome),
            Some(by) => rated.push((by, outcome.outcome)),
        }
    }
    rated.sort_by_key(|(by, _)| *by);
    for of_one in rated.chunk_by(|a, b| a.0 == b.0) {
        let mut counts = Counts::default();
        of_one.iter().for_each(|(_, outcome)| counts.add(*outcome));
        raters.push((of_one[0].0, counts));
    }
    (own, raters)
}
