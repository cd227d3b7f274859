//! Sequences of pictures of a trial.

use pictures::{Look, Picture, PictureError, Width, moment};
use recording::Recording;

use super::trial::RecordedArguments;
use crate::arguments::LookArguments;
use crate::prelude::*;

/// Largest number of pictures in a sequence.
const MOST: usize = 100_000;

/// The trial, and which of its moments are drawn.
#[derive(Debug, Args)]
pub(super) struct FilmArguments {
    #[command(flatten)]
    pub(super) recorded: RecordedArguments,
    /// Where the pictures of --every begin, in seconds of simulated time
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, requires = "every")]
    begin: f64,
    /// Where the pictures of --every end, in seconds of simulated time [default: the end of the trial]
    #[arg(long, value_name = "SECONDS", requires = "every")]
    end: Option<f64>,
    #[command(flatten)]
    pub(super) look: LookArguments,
}

/// A sequence of pictures to draw.
pub(super) struct Row<'r> {
    recording: &'r Recording,
    pub(super) numbers: Vec<usize>,
    look: Look,
}

impl Row<'_> {
    /// The picture of a frame.
    pub(super) fn picture(&self, number: usize) -> Result<Picture, Failure> {
        if is_stopped() {
            return Err(Failure::Interrupted("stopped; the pictures are not complete".to_owned()));
        }
        let last = self.recording.frames() - 1; // of trials side by side, one may end before the other
        moment(self.recording, number.min(last), &self.look).map_err(failed)
    }
}

pub(super) fn failed(error: PictureError) -> Failure {
    match error {
        PictureError::Gif(_) => Failure::storage(error),
        _ => Failure::input(error),
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

impl FilmArguments {
    /// The pictures of --every.
    pub(super) fn row<'r>(&self, recording: &'r Recording) -> Result<Row<'r>, Failure> {
        stop_on_signals();
        let look = self.look.look(Width::Pixels(640));
        Ok(Row { numbers: self.numbers(recording)?, recording, look })
    }

    /// Numbers of the frames that are drawn.
    fn numbers(&self, recording: &Recording) -> Result<Vec<usize>, Failure> {
        let last = recording.header.time_s_of(recording.frames() - 1);
        let from = self.begin.max(recording.header.time_s_of(0));
        let (every, to) = (self.recorded.every.unwrap_or(1.0), self.end.unwrap_or(last));
        frame_at(recording, "--begin", from)?;
        frame_at(recording, "--end", to)?;
        if to < from {
            refuse!("--end: must not be before --begin ({from}), found {to}");
        }
        let count = ((to - from) / every + 1e-6).floor() as usize + 1;
        if count > MOST {
            refuse!("--every: would be {count} pictures, at most {MOST} are drawn");
        }
        Ok((0..count).map(|i| recording.frame_at(from + i as f64 * every)).collect())
    }
}
