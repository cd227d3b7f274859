//! Why a picture could not be made.

use thiserror::Error;

/// Why a picture could not be made.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PictureError {
    /// A frame of the recording cannot be read.
    #[error(transparent)]
    Recording(#[from] recording::ReadError),
    /// The SVG cannot be rendered to pixels: a defect of this crate.
    #[cfg(feature = "raster")]
    #[error("the picture cannot be made pixels: {0}")]
    Svg(String),
    /// The SVG cannot be converted to a PDF: a defect of this crate.
    #[cfg(feature = "raster")]
    #[error("the picture cannot be made a PDF: {0}")]
    Pdf(String),
    /// The picture has more pixels than allowed.
    #[cfg(feature = "raster")]
    #[error("the picture would be {width} x {height} pixels large; at most {most} on each side are drawn")]
    TooLarge {
        /// Pixels from left to right.
        width: u32,
        /// Pixels from top to bottom.
        height: u32,
        /// The limit on each side.
        most: u32,
    },
    /// The pictures of an animation differ in size.
    #[cfg(feature = "raster")]
    #[error("the pictures of an animation must have one size")]
    OtherSize,
    /// The GIF cannot be written.
    #[cfg(feature = "raster")]
    #[error("cannot be written: {0}")]
    Gif(#[from] gif::EncodingError),
}
