//! `Travos(error, confidence)`: own experience, or else opinions of others as far as they were right before.
//!
//! The base's own outcomes alone count if its trust is within `error` of the mean with more than
//! `confidence`. Else the opinion of each rater, `m` good and `n` bad with the mean `E`, counts by how right
//! such opinions of this rater were. Of five bins of equal width, take the one of `E`; `rho` is the mass of
//! `Beta(1 + good, 1 + bad)` in this bin, with the base's outcomes about any robot at the times when this
//! rater's opinion of that robot lay in the bin. The opinion becomes one with the mean `0.5 + rho (E - 0.5)`
//! and the deviation `even + rho (sd - even)`, where `even = 12^-0.5`, and is added to the base's own (Teacy,
//! Patel, Jennings, Luck 2006, *TRAVOS: Trust and Reputation in the Context of Inaccurate Information
//! Sources*). An opinion is what the rater said in the rounds before.

use teaming::ids::place_of;
use teaming::{Estimate, Estimator, EstimatorKind, PolicyError, Question};

use super::counts::Counts;
use super::incomplete_beta::within;
use super::last_said::{last_said, last_said_with};
use super::outcomes::{Outcome, Outcomes, TOLERANCE, by_rater};

/// Number of bins of opinions.
const BINS: usize = 5;

teaming::options! {
    /// Believes robots by the base's own outcomes, and by raters as far as they were right; levels are those
    /// said last.
    #[derive(Copy)]
    pub struct Travos {
        /// How far the trust may be from its mean, above 0 and below 1.
        pub error: f64 = 0.2,
        /// How likely that must be for others not to be asked, above 0 and below 1.
        pub confidence: f64 = 0.95,
    }
}

/// The registry's line.
#[must_use]
pub fn kind() -> EstimatorKind {
    EstimatorKind::with_options(
        "Travos",
        "trust by own outcomes, or by raters that were right",
        Travos::checked,
    )
    .from_sources(env!("SOURCES_ESTIMATOR_TRAVOS"))
}

impl Travos {
    fn checked(self) -> Result<Self, String> {
        let is_share = |share: f64| share > 0.0 && share < 1.0;
        let shares = [("error", self.error), ("confidence", self.confidence)];
        match shares.into_iter().find(|(_, share)| !is_share(*share)) {
            Some((name, _)) => Err(format!("{name} must be above 0 and below 1")),
            None => Ok(self),
        }
    }
}

impl Estimator for Travos {
    fn judges_trust_only(&self) -> bool {
        true
    }

    fn estimate(&self, question: &Question) -> Result<Vec<Estimate>, PolicyError> {
        let Some(evidence) = &question.evidence else { return last_said(question) };
        let outcomes = Outcomes::of(question, evidence, TOLERANCE);
        let accuracies = Accuracies::of(&outcomes).judged();
        let trust = |id: u32| {
            let (own, raters) = by_rater(outcomes.about(id));
            if confidence(own, self.error) > self.confidence {
                return own.mean();
            }
            let opinions = raters.iter().map(|(rater, said)| adjusted(*said, accuracies.rho(*rater, *said)));
            combined(own, opinions)
        };
        last_said_with(question, question.members.iter().map(|member| trust(member.id)))
    }
}

/// How likely the trust is within `error` of its mean.
fn confidence(own: Counts, error: f64) -> f64 {
    let mean = own.mean();
    within(mean - error, mean + error, own.beta())
}

/// The trust by the base's own counts and by opinions.
fn combined(mut own: Counts, opinions: impl Iterator<Item = Counts>) -> f64 {
    opinions.for_each(|opinion| own.join(opinion));
    own.mean()
}

/// The bin of an opinion's mean. A mean between two bins is in the lower one: with 3 good outcomes and a mean
/// of 0.8, the paper's example comes out in this way only.
fn bin(opinion: Counts) -> usize {
    ((opinion.mean() * BINS as f64).ceil() as usize).clamp(1, BINS) - 1
}

/// How right opinions in a bin were.
fn rho(bin: usize, outcomes: Counts) -> f64 {
    let width = 1.0 / BINS as f64;
    let from = bin as f64 * width;
    within(from, from + width, outcomes.beta())
}

/// An opinion as far as opinions in its bin were right.
fn adjusted(opinion: Counts, rho: f64) -> Counts {
    let even_sd = (1.0_f64 / 12.0).sqrt();
    let mean = 0.5 + rho * (opinion.mean() - 0.5);
    let sd = even_sd + rho * (opinion.sd() - even_sd);
    let size = mean * (1.0 - mean) / (sd * sd) - 1.0;
    Counts { good: (mean * size - 1.0).max(0.0), bad: ((1.0 - mean) * size - 1.0).max(0.0) }
}

/// For each rater and bin, the base's outcomes at the times when an opinion of the rater lay in the bin.
#[derive(Debug, Clone, PartialEq, Default)]
struct Accuracies(Vec<(u32, [Counts; BINS])>);

impl Accuracies {
    fn of(outcomes: &Outcomes) -> Self {
        let mut raters: Vec<u32> = outcomes.all().iter().filter_map(|outcome| outcome.by).collect();
        raters.sort_unstable();
        raters.dedup();
        let mut found = Self(raters.into_iter().map(|rater| (rater, Default::default())).collect());
        for about_one in outcomes.all().chunk_by(|a, b| a.of == b.of) {
            found.learn(about_one);
        }
        found
    }

