//! The figures of a study of regret, as files.

use experiments::Failure;
use experiments::regret::Analysis;

use crate::drawing::Sketch;
use crate::figures::regret;

/// The figures of a study as files: for each figure its drawing and the numbers behind it, each with the
/// name of its file.
///
/// # Errors
/// None: all is made in memory.
pub fn regret_figures(analyses: &[Analysis]) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    Ok(Sketch::files(regret(analyses)?))
}
