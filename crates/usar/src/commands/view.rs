//! `usar view`: shows a trial as one page that needs only a browser.

mod at;
pub(super) mod page;

use std::process::{Command, Stdio};

use crate::arguments::TrialArguments;
use crate::library;
use crate::prelude::*;
use crate::recordings::Shown;

/// Watch a trial, or several side by side, in a browser
#[derive(Debug, Args)]
#[command(after_help = "\
FILE is a recording (`usar run --record`), a scenario, which is simulated first, or the folder of a sweep, \
whose trial is taken from its recordings or simulated again. The page has everything in it: it needs no \
server and no network, and can be sent to others. An earlier page of this command is replaced, no other file.

With --with-replays, the page has all recorded trials of a sweep in it (`usar sweep --recordings`) and lists \
them with what each rescued: one file to send. If none is recorded, it has the trials with the first seed. \
--policy, --seed and --case choose.

With --at, no page is written: the state at that moment is printed as JSON. --policy can be a list.

In the page: space plays and pauses, the arrows step, + and - change the speed, g goes to a time, a \
click on a robot shows its levels, needs and delays, f follows it, ? lists all keys. The address follows: \
FILE.html#t=128&robot=4 opens at 128 s with robot 4 chosen.

Examples:
  usar view scenarios/paper.ron
  usar view scenarios/paper.ron --policy RNE,DIS --seed 3     two policies side by side, in step
  usar view results/paper --policy RNE --seed 3               a trial of a finished sweep
  usar view results/paper --with-replays --out paper.html     its recorded trials in one page
  usar view first.usrec second.usrec --out both.html --no-open
  usar view first.usrec --at 120                              the state after 120 s, as JSON")]
pub(crate) struct Arguments {
    /// Recordings, scenarios or folders of sweeps
    #[arg(required = true, value_name = "FILE", value_parser = library::path)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    trial: TrialArguments,
    /// Add replays of trials of the sweep [default: all recorded trials, or those with the first seed]
    #[arg(long, conflicts_with = "set")]
    with_replays: bool,
    /// File or folder to write [default: FILE.html]
    #[arg(long, value_name = "FILE.html")]
    out: Option<PathBuf>,
    /// Do not open the page
    #[arg(long)]
    no_open: bool,
    /// A moment, in seconds of simulated time
    #[arg(long, value_name = "SECONDS", conflicts_with_all = ["out", "no_open", "with_replays"])]
    at: Option<f64>,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let shown = if self.with_replays {
            self.trial.replays(&self.files, registry)?
        } else {
            self.trial.recordings(&self.files, registry)?
        };
        let recordings = shown.iter().map(Shown::read).collect::<Result<Vec<_>, Failure>>()?;
        if let Some(time_s) = self.at {
            return at::print(&recordings, time_s);
        }
        let path = self.out.clone().unwrap_or_else(|| default_path(&self.files[0]));
        page::write(&path, &shown, self.with_replays)?;
        Report::from(path.display().to_string()).print()?;
        if !self.no_open {
            open_page(&path);
        }
        Ok(Report::default())
    }
}

fn default_path(file: &Path) -> PathBuf {
    let stem = file.file_stem().unwrap_or(std::ffi::OsStr::new("trial"));
    Path::new(&format!("{}.html", stem.display())).to_owned()
}

/// Opens a page with the desktop's default program.
fn open_page(path: &Path) {
    let (program, first): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("cmd", &["/C", "start", ""]),
        _ => ("xdg-open", &[]),
    };
    let opened =
        Command::new(program).args(first).arg(path).stdout(Stdio::null()).stderr(Stdio::null()).status();
    if !opened.is_ok_and(|status| status.success()) {
        tell(format_args!("note: {program} did not open it; open {} in a browser", path.display()));
    }
}
