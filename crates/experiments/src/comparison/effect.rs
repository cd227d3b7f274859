//! Main effects: how much a field of the scenario changes a policy's result. An effect is the difference of
//! one policy between two cases of a sweep with axes, paired by seed: a case, and its reference, in which
//! one axis has its first value instead.

use rayon::prelude::*;
use serde::Serialize;
use store::Failure;

use super::{CONFIDENCE, Choice, LEVEL, Standing, Trials, policies_of};
use crate::experiment::{Case, Experiment};
use crate::sweep::folder::Folder;
use statistics::Moments;
use statistics::paired::holm;
use statistics::wilcoxon::SignedRank;

/// How one policy's mean changes with one field of the scenario.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Effect {
    /// Number of the case, from 1.
    pub case: usize,
    /// Number of the reference, the case with which it is compared.
    pub reference: usize,
    /// The field that differs.
    pub path: String,
    /// Its value in the reference, and in the case.
    pub values: [String; 2],
    /// The other axes and their values, the same in both.
    pub others: Vec<(String, String)>,
    /// Name of the metric.
    pub metric: String,
    /// The policy.
    pub policy: String,
    /// Seeds for which the metric is defined in both trials.
    pub n: usize,
    /// Mean of the policy in the reference, and in the case.
    pub means: Option<[f64; 2]>,
    /// Mean in the case minus mean in the reference.
    pub change: Option<f64>,
    /// 95 % bootstrap interval of the change.
    pub interval: Option<[f64; 2]>,
    /// Two-sided p of Wilcoxon's signed-rank test.
    pub p: Option<f64>,
    /// p after Holm's correction over all effects.
    pub p_holm: Option<f64>,
}

impl Effect {
    /// Whether the change shows after correction.
    pub fn is_found(&self) -> bool {
        is_shown(self.p_holm, self.interval)
    }

    /// The change and the ends of its interval, in percent of the mean in the reference. `None` if that
    /// mean is not above zero.
    pub fn in_percent(&self) -> Option<(f64, Option<[f64; 2]>)> {
        let [there, _] = self.means.filter(|[there, _]| *there > 0.0)?;
        let percent = |change: f64| 100.0 * change / there;
        Some((percent(self.change?), self.interval.map(|ends| ends.map(percent))))
    }
}

/// The effects of a sweep's axes on these metrics and policies; empty without axes.
///
/// # Errors
/// An unknown policy.
pub fn effects(folder: &Folder, metrics: &[usize], choice: Choice) -> Result<Vec<Effect>, Failure> {
    let experiment = folder.experiment();
    let policies = policies_of(experiment, choice)?;
    let mut asked = Vec::new();
    for contrast in contrasts(experiment) {
        for metric in metrics {
            asked.extend(policies.iter().map(|policy| (contrast, *metric, *policy)));
        }
    }
    let one =
        |(contrast, metric, policy): &(Contrast, usize, usize)| effect(folder, *contrast, *metric, *policy);
    let mut found: Vec<Effect> = asked.par_iter().map(one).collect();
    let ps: Vec<Option<f64>> = found.iter().map(|effect| effect.p).collect();
    for (effect, p) in found.iter_mut().zip(corrected(&ps)) {
        effect.p_holm = p;
    }
    Ok(found)
}

fn effect(folder: &Folder, contrast: Contrast, metric: usize, policy: usize) -> Effect {
    let experiment = folder.experiment();
    let Contrast { case, reference, .. } = contrast;
    let pairs = Trials::of(folder, case).pairs([case, reference].map(|case| ((case, policy), metric)));
    Effect {
        case: case + 1,
        reference: reference + 1,
        path: experiment.axes[contrast.axis].path.clone(),
        values: contrast.values(experiment),
        others: contrast.others(experiment),
        metric: experiment.metrics[metric].name.clone(),
        policy: experiment.policies[policy].label.clone(),
        n: pairs.a.len(),
        means: Moments::of(&pairs.b).mean.zip(Moments::of(&pairs.a).mean).map(|(there, here)| [there, here]),
        change: pairs.difference(),
        interval: pairs.interval(CONFIDENCE),
        p: (pairs.standing() == Standing::Judged).then(|| SignedRank::of(&pairs.tested()).p),
        p_holm: None,
    }
}

/// Whether a change with this corrected p and interval is shown.
pub(super) fn is_shown(p_holm: Option<f64>, interval: Option<[f64; 2]>) -> bool {
    p_holm.is_some_and(|p| p < LEVEL) && interval.is_some_and(|[low, high]| low > 0.0 || high < 0.0)
}

/// Each p after Holm's correction over all p that exist.
pub(super) fn corrected(ps: &[Option<f64>]) -> Vec<Option<f64>> {
    let mut holm = holm(&ps.iter().flatten().copied().collect::<Vec<f64>>()).into_iter();
    ps.iter().map(|p| p.and_then(|_| holm.next())).collect()
}

/// A case and its reference: the case that differs from it in one axis only, where it has the axis's first
/// value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contrast {
    pub case: usize,
    pub reference: usize,
    pub axis: usize,
}

impl Contrast {
    /// The axis's value in the reference, and in the case.
    pub fn values(self, experiment: &Experiment) -> [String; 2] {
        [self.reference, self.case].map(|case| experiment.cases[case].values[self.axis].clone())
    }

    /// The other axes and their values.
    pub fn others(self, experiment: &Experiment) -> Vec<(String, String)> {
        let all = experiment.axes.iter().zip(&experiment.cases[self.case].values).enumerate();
        all.filter(|(i, _)| *i != self.axis)
            .map(|(_, (axis, value))| (axis.path.clone(), value.clone()))
            .collect()
    }
}

/// All contrasts of a sweep.
pub(super) fn contrasts(experiment: &Experiment) -> Vec<Contrast> {
    let cases = &experiment.cases;
    let mut contrasts = Vec::new();
    for (axis, of) in experiment.axes.iter().enumerate() {
        for (case, one) in cases.iter().enumerate() {
            let is_reference = |other: &Case| {
                let mut values = one.values.iter().zip(&other.values).enumerate();
                values
                    .all(|(i, (here, there))| if i == axis { *there == of.values[0] } else { here == there })
            };
            if one.values[axis] != of.values[0] {
                let reference = cases.iter().position(is_reference);
                contrasts.extend(reference.map(|reference| Contrast { case, reference, axis }));
            }
        }
    }
    contrasts
}
