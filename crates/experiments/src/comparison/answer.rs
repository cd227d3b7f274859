//! The answer to the first question of a sweep, in a sentence or two.

use super::words::{beyond_in_words, digits, p_in_words, pairs_in_words, short};
use super::{Comparison, Judged};
use crate::metric::{Direction, Metric};
use crate::stats::Moments;
use crate::sweep::folder::Folder;

/// The answer for a case and a metric: which policy has the highest mean (the lowest, for a cost), by how
/// much, and how certain the difference is. `None` without values.
#[must_use]
pub fn answer(folder: &Folder, case: usize, metric: usize, comparisons: &[&Comparison]) -> Option<String> {
    let experiment = folder.experiment();
    let declared = &experiment.metrics[metric];
    let mut means: Vec<(f64, &str)> = Vec::new();
    for (place, policy) in experiment.policies.iter().enumerate() {
        means.extend(
            Moments::of(&folder.values(case, place, metric)).mean.map(|mean| (mean, policy.label.as_str())),
        );
    }
    let sign = if declared.direction == Direction::Lower { -1.0 } else { 1.0 };
    means.sort_by(|a, b| (sign * b.0).total_cmp(&(sign * a.0)));
    let (first, last) = (means.first()?, means.last()?);
    let value = |mean: f64| format!("{} {}", digits(mean, 4), unit_of(declared));
    if means.len() == 1 {
        return Some(format!("{} has {} on average.", first.1, value(first.0).trim_end()));
    }
    let own: Vec<&Comparison> = comparisons.iter().filter(|c| c.metric == declared.name).copied().collect();
    let found: Vec<&Comparison> = own.iter().filter(|c| c.is_found()).copied().collect();
    let most = if sign > 0.0 { "highest" } else { "lowest" };
    let lead =
        format!("{} has the {most} mean of {}: {}", first.1, declared.title, value(first.0).trim_end());
    let ahead: Vec<&Comparison> =
        found.iter().filter(|c| c.a == first.1 || c.b == first.1).copied().collect();
    let size = |c: &Comparison| c.difference.map_or(0.0, f64::abs);
    if let Some(nearest) = ahead.iter().min_by(|a, b| size(a).total_cmp(&size(b))) {
        let others: Vec<&str> =
            ahead.iter().map(|c| if c.a == first.1 { c.b.as_str() } else { c.a.as_str() }).collect();
        let all = match &others[..] {
            [_] => String::new(),
            several => format!(" The difference to each of {} is shown; the smallest:", several.join(", ")),
        };
        return Some(format!("{lead}.{all} {}", shown(nearest, first.1)));
    }
    if own.is_empty() {
        return Some(format!("{lead}."));
    }
    let range = format!("{lead}; {} has {}", last.1, value(last.0).trim_end());
    if found.is_empty() {
        return Some(format!("{} {range}.", not_shown(declared, &own)));
    }
    Some(format!("{range}. {}", shown(found[0], &found[0].a)))
}

/// What comparisons say of which none shows a difference: what is equivalent, and how open the rest is.
fn not_shown(metric: &Metric, comparisons: &[&Comparison]) -> String {
    let (equal, open): (Vec<&Comparison>, Vec<&Comparison>) =
        comparisons.iter().copied().partition(|comparison| comparison.is_equivalent());
    let mut said: Vec<String> = equal.iter().map(|comparison| equivalent(metric, comparison)).collect();
    said.extend(match open[..] {
        [] => None,
        [only] => undecided(only),
        _ => Some(several(metric, &open)),
    });
    said.join(" ")
}

/// Two equivalent policies, and how near to each other they are.
fn equivalent(metric: &Metric, comparison: &Comparison) -> String {
    let Comparison { a, b, n, .. } = comparison;
    let Some((margin, difference, [low, high])) = comparison
        .judged
        .and_then(|judged| Some((judged.margin, comparison.difference?, judged.interval_90?)))
    else {
        return comparison.in_words.clone();
    };
    let [margin, difference, low, high] = [margin, difference, low, high].map(short);
    format!(
        "{a} and {b} are equivalent in {}, within the margin of {margin}: {a} less {b} is {difference} (90 % \
         interval {low} to {high}, {n} pairs).",
        metric.title
    )
}

