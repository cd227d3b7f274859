//! A picture as pixels and as PDF.

mod font;
mod pdf;

use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

use crate::error::PictureError;
use crate::picture::Picture;
use font::FONT;

/// Largest number of pixels on a side.
const MOST_PIXELS: u32 = 16_384;

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
