//! The paper's claims as data, and the verdict of trials on each claim.
//!
//! A claim has one or more parts that must all be true. Example: RNE rescues the most if it rescues more
//! than each of the other policies. A part compares two quantities over pairs of trials.
//!
//! - *Holds*: the 95 % interval of every part lies entirely on the claimed side. Since all parts must hold,
//!   no correction is needed (intersection-union test, Berger 1982). A false claim is called true in at
//!   most about 2.5 % of experiments.
//! - *Equivalent*: not that, but each part holds or is within its margin: the 90 % interval of the difference
//!   lies inside the margin that `paper.sweep.ron` declares (two one-sided tests at 5 %). What the paper
//!   claims to be more, or less, is practically the same.
//! - *Does not hold*: neither of these, and the interval of some part lies entirely on the other side, at
//!   95 % shared by the parts (Bonferroni). With three parts, each interval is at 98.3 %. A true claim is
//!   called false in at most about 2.5 % of experiments.
//! - *The same*: the quantities of each part are the same in all trials.
//! - *Undecided*: otherwise.

mod examples;
mod files;
mod papers;
mod power;

use experiments::Failure;
use experiments::comparison::{CONFIDENCE, Pairs, Quantity, Standing, TOST_CONFIDENCE, Trials};
use experiments::metric::Catalogue;
use experiments::sweep::folder::Folder;
use serde::Serialize;
use statistics::Moments;
use statistics::paired::{detectable, pairs_needed};

use crate::scenarios::{PAPERS_TRIALS, Standing as Role, margins};

pub use examples::{Example, examples};
pub use files::{write_authors_columns, write_claims, write_examples, write_power};
pub use papers::CLAIMS;
use power::TIMES;
pub use power::{Power, Shares, power};

/// A claim that the paper makes about its experiment.
#[derive(Debug)]
pub struct Claim {
    /// Short name.
    pub name: &'static str,
    /// The claim, in our words.
    pub words: &'static str,
    /// The section of the paper.
    pub section: &'static str,
    /// The comparisons that must all be true.
    pub parts: &'static [Part],
}

/// A comparison of two quantities.
#[derive(Debug)]
pub struct Part {
    /// Policy and metric of the first quantity.
    pub a: [&'static str; 2],
    /// Policy and metric of the second quantity.
    pub b: [&'static str; 2],
    /// Side that the paper claims for the first quantity.
    pub claimed: Side,
}

/// A side of zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The first is more.
    More,
    /// The first is less.
    Less,
}

/// The verdict of trials on a claim.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Verdict {
    /// The claim is true.
    #[serde(rename = "holds")]
    Holds,
    /// The claim is false.
    #[serde(rename = "does not hold")]
    DoesNotHold,
    /// Each comparison holds, or the difference is smaller than the margin: of a claim to be the best, that
    /// it is the best or within the margin of the best.
    #[serde(rename = "holds or within margin")]
    WithinMargin,
    /// The quantities of each comparison are the same in all trials.
    #[serde(rename = "the same")]
    Same,
    /// The trials do not decide.
    #[serde(rename = "undecided")]
    Undecided,
}

impl Verdict {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::DoesNotHold => "does not hold",
            Self::WithinMargin => "holds or within margin",
            Self::Same => "the same",
            Self::Undecided => "undecided",
        }
    }

    /// The verdict on several worlds together, from the verdict in each.
    fn over(mut worlds: impl Iterator<Item = Self> + Clone) -> Self {
        if worlds.clone().any(|verdict| verdict == Self::DoesNotHold) {
            Self::DoesNotHold
        } else if worlds.clone().all(|verdict| verdict == Self::Holds) {
            Self::Holds
        } else if worlds.clone().all(|verdict| verdict == Self::Same) {
            Self::Same
        } else if worlds.all(|verdict| matches!(verdict, Self::Holds | Self::WithinMargin)) {
            Self::WithinMargin
        } else {
            Self::Undecided
        }
    }

    /// The verdict from the intervals of all parts: each at 95 %, within its margin, and each at 95 % shared
    /// by the parts.
    fn of(parts: &[PartFinding]) -> Self {
        let on = |interval: Option<[f64; 2]>, side: Side| {
            interval.is_some_and(|[low, high]| match side {
                Side::More => low > 0.0,
                Side::Less => high < 0.0,
            })
        };
        let holds = |part: &PartFinding| on(part.interval, part.claimed);
        if !parts.is_empty() && parts.iter().all(|part| part.standing == Standing::Same) {
            Self::Same
        } else if !parts.is_empty() && parts.iter().all(holds) {
            Self::Holds
        } else if !parts.is_empty() && parts.iter().all(|part| holds(part) || part.is_equivalent) {
            Self::WithinMargin
        } else if parts.iter().any(|part| on(part.shared_interval, part.claimed.other())) {
            Self::DoesNotHold
        } else {
            Self::Undecided
        }
    }
}

