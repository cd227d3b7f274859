//! The font of all pictures.

/// A subset of `DejaVu Sans`. Its licence is in the file beside it.
pub(super) const FONT: &[u8] = include_bytes!("../../fonts/DejaVuSans-subset.ttf");
