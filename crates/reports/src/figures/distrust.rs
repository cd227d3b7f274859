//! The heat map of how little the robots of a team trust each other.

use kuva::render::plots::Plot;

use crate::drawing::{Drawing, Panel, from_top, heat_map, layout};

/// The most robots whose cells are large enough for numbers.
const MOST_WITH_NUMBERS: usize = 30;

/// A heat map as SVG: the distrust of the robot of each row towards the robot of each column, in thousandths
/// of its unit. Up to 30 robots have their numbers in the cells, unless one of these is infinite.
///
/// ```
/// let names = ["spot-1", "spot-2"].map(str::to_owned);
/// let svg = reports::distrust_map("RNE", &names, &[vec![0.0, 0.25], vec![0.5, 0.0]]);
/// assert!(svg.contains("spot-2") && svg.contains(">250.00<"));
/// ```
pub fn distrust_map(title: &str, names: &[String], distrust: &[Vec<f64>]) -> String {
    let cell = if names.len() > MOST_WITH_NUMBERS { 14.0 } else { 46.0 };
    let side = (cell * names.len() as f64).max(280.0);
    let longest = names.iter().map(|name| name.chars().count()).max().unwrap_or(0) as f64;
    let panel = distrust_panel(title, names, distrust, largest(distrust));
    Drawing::new(vec![panel], 1, [side + 180.0 + 7.0 * longest, side + 130.0 + 5.0 * longest]).svg()
}

/// The largest finite distrust.
pub(super) fn largest(distrust: &[Vec<f64>]) -> f64 {
    distrust.iter().flatten().copied().filter(|value| value.is_finite()).fold(0.0, f64::max)
}

/// The heat map as a panel, in the scale of panels whose largest finite value is `largest`. An infinite value
/// is drawn above every finite value: it means no trust at all. No cell has its number then, for that of the
/// infinite cells would be none.
pub(super) fn distrust_panel(title: &str, names: &[String], distrust: &[Vec<f64>], largest: f64) -> Panel {
    let most = 1000.0 * largest;
    let beyond = if most > 0.0 { 1.25 * most } else { 1.0 };
    let is_infinite = distrust.iter().flatten().any(|value| !value.is_finite());
    let shown = |value: &f64| if value.is_finite() { 1000.0 * value } else { beyond };
    let cells = distrust.iter().map(|row| row.iter().map(shown).collect()).collect();
    let mut map = heat_map(cells, if is_infinite { beyond } else { most });
    if let Plot::Heatmap(map) = &mut map {
        map.show_values = !is_infinite && names.len() <= MOST_WITH_NUMBERS;
    }
    let plots = vec![map];
    let layout = layout(&plots, title)
        .with_x_categories(names.to_vec())
        .with_y_categories(from_top(names.iter().cloned()))
        .with_x_label("to robot")
        .with_y_label("from robot");
    let is_long = names.iter().any(|name| name.chars().count() > 3);
    let layout = if is_long { layout.with_x_tick_rotate(-45.0) } else { layout };
    Panel { metric: String::new(), plots, layout }
}
