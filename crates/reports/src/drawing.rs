//! The parts of figures: panels as one SVG, and the table of their numbers.

use std::sync::Arc;

use experiments::Failure;
use experiments::experiment::{Experiment, PolicySpec};
use experiments::sweep::names::PLOTS;
use experiments::sweep::owned::Report;
use kuva::backend::svg::SvgBackend;
use kuva::plot::{ColorMap, ForestPlot, Heatmap, LinePlot, LineStyle};
use kuva::render::figure::Figure as Panels;
use kuva::render::layout::{Layout, TickFormat};
use kuva::render::plots::Plot;
use kuva::render::theme::Theme;

/// Okabe and Ito's colours, which colour-blind readers can tell apart, in the order of the policies.
const COLOURS: [&str; 8] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#999999", "#000000"];

/// A figure before it is drawn.
pub(crate) struct Sketch {
    /// Name of its files.
    pub name: String,
    /// Heading.
    pub title: String,
    /// Content of the figure, and the number of trials behind it.
    pub caption: String,
    /// Its panels.
    pub drawing: Drawing,
    /// The numbers, as a table.
    pub csv: String,
}

/// The panels of a figure, and how the report lays them out.
pub(crate) struct Drawing {
    panels: Vec<Panel>,
    columns: usize,
    cell: [f64; 2],
}

/// Size of the numbers at axes, in the unit of a drawing.
pub(crate) const TICK: f64 = 11.0;

/// A panel for a column is at least this share of its width in the report, and so many units high.
const NARROWEST: f64 = 0.44;
const LOWEST: f64 = 165.0;

/// Space around the panels, and between two of them, in the same unit, as in kuva's figures.
const MARGIN: f64 = 10.0;
const GAP: f64 = 15.0;

impl Drawing {
    /// Panels in rows with this many columns, each panel of this width and height.
    pub fn new(panels: Vec<Panel>, columns: usize, cell: [f64; 2]) -> Self {
        Self { panels, columns, cell }
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.panels.is_empty()
    }

    /// Keeps only the panels of this metric. Panels without a metric are removed, too.
    pub fn keep(&mut self, metric: &str) {
        self.panels.retain(|panel| panel.metric == metric);
    }

    /// The drawing in the report's layout; empty without any panel.
    pub fn svg(self) -> String {
        let (columns, cell) = (self.columns, self.cell);
        self.laid_out(columns, cell)
    }

    /// The drawing for a column of this width, in units in which `TICK` is readable; as high as is asked for,
    /// or with panels of the report's proportions. Each row has as many panels side by side as can be read.
    pub fn svg_for(mut self, width: f64, height: Option<f64>) -> String {
        let [cell_width, cell_height] = self.cell;
        let panels = self.panels.len().max(1);
        let columns = ((width / (NARROWEST * cell_width)) as usize).clamp(1, panels);
        let rows = panels.div_ceil(columns);
        let size = |all: f64, parts: usize| (all - GAP * (parts - 1) as f64 - 2.0 * MARGIN) / parts as f64;
        let panel_width = size(width, columns);
        let proportional = (panel_width * cell_height / cell_width).max(LOWEST);
        let panel_height = height.map_or(proportional, |height| size(height, rows));
        let in_column = |panel: Panel| {
            let layout = panel.layout.with_title_size(TICK as u32 + 1).with_label_size(TICK as u32);
            let has_names = matches!(panel.plots[..], [Plot::Box(_), ..]);
            let layout = if has_names { layout.with_x_tick_rotate(-30.0) } else { layout.with_ticks(4) };
            Panel { layout, ..panel }
        };
        self.panels = self.panels.into_iter().map(in_column).collect();
        self.laid_out(columns, [panel_width, panel_height])
    }

    fn laid_out(self, columns: usize, cell: [f64; 2]) -> String {
        if self.panels.is_empty() { String::new() } else { draw(self.panels, columns, cell) }
    }
}

impl Sketch {
    /// The drawings and numbers of those that have something to draw, each with the name of its file.
    pub fn files(all: Vec<Self>) -> Vec<(String, Vec<u8>)> {
        let files = |Figure { name, svg, csv, .. }: Figure| {
            [(format!("{name}.svg"), svg.into_bytes()), (format!("{name}.csv"), csv.into_bytes())]
        };
        let drawn = all.into_iter().filter(|sketch| !sketch.drawing.is_empty()).map(Self::drawn);
        drawn.flat_map(files).collect()
    }

    /// The figure in the report's layout.
    pub fn drawn(self) -> Figure {
        let Self { name, title, caption, drawing, csv } = self;
        Figure { name, title, caption, svg: drawing.svg(), csv }
    }
}

