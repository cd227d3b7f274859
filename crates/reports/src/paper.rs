//! One figure of a sweep for the column of a paper.

use experiments::comparison::{Comparison, compare};
use experiments::sweep::folder::Folder;
use experiments::{Failure, refuse};

use crate::drawing::{Sketch, TICK};
use crate::figures::{Part, sketches, sketches_along_axes};
use crate::wanted::Wanted;

/// Points in a millimetre.
const POINTS_PER_MM: f64 = 72.0 / 25.4;

/// The smallest text of a figure, in points.
pub const LEAST_TEXT_POINTS: f64 = 7.0;

/// The look of a figure for a paper.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnLook {
    /// Width of the column, in millimetres.
    pub width_mm: f64,
    /// Height of the figure, in millimetres; `None` for that of its panels.
    pub height_mm: Option<f64>,
    /// Whether colours are replaced by greys.
    pub is_grey: bool,
    /// The metric whose panels are kept; `None` for all.
    pub metric: Option<String>,
}

/// A figure by its name, as SVG with its width in millimetres and no text below 7 points. The names are
/// those of the report's files.
///
/// # Errors
/// There is no such figure, or nothing to draw in it.
pub fn column_figure(
    folder: &mut Folder,
    name: &str,
    wanted: &Wanted,
    look: &ColumnLook,
) -> Result<String, Failure> {
    let sketches = all(folder, wanted)?;
    let names: Vec<String> = sketches.iter().map(|sketch| sketch.name.clone()).collect();
    let mut sketch = sketches.into_iter().find(|sketch| sketch.name == name).ok_or_else(|| {
        Failure::input(format!(
            "--figure: must be a figure of this sweep ({}), found {name:?}",
            names.join(", ")
        ))
    })?;
    if let Some(metric) = &look.metric {
        sketch.drawing.keep(metric);
        if sketch.drawing.is_empty() {
            refuse!("--metric: the figure {name} has no panel of {metric}");
        }
    }
    let units = |mm: f64| mm * POINTS_PER_MM * TICK / LEAST_TEXT_POINTS;
    let svg = sketch.drawing.svg_for(units(look.width_mm), look.height_mm.map(units));
    let svg = in_millimetres(&svg, look.width_mm);
    Ok(if look.is_grey { grey(&svg) } else { svg })
}

fn all(folder: &mut Folder, wanted: &Wanted) -> Result<Vec<Sketch>, Failure> {
    let case = wanted.case.unwrap_or(0);
    let is_compared = folder.experiment().policies.len() > 1;
    let asked = &wanted.asked;
    let comparisons = if is_compared { compare(folder, &asked.metrics, asked.choice())? } else { Vec::new() };
    let here: Vec<&Comparison> = comparisons.iter().filter(|c| c.case == case + 1).collect();
    let part = Part { case, only: asked.policies.as_deref(), seed: None };
    let along =
        if folder.experiment().axes.is_empty() { Vec::new() } else { sketches_along_axes(folder, part)? };
    let figures = sketches(folder, part, &here)?;
    Ok(figures.into_iter().chain(along).filter(|sketch| !sketch.drawing.is_empty()).collect())
}

/// The drawing with its size in millimetres.
fn in_millimetres(svg: &str, width_mm: f64) -> String {
    let Some((head, rest)) = svg.split_once('>') else { return svg.to_owned() };
    let size = |name: &str| {
        let text = head.split_once(&format!(" {name}=\""))?.1.split_once('"')?.0;
        Some((text.to_owned(), text.parse::<f64>().ok()?))
    };
    let (Some((width, wide)), Some((height, high))) = (size("width"), size("height")) else {
        return svg.to_owned();
    };
    let head = head.replacen(&format!(" width=\"{width}\""), &format!(" width=\"{width_mm}mm\""), 1);
    let height_mm = high * width_mm / wide;
    let head = head.replacen(&format!(" height=\"{height}\""), &format!(" height=\"{height_mm:.2}mm\""), 1);
    format!("{head}>{rest}")
}

/// The drawing with each colour replaced by a grey of the same lightness.
fn grey(svg: &str) -> String {
    let mut parts = svg.split('#');
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let digits = part.chars().take_while(char::is_ascii_hexdigit).count();
        let channel = |at: usize| u8::from_str_radix(&part[at..at + 2], 16).map_or(0.0, f64::from);
        text.push('#');
        if digits == 6 {
            // Rec. 709 weights, applied to the channels as encoded.
            let light = 0.2126 * channel(0) + 0.7152 * channel(2) + 0.0722 * channel(4);
            let light = light.round() as u8;
            text.push_str(&format!("{light:02X}").repeat(3));
            text.push_str(&part[6..]);
        } else {
            text.push_str(part);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Drawing;

    #[test]
    fn a_drawing_is_no_wider_than_its_column_so_that_its_text_is_large_enough() {
        for (panels, width) in [(1, 392.0), (3, 392.0), (3, 900.0), (4, 1300.0)] {
            let lines = [(0, "A", vec![(0.0, 1.0, 0.5), (1.0, 2.0, 0.5)])];
            let panel = || crate::drawing::line_panel(&lines, "m", "title", "x", "y").unwrap();
            let drawing = Drawing::new((0..panels).map(|_| panel()).collect(), 3, [420.0, 320.0]);
            let svg = drawing.svg_for(width, None);
            let shown = svg.split_once("viewBox=\"0 0 ").unwrap().1.split_once(' ').unwrap().0;
            assert!(shown.parse::<f64>().unwrap() <= width + 0.5, "{shown} for {width}");
        }
    }

    #[test]
    fn colours_become_greys_and_sizes_millimetres() {
        assert_eq!(
            grey("<a fill=\"#0072B2\"/><b fill=\"#fff\" id=\"#x\"/>"),
            "<a fill=\"#5E5E5E\"/><b fill=\"#fff\" id=\"#x\"/>"
        );
        let svg = "<svg viewBox=\"0 0 400 300\" width=\"400\" height=\"300\"><a width=\"400\"/></svg>";
        assert_eq!(
            in_millimetres(svg, 80.0),
            "<svg viewBox=\"0 0 400 300\" width=\"80mm\" height=\"60.00mm\"><a width=\"400\"/></svg>"
        );
    }
}
