//! `usar export`: sweeps and trials for papers, slides and other programs.

#[cfg(feature = "pictures")]
mod animation;
mod figure;
mod film;
mod kind;
#[cfg(feature = "exports")]
mod log;
mod trial;

use experiments::sweep::{tidy_columns, tidy_rows};
use tables::Csv;

use crate::arguments::{
    ComparisonArguments, LookArguments, MeasureArgument, PictureFile, TrialArguments, seconds, width,
};
use crate::input::read_sweep;
use crate::library;
use crate::prelude::*;
use crate::report::sentences;
use kind::{Given, Kind};
use pictures::Width;

/// Write a trial or a sweep as table, log, picture or figure
#[derive(Debug, Args)]
#[command(after_help = "\
Of a trial, --to is NAME.csv or NAME.parquet for its tables (NAME-robots, NAME-groups, NAME-events and \
NAME-decisions: a row for each thing at each time, units in the names); .mcap for a log for Foxglove, \
Lichtblick and Rerun; .png, .svg or .pdf with --at for a moment, with --trails for all trajectories, and \
with --every for a series, whose name has a place for the number; .gif with --every for an animation. In an \
animation, --policy can be a list: the trials are drawn side by side. No display and no fonts are needed.

Of a sweep's folder, --to is .pdf, .svg or .png with --figure for one figure of its report, and .csv for one \
long table of everything that it measured; --to - prints that table. Its columns are case, the sweep's axes, \
policy, trial, seed, round, task, metric, value. Values of a whole trial have no round, those of all tasks \
together no task. The folder's columns.md says what each metric means. --policy and --seed name one trial \
of the folder: with one of them, .csv is the tables of that trial.

The figures are rescuees, differences, rescuees-over-time, energy-per-rescuee, costs, groups, levels, \
sorting; a wrong name lists those of the sweep. With --metric, its panel alone is drawn; for `differences`, \
it says which metrics are compared. No text is smaller than 7 points. A PDF has its font embedded. --grey \
takes the colours away: policies still differ by their dashes and their places.

Examples:
  usar export paper.usrec --to paper.csv --every 1             one row a second for each robot
  usar export scenarios/paper.ron --to paper.mcap
  usar export results/paper --policy DIS --seed 3 --to dis.png --at 300
  usar export paper.usrec --to ways.png --trails --width 88mm  a column of a paper, 300 dpi
  usar export paper.usrec --to 'frame-%04d.png' --every 10     one PNG every ten seconds
  usar export paper --policy RNE,DIS --to both.gif --every 2
  usar export results/paper --to tidy.csv                      everything that the sweep measured
  usar export results/paper --to fig3.pdf --figure rescuees-over-time --policies RNE,DIS --grey")]
pub(crate) struct Arguments {
    #[command(flatten)]
    given: Given,
    /// Recording (of `usar run --record`), scenario, which is simulated first, or folder of a sweep, whose
    /// trial is taken from its recordings or simulated again
    #[arg(value_parser = library::path)]
    file: PathBuf,
    /// File to write, as its ending says: .csv, .parquet, .mcap, .png, .svg, .pdf or .gif
    #[arg(long, value_name = "NAME.ENDING")]
    to: PathBuf,
    #[command(flatten)]
    trial: TrialArguments,
    /// A moment, in seconds of simulated time
    #[arg(long, value_name = "SECONDS")]
    at: Option<f64>,
    /// Draw the trajectories of all robots on one map
    #[arg(long)]
    trails: bool,
    /// Seconds of simulated time from one state or picture to the next [default: every frame of the
    /// recording]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    every: Option<f64>,
    /// Where the pictures of --every begin, in seconds of simulated time
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0)]
    begin: f64,
    /// Where the pictures of --every end, in seconds of simulated time [default: the end of the trial]
    #[arg(long, value_name = "SECONDS")]
    end: Option<f64>,
    /// Pictures in a second of an animation
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u16).range(1..=50))]
    fps: u16,
    /// Draw the figure of this name of a sweep
    #[arg(long, value_name = "NAME")]
    figure: Option<String>,
    #[command(flatten)]
    comparison: ComparisonArguments,
    #[command(flatten)]
    look: LookArguments,
    /// Height of a figure [default: that of its panels]
    #[arg(long, value_parser = width, value_name = "HEIGHT")]
    height: Option<Width>,
    /// Draw a figure without colours
    #[arg(long)]
    grey: bool,
    #[command(flatten)]
    measure: MeasureArgument,
}

impl Arguments {
    /// Whether a trial is exported, which may have to be simulated.
    pub(crate) fn simulates(&self) -> bool {
        Kind::of(self).is_ok_and(|kind| !matches!(kind, Kind::Long | Kind::Figure))
    }

    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let kind = Kind::of(self)?;
        kind.check(&self.given, &self.to)?;
        match kind {
            Kind::Long if self.to == Path::new("-") => {
                let mut out = sentences();
                self.print_long_table(registry, &mut out)?;
                out.flush()?;
                return Ok(Report::default());
            }
            Kind::Long => {
                let mut file = self.destination(&self.to)?.begin()?;
                self.print_long_table(registry, &mut file)?;
                file.finish()?;
            }
            Kind::Figure => self.draw_figure(registry)?,
            Kind::Tables => return self.write_tables(registry),
            #[cfg(feature = "exports")]
            Kind::Log => self.write_log(registry)?,
            Kind::Moment | Kind::Trails => self.draw_trial(registry)?,
            Kind::Series => return self.draw_series(registry),
            #[cfg(feature = "pictures")]
            Kind::Animation => self.animate(registry)?,
        }
        Ok(self.to.display().to_string().into())
    }

    fn destination(&self, path: &Path) -> Result<Destination, Failure> {
        Destination::new("--to", path, self.look.picture.replace.force)
    }

    fn picture_file(&self, path: &Path) -> Result<PictureFile, Failure> {
        PictureFile::of("--to", path, &["png", "svg", "pdf"], self.look.picture.replace)
    }

    fn print_long_table(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let mut folder = read_sweep(&self.file, registry)?;
        let mut table = Csv::new(out);
        table.add_row(tidy_columns(&folder))?;
        tidy_rows(&mut folder, |row| Ok(table.add_row(row)?))?;
        table.finish().map(drop).map_err(Failure::from)
    }
}