/// A figure of the report.
pub(crate) struct Figure {
    /// Name of its files.
    pub name: String,
    /// Heading.
    pub title: String,
    /// Content of the figure, and the number of trials behind it.
    pub caption: String,
    /// The drawing.
    pub svg: String,
    /// The numbers, as a table.
    pub csv: String,
}

impl Figure {
    /// Adds its files to a report, with a prefix before their names.
    pub fn add_to(&self, files: &mut Report, prefix: &str) -> Result<(), Failure> {
        let Self { name, svg, csv, .. } = self;
        files.add(format!("{PLOTS}/{prefix}{name}.svg"), svg)?;
        files.add(format!("{PLOTS}/{prefix}{name}.csv"), csv)
    }
}

/// A layout whose axes have these ends.
pub(crate) fn within(layout: Layout, x: [f64; 2], y: [f64; 2]) -> Layout {
    let layout = layout.with_x_axis_min(x[0]).with_x_axis_max(x[1]);
    layout.with_y_axis_min(y[0]).with_y_axis_max(y[1])
}

/// One panel: its plots and its axes.
pub(crate) struct Panel {
    /// The metric of the panel; empty for none.
    pub metric: String,
    pub plots: Vec<Plot>,
    pub layout: Layout,
}

/// The colour of a policy.
pub(crate) fn colour(policy: usize) -> &'static str {
    COLOURS[policy % COLOURS.len()]
}

/// The dashes of a policy's line, so that lines are told apart without colour.
fn dashes(policy: usize) -> LineStyle {
    const DASHES: [&str; 7] = ["8 4", "2 3", "10 3 2 3", "14 4", "5 3 2 3 2 3", "4 4", "1 5"];
    match policy % (DASHES.len() + 1) {
        0 => LineStyle::Solid,
        other => LineStyle::Custom(DASHES[other - 1].to_owned()),
    }
}

/// Whether a policy is drawn: any policy, unless `only` lists the policies to draw.
pub(crate) fn is_drawn(only: Option<&[String]>, label: &str) -> bool {
    only.is_none_or(|only| only.iter().any(|one| one == label))
}

/// A layout in the report's style.
pub(crate) fn layout(plots: &[Plot], title: &str) -> Layout {
    Layout::auto_from_plots(plots)
        .with_title(title)
        .with_title_size(15)
        .with_label_size(13)
        .with_tick_size(TICK as u32)
        .with_tick_format(TickFormat::Custom(Arc::new(tick)))
        .with_theme(Theme { box_median: "#1A1A1A".into(), ..Theme::light() })
        .with_font_family("DejaVu Sans, Helvetica, Arial, sans-serif")
}

/// A number at an axis: up to six decimals without trailing zeros, or scientific notation below 0.001.
fn tick(value: f64) -> String {
    if value != 0.0 && value.abs() < 0.001 {
        return format!("{value:.1e}");
    }
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text.is_empty() || text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// The range of an axis that shows all of these values and a margin; it begins at 0 if the values come near
/// to it.
pub(crate) fn range(values: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let (least, most) =
        values.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if least > most {
        return [0.0, 1.0];
    }
    let room = if most > least { 0.06 * (most - least) } else { 0.5 * most.abs().max(1.0) };
    let low = if least >= 0.0 && least < 0.4 * most.max(room) { 0.0 } else { least - room };
    [low, most + room]
}

/// A line: the policy, its label, and points. A point is a place, a mean, and half the width of the band
/// around it.
pub(crate) type Line<'a> = (usize, &'a str, Vec<(f64, f64, f64)>);

/// Lines through means, each with a band around it; `None` without any point. `x` and `y` are the
/// labels of the axes.
pub(crate) fn line_panel(lines: &[Line], metric: &str, title: &str, x: &str, y: &str) -> Option<Panel> {
    let all = || lines.iter().flat_map(|(_, _, points)| points);
    all().next()?;
    let plot = |(policy, label, points): &Line| {
        let low = points.iter().map(|(_, mean, half)| mean - half);
        let high = points.iter().map(|(_, mean, half)| mean + half);
        let line = LinePlot::new().with_data(points.iter().map(|(x, mean, _)| (*x, *mean)));
        Plot::Line(
            line.with_color(colour(*policy))
                .with_stroke_width(2.0)
                .with_line_style(dashes(*policy))
                .with_band(low, high)
                .with_legend(*label),
        )
    };
    let plots: Vec<Plot> = lines.iter().filter(|(_, _, points)| !points.is_empty()).map(plot).collect();
    let heights =
        range(all().flat_map(|(_, mean, half)| [(mean - half).max(0.0_f64.min(*mean)), mean + half]));
    let layout = layout(&plots, title).with_x_label(x).with_y_label(y);
    let layout = within(layout, range(all().map(|(x, _, _)| *x)), heights);
    Some(Panel { metric: metric.to_owned(), plots, layout })
}

