//! The figures of a study of lies, as files.

use experiments::Failure;
use experiments::deceit::{Borne, Deceit};

use crate::drawing::{
    Drawing, Panel, Sketch, difference_heat_map, forest_plot, from_top, interval_panel, layout,
};

/// Colours of a breakdown that is shown, and of one that is not.
const BROKEN: &str = "#D55E00";
const BEARS: &str = "#0072B2";

/// The figures of a study of lies as files: for each figure its drawing and the numbers behind it, each with
/// the name of its file.
///
/// # Errors
/// None: all is made in memory.
pub fn deceit_figures(found: &Deceit) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    Ok(Sketch::files(vec![above_draw(found)?, breakdown(found)?]))
}

/// The policies under each lie, in the order in which the lies first occur.
fn by_lie(found: &Deceit) -> Vec<(&str, Vec<&Borne>)> {
    let mut lies: Vec<(&str, Vec<&Borne>)> = Vec::new();
    for one in &found.borne {
        match lies.iter_mut().find(|(lie, _)| *lie == one.lie) {
            Some((_, all)) => all.push(one),
            None => lies.push((&one.lie, vec![one])),
        }
    }
    lies
}

fn above_draw(found: &Deceit) -> Result<Sketch, Failure> {
    let all = || found.borne.iter().flat_map(|one| one.differences.iter().flatten());
    let most = all().map(|difference| difference.abs()).fold(0.0, f64::max);
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for (lie, policies) in by_lie(found) {
        for one in &policies {
            let intervals = one.breakdown.intervals.iter();
            for ((liars, difference), interval) in found.counts.iter().zip(&one.differences).zip(intervals) {
                let ends = interval.map_or([None; 2], |ends| ends.map(Some));
                let numbers = [*difference, ends[0], ends[1]];
                let numbers = numbers.map(|number| number.map_or(String::new(), |number| number.to_string()));
                let names = [one.policy.clone(), lie.to_owned(), liars.to_string()];
                rows.push(names.into_iter().chain(numbers).collect());
            }
        }
        let cell = |difference: &Option<f64>| difference.unwrap_or(f64::NAN);
        let data: Vec<Vec<f64>> =
            policies.iter().map(|one| one.differences.iter().map(cell).collect()).collect();
        if data.iter().flatten().any(|value| value.is_nan()) {
            continue;
        }
        let plots = vec![difference_heat_map(data, most)];
        let layout = layout(&plots, lie)
            .with_x_label("liars")
            .with_x_categories(found.counts.iter().map(u32::to_string).collect())
            .with_y_categories(from_top(policies.iter().map(|one| one.policy.clone())));
        panels.push(Panel { metric: found.metric.clone(), plots, layout });
    }
    Ok(Sketch {
        name: "deceit-above-draw".to_owned(),
        title: format!("{} above a draw", found.metric),
        caption: format!("Mean difference from {} by number of liars, in one scale", found.draw),
        drawing: Drawing::new(panels, 2, size(found, 46.0 * found.counts.len() as f64 + 150.0)),
        csv: tables::csv(["policy", "lie", "liars", "difference", "low", "high"], rows)?,
    })
}

fn breakdown(found: &Deceit) -> Result<Sketch, Failure> {
    let last = found.counts.last().copied().unwrap_or_default();
    let at = |place: usize| found.counts.get(place).copied().unwrap_or_default();
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for (lie, policies) in by_lie(found) {
        let mut plot = forest_plot();
        let mut is_empty = true;
        for one in policies {
            let Some(safe) = one.breakdown.safe.map(at) else { continue };
            let broken = one.breakdown.broken.map(at);
            let [low, high] = [safe, broken.unwrap_or(last)].map(f64::from);
            let colour = if broken.is_some() { BROKEN } else { BEARS };
            plot = plot.with_colored_row(one.policy.clone(), low, low, high, colour);
            is_empty = false;
            let broken = broken.map_or(String::new(), |broken| broken.to_string());
            rows.push(vec![one.policy.clone(), lie.to_owned(), safe.to_string(), broken]);
        }
        if !is_empty {
            panels.push(interval_panel(plot, lie, "liars", [0.0, f64::from(last) + 0.5]));
        }
    }
    Ok(Sketch {
        name: "deceit-breakdown".to_owned(),
        title: "How many liars a policy bears".to_owned(),
        caption:
            "From the largest number of liars up to which a policy is shown to be better than a draw, to \
            the smallest one with which it is shown not to be (orange), or to the largest that was tried \
            (blue); policies without room among honest robots are left out"
                .to_owned(),
        drawing: Drawing::new(panels, 2, size(found, 330.0)),
        csv: tables::csv(["policy", "lie", "safe", "broken"], rows)?,
    })
}

/// Width and height of a panel with a row for each policy, beside its names.
fn size(found: &Deceit, width: f64) -> [f64; 2] {
    let rows = by_lie(found).iter().map(|(_, policies)| policies.len()).max().unwrap_or(0);
    let longest = found.borne.iter().map(|one| one.policy.chars().count()).max().unwrap_or(0);
    [width + 7.0 * longest as f64, 26.0 * rows as f64 + 110.0]
}