/// Two policies that the trials cannot tell apart.
fn undecided(comparison: &Comparison) -> Option<String> {
    let Comparison { a, b, n, .. } = comparison;
    let [low, high] = comparison.interval?;
    let side = |value: f64| format!("{} {}", short(value.abs()), if value < 0.0 { "less" } else { "more" });
    let [low, high] = [low, high].map(side);
    Some(format!(
        "{n} pairs of trials cannot tell {a} from {b}: {a} may have {low} or {high} (95 % interval).{}",
        power_for_margin(&[comparison])
    ))
}

/// With a margin: that the question of it is open, and how many pairs have power for it.
fn power_for_margin(comparisons: &[&Comparison]) -> String {
    let pairs = |comparison: &&Comparison| comparison.judged.and_then(|judged| judged.pairs_for_margin);
    let most = comparisons.iter().max_by_key(|comparison| pairs(comparison));
    let told = most.and_then(|most| {
        let (needed, margin) = (pairs(most)?, short(most.judged?.margin));
        if needed <= most.n as u64 {
            return Some(format!(
                " Whether a difference is larger than the margin of {margin} is undecided."
            ));
        }
        let needed = pairs_in_words(needed);
        let widest = if comparisons.len() > 1 { " in the widest of these comparisons" } else { "" };
        Some(format!(
            " A rough guess from these trials: about {needed} pairs would detect a true difference of \
             {margin}, the margin, with 80 % power{widest}, before correction."
        ))
    });
    told.unwrap_or_default()
}

/// Several comparisons that show nothing.
fn several(metric: &Metric, comparisons: &[&Comparison]) -> String {
    let n = comparisons.iter().map(|c| c.n).max().unwrap_or(0);
    let half = |[low, high]: [f64; 2]| (high - low) / 2.0;
    let widest = comparisons.iter().filter_map(|c| c.interval).map(half).fold(0.0, f64::max);
    let precision =
        if widest > 0.0 { format!(", known to ± {} or better", short(widest)) } else { String::new() };
    format!(
        "No policy is shown to differ in {} from those that it was compared with. That does not mean that \
         they are equal: the differences stand on up to {n} pairs of trials{precision}.{}",
        metric.title,
        power_for_margin(comparisons)
    )
}

fn unit_of(metric: &Metric) -> &str {
    if metric.unit.is_empty() { metric.title.split(' ').next().unwrap_or_default() } else { metric.unit }
}

/// A difference that is shown, from the viewpoint of one of its two policies.
fn shown(comparison: &Comparison, policy: &str) -> String {
    let (Some(difference), Some([low, high]), Some(p)) =
        (comparison.difference, comparison.interval, comparison.p_holm)
    else {
        return comparison.in_words.clone();
    };
    let (other, difference, [low, high]) = if comparison.a == policy {
        (&comparison.b, difference, [low, high])
    } else {
        (&comparison.a, -difference, [-high, -low])
    };
    let direction = if difference > 0.0 { "more" } else { "less" };
    let margin = match comparison.judged {
        Some(Judged { margin, interval_90: Some([low, high]), .. }) if comparison.is_equivalent() => {
            let ([low, high], margin) = ([low, high].map(short), short(margin));
            format!(
                " The difference is also shown to be smaller than the margin of {margin} (90 % interval of {} \
                 less {}: {low} to {high}).",
                comparison.a, comparison.b
            )
        }
        judged => judged.map_or(String::new(), beyond_in_words),
    };
    format!(
        "{policy} has {} {direction} than {other} (95 % interval of the mean difference {} to {}, {} pairs, \
         corrected {}).{margin}",
        short(difference.abs()),
        short(low),
        short(high),
        comparison.n,
        p_in_words(p)
    )
}
