//! `usar export video`: a trial as an animated GIF or as a film.

use pictures::{Animation, Pixels};

use super::ffmpeg;
use super::film::{FilmArguments, Row, failed};
use crate::prelude::*;

/// Draw a trial as an animated GIF or as a film
#[derive(Debug, Args)]
#[command(
    mut_arg("every", |every| every.required(true)),
    after_help = "\
A GIF needs no other program; a film (MP4, H.264) is made by ffmpeg. --policy can be a list: then the trials \
are drawn side by side.

Examples:
  usar export video paper.usrec --every 1 --begin 100 --end 190 --out round.gif --width 480
  usar export video paper --policy RNE,DIS --every 2 --out both.gif
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
        let recordings = self.film.recorded.recordings(registry)?;
        let rows = recordings.iter().map(|recording| self.film.row(recording));
        let rows = rows.collect::<Result<Vec<_>, Failure>>()?;
        if is_gif {
            self.write_gif(&to, &rows)?;
        } else {
            let pictures = rows[0].numbers.iter().map(|number| beside(&rows, *number));
            let (folder, name) = to.parts();
            ffmpeg::write(folder, name, self.fps, pictures)?;
        }
        Ok(writeln!(out, "{}", self.out.display())?)
    }

    fn write_gif(&self, to: &Destination, rows: &[Row]) -> Result<(), Failure> {
        let numbers = &rows[0].numbers;
        let pixels = |place: usize| beside(rows, numbers[place]);
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

/// The pictures of several trials at one moment, side by side.
fn beside(rows: &[Row], number: usize) -> Result<Pixels, Failure> {
    let pixels = |row: &Row| row.picture(number)?.pixels().map_err(failed);
    let pictures = rows.iter().map(pixels).collect::<Result<Vec<_>, Failure>>()?;
    Pixels::beside(&pictures).ok_or_else(|| Failure::input("the worlds of these trials differ in shape"))
}
