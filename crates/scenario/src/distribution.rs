//! Distributions of numbers, which a scenario may have in place of a number.

use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use ron_tree::{Node, Problem, Value, nearest};
use schemars::JsonSchema;
use serde::de::value::EnumAccessDeserializer;
use serde::de::{EnumAccess, Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::seed::normal;

/// The names with which a distribution begins.
pub(super) const WORDS: [&str; 5] = ["Uniform", "Normal", "Clamped", "Truncated", "Choice"];

/// Draws of a truncated distribution before the nearest bound is used.
const TRUNCATION_TRIES: u32 = 1000;

/// The bounds of a truncated normal distribution must admit values within this many standard deviations of
/// its mean.
const MOST_DEVIATIONS: f64 = 4.0;

/// A distribution of numbers. It is bounded: a `Normal` stands within `Clamped` or `Truncated`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum Distribution {
    /// `Uniform(2, 5)`: every value between the two alike; of whole numbers, both ends too.
    Uniform(f64, f64),
    /// `Normal(80, 20)`: the normal distribution of this mean and standard deviation.
    Normal(f64, f64),
    /// `Clamped(Normal(80, 20), 1, 100)`: a draw beyond a bound counts as the bound.
    Clamped(Box<Distribution>, f64, f64),
    /// `Truncated(Normal(80, 20), 1, 100)`: a draw beyond a bound is drawn again.
    Truncated(Box<Distribution>, f64, f64),
    /// `Choice([1, 2, 5])`: one of the numbers, each alike.
    Choice(Vec<f64>),
}

impl Distribution {
    /// The least and the greatest value; infinite for a normal distribution.
    pub fn support(&self) -> [f64; 2] {
        match self {
            Self::Uniform(least, most) => [*least, *most],
            Self::Normal(mean, sd) if *sd == 0.0 => [*mean, *mean],
            Self::Normal(..) => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Clamped(of, least, most) => of.support().map(|end| end.clamp(*least, *most)),
            Self::Truncated(of, least, most) => {
                let [low, high] = of.support();
                [low.max(*least), high.min(*most)]
            }
            Self::Choice(values) => [
                values.iter().copied().fold(f64::INFINITY, f64::min),
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            ],
        }
    }

    /// The problem of an invalid distribution, as the rest of a sentence: `must ...`.
    pub fn fault(&self) -> Option<&'static str> {
        let fault = self.fault_inside();
        fault.or_else(|| {
            let is_bounded = self.support().iter().all(|end| end.is_finite());
            (!is_bounded)
                .then_some("must be bounded: write Clamped(Normal(mean, sd), least, most), or Truncated(...)")
        })
    }

    fn fault_inside(&self) -> Option<&'static str> {
        match self {
            Self::Uniform(a, b) => {
                (!(a.is_finite() && b.is_finite() && a <= b)).then_some("must have its least value first")
            }
            Self::Normal(mean, sd) => (!(mean.is_finite() && sd.is_finite() && *sd >= 0.0))
                .then_some("must have a mean and a standard deviation from 0"),
            Self::Clamped(of, a, b) | Self::Truncated(of, a, b) => {
                let is_rising = a.is_finite() && b.is_finite() && a <= b;
                let fault = (!is_rising).then_some("must have its lower bound before its upper bound");
                fault.or_else(|| of.fault_inside()).or_else(|| self.fault_of_truncation())
            }
            Self::Choice(values) => (values.is_empty() || !values.iter().all(|value| value.is_finite()))
                .then_some("must have at least one number to choose from"),
        }
    }

    fn fault_of_truncation(&self) -> Option<&'static str> {
        let Self::Truncated(of, least, most) = self else { return None };
        let [low, high] = match **of {
            Self::Normal(mean, sd) => [mean - MOST_DEVIATIONS * sd, mean + MOST_DEVIATIONS * sd],
            _ => of.support(),
        };
        (low > *most || high < *least).then_some("must have bounds within which it has values")
    }

    /// One draw. For a `whole` number, every number of a `Uniform` is equally likely.
    pub fn draw(&self, stream: &mut ChaCha8Rng, whole: bool) -> f64 {
        match self {
            Self::Uniform(least, most) if whole => {
                let count = (most.floor() - least.ceil() + 1.0).max(1.0);
                (least.ceil() + (stream.random::<f64>() * count).floor()).min(*most)
            }
            Self::Uniform(least, most) => least + (most - least) * stream.random::<f64>(),
            Self::Normal(mean, sd) => {
                let value = normal(stream, *mean, *sd);
                if whole { value.round() } else { value }
            }
            Self::Clamped(of, least, most) => of.draw(stream, whole).clamp(*least, *most),
            Self::Truncated(of, least, most) => {
                let mut value = of.draw(stream, whole);
                for _ in 0..TRUNCATION_TRIES {
                    if (*least..=*most).contains(&value) {
                        break;
                    }
                    value = of.draw(stream, whole);
                }
                value.clamp(*least, *most)
            }
            Self::Choice(values) => values[index(stream, values.len())],
        }
    }
}

