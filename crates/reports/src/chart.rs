//! A chart of points and lines from any numbers, in the look of the other figures.

use kuva::plot::scatter::MarkerShape;
use kuva::plot::{LinePlot, ScatterPlot};
use kuva::render::plots::Plot;

use crate::drawing::{Drawing, Panel, colour, layout, within};

/// Signs of the series with points, in their order, so that they are told apart without colour.
const SIGNS: [MarkerShape; 6] = [
    MarkerShape::Circle,
    MarkerShape::Square,
    MarkerShape::Triangle,
    MarkerShape::Diamond,
    MarkerShape::Cross,
    MarkerShape::Plus,
];

/// A series of a chart.
#[derive(Debug, Clone)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Its points: x and y.
    pub points: Vec<[f64; 2]>,
    /// Whether they are joined by a line, without signs.
    pub is_line: bool,
}

/// The words at a chart.
#[derive(Debug, Clone, Copy)]
pub struct Labels<'a> {
    /// Above it.
    pub title: &'a str,
    /// At the axis to the right.
    pub x: &'a str,
    /// At the axis upwards.
    pub y: &'a str,
}

/// The chart of these series as SVG, with both axes from 0. Empty without a series.
pub fn chart(labels: Labels, series: &[Series]) -> String {
    let plots: Vec<Plot> = series.iter().enumerate().map(|(i, series)| plot(i, series)).collect();
    if plots.is_empty() {
        return String::new();
    }
    let largest = |of: usize| {
        let values = series.iter().flat_map(|series| series.points.iter().map(move |point| point[of]));
        1.05 * values.fold(0.0, f64::max)
    };
    let layout = layout(&plots, labels.title).with_x_label(labels.x).with_y_label(labels.y);
    let layout = within(layout, [0.0, largest(0)], [0.0, largest(1)]);
    Drawing::new(vec![Panel { metric: String::new(), plots, layout }], 1, [720.0, 420.0]).svg()
}

fn plot(place: usize, series: &Series) -> Plot {
    let points = series.points.iter().map(|[x, y]| (*x, *y));
    if series.is_line {
        let line = LinePlot::new().with_data(points).with_color(colour(place)).with_stroke_width(2.0);
        return Plot::Line(line.with_legend(series.name.clone()));
    }
    let signs = ScatterPlot::new().with_data(points).with_color(colour(place)).with_size(5.0);
    Plot::Scatter(signs.with_marker(SIGNS[place % SIGNS.len()]).with_legend(series.name.clone()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chart_has_its_series_and_begins_at_zero() {
        let series = |name: &str, is_line| Series {
            name: name.to_owned(),
            points: vec![[1.0, 2.0], [3.0, 4.0]],
            is_line,
        };
        let labels = Labels { title: "t", x: "width", y: "flow" };
        let svg = chart(labels, &[series("measured", false), series("fitted", true)]);
        assert!(
            ["measured", "fitted", "width", "flow", ">0<"].iter().all(|word| svg.contains(word)),
            "{svg}"
        );
        assert_eq!(chart(labels, &[]), "");
    }
}
