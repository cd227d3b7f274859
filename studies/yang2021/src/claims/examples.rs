//! The claims that the paper draws from its numerical examples, checked with exact values.

use experiments::Failure;
use rne_core::{NeedDistribution, NeedVector, NeedWeights, relative_entropy};

use super::Verdict;

/// A comparison that the paper draws from one of its examples.
#[derive(Debug, Clone, PartialEq)]
pub struct Example {
    /// Name of the example.
    pub name: &'static str,
    /// The claim, in our words.
    pub words: &'static str,
    /// The relative needs entropy that is claimed to be lower, in nats: more trust.
    pub trusting: f64,
    /// The relative needs entropy that is claimed to be higher, in nats.
    pub doubting: f64,
    /// Whether the exact values agree with the claim.
    pub verdict: Verdict,
}

const WEIGHTS: [f64; 3] = [6.0, 4.0, 2.0];
const R1: &[[f64; 3]] = &[[86.0, 120.0, 30.0]];
const R2: &[[f64; 3]] = &[[20.0, 30.0, 10.0]];
const R3: &[[f64; 3]] = &[[80.0, 115.0, 25.0]];
const G1: &[[f64; 3]] = &[[82.0, 114.0, 24.0], [79.0, 117.0, 23.0]];
const G2: &[[f64; 3]] = &[[40.0, 56.0, 12.0], [56.0, 48.0, 15.0]];

/// The three examples.
///
/// # Errors
/// None: their needs are given.
pub fn examples() -> Result<[Example; 3], Failure> {
    Ok([
        example("Example 1", "robot 1 trusts robot 3 more than robot 2", rne(R1, R3)?, rne(R1, R2)?),
        example("Example 2", "robot 1 trusts group 1 more than group 2", rne(R1, G1)?, rne(R1, G2)?),
        example(
            "Example 3",
            "group 1 trusts group 2 much more than group 2 trusts group 1",
            rne(G1, G2)?,
            rne(G2, G1)?,
        ),
    ])
}

fn example(name: &'static str, words: &'static str, trusting: f64, doubting: f64) -> Example {
    let verdict = if trusting < doubting { Verdict::Holds } else { Verdict::DoesNotHold };
    Example { name, words, trusting, doubting, verdict }
}

fn rne(from: &[[f64; 3]], to: &[[f64; 3]]) -> Result<f64, Failure> {
    let weights = NeedWeights::new(WEIGHTS.to_vec()).map_err(Failure::run)?;
    let distribution = |group: &[[f64; 3]]| {
        let members: Result<Vec<NeedVector>, _> =
            group.iter().map(|needs| NeedVector::new(needs.to_vec())).collect();
        members.and_then(|members| NeedDistribution::of_group(&members, &weights)).map_err(Failure::run)
    };
    let rne = relative_entropy(&distribution(from)?, &distribution(to)?).map_err(Failure::run)?;
    rne.nats().ok_or_else(|| Failure::run("the examples have no infinite entropy"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_examples_hold_and_the_third_is_the_other_way_round() {
        let [one, two, three] = examples().unwrap();
        assert_eq!(
            [one.verdict, two.verdict, three.verdict],
            [Verdict::Holds, Verdict::Holds, Verdict::DoesNotHold]
        );
        assert!((one.trusting - 0.000_504_442_597_037_169_6).abs() < 1e-12);
        assert!((three.trusting - 0.009_534_892_308_733_986).abs() < 1e-12);
        assert!((three.doubting - 0.009_418_613_384_441_856).abs() < 1e-12);
    }
}
