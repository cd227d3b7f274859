//! Figures of a study of regret.

use std::collections::BTreeMap;

use experiments::Failure;
use experiments::regret::{Analysis, DecisionRow, Estimate};
use statistics::Moments;
use statistics::paired::t_half_width;

use crate::drawing::{Drawing, Sketch, forest_plot, interval_panel, line_panel, range};

/// Regret round by round, and the share of the achievable that each policy achieves.
///
/// # Errors
/// None: tables are written to memory.
pub fn regret_figures(analyses: &[Analysis]) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    Ok(Sketch::files(vec![by_round(analyses)?, achieved(analyses)?]))
}

fn by_round(analyses: &[Analysis]) -> Result<Sketch, Failure> {
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for analysis in analyses {
        let labels: Vec<&str> = analysis.policies.iter().map(|policy| policy.policy.as_str()).collect();
        let mut lines = Vec::new();
        for (place, label) in labels.iter().enumerate() {
            let own = analysis.rows.iter().filter(|row| row.policy == *label);
            lines.push((place, *label, points(own.map(|row| (row.round, row.regret)))));
        }
        let first = || analysis.rows.iter().filter(|row| Some(&row.policy.as_str()) == labels.first());
        let behind = |value: fn(&DecisionRow) -> f64| {
            first().map(move |row| (row.round, (row.best - value(row)).abs()))
        };
        lines.push((labels.len(), "fair draw", points(behind(|row| row.mean))));
        lines.push((labels.len() + 1, "worst", points(behind(|row| row.worst))));
        for (_, label, points) in &lines {
            let row = |(round, mean, half): &(f64, f64, f64)| {
                vec![
                    analysis.metric.clone(),
                    (*label).to_owned(),
                    round.to_string(),
                    mean.to_string(),
                    half.to_string(),
                ]
            };
            rows.extend(points.iter().map(row));
        }
        panels.extend(line_panel(&lines, &analysis.metric, &analysis.metric, "round", "regret"));
    }
    Ok(Sketch {
        name: "regret-by-round".to_owned(),
        title: "Regret, round by round".to_owned(),
        caption: "Mean distance to the best assignment, with 95 % t intervals; 0 is the best, the lines \
            `fair draw` and `worst` are those of the mean and of the worst assignment"
            .to_owned(),
        drawing: Drawing::new(panels, 2, [460.0, 340.0]),
        csv: tables::csv(["metric", "policy", "round", "mean", "half_width"], rows)?,
    })
}

/// For each round with at least two decisions: the round, the mean, and half the width of its interval.
fn points(values: impl Iterator<Item = (u32, f64)>) -> Vec<(f64, f64, f64)> {
    let mut by_round: BTreeMap<u32, Vec<f64>> = BTreeMap::new();
    values.for_each(|(round, value)| by_round.entry(round).or_default().push(value));
    let point = |(round, values): (u32, Vec<f64>)| {
        let half = t_half_width(&values)?;
        Some((f64::from(round), Moments::of(&values).mean?, half))
    };
    by_round.into_iter().filter_map(point).collect()
}

fn achieved(analyses: &[Analysis]) -> Result<Sketch, Failure> {
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for analysis in analyses {
        let mut plot = forest_plot();
        let mut ends = vec![0.0, 100.0];
        for policy in &analysis.policies {
            let Some(Estimate { value, interval: Some([low, high]) }) = policy.achieved else { continue };
            let [value, low, high] = [value, low, high].map(|share| 100.0 * share);
            plot = plot.with_colored_row(policy.policy.clone(), value, low, high, "#0072B2");
            ends.extend([low, high]);
            let [gained, achievable] = policy.gains;
            let numbers = [value, low, high, gained, achievable].map(|number| number.to_string());
            rows.push([vec![analysis.metric.clone(), policy.policy.clone()], numbers.to_vec()].concat());
        }
        if ends.len() > 2 {
            panels.push(interval_panel(plot, &analysis.metric, "achieved (%)", range(ends)));
        }
    }
    Ok(Sketch {
        name: "achieved".to_owned(),
        title: "How much of the achievable is achieved".to_owned(),
        caption: "0 is a fair draw, 100 % the best assignment of each decision; 95 % bootstrap intervals \
            over trials"
            .to_owned(),
        drawing: Drawing::new(panels, 2, [460.0, 280.0]),
        csv: tables::csv(
            ["metric", "policy", "achieved_percent", "low", "high", "gained", "achievable"],
            rows,
        )?,
    })
}