/// The index of one of `count` things, each equally likely.
pub(super) fn index(stream: &mut ChaCha8Rng, count: usize) -> usize {
    ((stream.random::<f64>() * count as f64) as usize).min(count.saturating_sub(1))
}

/// A number, or a distribution from which each thing draws its own.
#[derive(Debug, Clone, PartialEq)]
pub enum Amount {
    /// The same for all.
    Fixed(f64),
    /// Drawn for each.
    Drawn(Distribution),
}

impl Amount {
    /// The least and the greatest value.
    pub fn support(&self) -> [f64; 2] {
        match self {
            Self::Fixed(value) => [*value; 2],
            Self::Drawn(distribution) => distribution.support(),
        }
    }

    /// The value of one thing.
    pub fn draw(&self, stream: &mut ChaCha8Rng) -> f64 {
        match self {
            Self::Fixed(value) => *value,
            Self::Drawn(distribution) => distribution.draw(stream, false),
        }
    }
}

/// Whether a value is written like a distribution.
pub(super) fn is_distribution(node: &Node) -> bool {
    matches!(&node.value, Value::Tuple(name, _) if WORDS.contains(&&**name))
}

/// Adds a hint with the most similar distribution to a problem with a number.
pub(super) fn hint(problem: &mut Problem) {
    let is_of_number = ["must be a number", "must be a whole number"].contains(&problem.rule.as_str());
    let name = problem.found.split('(').next().filter(|name| name.len() < problem.found.len());
    let meant = name.and_then(|name| nearest(name, WORDS));
    if let Some(meant) = meant.filter(|_| is_of_number && problem.hint.is_empty()) {
        problem.hint = format!("did you mean {meant}?");
    }
}

impl<'de> Deserialize<'de> for Amount {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AmountVisitor)
    }
}

struct AmountVisitor;

impl<'de> Visitor<'de> for AmountVisitor {
    type Value = Amount;

    fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str("a number or a distribution")
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Amount, E> {
        Ok(Amount::Fixed(value as f64))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Amount, E> {
        Ok(Amount::Fixed(value))
    }

    fn visit_enum<A: EnumAccess<'de>>(self, written: A) -> Result<Amount, A::Error> {
        let distribution = Distribution::deserialize(EnumAccessDeserializer::new(written))?;
        distribution.fault().map_or(Ok(Amount::Drawn(distribution)), |fault| Err(A::Error::custom(fault)))
    }
}

impl Serialize for Amount {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Fixed(value) => value.serialize(serializer),
            Self::Drawn(distribution) => distribution.serialize(serializer),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Purpose, stream};

    fn read(text: &str) -> Distribution {
        Node::parse(text).unwrap().read_as().unwrap()
    }

    #[test]
    fn draws_lie_within_the_support_and_reach_its_ends() {
        let mut draws = stream(3, Purpose::Slot, 0);
        for (text, whole) in [
            ("Uniform(2, 5)", true),
            ("Uniform(-1.5, 2)", false),
            ("Clamped(Normal(80, 20), 70, 90)", false),
            ("Truncated(Normal(0, 1), 1, 2)", false),
            ("Truncated(Normal(4, 2), 2, 6)", true),
            ("Choice([1, 7, 3])", true),
        ] {
            let distribution = read(text);
            assert_eq!(distribution.fault(), None, "{text}");
            let [least, most] = distribution.support();
            let sample: Vec<f64> = (0..4000).map(|_| distribution.draw(&mut draws, whole)).collect();
            let [low, high] =
                [sample.iter().copied().fold(9e9, f64::min), sample.iter().copied().fold(-9e9, f64::max)];
            assert!(low >= least && high <= most, "{text}: {low} to {high}");
            assert!(low < least + 0.02 && high > most - 0.02, "{text}: {low} to {high}");
            assert!(!whole || sample.iter().all(|value| value.fract() == 0.0), "{text}");
        }
    }

    #[test]
    fn whole_numbers_are_alike() {
        let mut draws = stream(5, Purpose::Slot, 1);
        let mut counts = [0_u32; 4];
        (0..8000).for_each(|_| counts[read("Uniform(2, 5)").draw(&mut draws, true) as usize - 2] += 1);
        assert!(counts.iter().all(|count| (1800..2200).contains(count)), "{counts:?}");
    }

    #[test]
    fn what_is_no_bounded_distribution_is_told() {
        for (text, says) in [
            ("Uniform(5, 2)", "least value first"),
            ("Normal(80, 20)", "must be bounded"),
            ("Clamped(Normal(80, 20), 9, 1)", "lower bound"),
            ("Truncated(Normal(0, 1), 5, 6)", "within which it has values"),
            ("Truncated(Normal(0, -1), 5, 6)", "standard deviation"),
            ("Choice([])", "at least one number"),
        ] {
            assert!(read(text).fault().unwrap().contains(says), "{text}");
        }
        assert_eq!(read("Clamped(Normal(80, 20), 1, 100)").fault(), None);
    }
}
