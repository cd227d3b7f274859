//! One trial: its tables, its log, and single pictures of it.

use pictures::{Width, moment, trails};
use recording::{Recording, Table};

use super::Arguments;
use crate::prelude::*;

impl Arguments {
    /// The recording of the one trial that is meant.
    pub(super) fn recording(&self, registry: &Registry) -> Result<Recording, Failure> {
        self.trial.recording(&self.file, registry)
    }

    /// The recording, and the number of its frames from one exported state to the next.
    pub(super) fn read(&self, registry: &Registry) -> Result<(Recording, usize), Failure> {
        let recording = self.recording(registry)?;
        let frame_s = recording.header.dt_s * recording.header.steps_per_frame as f64;
        let every = self.every.map_or(1, |every| (every / frame_s).round().max(1.0) as usize);
        Ok((recording, every))
    }

    pub(super) fn write_tables(&self, registry: &Registry) -> Result<Report, Failure> {
        let [stem, form] =
            [self.to.file_stem(), self.to.extension()].map(|part| part.unwrap_or_default().to_string_lossy());
        let file = |table: Table| {
            let path = self.to.with_file_name(format!("{stem}-{}.{form}", table.name()));
            Ok((table, self.destination(&path)?, path))
        };
        let files = Table::ALL.into_iter().map(file).collect::<Result<Vec<_>, Failure>>()?;
        let (recording, every) = self.read(registry)?;
        for (table, to, path) in files {
            #[cfg(feature = "exports")]
            if form == "parquet" {
                super::log::write_parquet(&recording, table, every, &path, &to)?;
                Report::from(path.display().to_string()).print()?;
                continue;
            }
            let file = table.write_csv::<_, Box<dyn std::error::Error>>(&recording, every, to.begin()?);
            file.map_err(|error| failed(&path, error))?.finish()?;
            Report::from(path.display().to_string()).print()?;
        }
        Ok(Report::default())
    }

    /// Draws a moment, or else all trajectories.
    pub(super) fn draw_trial(&self, registry: &Registry) -> Result<(), Failure> {
        let file = self.picture_file(&self.to)?;
        let recording = self.recording(registry)?;
        let picture = match self.at {
            Some(time_s) => {
                let number = frame_at(&recording, "--at", time_s)?;
                moment(&recording, number, &self.look.look(Width::Pixels(800)))
            }
            None => trails(&recording, &self.look.look(Width::Millimetres(88.0))),
        };
        file.write(&picture.map_err(Failure::input)?)
    }
}

/// The frame at a time of the recording.
pub(super) fn frame_at(recording: &Recording, flag: &str, time_s: f64) -> Result<usize, Failure> {
    let header = &recording.header;
    let [first, last] = [0, recording.frames() - 1].map(|frame| header.time_s_of(frame));
    if !(first..=last + 1e-6).contains(&time_s) {
        let rule = format!("must be from {first} to {last}, the times of the trial, found {time_s}");
        refuse!("{flag}: {rule}");
    }
    Ok(recording.frame_at(time_s))
}

/// The failure of a table to a path: of the disk, or of the recording.
fn failed(path: &Path, error: Box<dyn std::error::Error>) -> Failure {
    match error.downcast::<std::io::Error>() {
        Ok(error) => Failure::storage(format!("{}: {error}", path.display())),
        Err(error) => Failure::input(error.to_string()),
    }
}
