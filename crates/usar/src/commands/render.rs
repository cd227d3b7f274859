//! `usar render`: draws a trial as pictures, without a display.

mod film;
mod video;

use std::io::Write;
use std::path::PathBuf;

use clap::{ArgGroup, Args};
use experiments::Failure;
use pictures::{Picture, Width, moment, trails};
use recording::Recording;
use rne_core::Registry;

use super::drawn::{Kind, Looks};
use super::output;
use super::trials::Asked;

/// Draw a trial: one moment, all trajectories, or a series of frames
#[derive(Debug, Args)]
#[command(
    group(ArgGroup::new("what").args(["at", "trails", "every"]).required(true)),
    group(ArgGroup::new("film").args(["frames", "gif", "mp4"])),
    after_help = "\
FILE is a recording (`usar run --record`), a scenario, which is simulated first, or the folder of a sweep, \
whose trial is taken from its recordings or simulated again. Nothing else is needed: no display, no fonts. \
Only --mp4 needs ffmpeg.

Examples:
  usar render scenarios/paper.ron --at 120 --out frame.svg
  usar render paper.usrec --trails --width 88mm --out ways.png            a column of a paper, 300 dpi
  usar render results/paper --policy DIS --seed 3 --at 300 --out dis.png
  usar render paper.usrec --every 10 --frames pictures                    one PNG every ten seconds
  usar render paper.usrec --every 1 --from 100 --to 190 --gif round.gif --width 480
  usar render paper.usrec --every 0.2 --fps 25 --mp4 trial.mp4            five times as fast as the robots"
)]
pub(crate) struct Arguments {
    /// Recording, scenario or folder of a sweep
    file: PathBuf,
    #[command(flatten)]
    asked: Asked,
    /// Draw the moment at this simulated time, in seconds
    #[arg(long, value_name = "SECONDS", requires = "out")]
    at: Option<f64>,
    /// Draw the trajectories of all robots on one map
    #[arg(long, requires = "out")]
    trails: bool,
    /// Draw a frame every so many seconds of simulated time
    #[arg(long, value_name = "SECONDS", requires = "film", value_parser = super::seconds)]
    every: Option<f64>,
    /// The picture to write, of --at and --trails; it must not exist yet
    #[arg(long, value_name = "FILE.svg|png", conflicts_with = "every")]
    out: Option<PathBuf>,
    /// Folder for the pictures of --every, as PNG
    #[arg(long, value_name = "FOLDER", requires = "every")]
    frames: Option<PathBuf>,
    /// Write the pictures of --every as an animated GIF
    #[arg(long, value_name = "FILE.gif", requires = "every")]
    gif: Option<PathBuf>,
    /// Write the pictures of --every as a film (H.264), by the program ffmpeg
    #[arg(long, value_name = "FILE.mp4", requires = "every")]
    mp4: Option<PathBuf>,
    /// Frames per second of a GIF or film
    #[arg(long, value_name = "FPS", default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=50), requires = "every")]
    fps: u16,
    /// Where the pictures of --every begin, in seconds of simulated time
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, requires = "every")]
    from: f64,
    /// Where the pictures of --every end, in seconds of simulated time [default: the end of the trial]
    #[arg(long, value_name = "SECONDS", requires = "every")]
    to: Option<f64>,
    #[command(flatten)]
    looks: Looks,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        match &self.out {
            Some(path) => {
                let kind = Kind::of(path)?;
                let (folder, name) = output::place("--out", path, self.looks.force)?;
                let recording = self.asked.open_one(&self.file, registry)?;
                output::write(&folder, name, &kind.content(&self.picture(&recording)?)?)?;
                Ok(writeln!(out, "{}", path.display())?)
            }
            None => self.film(registry, out),
        }
    }

    /// The picture of --at or --trails.
    fn picture(&self, recording: &Recording) -> Result<Picture, Failure> {
        match self.at {
            Some(time_s) => {
                let number = film::frame_at(recording, "--at", time_s)?;
                moment(recording, number, &self.looks.look(Width::Pixels(800))).map_err(Failure::input)
            }
            None => trails(recording, &self.looks.look(Width::Millimetres(88.0))).map_err(Failure::input),
        }
    }
}
