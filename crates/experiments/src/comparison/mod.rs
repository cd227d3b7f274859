//! Paired comparisons of the policies of a sweep: which are made, and from what trials. What they say is
//! computed by the crate [`statistics`].

mod asked;
mod doubts;
mod effect;
mod interaction;
mod own;
mod trials;

use rayon::prelude::*;
pub use statistics::comparison::*;
use store::{Failure, refuse};

use crate::experiment::Experiment;
use crate::sweep::folder::Folder;

pub use asked::{Asked, Wishes};
pub use doubts::doubts;
pub use effect::{Effect, effects};
pub use interaction::{Interaction, interactions};
pub use own::own_question;
pub use trials::{Cell, Quantity, Trials};

/// The same warning for the changes along axes: of means, or of differences.
pub fn limit_of_changes(effects: &[Effect], interactions: &[Interaction]) -> Option<String> {
    let of_effects = || effects.iter().filter(|effect| effect.p.is_some()).map(|effect| effect.n);
    let of_interactions = || interactions.iter().filter(|one| one.p.is_some()).map(|one| one.n);
    limit(of_effects().max()?, of_effects().count(), "changes of means")
        .or_else(|| limit(of_interactions().max()?, of_interactions().count(), "changes of differences"))
}

/// Which policies are compared, by their labels.
#[derive(Debug, Clone, Copy, Default)]
pub struct Choice<'a> {
    /// The policy with which the others are compared; `None` for all pairs.
    pub baseline: Option<&'a str>,
    /// The only policies to compare; `None` for all.
    pub policies: Option<&'a [String]>,
    /// For metrics, by their places, the largest difference that does not matter.
    pub margins: &'a [(usize, f64)],
}

/// All comparisons of these metrics: of each pair of policies, or of each policy with the baseline.
///
/// # Errors
/// An unknown policy, or only one although the sweep has no axes.
pub fn compare(folder: &Folder, metrics: &[usize], choice: Choice) -> Result<Vec<Comparison>, Failure> {
    let experiment = folder.experiment();
    let pairs = policy_pairs(experiment, choice)?;
    let cases = 0..experiment.cases.len();
    let all: Vec<(usize, usize, [usize; 2])> = cases
        .flat_map(|case| metrics.iter().map(move |metric| (case, *metric)))
        .flat_map(|(case, metric)| pairs.iter().map(move |pair| (case, metric, *pair)))
        .collect();
    let pairs = |(case, metric, pair): &(usize, usize, [usize; 2])| {
        Trials::of(folder, *case).pairs(pair.map(|policy| ((*case, policy), *metric)))
    };
    let one = |of: &(usize, usize, [usize; 2])| {
        let (case, metric, pair) = *of;
        named(experiment, case, metric, pair).measured(&pairs(of))
    };
    let mut comparisons: Vec<Comparison> = all.par_iter().map(one).collect();
    correct(&mut comparisons);
    for (comparison, of) in comparisons.iter_mut().zip(&all) {
        let (_, metric, _) = of;
        let margin = choice.margins.iter().find(|(place, _)| place == metric).map(|(_, margin)| *margin);
        let with_margin = margin.map(|margin| (margin, pairs(of)));
        let margin = with_margin.as_ref().map(|(margin, pairs)| (*margin, pairs));
        comparison.judge(experiment.metrics[*metric].direction, margin);
    }
    Ok(comparisons)
}

/// The places of the chosen policies, with the baseline.
fn policies_of(experiment: &Experiment, choice: Choice) -> Result<Vec<usize>, Failure> {
    let baseline = choice.baseline.map(|name| place(experiment, "--baseline", name)).transpose()?;
    let mut chosen: Vec<usize> = (0..experiment.policies.len()).collect();
    if let Some(policies) = choice.policies {
        let places = policies.iter().map(|name| place(experiment, "--policies", name));
        let places = places.collect::<Result<Vec<_>, _>>()?;
        chosen.retain(|policy| places.contains(policy) || baseline == Some(*policy));
    }
    Ok(chosen)
}

fn place(experiment: &Experiment, option: &str, wanted: &str) -> Result<usize, Failure> {
    let mut labels = experiment.policies.iter().map(|policy| policy.label.as_str());
    labels.position(|label| label == wanted).ok_or_else(|| {
        let known: Vec<&str> = experiment.policies.iter().map(|policy| policy.label.as_str()).collect();
        let known = known.join(", ");
        Failure::input(format!("{option}: must be a policy of the sweep ({known}), found {wanted:?}"))
    })
}

pub(crate) fn policy_pairs(experiment: &Experiment, choice: Choice) -> Result<Vec<[usize; 2]>, Failure> {
    let chosen = policies_of(experiment, choice)?;
    let baseline = choice.baseline.map(|name| place(experiment, "--baseline", name)).transpose()?;
    if let [only] = chosen[..] {
        if experiment.cases.len() > 1 {
            return Ok(Vec::new());
        }
        let only = &experiment.policies[only].label;
        refuse!(
            "there is nothing to compare: {only} only; the sweep with `--policies {only},...` adds others to \
             it"
        );
    }
    let pairs = |(i, a): (usize, &usize)| chosen[i + 1..].iter().map(|b| [*a, *b]).collect::<Vec<_>>();
    let pairs: Vec<[usize; 2]> = match baseline {
        None => chosen.iter().enumerate().flat_map(pairs).collect(),
        Some(baseline) => chosen.iter().filter(|a| **a != baseline).map(|a| [*a, baseline]).collect(),
    };
    Ok(pairs.into_iter().map(|pair| signed(experiment, pair)).collect())
}

/// The pair with the sign that it has in every answer of a folder: the sweep file's baseline is what is
/// taken off; without one, it is the first policy of the sweep that something is taken off from.
fn signed(experiment: &Experiment, [a, b]: [usize; 2]) -> [usize; 2] {
    let declared = experiment.plan.baseline.as_deref();
    let is_baseline = |policy: usize| declared == Some(experiment.policies[policy].label.as_str());
    let is_turned = is_baseline(a) || (declared.is_none() && b == 0);
    if is_turned { [b, a] } else { [a, b] }
}

/// A comparison of which only the names are known: case, metric and policies, by their places.
fn named(experiment: &Experiment, case: usize, metric: usize, pair: [usize; 2]) -> Comparison {
    let [a, b] = pair.map(|policy| experiment.policies[policy].label.clone());
    let values = experiment.axes.iter().zip(&experiment.cases[case].values);
    Comparison {
        case: case + 1,
        axes: values.map(|(axis, value)| (axis.path.clone(), value.clone())).collect(),
        metric: experiment.metrics[metric].name.clone(),
        a,
        b,
        ..Comparison::default()
    }
}
