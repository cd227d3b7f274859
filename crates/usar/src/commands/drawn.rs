//! Shared arguments of `usar draw` and `usar render`: the size of a picture, and the kind of file.

use std::path::Path;

use clap::Args;
use experiments::Failure;
use pictures::{Look, Picture, Width};

use crate::bad_value::BadValue;

/// How pictures look.
#[derive(Debug, Args)]
pub(crate) struct Looks {
    /// Width of the picture: pixels, or millimetres on paper, as in `88mm` for a column
    #[arg(long, value_name = "WIDTH", value_parser = width)]
    width: Option<Width>,
    /// Dots per inch of a PNG whose width is in millimetres
    #[arg(long, value_name = "DOTS", default_value_t = 300, value_parser = clap::value_parser!(u16).range(30..=1200))]
    dpi: u16,
    /// Leave out the line above the map
    #[arg(long)]
    no_title: bool,
    /// Leave out the legend and the scale
    #[arg(long)]
    no_legend: bool,
    /// Replace files that are there already
    #[arg(long)]
    pub(crate) force: bool,
}

/// A width from the command line.
fn width(text: &str) -> Result<Width, BadValue> {
    let wrong = || BadValue::new("100 to 8000 pixels, as in `800`, or 20mm to 1000mm", text);
    let width = if let Some(length) = text.strip_suffix("mm") {
        let length = length.trim().parse().ok().filter(|length| (20.0..=1000.0).contains(length));
        length.map(Width::Millimetres)
    } else {
        let pixels = text.strip_suffix("px").unwrap_or(text).trim().parse().ok();
        pixels.filter(|pixels| (100..=8000).contains(pixels)).map(Width::Pixels)
    };
    width.ok_or_else(wrong)
}

impl Looks {
    /// The look of a picture; `usual` is the width if none is given.
    pub(crate) fn look(&self, usual: Width) -> Look {
        Look {
            width: self.width.unwrap_or(usual),
            dpi: f64::from(self.dpi),
            has_title: !self.no_title,
            has_legend: !self.no_legend,
        }
    }
}

/// The kind of a picture file, by the extension of its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Svg,
    Png,
}

impl Kind {
    /// The kind for a file's name.
    pub(crate) fn of(path: &Path) -> Result<Self, Failure> {
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(Failure::input(format!("--out: must end with .svg or .png, found {}", path.display()))),
        }
    }

    /// The picture as a file of this kind.
    pub(crate) fn content(self, picture: &Picture) -> Result<Vec<u8>, Failure> {
        match self {
            Self::Svg => Ok(picture.svg().as_bytes().to_vec()),
            Self::Png => picture.png().map_err(Failure::input),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn widths_are_pixels_or_millimetres() {
        assert_eq!(width("88mm"), Ok(Width::Millimetres(88.0)));
        assert_eq!((width("800"), width("640px")), (Ok(Width::Pixels(800)), Ok(Width::Pixels(640))));
        for text in ["", "0", "99", "8001", "88 cm", "nanmm", "1e9mm", "-5"] {
            assert!(width(text).unwrap_err().to_string().contains("must be 100 to 8000 pixels"), "{text}");
        }
    }
}
