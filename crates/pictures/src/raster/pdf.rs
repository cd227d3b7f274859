//! A picture as PDF, by the crate svg2pdf, which reads SVG with its own version of `usvg`.

use std::sync::{Arc, LazyLock};

use svg2pdf::usvg::{Options, Tree, fontdb};
use svg2pdf::{ConversionOptions, PageOptions};

use super::font::FONT;
use crate::error::PictureError;

/// Dots of SVG in an inch, as defined by CSS.
const DPI: f32 = 96.0;

/// Options with the embedded font for every family.
static OPTIONS: LazyLock<Options<'static>> = LazyLock::new(|| {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    let family = fonts.faces().next().and_then(|face| face.families.first()).map(|(name, _)| name.clone());
    let family = family.unwrap_or_default();
    fonts.set_sans_serif_family(&family);
    Options { fontdb: Arc::new(fonts), font_family: family, dpi: DPI, ..Options::default() }
});

/// Converts a drawing to a PDF with one page of the same size.
pub(super) fn pdf(svg: &str) -> Result<Vec<u8>, PictureError> {
    let trouble = |error: &dyn std::fmt::Display| PictureError::Pdf(error.to_string());
    let tree = Tree::from_str(svg, &OPTIONS).map_err(|error| trouble(&error))?;
    let options = ConversionOptions { embed_text: true, ..ConversionOptions::default() };
    svg2pdf::to_pdf(&tree, options, PageOptions { dpi: DPI }).map_err(|error| trouble(&error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_the_size_of_the_drawing_and_its_font() {
        let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"88mm\" height=\"44mm\" viewBox=\"0 0 \
            200 100\">\
                   <text x=\"10\" y=\"50\" font-family=\"DejaVu Sans\" \
                   font-size=\"11\">rescuees</text></svg>";
        let pdf = pdf(svg).unwrap();
        let text = String::from_utf8_lossy(&pdf);
        assert!(text.starts_with("%PDF-1."));
        // 88 mm are 249.45 points.
        assert!(text.contains("/MediaBox [0 0 249.4"), "{text}");
        assert!(text.contains("/FontFile"), "the font is embedded");
    }
}
