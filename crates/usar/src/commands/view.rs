//! `usar view`: a trial to watch, as one page that needs nothing but a browser.

mod at;
mod page;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use clap::Args;
use experiments::Failure;
use experiments::experiment::{Experiment, PolicySpec, check_cost, defaults, split_list, with_settings};
use experiments::limits::RECORDING_BYTES;
use experiments::run::TrialKey;
use experiments::sweep::disk::experiment_in;
use recording::{Options, Recording};
use ron_fields::file::read_start;
use usar_sim::simulation::Simulation;

use super::load;
use crate::recordings::{path_of, recorded, recording_of};
use crate::running::tell;

/// The first bytes of a recording.
const MAGIC: &[u8] = b"USREC";

/// Watch a trial, or several side by side, in a browser
#[derive(Debug, Args)]
#[command(after_help = "\
FILE is a recording (`usar run --record`), a scenario, which is simulated first, or the folder of a sweep, whose trial is taken from its \
recordings or simulated again. The page has everything in it: it needs no server and no network, and can be sent to others.

In the page: space plays and pauses, the arrows step, + and - change the speed, a click on a robot shows its levels, needs and delays, \
f follows it, ? lists all keys.

Examples:
  usar view scenarios/paper.ron
  usar view scenarios/paper.ron --policy RNE,DIS --seed 3     two policies side by side, in step
  usar view results/paper --policy RNE --seed 3               a trial of a finished sweep
  usar view first.usrec second.usrec --out both.html --no-open
  usar view first.usrec --at 120                              the state after 120 s, as JSON")]
pub(crate) struct Arguments {
    /// Recordings, scenarios or folders of sweeps
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Policies to show, separated by commas, of a scenario or of a sweep [default: the first]
    #[arg(long)]
    policy: Option<String>,
    /// Seed of the trial, of a scenario or of a sweep [default: the first]
    #[arg(long)]
    seed: Option<u64>,
    /// Case of a sweep with axes, from 1
    #[arg(long, default_value_t = 1)]
    case: usize,
    /// Set a field of the scenario, by its path, to a value in RON; may stand several times
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// The page to write [default: FILE.html, in this folder]
    #[arg(long, value_name = "FILE.html")]
    out: Option<PathBuf>,
    /// Simulate even if it takes very long: more bodies x steps than docs/limits.md has
    #[arg(long)]
    allow_expensive: bool,
    /// Do not open the page
    #[arg(long)]
    no_open: bool,
    /// Print the state at this simulated time in seconds as JSON, instead of a page
    #[arg(long, value_name = "SECONDS", conflicts_with_all = ["out", "no_open"])]
    at: Option<f64>,
}

/// A recording on its way into a page.
struct Shown {
    name: String,
    bytes: Vec<u8>,
}

impl Arguments {
    pub(crate) fn execute(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let mut shown = Vec::new();
        for file in &self.files {
            self.open(file, &mut shown)?;
        }
        if let Some(time_s) = self.at {
            let recordings = shown.iter().map(read).collect::<Result<Vec<_>, Failure>>()?;
            return at::print(out, &recordings, time_s);
        }
        for shown in &shown {
            if let Some(rest) = read(shown)?.cut {
                tell(format_args!(
                    "note: {}: was cut short; {rest} bytes at its end were left out",
                    shown.name
                ));
            }
        }
        let path = self.out.clone().unwrap_or_else(|| default_path(&self.files[0]));
        page::write(&path, &shown)?;
        writeln!(out, "{}", path.display())?;
        if !self.no_open {
            open_page(&path);
        }
        Ok(())
    }

    fn open(&self, file: &Path, shown: &mut Vec<Shown>) -> Result<(), Failure> {
        if file.is_dir() {
            return self.open_folder(file, shown);
        }
        let unreadable = |error| Failure::input(format!("{}: {error}", file.display()));
        let most = RECORDING_BYTES.most as u64;
        let (start, _) = read_start(file, MAGIC.len() as u64, most).map_err(unreadable)?;
        if start == MAGIC {
            let bytes = ron_fields::file::read(file, most).map_err(unreadable)?;
            shown.push(Shown { name: file.display().to_string(), bytes });
            return Ok(());
        }
        let (scenario, _) = load(file)?;
        let scenario = with_settings(&scenario, &self.set)?;
        check_cost(&scenario, self.allow_expensive)?;
        let (first_policy, first_seed) = defaults(file)?;
        let seed = self.seed.unwrap_or(first_seed);
        for policy in split_list(self.policy.as_deref().unwrap_or(&first_policy)) {
            let spec =
                PolicySpec::parse(policy).map_err(|error| Failure::input(format!("--policy: {error}")))?;
            let made = spec.make().map_err(Failure::input)?;
            let simulation = Simulation::new(&scenario, seed)
                .map_err(|error| Failure::input(format!("{}: {error}", file.display())))?;
            let bytes = recorded(simulation, &*made.policy, &Options::new(&spec.label))?;
            shown.push(Shown { name: file.display().to_string(), bytes });
        }
        Ok(())
    }

    fn open_folder(&self, folder: &Path, shown: &mut Vec<Shown>) -> Result<(), Failure> {
        let (experiment, _) = experiment_in(folder)?;
        for key in self.keys(&experiment)? {
            let path = path_of(folder, &experiment, &key);
            let bytes = recording_of(folder, &experiment, &key)?;
            shown.push(Shown { name: path.display().to_string(), bytes });
        }
        Ok(())
    }

    /// The trials of a sweep that are asked for.
    fn keys(&self, experiment: &Experiment) -> Result<Vec<TrialKey>, Failure> {
        let labels: Vec<&str> = experiment.policies.iter().map(|spec| spec.label.as_str()).collect();
        let asked = self.policy.as_deref().map_or_else(|| vec![labels[0]], split_list);
        let seed = self.seed.unwrap_or_else(|| experiment.seed(1));
        let find = |label: &str| {
            let mut keys = experiment.keys(None);
            keys.find(|key| key.case + 1 == self.case && key.seed == seed && key.label == label)
        };
        let found = asked.iter().map(|label| {
            find(label).ok_or_else(|| {
                let (last, cases) = (experiment.seed(experiment.trials), experiment.cases.len());
                Failure::input(format!(
                    "no trial of policy {label:?} with seed {seed} in case {}; the sweep has {}, seeds {} to {last}, {cases} cases",
                    self.case,
                    labels.join(", "),
                    experiment.seed(1),
                ))
            })
        });
        found.collect()
    }
}

fn read(shown: &Shown) -> Result<Recording, Failure> {
    Recording::read(&shown.bytes).map_err(|error| Failure::input(format!("{}: {error}", shown.name)))
}

fn default_path(file: &Path) -> PathBuf {
    let stem = file.file_stem().unwrap_or(std::ffi::OsStr::new("trial"));
    Path::new(&format!("{}.html", stem.display())).to_owned()
}

/// Opens a page with the program that the desktop has for pages.
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
