//! Options of commands that draw: the size of a picture, and the kind of its file.

use pictures::{Look, Picture, Width};

use super::ReplaceArgument;
use crate::bad_value::BadValue;
use crate::builds::check_kind;
use crate::prelude::*;

/// The size of pictures.
#[derive(Debug, Args)]
pub(crate) struct PictureArguments {
    /// Width of the picture: pixels, or millimetres on paper, as in `88mm` for a column
    #[arg(long, value_name = "WIDTH", value_parser = width)]
    pub(crate) width: Option<Width>,
    /// Dots per inch of a PNG whose width is in millimetres [default: 300; of figures 600]
    #[arg(long, value_name = "DOTS", hide_short_help = true, value_parser = dots)]
    pub(crate) dpi: Option<u16>,
    #[command(flatten)]
    pub(crate) replace: ReplaceArgument,
}

/// What stands beside a map.
#[derive(Debug, Args)]
pub(crate) struct LookArguments {
    #[command(flatten)]
    pub(crate) picture: PictureArguments,
    /// Leave out the line above the map
    #[arg(long, hide_short_help = true)]
    no_title: bool,
    /// Leave out the legend and the scale
    #[arg(long, hide_short_help = true)]
    no_legend: bool,
}
/// A number of dots per inch.
fn dots(text: &str) -> Result<u16, BadValue> {
    let dots = text.parse().ok().filter(|dots| (30..=1200).contains(dots));
    dots.ok_or_else(|| BadValue::new("a number from 30 to 1200", text))
}

/// A width from the command line.
pub(crate) fn width(text: &str) -> Result<Width, BadValue> {
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

impl LookArguments {
    /// The look of a picture; `usual` is the width if none is given.
    pub(crate) fn look(&self, usual: Width) -> Look {
        Look {
            width: self.picture.width.unwrap_or(usual),
            dpi: f64::from(self.picture.dpi.unwrap_or(300)),
            has_title: !self.no_title,
            has_legend: !self.no_legend,
        }
    }
}

/// A file for a picture, of the kind that its extension names.
pub(crate) struct PictureFile {
    write: fn(&Picture) -> Result<Vec<u8>, Failure>,
    to: Destination,
}

impl PictureFile {
    /// The file that an option names, which must end as one of these kinds.
    pub(crate) fn of(
        flag: &str,
        path: &Path,
        kinds: &[&str],
        replace: ReplaceArgument,
    ) -> Result<Self, Failure> {
        let kind = path.extension().and_then(|ending| ending.to_str()).filter(|kind| kinds.contains(kind));
        check_kind(flag, kind.unwrap_or_default())?;
        let write: fn(&Picture) -> Result<Vec<u8>, Failure> = match kind {
            Some("svg") => |picture| Ok(picture.svg().as_bytes().to_vec()),
            #[cfg(feature = "pictures")]
            Some("png") => |picture| picture.png().map_err(Failure::input),
            #[cfg(feature = "pictures")]
            Some("pdf") => |picture| picture.pdf().map_err(Failure::run),
            _ => {
                let (kinds, path) = (kinds.join(" or ."), path.display());
                refuse!("{flag}: must end with .{kinds}, found {path}");
            }
        };
        Ok(Self { write, to: Destination::new(flag, path, replace.force)? })
    }

    /// Writes the picture.
    pub(crate) fn write(&self, picture: &Picture) -> Result<(), Failure> {
        self.to.write(&(self.write)(picture)?)
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
