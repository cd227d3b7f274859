//! Figures of metrics: box plots as in the paper, energy against HP, and paired differences.

use experiments::Failure;
use experiments::comparison::{Comparison, Trials};
use experiments::experiment::Experiment;
use experiments::metric::{Metric, Values};
use experiments::sweep::folder::Folder;
use kuva::plot::annotations::ReferenceLine;
use kuva::plot::{BoxPlot, ScatterPlot, StripPlot};
use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use statistics::bootstrap::quantile;

use super::is_quiet;
use crate::drawing::{
    Drawing, Panel, Sketch, colour, forest_plot, interval_panel, is_drawn, layout, names, range, within,
};

/// About the largest number of a policy's trials that are drawn as points, beside those beyond the whiskers;
/// more would hide the boxes.
const MAX_POINTS: usize = 40;

/// The axis of the differences is widened to show a margin at most so many times as far as the intervals go.
const FARTHEST_MARGIN: f64 = 3.0;

const PANEL: [f64; 2] = [360.0, 320.0];

/// Box plots with points, a figure for each group of metrics.
pub(super) fn boxes(folder: &Folder, case: usize, only: Option<&[String]>) -> Result<Vec<Sketch>, Failure> {
    let figures = folder.experiment().metrics.figures().into_iter();
    figures.map(|(name, metrics)| box_figure(folder, case, name, &metrics, only)).collect()
}

fn box_figure(
    folder: &Folder,
    case: usize,
    name: &str,
    places: &[usize],
    only: Option<&[String]>,
) -> Result<Sketch, Failure> {
    let Experiment { policies, metrics, .. } = folder.experiment();
    let names = names(folder.experiment());
    let step = (folder.experiment().trials as usize).div_ceil(MAX_POINTS).max(1);
    let (mut panels, mut counts) = (Vec::new(), Vec::new());
    let mut rows = Vec::new();
    for place in places.iter().filter(|place| !is_quiet(folder, case, **place)) {
        let metric = &metrics[*place];
        let mut plot = BoxPlot::new().with_width(0.6);
        let mut points = StripPlot::new().with_jitter(0.2).with_point_size(2.0).with_color("#333333");
        points = points.with_marker_opacity(if step > 1 { 0.45 } else { 0.8 });
        let (mut colours, mut all) = (Vec::new(), Vec::new());
        for (i, policy) in policies.iter().enumerate().filter(|(_, policy)| is_drawn(only, &policy.label)) {
            let found = trials(folder, case, i, |metrics| metrics.get(*place));
            for (seed, value) in &found {
                rows.push(vec![
                    metric.name.clone(),
                    policy.label.clone(),
                    seed.to_string(),
                    value.to_string(),
                ]);
            }
            let values: Vec<f64> = found.into_iter().map(|(_, value)| value).collect();
            counts.push(values.len());
            all.extend_from_slice(&values);
            if !values.is_empty() {
                points = points.with_group(names[i].clone(), thinned(&values, step));
                plot = plot.with_group(names[i].clone(), values);
                colours.push(lighter(colour(i)));
            }
        }
        if colours.is_empty() {
            continue;
        }
        let plots = vec![Plot::Box(plot.with_group_colors(colours)), Plot::Strip(points)];
        let [low, high] = range(all);
        let mut layout = layout(&plots, &metric.name)
            .with_y_label(&metric.unit_in_words)
            .with_y_axis_min(low)
            .with_y_axis_max(high);
        for line in bounds(folder, case, *place) {
            layout = layout.with_reference_line(line);
        }
        panels.push(Panel { metric: metric.name.clone(), plots, layout });
    }
    Ok(Sketch {
        name: name.replace(' ', "-").to_lowercase(),
        title: capitalised(name),
        caption: format!(
            "Median, quartiles, and whiskers to the last trial within 1.5 times the distance of the \
             quartiles; {}. {}",
            if step > 1 {
                format!("points: one trial in {step}, and each trial beyond the whiskers")
            } else {
                "each point is a trial".to_owned()
            },
            per_box(&counts)
        ),
        drawing: Drawing::new(panels, 3, PANEL),
        csv: tables::csv(["metric", "policy", "seed", "value"], rows)?,
    })
}