impl Side {
    fn other(self) -> Self {
        match self {
            Self::More => Self::Less,
            Self::Less => Self::More,
        }
    }

    /// The side as a sign between the two quantities.
    pub fn sign(self) -> char {
        match self {
            Self::More => '>',
            Self::Less => '<',
        }
    }
}

/// The result of trials for one part.
#[derive(Debug, Clone, PartialEq)]
pub struct PartFinding {
    /// Side that the paper claims for the first quantity.
    pub claimed: Side,
    /// What the pairs can say.
    pub standing: Standing,
    /// Pairs in which both are defined.
    pub n: usize,
    /// First minus second: the mean difference, or the difference of ratios of sums.
    pub difference: Option<f64>,
    /// Standard deviation of the differences.
    pub sd: Option<f64>,
    /// 95 % interval of the difference.
    pub interval: Option<[f64; 2]>,
    /// Interval at 95 % shared by all parts of the claim.
    pub shared_interval: Option<[f64; 2]>,
    /// Whether the 90 % interval lies within the margin of the metric.
    pub is_equivalent: bool,
    /// Pairs that a paired t test needs for 80 % power, if the true difference is the observed one.
    pub pairs_needed: Option<u64>,
}

impl PartFinding {
    /// The difference that 80 % of experiments with the paper's number of trials would find.
    pub(crate) fn least_found(&self) -> Option<f64> {
        detectable(self.sd?, PAPERS_TRIALS as usize)
    }
}

/// The result of trials for a claim.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// The verdict.
    pub verdict: Verdict,
    /// The results of the parts, in the order of the claim.
    pub parts: Vec<PartFinding>,
    /// The differences of all parts, for each trial that every part has.
    pub trials: Vec<Vec<f64>>,
}

/// With fewer trials, no power is computed.
pub(crate) const LEAST_TRIALS: u32 = PAPERS_TRIALS * TIMES as u32;

/// Seed of the drawn experiments from which the power is computed.
const POWER_SEED: u64 = 1;

/// The results of a scenario's trials for each claim.
pub struct Judged {
    /// The role of the scenario in the study.
    pub standing: Role,
    /// Name of the scenario.
    pub scenario: String,
    /// Catalogue of the scenario's metrics.
    pub metrics: Catalogue,
    /// Results over the paper's number of trials.
    pub of_few: Vec<Finding>,
    /// Number of all trials.
    pub trials: u32,
    /// Results over all trials.
    pub of_all: Vec<Finding>,
    /// The verdicts expected from experiments of other sizes.
    pub powers: Vec<Option<Power>>,
}

impl Judged {
    /// Judges the first trials of a folder's sweep.
    ///
    /// # Errors
    /// The sweep lacks a policy of a claim.
    pub fn of(folder: &Folder, standing: Role, trials: u32) -> Result<Self, Failure> {
        let all =
            |trials| CLAIMS.iter().map(|claim| judge(folder, claim, trials)).collect::<Result<Vec<_>, _>>();
        let (of_few, of_all) = (all(PAPERS_TRIALS)?, all(trials)?);
        let powers =
            of_all.iter().map(|finding| power(finding, PAPERS_TRIALS as usize, POWER_SEED)).collect();
        let (scenario, metrics) = (folder.experiment().name.clone(), folder.experiment().metrics.clone());
        Ok(Self { standing, scenario, metrics, of_few, trials, of_all, powers })
    }
}

