//! `usar report`: writes the report of a sweep as one HTML file, with its figures.

use experiments::run::TrialKey;
use experiments::sweep::folder::Folder;
use reports::{ShownTrial, Wanted, write_report};

use super::view::page;
use crate::arguments::{CaseArgument, FamilyArguments, MeasureArgument};
use crate::input::read_sweep;
use crate::prelude::*;
use crate::recordings::replay_of;

/// Write a page: means, comparisons, figures, and their origin
#[derive(Debug, Args)]
#[command(after_help = "\
Writes report.html into the folder, which opens from disk and prints, and plots/: each figure as SVG and \
its numbers as CSV. It answers first what `usar compare` with the same flags says. Where the sweep has \
axes, report.html says how differences change along them, and links to a page for each case, up to 24. With \
--trial, the trajectories of all robots in the trials with this seed are drawn; with --with-replays, these \
trials can be watched from the report: each is a page of its own in plots/, as `usar view` writes it. Both \
take the recordings of the sweep, or simulate again.

Examples:
  usar report results/paper
  usar report results/paper --baseline DIS --metric rescuees.hard --title 'Rescuees of the hard task'
  usar report results/paper --trial 3 --with-replays
  usar report results/energy --case 3      (the third point of the grid)")]
pub(crate) struct Arguments {
    /// Folder of a sweep
    folder: PathBuf,
    #[command(flatten)]
    family: FamilyArguments,
    /// Title of the report [default: the sweep's name]
    #[arg(long)]
    title: Option<String>,
    #[command(flatten)]
    case: CaseArgument,
    /// Draw the trajectories of all robots in the trials with this seed, one for each policy
    #[arg(long, value_name = "SEED")]
    trial: Option<u64>,
    /// Add replays of trials of the sweep [default: those of --trial, or those with the first seed]
    #[arg(long)]
    with_replays: bool,
    #[command(flatten)]
    measure: MeasureArgument,
}

impl Arguments {
    /// Whether trials may be simulated again.
    pub(crate) fn simulates(&self) -> bool {
        self.trial.is_some() || self.with_replays
    }

    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let registry = &self.measure.chosen_in(registry)?;
        let mut folder = read_sweep(&self.folder, registry)?;
        let case = self.case.named(folder.experiment())?;
        if folder.results().values().all(|measured| measured.metrics.is_none()) {
            refuse!("{}: no trial has given numbers yet", self.folder.display());
        }
        let wanted = Wanted {
            asked: self.family.asked(folder.experiment())?,
            title: self.title.clone(),
            case,
            shown: self.shown(&folder, case.unwrap_or(0))?,
        };
        let path = write_report(&mut folder, wanted)?;
        Ok(path.display().to_string().into())
    }

    /// The trials to draw, with their replays if requested.
    fn shown(&self, folder: &Folder, case: usize) -> Result<Vec<ShownTrial>, Failure> {
        let experiment = folder.experiment();
        let first = experiment.seed(1);
        let Some(seed) = self.trial.or(self.with_replays.then_some(first)) else { return Ok(Vec::new()) };
        let is_shown = |key: &TrialKey| key.case == case && key.seed == seed && folder.has(key);
        let keys: Vec<TrialKey> = experiment.keys(None).filter(is_shown).collect();
        if keys.is_empty() {
            let last = experiment.seed(experiment.trials);
            refuse!("--trial: must be the seed of a finished trial, from {first} to {last}, found {seed}");
        }
        keys.iter().map(|key| self.show(folder, key)).collect()
    }

    fn show(&self, folder: &Folder, key: &TrialKey) -> Result<ShownTrial, Failure> {
        let shown = replay_of(folder.path(), folder.experiment(), key)?;
        let recording = shown.read()?;
        let page = || (format!("replay-{}.html", shown.name), page::page(&[shown], false));
        let (label, seed, replay) = (key.label.clone(), key.seed, self.with_replays.then(page));
        Ok(ShownTrial { label, seed, recording, replay })
    }
}