/// One value in so many, and all that lie beyond the whiskers of a box plot.
fn thinned(values: &[f64], step: usize) -> Vec<f64> {
    if step == 1 || values.is_empty() {
        return values.to_vec();
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let [low, high] = [0.25, 0.75].map(|share| quantile(&sorted, share));
    let reach = 1.5 * (high - low);
    let is_shown =
        |(place, value): &(usize, &f64)| place % step == 0 || **value < low - reach || **value > high + reach;
    values.iter().enumerate().filter(is_shown).map(|(_, value)| *value).collect()
}

/// The values of a policy's trials, where defined, each with its seed.
fn trials<T>(
    folder: &Folder,
    case: usize,
    policy: usize,
    value: impl Fn(&Values) -> Option<T>,
) -> Vec<(u64, T)> {
    let trials = folder.results().range((case, policy, 0)..=(case, policy, u32::MAX));
    let found = trials.filter_map(|((_, _, trial), measured)| {
        Some((folder.experiment().seed(*trial), value(measured.metrics.as_ref()?)?))
    });
    found.collect()
}

/// Lines at the means of the oracle and of a fair draw, if the sweep has these policies.
fn bounds(folder: &Folder, case: usize, metric: usize) -> Vec<ReferenceLine> {
    let policies = &folder.experiment().policies;
    let line = |name: &str, label: &str| {
        let policy = policies.iter().position(|policy| policy.name == name)?;
        let mean = Trials::of(folder, case).moments(((case, policy), metric)).mean?;
        Some(ReferenceLine::horizontal(mean).with_color("#555555").with_dasharray("4 3").with_label(label))
    };
    [line("ORACLE", "oracle"), line("RANDOM", "fair draw")].into_iter().flatten().collect()
}

/// The number of trials behind each policy's part of a panel, in words.
fn per_box(counts: &[usize]) -> String {
    let (least, most) =
        (counts.iter().min().copied().unwrap_or(0), counts.iter().max().copied().unwrap_or(0));
    if least == most {
        format!("n = {least} for each policy.")
    } else {
        format!("n = {least} to {most} for each policy: trials in which it is defined.")
    }
}

/// A colour halfway to white.
fn lighter(colour: &str) -> String {
    let part = |at: usize| u8::from_str_radix(&colour[at..at + 2], 16).unwrap_or(0).midpoint(255);
    format!("#{:02X}{:02X}{:02X}", part(1), part(3), part(5))
}

pub(super) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Energy against HP per rescuee: the cost of a rescue.
pub(super) fn costs(folder: &Folder, case: usize, only: Option<&[String]>) -> Result<Sketch, Failure> {
    let Experiment { policies, metrics, base, .. } = folder.experiment();
    let (names, words) = (names(folder.experiment()), &base.words);
    let (mut panels, mut counts) = (Vec::new(), Vec::new());
    let mut rows = Vec::new();
    let [energies, hps] = ["energy_per_rescuee", "hp_per_rescuee"].map(|name| metrics.declared(name));
    for (energy, hp) in energies.into_iter().zip(hps) {
        let part = metrics[energy].part();
        let (mut plots, mut all) = (Vec::new(), Vec::new());
        for (i, policy) in policies.iter().enumerate().filter(|(_, policy)| is_drawn(only, &policy.label)) {
            let found = trials(folder, case, i, |metrics| Some((metrics.get(energy)?, metrics.get(hp)?)));
            for (seed, (energy, hp)) in &found {
                let numbers = [seed.to_string(), energy.to_string(), hp.to_string()];
                rows.push([vec![part.to_owned(), policy.label.clone()], numbers.to_vec()].concat());
            }
            let points: Vec<(f64, f64)> = found.into_iter().map(|(_, point)| point).collect();
            counts.push(points.len());
            all.extend_from_slice(&points);
            if !points.is_empty() {
                let points = points.into_iter().take(MAX_POINTS);
                let plot = ScatterPlot::new().with_data(points).with_color(colour(i)).with_size(3.5);
                plots.push(Plot::Scatter(plot.with_legend(names[i].clone())));
            }
        }
        if plots.is_empty() {
            continue;
        }
        let [energies, hps] =
            [range(all.iter().map(|(energy, _)| *energy)), range(all.iter().map(|(_, hp)| *hp))];
        let layout = layout(&plots, part)
            .with_x_label(words.text("energy per rescuee"))
            .with_y_label(words.text("HP per rescuee"));
        let layout = within(layout, energies, hps);
        panels.push(Panel { metric: metrics[energy].name.clone(), plots, layout });
    }
    Ok(Sketch {
        name: "costs".into(),
        title: words.text("Energy and HP per rescuee"),
        caption: format!(
            "Percent points per {} delivered; each point is a trial, at most the first {MAX_POINTS} of \
             each policy are drawn. {}",
            words.rescuee,
            per_box(&counts)
        ),
        drawing: Drawing::new(panels, 3, [400.0, 320.0]),
        csv: tables::csv(["task", "policy", "seed", "energy_per_rescuee", "hp_per_rescuee"], rows)?,
    })
}

/// Paired differences with their intervals.
pub(super) fn forest(experiment: &Experiment, comparisons: &[&Comparison]) -> Result<Sketch, Failure> {
    let mut metrics: Vec<&str> = comparisons.iter().map(|comparison| comparison.metric.as_str()).collect();
    metrics.dedup();
    let mut panels = Vec::new();
    for metric in metrics {
        let of_metric: Vec<&Comparison> =
            comparisons.iter().filter(|comparison| comparison.metric == metric).copied().collect();
        panels.extend(forest_panel(experiment, metric, &of_metric)?);
    }
    let dotted = if comparisons.iter().any(|comparison| comparison.judged.is_some()) {
        " Dotted: the margin, the largest difference that does not matter; if no dotted line is drawn, it \
         lies beyond the axis."
    } else {
        ""
    };
    Ok(Sketch {
        name: "differences".into(),
        title: "Paired differences".into(),
        caption: format!(
            "First policy less second over the same seeds, with the 95 % bootstrap interval of the mean; the \
             number of pairs in brackets. The intervals are one by one; p after correction is in the table \
             below.{dotted}"
        ),
        drawing: Drawing::new(panels, 3, [420.0, 280.0]),
        csv: tables::csv(DIFFERENCES.split(','), comparisons.iter().copied().map(differences_row))?,
    })
}

/// The differences in one metric, with its margin; `None` if there is no interval to draw.
fn forest_panel(
    experiment: &Experiment,
    metric: &str,
    comparisons: &[&Comparison],
) -> Result<Option<Panel>, Failure> {
    let names = names(experiment);
    let name = |label: &String| {
        let place = experiment.policies.iter().position(|policy| policy.label == *label);
        place.map_or("", |place| names[place].as_str())
    };
    let Metric { name: title, unit, .. } = &experiment.metrics[experiment.metrics.named(metric)?];
    let mut plot = forest_plot();
    let mut ends = Vec::new();
    for comparison in comparisons {
        let (Some(difference), Some([low, high])) = (comparison.difference, comparison.interval) else {
            continue;
        };
        let label = format!("{} - {} ({})", name(&comparison.a), name(&comparison.b), comparison.n);
        plot = plot.with_colored_row(label, difference, low, high, "#0072B2");
        ends.extend([low, high]);
    }
    if ends.is_empty() {
        return Ok(None);
    }
    let mut lines = Vec::new();
    let widest = ends.iter().fold(0.0, |most: f64, end| most.max(end.abs()));
    let margin = comparisons.iter().find_map(|comparison| comparison.judged).map(|judged| judged.margin);
    if let Some(margin) = margin.filter(|margin| *margin <= FARTHEST_MARGIN * widest) {
        ends.extend([-margin, margin]);
        let dotted = |at| ReferenceLine::vertical(at).with_color("#555555").with_dasharray("2 3");
        lines.extend([-margin, margin].map(dotted));
    }
    let label = format!("first less second ({})", if unit.is_empty() { "count" } else { unit });
    let Panel { plots, layout, .. } = interval_panel(plot, title, &label, forest_range(&ends));
    let layout = lines.into_iter().fold(layout, Layout::with_reference_line);
    Ok(Some(Panel { metric: metric.to_owned(), plots, layout }))
}

/// Columns of `differences.csv`.
const DIFFERENCES: &str = "metric,a,b,n,difference,low,high,p,p_holm,shift,effect,pairing,detectable,margin,\
    pairs_for_margin";

fn differences_row(c: &Comparison) -> Vec<String> {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    let pairs = c.judged.and_then(|judged| judged.pairs_for_margin);
    vec![
        c.metric.clone(),
        c.a.clone(),
        c.b.clone(),
        c.n.to_string(),
        number(c.difference),
        number(c.interval.map(|interval| interval[0])),
        number(c.interval.map(|interval| interval[1])),
        number(c.p),
        number(c.p_holm),
        number(c.shift),
        number(c.effect),
        number(c.pairing),
        number(c.detectable),
        number(c.judged.map(|judged| judged.margin)),
        pairs.map_or(String::new(), |pairs| pairs.to_string()),
    ]
}

/// A range that shows all of these values and zero.
fn forest_range(ends: &[f64]) -> [f64; 2] {
    let most = ends.iter().fold(0.0, |most: f64, end| most.max(end.abs()));
    let reach = |sign: f64| ends.iter().fold(0.0, |reach: f64, end| reach.max(sign * end));
    let room = if most > 0.0 { 0.06 * most } else { 1.0 };
    [-reach(-1.0) - room, reach(1.0) + room]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_box_keeps_every_trial_beyond_its_whiskers() {
        let mut values: Vec<f64> = (0..200).map(|i| f64::from(i % 10)).collect();
        values[7] = 100.0;
        values[11] = -100.0;
        let shown = thinned(&values, 5);
        assert_eq!(shown.len(), 42);
        assert!(shown.contains(&100.0) && shown.contains(&-100.0));
        assert_eq!(thinned(&values, 1), values);
        assert!(thinned(&[], 5).is_empty());
    }
}
