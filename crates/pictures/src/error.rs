//! Why there is no picture.

use thiserror::Error;

/// Why there is no picture.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PictureError {
    /// A frame of the recording cannot be read.
    #[error(transparent)]
    Recording(#[from] recording::ReadError),
    /// The SVG cannot be made pixels: a defect of this crate.
    #[error("the picture cannot be made pixels: {0}")]
    Svg(String),
    /// The SVG cannot be made a PDF: a defect of this crate.
    #[error("the picture cannot be made a PDF: {0}")]
    Pdf(String),
    /// It has more pixels than are made.
    #[error("the picture would be {width} x {height} pixels large; at most {most} on each side are drawn")]
    TooLarge {
        /// Pixels from left to right.
        width: u32,
        /// Pixels from top to bottom.
        height: u32,
        /// The most on each side.
        most: u32,
    },
    /// The pictures of an animation differ in size.
    #[error("the pictures of an animation must have one size")]
    OtherSize,
    /// It cannot be written.
    #[error("cannot be written: {0}")]
    Gif(#[from] gif::EncodingError),
}
