//! `usar export frames`: a trial as pictures, without a display.

use clap::ArgGroup;
use experiments::files::NewFile;
use pictures::{Picture, Width, moment, trails};
use recording::Recording;

use super::film::{FilmArguments, failed, frame_at};
use crate::arguments::PictureFile;
use crate::prelude::*;

/// Draw a trial: one moment, all trajectories, or a series of frames
#[derive(Debug, Args)]
#[command(
    group(ArgGroup::new("what").args(["at", "trails", "every"]).required(true)),
    after_help = "\
Nothing else is needed: no display, no fonts. \
--out is a picture for --at and --trails, and a folder of PNG pictures for --every.

Examples:
  usar export frames scenarios/paper.ron --at 120 --out frame.svg
  usar export frames paper.usrec --trails --width 88mm --out ways.png            a column of a paper, 300 dpi
  usar export frames results/paper --policy DIS --seed 3 --at 300 --out dis.png
  usar export frames paper.usrec --every 10 --out pictures                       one PNG every ten seconds"
)]
pub(crate) struct Arguments {
    #[command(flatten)]
    film: FilmArguments,
    /// A moment, in seconds of simulated time
    #[arg(long, value_name = "SECONDS")]
    at: Option<f64>,
    /// Draw the trajectories of all robots on one map
    #[arg(long)]
    trails: bool,
    /// File or folder to write
    #[arg(long, value_name = "FILE.svg|png|FOLDER")]
    out: PathBuf,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let replace = self.film.look.picture.replace;
        if self.film.recorded.every.is_some() {
            make_folder(&self.out, replace.force)?;
            let recording = self.film.recorded.recording(registry)?;
            return self.write_frames(&self.out, &recording, out);
        }
        let file = PictureFile::of(&self.out, &["svg", "png"], replace)?;
        file.write(&self.picture(&self.film.recorded.recording(registry)?)?)?;
        Ok(writeln!(out, "{}", self.out.display())?)
    }

    /// The picture of --at or --trails.
    fn picture(&self, recording: &Recording) -> Result<Picture, Failure> {
        match self.at {
            Some(time_s) => {
                let number = frame_at(recording, "--at", time_s)?;
                moment(recording, number, &self.film.look.look(Width::Pixels(800))).map_err(Failure::input)
            }
            None => trails(recording, &self.film.look.look(Width::Millimetres(88.0))).map_err(Failure::input),
        }
    }

    fn write_frames(&self, folder: &Path, recording: &Recording, out: &mut dyn Write) -> Result<(), Failure> {
        let row = self.film.row(recording)?;
        for (place, number) in row.numbers.iter().enumerate() {
            let picture = row.picture(*number)?.png().map_err(failed)?;
            NewFile::write(folder, &format!("{place:05}.png"), &picture)?;
        }
        Ok(writeln!(out, "{} pictures in {}", row.numbers.len(), folder.display())?)
    }
}
