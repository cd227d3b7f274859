//! The analysis of a study of regret.

use serde::Serialize;
use store::Failure;
use teaming::{Asked, Assignment, MadeMeasure, Registry};

use super::features::{FEATURES, values};
use super::study::{PlayedTrial, StudyFolder};
use crate::experiment::PolicySpec;
use crate::oracle::{Objective, Standing, Survey};
use statistics::bootstrap::{interval, ratio_interval};
use statistics::{Moments, rank_correlation};

/// Confidence of all intervals.
const CONFIDENCE: f64 = 0.95;

/// A mean over trials with its interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The mean; for a ratio, the ratio of the sums.
    pub value: f64,
    /// Its 95 % interval, by a bootstrap over trials; absent with fewer than two trials.
    pub interval: Option<[f64; 2]>,
}

impl Estimate {
    /// The mean of one value for each trial.
    fn mean(values: &[f64]) -> Option<Self> {
        let value = values.iter().sum::<f64>() / values.len() as f64;
        (!values.is_empty()).then(|| Self { value, interval: interval(values, CONFIDENCE) })
    }

    /// The ratio of the sums of two quantities of each trial; `None` if the second sum is 0.
    fn ratio(pairs: &[[f64; 2]]) -> Option<Self> {
        let [over, under] = [0, 1].map(|i| pairs.iter().map(|pair| pair[i]).sum::<f64>());
        (under != 0.0).then(|| Self { value: over / under, interval: ratio_interval(pairs, CONFIDENCE) })
    }
}

/// One policy at one decision.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DecisionRow {
    /// Number of the trial.
    pub trial: u32,
    /// Seed of the trial.
    pub seed: u64,
    /// The policy that decided in the trial.
    pub driver: String,
    /// The round.
    pub round: u32,
    /// The policy that is judged.
    pub policy: String,
    /// Rank of its choice, from 1.
    pub rank: usize,
    /// Value of its choice.
    pub value: f64,
    /// Distance of its value to the best value, never negative.
    pub regret: f64,
    /// Value of the best assignment.
    pub best: f64,
    /// Mean over all assignments.
    pub mean: f64,
    /// Value of the worst assignment.
    pub worst: f64,
    /// Assignments that were played.
    pub played: usize,
    /// Whether all assignments were played.
    pub is_exact: bool,
}

/// One policy over all decisions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PolicyRegret {
    /// The policy.
    pub policy: String,
    /// Mean regret of a decision.
    pub regret: Option<Estimate>,
    /// Share of the decisions in which no assignment is better.
    pub best: Option<Estimate>,
    /// Mean share of the assignments that are better.
    pub outranked: Option<Estimate>,
    /// The share of the distance from a fair draw to the best assignment that the policy achieves: 0 for a
    /// fair draw, 1 for the best.
    pub achieved: Option<Estimate>,
    /// What this share is of: the sums over all decisions of what the policy gains over a fair draw, and of
    /// what the best assignment gains.
    pub gains: [f64; 2],
}

/// The correlation of a feature with the outcome.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FeatureRow {
    /// The feature.
    pub feature: String,
    /// Mean rank correlation with the value, with the sign chosen so that + is better, over the decisions
    /// in which both vary.
    pub correlation: Option<Estimate>,
    /// Number of these decisions.
    pub decisions: usize,
}

/// The results of a study, by one objective.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Analysis {
    /// The objective.
    pub metric: String,
    /// Number of trials.
    pub trials: usize,
    /// Number of decisions in which the objective is defined.
    pub decisions: usize,
    /// Number of decisions of which all assignments were played.
    pub exact: usize,
    /// Share of the decisions in which the best assignment is better than the worst.
    pub matters: Option<Estimate>,
    /// Mean over decisions of the best minus the worst value.
    pub spread: Option<Estimate>,
    /// Mean over decisions of the best value.
    pub best: Option<Estimate>,
    /// Mean over decisions of the mean value: the expected value of a fair draw.
    pub drawn: Option<Estimate>,
    /// Mean over decisions of the worst value.
    pub worst: Option<Estimate>,
    /// The policies.
    pub policies: Vec<PolicyRegret>,
    /// The features.
    pub features: Vec<FeatureRow>,
    /// Every decision of every policy.
    #[serde(skip)]
    pub rows: Vec<DecisionRow>,
}

