//! `usar export video`: a trial as an animated GIF or as a film.

use pictures::Animation;

use super::ffmpeg;
use super::film::{FilmArguments, Row, failed};
use crate::prelude::*;

/// Draw a trial as an animated GIF or as a film
#[derive(Debug, Args)]
#[command(
    mut_arg("every", |every| every.required(true)),
    after_help = "\
A GIF needs no other program; a film (MP4, H.264) is made by ffmpeg.

Examples:
  usar export video paper.usrec --every 1 --begin 100 --end 190 --out round.gif --width 480
  usar export video paper.usrec --every 0.2 --fps 25 --out trial.mp4    five times as fast as the robots"
)]
pub(crate) struct Arguments {
    #[command(flatten)]
    film: FilmArguments,
    /// Pictures in a second of the video
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=50))]
    fps: u16,
    /// File or folder to write
    #[arg(long, value_name = "FILE.gif|mp4")]
    out: PathBuf,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let to = Destination::new("--out", &self.out, self.film.look.picture.replace.force)?;
        let is_gif = match self.out.extension().and_then(|ending| ending.to_str()) {
            Some("gif") => true,
            Some("mp4") => false,
            _ => {
                let path = self.out.display();
                refuse!("--out: must end with .gif or .mp4, found {path}");
            }
        };
        if !is_gif {
            ffmpeg::check_program()?;
        }
        let recording = self.film.recorded.recording(registry)?;
        let row = self.film.row(&recording)?;
        if is_gif {
            self.write_gif(&to, &row)?;
        } else {
            let pictures = row.numbers.iter().map(|number| row.picture(*number)?.pixels().map_err(failed));
            let (folder, name) = to.parts();
            ffmpeg::write(folder, name, self.fps, pictures)?;
        }
        Ok(writeln!(out, "{}", self.out.display())?)
    }

    fn write_gif(&self, to: &Destination, row: &Row) -> Result<(), Failure> {
        let numbers = &row.numbers;
        let pixels = |place: usize| row.picture(numbers[place])?.pixels().map_err(failed);
        let samples = [0, numbers.len() / 2, numbers.len() - 1].map(pixels);
        let samples = samples.into_iter().collect::<Result<Vec<_>, Failure>>()?;
        let delay = (100.0 / f64::from(self.fps)).round() as u16;
        let mut gif = Animation::begin(to.begin()?, &samples, delay).map_err(failed)?;
        for place in 0..numbers.len() {
            gif.push(&pixels(place)?).map_err(failed)?;
        }
        gif.finish().map_err(failed)?.finish().map(drop)
    }
}
