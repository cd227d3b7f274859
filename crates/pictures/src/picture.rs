//! A picture: its SVG text, and its pixels.

use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use crate::error::PictureError;
use crate::font::FONT;
use crate::pdf;

/// The font families of the SVG's text. The embedded font comes first, for browsers that have it.
pub(crate) const FONTS: &str = "DejaVu Sans, Helvetica, Arial, sans-serif";

/// Pixels in a millimetre of SVG, as defined by CSS.
const PIXELS_PER_MM: f64 = 96.0 / 25.4;

/// Largest number of pixels on a side.
const MOST_PIXELS: u32 = 16_384;

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
    svg: String,
    zoom: f64,
}

/// The pixels of a picture: four bytes each, red, green, blue and 255, row by row from the upper left corner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pixels {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The bytes.
    pub rgba: Vec<u8>,
}

impl Pixels {
    /// Pictures of one height side by side; `None` for other pictures, or without any.
    ///
    /// ```
    /// let one = pictures::Pixels { width: 1, height: 2, rgba: vec![1, 1, 1, 255, 2, 2, 2, 255] };
    /// let two = pictures::Pixels::beside(&[one.clone(), one]).unwrap();
    /// assert_eq!((two.width, two.height), (2, 2));
    /// assert_eq!(two.rgba, [1, 1, 1, 255, 1, 1, 1, 255, 2, 2, 2, 255, 2, 2, 2, 255]);
    /// ```
    pub fn beside(pictures: &[Self]) -> Option<Self> {
        let height = pictures.first()?.height;
        if pictures.iter().any(|one| one.height != height) {
            return None;
        }
        let row = |one: &Self, y: usize| {
            let bytes = 4 * one.width as usize;
            one.rgba[y * bytes..(y + 1) * bytes].to_vec()
        };
        let rows = (0..height as usize).flat_map(|y| pictures.iter().flat_map(move |one| row(one, y)));
        Some(Self { width: pictures.iter().map(|one| one.width).sum(), height, rgba: rows.collect() })
    }
}

/// Options for text: the embedded font for every family.
static OPTIONS: LazyLock<Options<'static>> = LazyLock::new(|| {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    let family = fonts.faces().next().and_then(|face| face.families.first()).map(|(name, _)| name.clone());
    let family = family.unwrap_or_default();
    fonts.set_sans_serif_family(&family);
    Options { fontdb: Arc::new(fonts), font_family: family, ..Options::default() }
});

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

    /// The picture as a PNG file.
    ///
    /// # Errors
    /// It is too large.
    pub fn png(&self) -> Result<Vec<u8>, PictureError> {
        self.pixmap()?.encode_png().map_err(|error| PictureError::Svg(error.to_string()))
    }

    /// The picture as a PDF file of one page, with the embedded font.
    ///
    /// # Errors
    /// A defect of this crate.
    pub fn pdf(&self) -> Result<Vec<u8>, PictureError> {
        pdf::pdf(&self.svg)
    }

    /// The picture as pixels.
    ///
    /// # Errors
    /// It is too large.
    pub fn pixels(&self) -> Result<Pixels, PictureError> {
        let pixmap = self.pixmap()?;
        // The sheet is opaque, so that no division by alpha is needed.
        Ok(Pixels { width: pixmap.width(), height: pixmap.height(), rgba: pixmap.take() })
    }

    fn pixmap(&self) -> Result<Pixmap, PictureError> {
        let tree =
            Tree::from_str(&self.svg, &OPTIONS).map_err(|error| PictureError::Svg(error.to_string()))?;
        let side = |length: f32| (f64::from(length) * self.zoom).round().max(1.0) as u32;
        let (width, height) = (side(tree.size().width()), side(tree.size().height()));
        let most = MOST_PIXELS;
        if width > most || height > most {
            return Err(PictureError::TooLarge { width, height, most });
        }
        let mut pixmap = Pixmap::new(width, height).ok_or(PictureError::TooLarge { width, height, most })?;
        let scale = self.zoom as f32;
        resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixmap.as_mut());
        Ok(pixmap)
    }
}
