//! The Kalman filter of one member: what the base expects of its levels by what its group-mates spent, and
//! what of its reports that lets through.

use teaming::{Estimate, Evidence, Expected, Level, Member, PolicyError, Question, Rest};

use super::counts::Counts;
use super::rounds::Seen;

/// What is expected of a level if the base expects nothing.
const UNKNOWN: Expected = Expected { mean: 80.0, sd: 20.0 };

/// How much a filter lets through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rules {
    /// Variance by which a level becomes less sure in each round, in square percent points.
    pub(super) q: f64,
    /// Variance of a report, in square percent points.
    pub(super) r: f64,
    /// Greatest squared error of a report in terms of its variance.
    pub(super) gate: f64,
    /// So many reports in a row that fail begin the level anew; 0 if none do.
    pub(super) restart: u32,
}

/// What is thought of one level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Guess {
    /// Its mean, in percent.
    pub(super) x: f64,
    /// Its variance, in square percent points.
    pub(super) p: f64,
    /// The reports that failed since one passed.
    pub(super) failed: u32,
}

impl Guess {
    pub(super) fn of(x: f64, p: f64) -> Self {
        Self { x, p, failed: 0 }
    }

    /// Takes a report in; returns whether it passed. One that fails the gate changes nothing, unless so many
    /// failed that the level begins anew with it.
    pub(super) fn hear(&mut self, z: f64, rules: &Rules) -> bool {
        let s = self.p + rules.r;
        let error = z - self.x;
        if error * error / s > rules.gate {
            self.failed += 1;
            if self.failed == rules.restart {
                *self = Self::of(z, rules.r);
            }
            return false;
        }
        let gain = self.p / s;
        *self = Self::of(self.x + gain * error, self.p * (1.0 - gain));
        true
    }
}

