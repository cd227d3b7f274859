//! A picture, and how it looks.

/// The font families of the SVG's text. The embedded font comes first, for browsers that have it.
pub(crate) const FONTS: &str = "DejaVu Sans, Helvetica, Arial, sans-serif";

/// Pixels in a millimetre of SVG, as defined by CSS.
const PIXELS_PER_MM: f64 = 96.0 / 25.4;

/// Width of a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Width {
    /// Pixels, for a screen.
    Pixels(u32),
    /// Millimetres, for paper. A PNG then has [`Look::dpi`] dots in an inch.
    Millimetres(f64),
}

/// How a picture looks.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// Width of the picture. The height follows from it.
    pub width: Width,
    /// Dots in an inch of a PNG whose width is in millimetres.
    pub dpi: f64,
    /// Whether a title above the map says what it shows.
    pub has_title: bool,
    /// Whether a legend below the map explains the signs.
    pub has_legend: bool,
}

impl Default for Look {
    fn default() -> Self {
        Self { width: Width::Pixels(800), dpi: 300.0, has_title: true, has_legend: true }
    }
}

impl Look {
    /// The width in pixels of SVG.
    pub(crate) fn width_px(&self) -> f64 {
        match self.width {
            Width::Pixels(width) => f64::from(width),
            Width::Millimetres(width) => width * PIXELS_PER_MM,
        }
    }

    /// A length in pixels of SVG, as an attribute in the unit of the picture's width.
    pub(crate) fn length(&self, pixels: f64) -> String {
        match self.width {
            Width::Pixels(_) => format!("{:.0}", pixels.round()),
            Width::Millimetres(_) => format!("{:.2}mm", pixels / PIXELS_PER_MM),
        }
    }

    fn zoom(&self) -> f64 {
        match self.width {
            Width::Pixels(_) => 1.0,
            Width::Millimetres(_) => self.dpi / 96.0,
        }
    }
}

/// A picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub(crate) svg: String,
    pub(crate) zoom: f64,
}

impl Picture {
    pub(crate) fn new(svg: String, look: &Look) -> Self {
        Self { svg, zoom: look.zoom() }
    }

    /// A picture from a drawing that was made elsewhere. If its size is in millimetres, its PNG has `dpi`
    /// dots in an inch; a screen has 96. Its text is drawn with the embedded font.
    pub fn of_svg(svg: String, dpi: f64) -> Self {
        Self { svg, zoom: dpi / 96.0 }
    }

    /// The picture as the text of an SVG file.
    pub fn svg(&self) -> &str {
        &self.svg
    }
}