    /// Compares the opinions about one robot with the base's outcomes, round by round.
    fn learn(&mut self, outcomes: &[Outcome]) {
        let mut opinions: Vec<(usize, Counts)> = Vec::new();
        for round in outcomes.chunk_by(|a, b| a.round == b.round) {
            for own in round.iter().filter(|outcome| outcome.by.is_none()) {
                for (rater, opinion) in &opinions {
                    self.0[*rater].1[bin(*opinion)].add(own.outcome);
                }
            }
            for outcome in round {
                let Some(rater) = outcome.by.and_then(|by| self.place(by)) else { continue };
                let at = opinions.binary_search_by_key(&rater, |(rater, _)| *rater).unwrap_or_else(|at| {
                    opinions.insert(at, (rater, Counts::default()));
                    at
                });
                opinions[at].1.add(outcome.outcome);
            }
        }
    }

    fn place(&self, rater: u32) -> Option<usize> {
        place_of(&self.0, rater, |(rater, _)| *rater)
    }

    /// How right each rater was, bin by bin.
    fn judged(&self) -> Rightness {
        let of = |(rater, bins): &(u32, [Counts; BINS])| {
            let mut place = 0..BINS;
            (*rater, bins.map(|outcomes| rho(place.next().unwrap_or_default(), outcomes)))
        };
        Rightness(self.0.iter().map(of).collect())
    }
}

/// For each rater and bin, how right its opinions in the bin were.
#[derive(Debug, Clone, PartialEq)]
struct Rightness(Vec<(u32, [f64; BINS])>);

impl Rightness {
    /// How right opinions like this one of a rater were. A rater that never rated was never wrong, nor right.
    fn rho(&self, rater: u32, opinion: Counts) -> f64 {
        let place = place_of(&self.0, rater, |(rater, _)| *rater);
        place.map_or(1.0 / BINS as f64, |place| self.0[place].1[bin(opinion)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(good: f64, bad: f64) -> Counts {
        Counts { good, bad }
    }

    fn is_near(found: f64, expected: f64) -> bool {
        (found / expected - 1.0).abs() < 1e-9
    }

    /// The example of Teacy et al. (2006), Section 3: opinions (15, 46), (4, 1) and (3, 0) of raters whose
    /// opinions in these bins came with (11, 4), (22, 10) and (18, 8), by an independent implementation in
    /// Python.
    #[test]
    fn the_example_of_the_paper_comes_out() {
        let cases = [
            (counts(15.0, 46.0), counts(11.0, 4.0), [0.009_537_218_293_050_875, 0.014_409_634_522_552_395]),
            (counts(4.0, 1.0), counts(22.0, 10.0), [2.521_511_716_619_027_5, 0.756_666_086_891_887_1]),
            (counts(3.0, 0.0), counts(18.0, 8.0), [2.062_910_245_124_859_5, 0.175_121_406_913_406_83]),
        ];
        assert_eq!(cases.map(|(opinion, ..)| bin(opinion)), [1, 3, 3]);
        for (opinion, outcomes, [good, bad]) in cases {
            let found = adjusted(opinion, rho(bin(opinion), outcomes));
            assert!(is_near(found.good, good) && is_near(found.bad, bad), "{found:?} {good} {bad}");
        }
        let opinions = cases.map(|(opinion, outcomes, _)| adjusted(opinion, rho(bin(opinion), outcomes)));
        assert!(is_near(combined(counts(0.0, 0.0), opinions.into_iter()), 0.741_889_020_766_213_2));
        assert!(is_near(confidence(counts(0.0, 0.0), 0.2), 0.4));
        assert!(is_near(confidence(counts(17.0, 5.0), 0.2), 0.980_604_088_823_177_2));
        assert!(is_near(confidence(counts(3.0, 0.0), 0.2), 0.870_4));
        assert!(is_near(counts(17.0, 5.0).mean(), 0.75) && is_near(counts(3.0, 0.0).mean(), 0.8));
    }

    /// Rater 7 praised robot 0 in the first round (0.9 of one look: a mean of 0.63, bin 3), and the base
    /// found a lie in the second.
    #[test]
    fn raters_are_right_or_wrong_about_the_rounds_after_their_opinion() {
        let outcome = |by, round, outcome| Outcome { of: 0, by, round, outcome };
        let mut accuracies = Accuracies(vec![(7, Default::default())]);
        let all = [
            outcome(None, 1, 1.0),
            outcome(Some(7), 1, 0.9),
            outcome(None, 2, 0.0),
            outcome(Some(7), 2, 1.0),
        ];
        accuracies.learn(&all);
        assert_eq!(accuracies.0[0].1[3], counts(0.0, 1.0), "the first outcome came before any opinion");
        let judged = accuracies.judged();
        // Beta(1, 2) has 1 - (1 - x)^2 below x: between 0.6 and 0.8 it has 0.96 - 0.84
        assert!(is_near(judged.rho(7, counts(0.9, 0.1)), 0.12));
        assert!(
            is_near(judged.rho(7, counts(0.1, 0.9)), 0.2) && is_near(judged.rho(8, counts(0.9, 0.1)), 0.2)
        );
    }
}
