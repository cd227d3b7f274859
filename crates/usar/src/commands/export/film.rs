//! Pictures of a trial one after the other, as files.

use indicatif::ProgressBar;
use pictures::{Picture, PictureError, Width, moment};
use recording::Recording;

use super::Arguments;
use super::trial::frame_at;
use crate::arguments::progress_bar;
use crate::prelude::*;

/// The progress of fewer pictures is not told.
const TOLD: usize = 100;

/// Largest number of pictures in a row.
const MOST: usize = 100_000;

impl Arguments {
    /// Writes pictures to files, whose names have the number of the picture.
    pub(super) fn draw_series(&self, registry: &Registry) -> Result<Report, Failure> {
        let file = |number| self.picture_file(&numbered(&self.to, number)?);
        file(0)?;
        stop_on_signals();
        let recording = self.recording(registry)?;
        let numbers = self.numbers(&recording)?;
        let files = (0..numbers.len()).map(file).collect::<Result<Vec<_>, Failure>>()?;
        let bar = progress(files.len());
        for (file, number) in files.iter().zip(&numbers) {
            file.write(&self.picture(&recording, *number)?)?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        Ok(format!("{} pictures: {}", numbers.len(), self.to.display()).into())
    }

    /// Numbers of the frames that are drawn.
    pub(super) fn numbers(&self, recording: &Recording) -> Result<Vec<usize>, Failure> {
        let last = recording.header.time_s_of(recording.frames() - 1);
        let from = self.begin.max(recording.header.time_s_of(0));
        let (every, to) = (self.every.unwrap_or(1.0), self.end.unwrap_or(last));
        frame_at(recording, "--begin", from)?;
        frame_at(recording, "--end", to)?;
        if to < from {
            refuse!("--end: must not be before --begin ({from}), found {to}");
        }
        let between = recording.header.time_s_of(1) - recording.header.time_s_of(0);
        if every < between - 1e-9 {
            refuse!("--every: must be at least {between} s, the time between two frames, found {every}");
        }
        let count = ((to - from) / every + 1e-6).floor() as usize + 1;
        if count > MOST {
            refuse!("--every: would be {count} pictures, at most {MOST} are drawn");
        }
        Ok((0..count).map(|i| recording.frame_at(from + i as f64 * every)).collect())
    }

    /// The picture of a frame.
    pub(super) fn picture(&self, recording: &Recording, number: usize) -> Result<Picture, Failure> {
        if is_stopped() {
            return Err(Failure::Interrupted("stopped; the pictures are not complete".to_owned()));
        }
        let last = recording.frames() - 1; // of trials side by side, one may end before the other
        moment(recording, number.min(last), &self.look.look(Width::Pixels(640))).map_err(failed)
    }
}

/// The path of a picture of a series: `%04d` in it is the number with four digits.
fn numbered(path: &Path, number: usize) -> Result<PathBuf, Failure> {
    let text = path.to_string_lossy();
    let mut places = (1..10).map(|width| (width, format!("%0{width}d")));
    match places.find(|(_, place)| text.matches(place).count() == 1 && text.matches('%').count() == 1) {
        Some((width, place)) => Ok(text.replace(&place, &format!("{number:0width$}")).into()),
        None => refuse!(
            "--to: the pictures of --every need one place for a number, as in 'x-%04d.png', found {text}"
        ),
    }
}

pub(super) fn failed(error: PictureError) -> Failure {
    match error {
        #[cfg(feature = "pictures")]
        PictureError::Gif(_) => Failure::storage(error),
        _ => Failure::input(error),
    }
}

pub(super) fn progress(count: usize) -> ProgressBar {
    progress_bar(count, "pictures", 1, count < TOLD)
}