/// One decision, evaluated.
struct Looked {
    trial: u32,
    range: [f64; 2],
    mean: f64,
    is_exact: bool,
    /// For each policy, the standing of its choice.
    standings: Vec<Option<Standing>>,
    played: usize,
    correlations: Vec<Option<f64>>,
}

/// By what decisions are judged.
pub struct Criteria<'a> {
    /// The objective of which outcomes are worth more or less.
    pub objective: &'a Objective,
    /// The trust measure of the features.
    pub measure: &'a MadeMeasure,
}

/// Analyses a study by one objective.
///
/// # Errors
/// A policy that this program does not know.
pub fn analyse(folder: &StudyFolder, criteria: &Criteria, registry: &Registry) -> Result<Analysis, Failure> {
    let mean = |objective: &Objective| {
        let of_trial = |trial: &PlayedTrial| {
            let decisions = trial.decisions.iter().filter_map(|decision| decision.survey().mean(objective));
            Moments::of(&decisions.collect::<Vec<_>>()).mean
        };
        Moments::of(&folder.folder.entries.iter().filter_map(of_trial).collect::<Vec<_>>()).mean
    };
    let criteria = &Criteria { objective: &criteria.objective.clone().over(mean), ..*criteria };
    let specs = folder.study.specs(registry)?;
    let labels: Vec<&str> = specs.iter().map(|spec| spec.label.as_str()).collect();
    let (mut looked, mut rows) = (Vec::new(), Vec::new());
    for trial in &folder.folder.entries {
        for decision in &trial.decisions {
            let survey = decision.survey();
            let choice = |spec: &PolicySpec| {
                spec.made().open().ok()?.decide(&Asked::of(&decision.question).knowing(decision.team())).ok()
            };
            let choices: Vec<Option<Assignment>> =
                specs.iter().map(|spec| Some(choice(spec)?.assignment)).collect();
            let Some(found) = look(trial, &survey, criteria, &choices, decision) else { continue };
            rows.extend(rows_of(trial, decision.question.round, &labels, &found));
            looked.push(found);
        }
    }
    Ok(summary(criteria, &labels, &looked, rows))
}

fn look(
    trial: &PlayedTrial,
    survey: &Survey,
    criteria: &Criteria,
    choices: &[Option<Assignment>],
    decision: &super::PlayedDecision,
) -> Option<Looked> {
    let objective = criteria.objective;
    let range = survey.range(objective)?;
    let standing = |choice: &Option<Assignment>| survey.standing(objective, choice.as_ref()?);
    let defined: Vec<_> = survey
        .evaluations
        .iter()
        .filter_map(|evaluation| Some((&evaluation.assignment, objective.score(&evaluation.outcome)?)))
        .collect();
    let (assignments, scores): (Vec<&Assignment>, Vec<f64>) = defined.into_iter().unzip();
    let features = values(&decision.true_question(), &assignments, criteria.measure);
    let correlation = |feature: &Vec<Option<f64>>| {
        let feature: Option<Vec<f64>> = feature.iter().copied().collect();
        rank_correlation(&feature?, &scores)
    };
    Some(Looked {
        trial: trial.trial,
        range,
        mean: survey.mean(objective)?,
        is_exact: survey.coverage == crate::oracle::Coverage::All,
        standings: choices.iter().map(standing).collect(),
        played: survey.evaluations.len(),
        correlations: features.iter().map(correlation).collect(),
    })
}

