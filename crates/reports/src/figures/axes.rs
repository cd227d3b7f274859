//! Figures along the axes of a sweep: the differences over two axes as maps, and means along each axis.

use experiments::Failure;
use experiments::comparison::{Comparison, Trials};
use experiments::experiment::{Axis, Experiment};
use experiments::sweep::folder::Folder;

use super::band::Band;
use crate::drawing::{
    Drawing, Panel, Sketch, difference_heat_map, from_top, is_drawn, layout, line_panel, names,
};

/// The differences between policies over two axes: for each metric a figure with a map for each pair, all
/// of one colour scale. Empty for any other number of axes, or without comparisons.
pub(super) fn difference_maps(
    experiment: &Experiment,
    comparisons: &[Comparison],
) -> Result<Vec<Sketch>, Failure> {
    let [down, across] = &experiment.axes[..] else { return Ok(Vec::new()) };
    let one = |of_metric: Vec<Comparison>| difference_maps_of([down, across], &of_metric);
    by(comparisons, |one| one.metric.clone()).into_iter().map(one).collect()
}

/// The maps of one metric.
fn difference_maps_of([down, across]: [&Axis; 2], comparisons: &[Comparison]) -> Result<Sketch, Failure> {
    let place = |values: &[String], value: &str| values.iter().position(|one| one == value);
    let sizes = comparisons.iter().filter_map(|one| one.difference).map(f64::abs);
    let (most, metric) = (sizes.fold(0.0, f64::max), &comparisons[0].metric);
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for pair in by(comparisons, |one| (one.a.clone(), one.b.clone())) {
        let name = format!("{} - {}", pair[0].a, pair[0].b);
        let mut data = vec![vec![f64::NAN; across.values.len()]; down.values.len()];
        for one in &pair {
            let [(_, row), (_, column)] = &one.axes[..] else { continue };
            let cell = place(&down.values, row).zip(place(&across.values, column));
            let (Some((i, j)), Some(difference)) = (cell, one.difference) else { continue };
            data[i][j] = difference;
            let ends = [difference.to_string(), one.verdict.name().to_owned()];
            rows.push([name.clone(), row.clone(), column.clone()].into_iter().chain(ends).collect());
        }
        if data.iter().flatten().any(|value| value.is_nan()) {
            continue;
        }
        let plots = vec![difference_heat_map(data, most)];
        let layout = layout(&plots, &name)
            .with_x_label(&across.path)
            .with_y_label(&down.path)
            .with_x_categories(across.values.clone())
            .with_y_categories(from_top(down.values.iter().cloned()));
        panels.push(Panel { metric: metric.clone(), plots, layout });
    }
    Ok(Sketch {
        name: format!("differences-{}", metric.replace('.', "-")),
        title: format!("Differences in {metric}"),
        caption: format!(
            "Mean difference of each pair of policies in {metric} at each pair of values: blue where the \
             first is above, orange where it is below, in one scale. The table says which differences are \
             shown."
        ),
        drawing: Drawing::new(panels, 3, [400.0, 300.0]),
        csv: tables::csv(["pair", &down.path, &across.path, "difference", "verdict"], rows)?,
    })
}

/// The comparisons in groups of the same key, in the order in which the keys first occur.
fn by<K: PartialEq>(all: &[Comparison], key: impl Fn(&Comparison) -> K) -> Vec<Vec<Comparison>> {
    let mut groups: Vec<Vec<Comparison>> = Vec::new();
    for one in all {
        match groups.iter_mut().find(|group| key(&group[0]) == key(one)) {
            Some(group) => group.push(one.clone()),
            None => groups.push(vec![one.clone()]),
        }
    }
    groups
}

/// Means of the first figure's metrics along each numeric axis, with the other axes as in the case.
pub(super) fn axes(folder: &Folder, case: usize, only: Option<&[String]>) -> Result<Vec<Sketch>, Failure> {
    let experiment = folder.experiment();
    let names = names(experiment);
    let metrics = experiment.metrics.figures().into_iter().next().map_or(Vec::new(), |(_, metrics)| metrics);
    let mut all = Vec::new();
    for (i, axis) in experiment.axes.iter().enumerate() {
        let numbers: Vec<f64> = axis.values.iter().filter_map(|value| value.parse().ok()).collect();
        let is_numeric = numbers.len() == axis.values.len();
        let same_elsewhere = |other: &[String]| {
            let here = &experiment.cases[case].values;
            (0..here.len()).all(|k| k == i || here[k] == other[k])
        };
        let cases: Vec<usize> = (0..experiment.cases.len())
            .filter(|other| same_elsewhere(&experiment.cases[*other].values))
            .collect();
        let (mut panels, mut rows) = (Vec::new(), Vec::new());
        for metric in &metrics {
            let mut lines = Vec::new();
            let policies = experiment.policies.iter().enumerate();
            for (p, policy) in policies.filter(|(_, policy)| is_drawn(only, &policy.label)) {
                let mut points: Vec<(f64, f64, f64)> = Vec::new();
                for (at, other) in cases.iter().enumerate() {
                    let values = Trials::of(folder, *other).values(((*other, p), *metric));
                    let Some(band) = Band::of(&values) else { continue };
                    points.push(band.at(if is_numeric { numbers[at] } else { at as f64 }));
                    let name = &experiment.metrics[*metric].name;
                    rows.push(band.row([name, &policy.label, &axis.values[at]]));
                }
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                lines.push((p, names[p].as_str(), points));
            }
            panels.extend(line_panel(
                &lines,
                &experiment.metrics[*metric].name,
                &experiment.metrics[*metric].name_with_unit(),
                &axis.path,
                "",
            ));
        }
        let n = experiment.trials;
        let places: Vec<String> =
            axis.values.iter().enumerate().map(|(at, value)| format!("{at}: {value}")).collect();
        let legend = if is_numeric { String::new() } else { format!(" Values: {}.", places.join(", ")) };
        let others: Vec<String> = experiment
            .axes
            .iter()
            .zip(&experiment.cases[case].values)
            .enumerate()
            .filter(|(k, _)| *k != i)
            .map(|(_, (axis, value))| format!("{}={value}", axis.path))
            .collect();
        let fixed = if others.is_empty() { String::new() } else { format!(" Here {}.", others.join(", ")) };
        all.push(Sketch {
            name: format!("along-{}", axis.path.replace(['.', '[', ']'], "-")),
            title: format!("Along {}", axis.path),
            caption: format!("Means of up to {n} trials with their 95 % t intervals (band).{legend}{fixed}"),
            drawing: Drawing::new(panels, 3, [420.0, 320.0]),
            csv: tables::csv(["metric", "policy", "value", "n", "mean", "half_width"], rows)?,
        });
    }
    Ok(all)
}