/// Follows the levels of one member. `hears` tells whether its own reports count. Returns the guesses of all
/// levels, and how many reports of a level passed and failed.
pub(super) fn follow(
    question: &Question,
    seen: &[Seen<'_>],
    rules: &Rules,
    hears: bool,
) -> (Vec<Guess>, Counts) {
    let at_first = |level: &Level| {
        let Expected { mean, sd } = level.expected.unwrap_or(UNKNOWN);
        Guess::of(mean, sd * sd)
    };
    let mut guesses: Vec<Guess> = question.levels.iter().map(at_first).collect();
    let mut passes = Counts::default();
    for (number, seen) in seen.iter().enumerate() {
        if number > 0 {
            predict(&mut guesses, seen, rules.q, question.rest);
        }
        let Some(said) = seen.said.filter(|_| hears) else { continue };
        for (guess, z) in guesses.iter_mut().zip(said.levels) {
            passes.add(f64::from(u8::from(guess.hear(*z, rules))));
        }
    }
    (guesses, passes)
}

/// What a round makes of the levels: they fall as those of the mates did. Where no mate can tell, they stay,
/// as unsure as those of which nothing is known. A rest fills them, or the lowest of them.
fn predict(guesses: &mut [Guess], seen: &Seen<'_>, q: f64, rest: Rest) {
    let unsure = if seen.used.is_some() { q } else { UNKNOWN.sd * UNKNOWN.sd };
    for (level, guess) in guesses.iter_mut().enumerate() {
        let used = seen.used.as_ref().and_then(|used| used.get(level)).copied().unwrap_or_default();
        *guess = Guess { x: guess.x - used, p: guess.p + unsure, ..*guess };
    }
    if seen.rested {
        let lower = |low: usize, level: usize| if guesses[level].x < guesses[low].x { level } else { low };
        let lowest = (0..guesses.len()).fold(0, lower);
        for (level, guess) in guesses.iter_mut().enumerate() {
            if rest == Rest::All || level == lowest {
                *guess = Guess::of(100.0, q);
            }
        }
    }
}

/// The estimate of a member by these guesses.
pub(super) fn estimate(
    member: &Member,
    evidence: &Evidence,
    guesses: &[Guess],
) -> Result<Estimate, PolicyError> {
    let levels = guesses.iter().map(|guess| guess.x.clamp(0.0, 100.0)).collect();
    Estimate::of_levels(member, evidence, levels, guesses.iter().map(|guess| guess.p.sqrt()).collect())
}

#[cfg(test)]
mod tests {
    use super::super::rounds::Said;
    use super::*;

    const RULES: Rules = Rules { q: 4.0, r: 25.0, gate: 6.634_896_601_021_214_5, restart: 0 };

    /// A question about the levels of the paper's team.
    fn question(rest: Rest) -> Question {
        let mut levels = Level::energy_and_hp();
        levels[1].expected = Some(Expected { mean: 90.0, sd: 10.0 });
        Question { levels, rest, ..Question::default() }
    }

    fn seen(said: Option<f64>, used: f64, rested: bool) -> Seen<'static> {
        let said = said.map(|energy| Said { levels: vec![energy, 90.0].leak(), sd: &[0.0; 2] });
        Seen { said, used: Some(vec![used, 0.0]), rested }
    }

    /// The guess of energy after each round, and the passes of energy alone.
    fn energies(rounds: &[Seen<'_>]) -> Vec<[f64; 2]> {
        let of = |count| follow(&question(Rest::All), &rounds[..count], &RULES, true).0[0];
        (1..=rounds.len()).map(|count| [of(count).x, of(count).p]).collect()
    }

    fn check(found: &[[f64; 2]], expected: &[[f64; 2]]) {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        }
    }

    /// Reference: an independent implementation in Python. The third report fails.
    #[test]
    fn levels_are_filtered_as_computed_elsewhere() {
        let used = [0.0, 12.0, 12.0, 12.0];
        let rounds: Vec<Seen<'_>> =
            [75.0, 62.0, 95.0, 41.0].iter().zip(used).map(|(z, used)| seen(Some(*z), used, false)).collect();
        check(
            &energies(&rounds),
            &[
                [75.294_117_647_058_83, 23.529_411_764_705_888],
                [62.615_901_455_767_08, 13.101_903_695_408_735],
                [50.615_901_455_767_08, 17.101_903_695_408_737],
                [39.707_158_298_719_91, 11.443_076_100_949_744],
            ],
        );
        let (_, passes) = follow(&question(Rest::All), &rounds, &RULES, true);
        assert!((passes.good - 7.0).abs() < 1e-12 && (passes.bad - 1.0).abs() < 1e-12, "{passes:?}");
    }

    #[test]
    fn a_rest_fills_a_level_and_silence_leaves_it_as_expected() {
        let rounds = [
            seen(Some(75.0), 0.0, false),
            seen(Some(62.0), 12.0, false),
            seen(Some(99.0), 0.0, true),
            seen(None, 9.0, false),
            seen(Some(80.0), 9.0, false),
        ];
        check(
            &energies(&rounds),
            &[
                [75.294_117_647_058_83, 23.529_411_764_705_888],
                [62.615_901_455_767_08, 13.101_903_695_408_735],
                [99.862_068_965_517_24, 3.448_275_862_068_965_3],
                [90.862_068_965_517_24, 7.448_275_862_068_965],
                [81.277_199_621_570_47, 7.852_412_488_174_077],
            ],
        );
    }

    /// A robot that fell by 40 points at once says so from then on. Reference: an independent implementation
    /// in Python.
    #[test]
    fn reports_that_fail_in_a_row_begin_a_level_anew() {
        let said = [75.0, 40.0, 35.0, 30.0, 26.0];
        let rounds: Vec<Seen<'_>> = said.map(|z| seen(Some(z), 5.0, false)).to_vec();
        let energy = |restart| {
            let (guesses, passes) = follow(&question(Rest::All), &rounds, &Rules { restart, ..RULES }, true);
            ([guesses[0].x, guesses[0].p], passes.bad)
        };
        let (found, failed) = energy(3);
        check(&[found], &[[25.537_037_037_037_038, 13.425_925_925_925_926]]);
        assert!((failed - 3.0).abs() < 1e-12, "{failed}");
        let (found, failed) = energy(0);
        assert!(found[0] > 54.0 && (failed - 4.0).abs() < 1e-12, "{found:?} {failed}");
    }

    /// Nobody came back who could tell what the round cost: a fall of 35 points passes.
    #[test]
    fn what_no_mate_can_tell_is_unknown_and_not_nothing() {
        let fall = |used| {
            let rounds = [seen(Some(75.0), 0.0, false), Seen { used, ..seen(Some(40.0), 0.0, false) }];
            follow(&question(Rest::All), &rounds, &RULES, true).1.bad
        };
        assert!(fall(None) < 0.5 && fall(Some(vec![0.0; 2])) > 0.5);
    }

    /// Energy 63 and health 90 after a round: only energy is filled. Nothing is heard.
    #[test]
    fn where_a_rest_fills_one_level_the_other_stays() {
        let rounds = [seen(Some(1.0), 0.0, false), seen(None, 17.0, true)];
        let (guesses, passes) = follow(&question(Rest::Low), &rounds, &RULES, false);
        let expected = vec![Guess::of(100.0, 4.0), Guess::of(90.0, 104.0)];
        assert_eq!((guesses, passes), (expected, Counts::default()));
    }
}
