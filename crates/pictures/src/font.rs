//! The font of all pictures.

/// A part of `DejaVu Sans`. The file beside it has its licence.
pub(crate) const FONT: &[u8] = include_bytes!("../fonts/DejaVuSans-subset.ttf");
