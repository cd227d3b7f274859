//! A recorded trial for other programs.

use exports::ExportError;
use recording::Recording;

use crate::arguments::{TrialArguments, seconds};
use crate::library;
use crate::prelude::*;
use crate::recordings::Shown;

/// A recorded trial, or one that is recorded now.
#[derive(Debug, Args)]
pub(super) struct RecordedArguments {
    /// Recording (of `usar run --record`), scenario, which is simulated first, or folder of a sweep, whose trial
    /// is taken from its recordings or simulated again
    #[arg(value_parser = library::path)]
    file: PathBuf,
    #[command(flatten)]
    trial: TrialArguments,
    /// Seconds of simulated time from one state or picture to the next [default: every frame of the
    /// recording]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub(super) every: Option<f64>,
}

impl RecordedArguments {
    /// The recording.
    pub(super) fn recording(&self, registry: &Registry) -> Result<Recording, Failure> {
        self.trial.recording(&self.file, registry)
    }

    /// The recordings, one for each policy of a list.
    pub(super) fn recordings(&self, registry: &Registry) -> Result<Vec<Recording>, Failure> {
        let shown = self.trial.recordings(std::slice::from_ref(&self.file), registry)?;
        shown.iter().map(Shown::read).collect()
    }

    /// The recording, and the number of its frames from one exported state to the next.
    pub(super) fn read(&self, registry: &Registry) -> Result<(Recording, usize), Failure> {
        let recording = self.recording(registry)?;
        let frame_s = recording.header.dt_s * recording.header.steps_per_frame as f64;
        let every = self.every.map_or(1, |every| (every / frame_s).round().max(1.0) as usize);
        Ok((recording, every))
    }
}

/// The failure of an export to a path.
pub(super) fn failed(path: &Path, error: &ExportError) -> Failure {
    match error {
        ExportError::Recording(_) => Failure::input(error.to_string()),
        _ => Failure::storage(format!("{}: {error}", path.display())),
    }
}
