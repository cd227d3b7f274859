//! Sequences of pictures: as files, as a GIF, or as a film.

use std::io::Write;
use std::path::Path;

use experiments::Failure;
use experiments::files::NewFile;
use pictures::{Animation, Look, PictureError, Pixels, Width, moment};
use recording::Recording;
use rne_core::Registry;

use super::{Arguments, video};
use crate::commands::output;
use crate::running::{STOP, stop_on_signals};

/// Largest number of pictures in a sequence.
const MOST: usize = 100_000;

/// The frame at a time of the recording.
pub(super) fn frame_at(recording: &Recording, flag: &str, time_s: f64) -> Result<usize, Failure> {
    let header = &recording.header;
    let [first, last] = [0, recording.frames() - 1].map(|frame| header.time_s_of(frame));
    if !(first..=last + 1e-6).contains(&time_s) {
        let rule = format!("must be from {first} to {last}, the times of the trial, found {time_s}");
        return Err(Failure::input(format!("{flag}: {rule}")));
    }
    Ok(recording.frame_at(time_s))
}

/// A sequence of pictures to draw.
struct Row<'r> {
    recording: &'r Recording,
    numbers: Vec<usize>,
    look: Look,
}

impl Row<'_> {
    fn pixels(&self, number: usize) -> Result<Pixels, Failure> {
        if STOP.load(std::sync::atomic::Ordering::Relaxed) {
            return Err(Failure::Interrupted("stopped; the pictures are not complete".to_owned()));
        }
        moment(self.recording, number, &self.look).and_then(|picture| picture.pixels()).map_err(failed)
    }
}

fn failed(error: PictureError) -> Failure {
    match error {
        PictureError::Gif(_) => Failure::storage(error),
        _ => Failure::input(error),
    }
}

impl Arguments {
    /// Writes the pictures of --every.
    pub(super) fn film(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let force = self.looks.force;
        let films = [("--gif", &self.gif), ("--mp4", &self.mp4)];
        let film = films.into_iter().find_map(|(flag, path)| Some((flag, path.as_ref()?)));
        let place = film.map(|(flag, path)| output::place(flag, path, force)).transpose()?;
        if let Some(folder) = &self.frames {
            output::check_folder("--frames", folder, force)?;
        }
        if self.mp4.is_some() {
            video::check_program()?;
        }
        let recording = self.asked.open_one(&self.file, registry)?;
        let look = self.looks.look(Width::Pixels(640));
        let row = Row { numbers: self.numbers(&recording)?, recording: &recording, look };
        stop_on_signals();
        match (&self.frames, place) {
            (Some(folder), _) => write_frames(folder, &row, out),
            (None, Some((folder, name))) => {
                if self.gif.is_some() {
                    self.write_gif(&folder, name, &row)?;
                } else {
                    video::write(
                        &folder,
                        name,
                        self.fps,
                        row.numbers.iter().map(|number| row.pixels(*number)),
                    )?;
                }
                let path = film.map(|(_, path)| path.display().to_string());
                Ok(writeln!(out, "{}", path.unwrap_or_default())?)
            }
            (None, None) => Err(Failure::input("--every needs --frames, --gif or --mp4")),
        }
    }

    /// Numbers of the frames that are drawn.
    fn numbers(&self, recording: &Recording) -> Result<Vec<usize>, Failure> {
        let last = recording.header.time_s_of(recording.frames() - 1);
        let from = self.from.max(recording.header.time_s_of(0));
        let (every, to) = (self.every.unwrap_or(1.0), self.to.unwrap_or(last));
        frame_at(recording, "--from", from)?;
        frame_at(recording, "--to", to)?;
        if to < from {
            return Err(Failure::input(format!("--to: must not be before --from ({from}), found {to}")));
        }
        let count = ((to - from) / every + 1e-6).floor() as usize + 1;
        if count > MOST {
            return Err(Failure::input(format!(
                "--every: would be {count} pictures, at most {MOST} are drawn"
            )));
        }
        Ok((0..count).map(|i| recording.frame_at(from + i as f64 * every)).collect())
    }

    fn write_gif(&self, folder: &Path, name: &str, row: &Row) -> Result<(), Failure> {
        let numbers = &row.numbers;
        let samples = [0, numbers.len() / 2, numbers.len() - 1].map(|place| row.pixels(numbers[place]));
        let samples = samples.into_iter().collect::<Result<Vec<_>, Failure>>()?;
        let delay = (100.0 / f64::from(self.fps)).round() as u16;
        let file = NewFile::new(folder, name)?;
        let mut gif = Animation::begin(file, &samples, delay).map_err(failed)?;
        for number in numbers {
            gif.push(&row.pixels(*number)?).map_err(failed)?;
        }
        gif.finish().map_err(failed)?.finish().map(drop)
    }
}

fn write_frames(folder: &Path, row: &Row, out: &mut dyn Write) -> Result<(), Failure> {
    output::make_folder(folder)?;
    for (place, number) in row.numbers.iter().enumerate() {
        if STOP.load(std::sync::atomic::Ordering::Relaxed) {
            return Err(Failure::Interrupted(format!("stopped after {place} pictures")));
        }
        let picture = moment(row.recording, *number, &row.look).and_then(|picture| picture.png());
        NewFile::write(folder, &format!("{place:05}.png"), &picture.map_err(failed)?)?;
    }
    Ok(writeln!(out, "{} pictures in {}", row.numbers.len(), folder.display())?)
}