/// The verdict on each claim over all calibrated worlds together: it holds if it holds in each world, and
/// does not hold if it does not hold in one. `None` if there is only one such world.
pub(crate) fn verdicts_over_worlds(judged: &[Judged]) -> Option<Vec<Verdict>> {
    let calibrated: Vec<&Judged> = judged.iter().filter(|world| world.standing.is_in_ensemble()).collect();
    let verdict = |claim: usize| Verdict::over(calibrated.iter().map(|world| world.of_all[claim].verdict));
    (calibrated.len() > 1).then(|| (0..CLAIMS.len()).map(verdict).collect())
}

/// Judges a claim by the first trials of a folder's sweep.
///
/// # Errors
/// The sweep lacks a policy of the claim.
pub fn judge(folder: &Folder, claim: &Claim, trials: u32) -> Result<Finding, Failure> {
    let metrics = &folder.experiment().metrics;
    let trials = Trials::new(metrics, folder.results(), 1..=trials);
    let place = |[policy, metric]: [&str; 2]| -> Result<Quantity, Failure> {
        Ok(((0, place_of(folder, policy)?), metrics.named(metric)?))
    };
    let pair = |part: &Part| Ok([place(part.a)?, place(part.b)?]);
    let pairs = claim.parts.iter().map(pair).collect::<Result<Vec<_>, Failure>>()?;
    let part = |(part, pair): (&Part, &[Quantity; 2])| finding(part, &trials.pairs(*pair), pairs.len());
    let parts: Vec<PartFinding> = claim.parts.iter().zip(&pairs).map(part).collect();
    let columns: Vec<Vec<f64>> = trials.joint(&pairs).iter().map(Pairs::differences).collect();
    let row = |trial: usize| columns.iter().map(|column| column[trial]).collect();
    let trials = (0..columns[0].len()).map(row).collect();
    Ok(Finding { verdict: Verdict::of(&parts), parts, trials })
}

/// What pairs say of one of so many parts.
fn finding(part: &Part, pairs: &Pairs, count: usize) -> PartFinding {
    let differences = pairs.differences();
    PartFinding {
        claimed: part.claimed,
        standing: pairs.standing(),
        n: differences.len(),
        difference: pairs.difference(),
        sd: Moments::of(&differences).sd,
        interval: pairs.interval(CONFIDENCE),
        shared_interval: pairs.interval(1.0 - (1.0 - CONFIDENCE) / count as f64),
        is_equivalent: is_within(pairs, margin_of(part)),
        pairs_needed: pairs_needed(&differences),
    }
}

/// The margin of a comparison of two policies in one metric, if the paper's sweep file declares one.
fn margin_of(part: &Part) -> Option<f64> {
    let [_, metric] = part.a;
    let declared = margins().into_iter().find(|(name, _)| name == metric);
    declared.map(|(_, margin)| margin).filter(|_| metric == part.b[1])
}

/// Whether the difference is shown to be smaller than the margin.
fn is_within(pairs: &Pairs, margin: Option<f64>) -> bool {
    let (Some(margin), Some([low, high])) = (margin, pairs.interval(TOST_CONFIDENCE)) else { return false };
    -margin < low && high < margin
}

fn place_of(folder: &Folder, policy: &str) -> Result<usize, Failure> {
    let place = folder.experiment().policies.iter().position(|known| known.label == policy);
    place.ok_or_else(|| Failure::input(format!("{}: has no policy {policy}", folder.path().display())))
}

impl Part {
    /// The comparison in words.
    pub fn words(&self) -> String {
        let ([policy, metric], [other, other_metric], sign) = (self.a, self.b, self.claimed.sign());
        if metric == other_metric {
            format!("{metric}: {policy} {sign} {other}")
        } else {
            format!("{policy}: {metric} {sign} {other_metric}")
        }
    }
}

