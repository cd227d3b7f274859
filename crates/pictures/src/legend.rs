//! The scale and the legend below a map.

use crate::shapes::Shape;
use crate::svg::{Anchor, At, Lettering, Num, Path, Svg};
use crate::theme::{INK, SOFT};

/// Approximate width of a letter as a share of the font size.
const LETTER: f64 = 0.58;

/// The sign before an entry of the legend.
pub(crate) enum Sign {
    /// A robot's shape with a colour.
    Robot(Shape, &'static str),
    /// A square with these looks.
    Square(String),
    /// A disc with these looks.
    Disc(String),
    /// A line with these looks.
    Line(String),
}

/// A sign and its meaning.
pub(crate) struct Entry {
    pub(crate) sign: Sign,
    pub(crate) means: String,
}

impl Entry {
    pub(crate) fn new(sign: Sign, means: impl Into<String>) -> Self {
        Self { sign, means: means.into() }
    }
}

/// Place of the legend on the sheet.
pub(crate) struct Legend {
    pub(crate) left: f64,
    pub(crate) right: f64,
    pub(crate) top: f64,
    pub(crate) unit: f64,
}

/// The largest of 1, 2, 5, 10, 20 ... that is not larger than a length.
fn round_length(most: f64) -> f64 {
    let mut length = 0.001;
    for step in [2.0, 2.5, 2.0].into_iter().cycle().take(24) {
        if length * step > most * (1.0 + 1e-9) {
            break;
        }
        length *= step;
    }
    length
}

impl Legend {
    /// Draws the scale of a map and the entries, line by line; returns the lower end.
    pub(crate) fn draw(&self, svg: &mut Svg, scale: f64, arena_m: f64, entries: Vec<Entry>) -> f64 {
        let (unit, size) = (self.unit, 10.5 * self.unit);
        let row = 16.0 * unit;
        let mut y = self.top + row / 2.0;
        let mut x = self.draw_scale(svg, scale, arena_m, y);
        for Entry { sign, means } in entries {
            let words = LETTER * size * means.chars().count() as f64;
            let width = 17.0 * unit + words + 12.0 * unit;
            if x + width - 12.0 * unit > self.right && x > self.left {
                (x, y) = (self.left, y + row);
            }
            sign.draw(svg, [x + 6.0 * unit, y], unit);
            svg.text(&means, [x + 17.0 * unit, y], &Lettering { size, anchor: Anchor::Start, colour: INK });
            x += width;
        }
        y + row / 2.0
    }

    /// Draws a scale bar of a round length; returns where the next sign may begin.
    fn draw_scale(&self, svg: &mut Svg, scale: f64, arena_m: f64, y: f64) -> f64 {
        let (unit, size) = (self.unit, 10.5 * self.unit);
        let length = round_length((0.2 * (self.right - self.left) / scale).min(arena_m));
        let end = self.left + length * scale;
        let mut bar = Path::default();
        let (low, high) = (y + 3.0 * unit, y - 3.0 * unit);
        bar.line([[self.left, high], [self.left, low], [end, low], [end, high]]);
        svg.path(&bar, &format!("fill=\"none\" stroke=\"{SOFT}\" stroke-width=\"{}\"", Num(1.2 * unit)));
        let text = format!("{length} m");
        let text = if length < 0.1 { format!("{} mm", length * 1000.0) } else { text };
        svg.text(&text, [end + 5.0 * unit, y], &Lettering { size, anchor: Anchor::Start, colour: SOFT });
        end + 5.0 * unit + LETTER * size * text.chars().count() as f64 + 14.0 * unit
    }
}

impl Sign {
    fn draw(&self, svg: &mut Svg, [x, y]: At, unit: f64) {
        let mut path = Path::default();
        let half = 5.0 * unit;
        match self {
            Self::Robot(shape, colour) => {
                shape.add([x, y], 4.5 * unit, &mut path);
                svg.path(&path, &format!("fill=\"{colour}\""));
            }
            Self::Square(looks) => svg.rect([x - half, y - half], [2.0 * half; 2], 1.5 * unit, looks),
            Self::Disc(looks) => svg.disc([x, y], half, looks),
            Self::Line(looks) => {
                path.line([[x - 1.3 * half, y], [x + 1.3 * half, y]]);
                svg.path(&path, looks);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::round_length;

    #[test]
    fn scales_have_round_lengths() {
        let lengths = [0.9, 1.0, 4.9, 5.0, 18.0, 20.0, 999.0, 8000.0].map(round_length);
        for (found, expected) in lengths.iter().zip([0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 500.0, 5000.0]) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{lengths:?}");
        }
    }
}