fn rows_of<'a>(
    trial: &'a PlayedTrial,
    round: u32,
    labels: &'a [&str],
    looked: &'a Looked,
) -> impl Iterator<Item = DecisionRow> + 'a {
    let row = move |(label, standing): (&&str, &Option<Standing>)| {
        let Standing { rank, regret, value } = (*standing)?;
        let [best, worst] = looked.range;
        Some(DecisionRow {
            trial: trial.trial,
            seed: trial.seed,
            driver: trial.driver.clone(),
            round,
            policy: (*label).to_owned(),
            rank,
            value,
            regret,
            best,
            mean: looked.mean,
            worst,
            played: looked.played,
            is_exact: looked.is_exact,
        })
    };
    labels.iter().zip(&looked.standings).filter_map(row)
}

/// For each trial, the mean of a quantity over those of its decisions in which it is defined.
fn by_trial(looked: &[Looked], value: impl Fn(&Looked) -> Option<f64>) -> Vec<f64> {
    let trials = looked.chunk_by(|a, b| a.trial == b.trial);
    let mean = |decisions: &[Looked]| {
        let values: Vec<f64> = decisions.iter().filter_map(&value).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    trials.filter_map(mean).collect()
}

fn summary(criteria: &Criteria, labels: &[&str], looked: &[Looked], rows: Vec<DecisionRow>) -> Analysis {
    let estimate = |value: &dyn Fn(&Looked) -> Option<f64>| Estimate::mean(&by_trial(looked, value));
    let flag = |is: bool| Some(f64::from(u8::from(is)));
    let spread = |decision: &Looked| (decision.range[0] - decision.range[1]).abs();
    let policy = |(place, label): (usize, &&str)| {
        let standing = |decision: &Looked| decision.standings[place];
        let gains = achieved(looked, place);
        PolicyRegret {
            policy: (*label).to_owned(),
            regret: estimate(&|decision| Some(standing(decision)?.regret)),
            best: estimate(&|decision| flag(standing(decision)?.rank == 1)),
            outranked: estimate(&|decision| {
                Some((standing(decision)?.rank - 1) as f64 / (decision.played.max(2) - 1) as f64)
            }),
            achieved: Estimate::ratio(&gains),
            gains: gains.iter().fold([0.0; 2], |sums, gains| [sums[0] + gains[0], sums[1] + gains[1]]),
        }
    };
    let feature = |(place, feature): (usize, &super::features::Feature)| FeatureRow {
        feature: feature.name(criteria.measure),
        correlation: estimate(&|decision| decision.correlations.get(place).copied().flatten()),
        decisions: looked.iter().filter(|d| d.correlations.get(place).copied().flatten().is_some()).count(),
    };
    Analysis {
        metric: criteria.objective.name().to_owned(),
        trials: looked.chunk_by(|a, b| a.trial == b.trial).count(),
        decisions: looked.len(),
        exact: looked.iter().filter(|decision| decision.is_exact).count(),
        matters: estimate(&|decision| flag(spread(decision) > 0.0)),
        spread: estimate(&|decision| Some(spread(decision))),
        best: estimate(&|decision| Some(decision.range[0])),
        drawn: estimate(&|decision| Some(decision.mean)),
        worst: estimate(&|decision| Some(decision.range[1])),
        policies: labels.iter().enumerate().map(policy).collect(),
        features: FEATURES.iter().enumerate().map(feature).collect(),
        rows,
    }
}

/// For each trial: the sums over its decisions of what a policy gains over a fair draw, and of what the
/// best assignment gains.
fn achieved(looked: &[Looked], policy: usize) -> Vec<[f64; 2]> {
    let trials = looked.chunk_by(|a, b| a.trial == b.trial);
    let sums = |decisions: &[Looked]| {
        decisions.iter().fold([0.0; 2], |[own, all], decision| {
            let Some(standing) = decision.standings[policy] else { return [own, all] };
            let possible = (decision.range[0] - decision.mean).abs();
            [own + possible - standing.regret, all + possible]
        })
    };
    trials.map(sums).collect()
}
