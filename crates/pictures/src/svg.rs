//! The text of an SVG file.

use std::fmt::{self, Display, Write};

use ron_tree::visible;

/// A position on the sheet, in pixels from its upper left corner.
pub(crate) type At = [f64; 2];

/// Prints a number with at most two decimals; NaN and infinities are printed as 0.
pub(crate) struct Num(pub f64);

impl Display for Num {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rounded = (self.0 * 100.0).round() / 100.0;
        // Avoids "-0".
        let rounded = if rounded.is_finite() && rounded != 0.0 { rounded } else { 0.0 };
        write!(out, "{rounded}")
    }
}

/// Escapes a text for SVG. Markup characters are escaped, characters that act unseen are written by their
/// numbers, and characters that SVG forbids become U+FFFD.
pub(crate) struct Escaped<'t>(pub &'t str);

impl Display for Escaped<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for c in visible(self.0).chars() {
            match c {
                '&' => out.write_str("&amp;")?,
                '<' => out.write_str("&lt;")?,
                '>' => out.write_str("&gt;")?,
                '"' => out.write_str("&quot;")?,
                c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.write_char('\u{fffd}')?,
                c => out.write_char(c)?,
            }
        }
        Ok(())
    }
}

/// An outline: the content of the attribute `d`.
#[derive(Default)]
pub(crate) struct Path(String);

impl Path {
    fn push(&mut self, command: char, [x, y]: At) {
        let _ = write!(self.0, "{command}{} {}", Num(x), Num(y));
    }

    /// A line through these places.
    pub(crate) fn line(&mut self, places: impl IntoIterator<Item = At>) -> &mut Self {
        for (number, place) in places.into_iter().enumerate() {
            self.push(if number == 0 { 'M' } else { 'L' }, place);
        }
        self
    }

    /// An outline with these corners.
    pub(crate) fn polygon(&mut self, corners: impl IntoIterator<Item = At>) {
        self.line(corners);
        self.0.push('Z');
    }

    pub(crate) fn disc(&mut self, [x, y]: At, radius: f64) {
        self.push('M', [x - radius, y]);
        let (r, across) = (Num(radius), Num(2.0 * radius));
        let _ = write!(self.0, "a{r} {r} 0 1 0 {across} 0a{r} {r} 0 1 0 -{across} 0Z");
    }

    pub(crate) fn square(&mut self, [x, y]: At, half: f64) {
        self.push('M', [x - half, y - half]);
        let side = Num(2.0 * half);
        let _ = write!(self.0, "h{side}v{side}h-{side}Z");
    }
}

/// Which point of a line of text is at its position.
#[derive(Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
}

/// How a line of text looks.
pub(crate) struct Lettering<'c> {
    pub size: f64,
    pub anchor: Anchor,
    pub colour: &'c str,
}

/// The elements of an SVG file, in order.
#[derive(Default)]
pub(crate) struct Svg(pub String);

impl Svg {
    /// Draws an outline; `looks` are attributes in SVG syntax. An empty outline is left out.
    pub(crate) fn path(&mut self, Path(path): &Path, looks: &str) {
        if !path.is_empty() {
            let _ = writeln!(self.0, "<path d=\"{path}\" {looks}/>");
        }
    }

    pub(crate) fn disc(&mut self, [x, y]: At, radius: f64, looks: &str) {
        let (x, y, radius) = (Num(x), Num(y), Num(radius));
        let _ = writeln!(self.0, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" {looks}/>");
    }

    /// Draws a rectangle with this upper left corner, size, and radius of the corners.
    pub(crate) fn rect(&mut self, [x, y]: At, [width, height]: At, round: f64, looks: &str) {
        let [x, y, width, height, round] = [x, y, width, height, round].map(Num);
        let size = format_args!("width=\"{width}\" height=\"{height}\"").to_string();
        let _ = writeln!(self.0, "<rect x=\"{x}\" y=\"{y}\" {size} rx=\"{round}\" {looks}/>");
    }

    /// Draws a line of text, vertically centred on a position, with a halo around it, so that it is legible
    /// on any background.
    pub(crate) fn text(&mut self, text: &str, [x, y]: At, look: &Lettering) {
        let Lettering { size, anchor, colour } = look;
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
        };
        let [x, y, size, halo] = [x, y + 0.35 * size, *size, 0.28 * size].map(Num);
        let place = format!("x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\"");
        let halo = format!(
            "paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"{halo}\" stroke-linejoin=\"round\""
        );
        let text = Escaped(text);
        let _ = writeln!(self.0, "<text {place} fill=\"{colour}\" {halo}>{text}</text>");
    }

    /// Begins a clipped part of the sheet with this upper left corner and size.
    pub(crate) fn begin_window(&mut self, [x, y]: At, [width, height]: At) {
        let [x, y, width, height] = [x, y, width, height].map(Num);
        let _ = writeln!(
            self.0,
            "<svg x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" viewBox=\"{x} {y} {width} \
             {height}\">"
        );
    }

    pub(crate) fn end_window(&mut self) {
        self.0.push_str("</svg>\n");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_texts_are_no_markup() {
        let text = [1.0, 0.126, -0.001, f64::NAN, 1234.5].map(|value| Num(value).to_string());
        assert_eq!(text, ["1", "0.13", "0", "0", "1234.5"]);
        let escaped = Escaped("<script>\u{1b}&\"\u{0}").to_string();
        assert_eq!(escaped, "&lt;script&gt;\\u{1b}&amp;&quot;\\u{0}");
        let mut path = Path::default();
        path.line([[0.0, 1.0], [2.0, 3.456]]);
        path.square([5.0, 5.0], 1.0);
        assert_eq!(path.0, "M0 1L2 3.46M4 4h2v2h-2Z");
    }
}