#[cfg(test)]
mod tests {
    use scenario::Scenario;

    use super::*;

    fn parts(intervals: &[[f64; 4]], claimed: Side) -> Vec<PartFinding> {
        let part = |[low, high, wide_low, wide_high]: &[f64; 4]| PartFinding {
            claimed,
            standing: Standing::Judged,
            n: 40,
            difference: None,
            sd: None,
            interval: Some([*low, *high]),
            shared_interval: Some([*wide_low, *wide_high]),
            is_equivalent: false,
            pairs_needed: None,
        };
        intervals.iter().map(part).collect()
    }

    #[test]
    fn a_claim_holds_over_worlds_when_it_holds_in_each_and_falls_with_one() {
        let over = |verdicts: &[Verdict]| Verdict::over(verdicts.iter().copied());
        let [holds, falls, open] = [Verdict::Holds, Verdict::DoesNotHold, Verdict::Undecided];
        assert_eq!(over(&[holds, holds]), holds);
        assert_eq!(over(&[holds, open]), open);
        assert_eq!(over(&[holds, open, falls]), falls);
        assert_eq!(over(&[holds, Verdict::WithinMargin]), Verdict::WithinMargin);
        assert_eq!(over(&[open, Verdict::WithinMargin]), open);
    }

    #[test]
    fn a_claim_holds_when_every_part_does_and_falls_with_one() {
        let above = [1.0, 3.0, 0.5, 3.5];
        let open = [-1.0, 3.0, -1.5, 3.5];
        let below = [-3.0, -1.0, -3.5, -0.5];
        let nearly_below = [-3.0, -0.1, -3.5, 0.2];
        let verdict = |intervals: &[[f64; 4]], side| Verdict::of(&parts(intervals, side));
        assert_eq!(verdict(&[above, above], Side::More), Verdict::Holds);
        assert_eq!(verdict(&[above, open], Side::More), Verdict::Undecided);
        assert_eq!(verdict(&[above, below], Side::More), Verdict::DoesNotHold);
        assert_eq!(verdict(&[above, nearly_below], Side::More), Verdict::Undecided);
        assert_eq!(verdict(&[below, below], Side::Less), Verdict::Holds);
        assert_eq!(verdict(&[below, above], Side::Less), Verdict::DoesNotHold);
        assert_eq!(verdict(&[], Side::More), Verdict::Undecided);
    }

    #[test]
    fn a_claim_is_equivalent_when_what_does_not_hold_is_within_its_margin() {
        let mut found = parts(&[[1.0, 3.0, 0.5, 3.5], [-3.0, -1.0, -3.5, -0.5]], Side::More);
        assert_eq!(Verdict::of(&found), Verdict::DoesNotHold);
        found[1].is_equivalent = true;
        assert_eq!(Verdict::of(&found), Verdict::WithinMargin);
        let within = |half: f64, margin| {
            let a = (1..=40).map(|i| if i % 2 == 0 { half } else { -half }).collect();
            is_within(&Pairs { a, b: vec![0.0; 40], ..Pairs::default() }, margin)
        };
        assert!(within(1.0, Some(5.0)));
        assert!(!within(30.0, Some(5.0)));
        assert!(!within(1.0, None));
    }

    #[test]
    fn every_claim_is_of_metrics_and_policies_that_exist() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/paper.ron");
        let metrics = Catalogue::of(&Scenario::load(&path).unwrap().0);
        for part in CLAIMS.iter().flat_map(|claim| claim.parts) {
            for [policy, metric] in [part.a, part.b] {
                assert!(metrics.named(metric).is_ok(), "{metric}");
                assert!(policies::standard().names().contains(&policy), "{policy}");
            }
        }
    }

    #[test]
    fn no_interval_is_no_verdict() {
        let mut unknown = parts(&[[1.0, 2.0, 1.0, 2.0]], Side::More);
        unknown[0].interval = None;
        unknown[0].shared_interval = None;
        assert_eq!(Verdict::of(&unknown), Verdict::Undecided);
    }
}