/// A heat map with its values written in it: white at 0 and blue at `most`, light enough for black text.
/// Equal values have equal colours, whatever the range of the other values. The first row is on top; its
/// categories are [`from_top`].
pub(crate) fn heat_map(data: Vec<Vec<f64>>, most: f64) -> Plot {
    coloured(data, most, |share| towards(SKY_BLUE, share.max(0.0)))
}

/// The same for values of both signs: white at 0, blue at `most`, and orange at its negative.
pub(crate) fn difference_heat_map(data: Vec<Vec<f64>>, most: f64) -> Plot {
    coloured(data, most, |share| towards(if share < 0.0 { ORANGE } else { SKY_BLUE }, share.abs()))
}

/// Okabe and Ito's sky blue and orange, light enough for black text.
const SKY_BLUE: [f64; 3] = [86.0, 180.0, 233.0];
const ORANGE: [f64; 3] = [230.0, 159.0, 0.0];

/// White mixed with this share of a colour.
fn towards(colour: [f64; 3], share: f64) -> String {
    let [r, g, b] = colour.map(|end| (255.0 + (end - 255.0) * share.min(1.0)).round() as u8);
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// A heat map whose colours depend on the values' shares of `most`.
fn coloured(mut data: Vec<Vec<f64>>, most: f64, colour: fn(f64) -> String) -> Plot {
    data.reverse(); // kuva begins at the bottom
    let all = || data.iter().flatten().copied();
    let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    // kuva gives the place between the least and the largest value.
    let colours = ColorMap::Custom(Arc::new(move |place: f64| {
        colour((low + place.clamp(0.0, 1.0) * (high - low)) / most.max(f64::MIN_POSITIVE))
    }));
    Plot::Heatmap(Heatmap::new().with_data(data).with_color_map(colours).with_values())
}

/// A plot of values with their intervals, a row for each, around zero.
pub(crate) fn forest_plot() -> ForestPlot {
    ForestPlot::new().with_null_value(0.0).with_cap_size(4.0)
}

/// The panel of such a plot, over this range.
pub(crate) fn interval_panel(plot: ForestPlot, title: &str, label: &str, [low, high]: [f64; 2]) -> Panel {
    let plots = vec![Plot::Forest(plot)];
    let layout = layout(&plots, title).with_x_label(label).with_ticks(4);
    Panel { metric: String::new(), plots, layout: layout.with_x_axis_min(low).with_x_axis_max(high) }
}

/// The names of a heat map's rows in kuva's order, if the first name is that of the top row.
pub(crate) fn from_top(names: impl IntoIterator<Item = String>) -> Vec<String> {
    let mut names: Vec<String> = names.into_iter().collect();
    names.reverse();
    names
}

/// The names of policies in figures: their labels, or, for a label that is too long for an axis, the
/// policy's name with its place in the list.
pub(crate) fn names(experiment: &Experiment) -> Vec<String> {
    let name = |(i, policy): (usize, &PolicySpec)| {
        let is_short = policy.label.chars().count() <= LONGEST_NAME;
        if is_short { policy.label.clone() } else { format!("{} #{}", policy.name, i + 1) }
    };
    experiment.policies.iter().enumerate().map(name).collect()
}

/// Largest number of characters of a policy's label in a figure.
const LONGEST_NAME: usize = 12;

/// Panels in rows with this many columns, as one drawing.
fn draw(panels: Vec<Panel>, columns: usize, [width, height]: [f64; 2]) -> String {
    let rows = panels.len().div_ceil(columns);
    let has_legend = panels.len() > 1
        && panels.iter().all(|panel| matches!(panel.plots[..], [Plot::Line(_) | Plot::Scatter(_), ..]));
    let (plots, layouts): (Vec<_>, Vec<_>) =
        panels.into_iter().map(|panel| (panel.plots, panel.layout)).unzip();
    let figure =
        Panels::new(rows, columns).with_plots(plots).with_layouts(layouts).with_cell_size(width, height);
    let figure = if has_legend { figure.with_shared_legend_bottom() } else { figure };
    let svg = SvgBackend.render_scene(&figure.render());
    with_view_box(&svg)
}

/// The drawing with its size also as a view box, so that it can be shown at any size.
fn with_view_box(svg: &str) -> String {
    let size = |name: &str| svg.split_once(&format!(" {name}=\""))?.1.split_once('"').map(|(size, _)| size);
    match (size("width"), size("height")) {
        (Some(width), Some(height)) if !svg.contains("viewBox") => {
            svg.replacen("<svg ", &format!("<svg viewBox=\"0 0 {width} {height}\" "), 1)
        }
        _ => svg.to_owned(),
    }
}
