//! Pictures of a trial one after the other, as an animation.

use pictures::{Animation, Pixels};
use recording::Recording;

use super::Arguments;
use super::film::{failed, progress};
use crate::prelude::*;
use crate::recordings::Shown;

impl Arguments {
    pub(super) fn animate(&self, registry: &Registry) -> Result<(), Failure> {
        let to = self.destination(&self.to)?;
        stop_on_signals();
        let shown = self.trial.recordings(std::slice::from_ref(&self.file), registry)?;
        let recordings = shown.iter().map(Shown::read).collect::<Result<Vec<_>, Failure>>()?;
        let rows = recordings.iter().map(|recording| self.numbers(recording));
        let numbers = &rows.collect::<Result<Vec<_>, Failure>>()?[0];
        let pixels = |number: usize| self.beside(&recordings, number);
        let samples = [0, numbers.len() / 2, numbers.len() - 1].map(|place| pixels(numbers[place]));
        let samples = samples.into_iter().collect::<Result<Vec<_>, Failure>>()?;
        let delay = (100.0 / f64::from(self.fps)).round() as u16;
        let mut gif = Animation::begin(to.begin()?, &samples, delay).map_err(failed)?;
        let bar = progress(numbers.len());
        for number in numbers {
            gif.push(&pixels(*number)?).map_err(failed)?;
            bar.inc(1);
        }
        bar.finish_and_clear();
        gif.finish().map_err(failed)?.finish().map(drop)
    }

    /// The pictures of several trials at one moment, side by side.
    fn beside(&self, recordings: &[Recording], number: usize) -> Result<Pixels, Failure> {
        let pixels = |recording: &Recording| self.picture(recording, number)?.pixels().map_err(failed);
        let pictures = recordings.iter().map(pixels).collect::<Result<Vec<_>, Failure>>()?;
        Pixels::beside(&pictures).ok_or_else(|| Failure::input("the worlds of these trials differ in shape"))
    }
}
