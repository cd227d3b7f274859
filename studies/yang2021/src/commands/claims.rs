//! `usar yang2021 claims`: runs the paper's experiment and judges the paper's claims.

use std::time::Duration;

use experiments::sweep::folder::{Folder, Opening};
use experiments::sweep::names::is_sweeps;
use reports::{Wanted, write_report};
use yang2021::claims::{Judged, examples, write_authors_columns, write_claims, write_examples, write_power};
use yang2021::page::{Section, sections, write_page};
use yang2021::predictions::{predictions, write_predictions};
use yang2021::scenarios::{PAPERS_TRIALS, POLICIES, Standing, World, worlds};

use usar::arguments::{ProgressArguments, ShownArguments, count, opened};
use usar::input::check_trials;
use usar::prelude::*;

/// Time limit of one trial.
const TRIAL_LIMIT: Duration = Duration::from_mins(10);

/// Put the paper's claims to the test: four policies, paired trials, the printed and calibrated worlds
#[derive(Debug, Args)]
#[command(after_help = "\
Runs RNE, DIS, ENG and HP_DIS on paper.ron (printed constants) and paper-calibrated.ron (fitted to the \
authors' recorded trials of DIS), and says of each of the paper's claims whether it holds: over the first 10 \
trials, as many as the paper has, and over all. Where the recorded trials cannot tell other fits from the \
calibrated one, a quarter of the trials runs in each of those worlds, too.

A claim holds when the 95 % interval of each of its comparisons lies on the claimed side; it does not when \
one lies on the other side, at 95 % shared by its comparisons. It is equivalent when each comparison holds \
or differs by less than the margin that the paper's sweep file declares, by its 90 % interval; else it is \
undecided. The last table says how many paired trials each claim would need, and what 10 could have shown.

The folder gets report.html, the verdicts as a page; a sweep's folder for each scenario, with a report.html \
of its own; claims.csv, power.csv and examples.csv; predictions.csv, what each policy does in each world, \
with intervals of the mean of ten trials; and for each scenario a CSV with exactly the authors' columns. \
docs/experiments.md says what is in each. The same command resumes an interrupted run; more --trials only add.

Examples:
  usar yang2021 claims
  usar yang2021 claims --trials 1000")]
pub(crate) struct Arguments {
    /// Trials of each policy, in each case or candidate
    #[arg(long, default_value_t = 200, value_parser = count(PAPERS_TRIALS..=1_000_000))]
    trials: u32,
    /// File or folder to write
    #[arg(long, default_value = "results/reproduction")]
    out: PathBuf,
    /// Start over: delete what an earlier run has left in the folder
    #[arg(long, hide_short_help = true)]
    fresh: bool,
    #[command(flatten)]
    progress: ProgressArguments,
    #[command(flatten)]
    shown: ShownArguments,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        if is_sweeps(&self.out) {
            refuse!(
                "--out: {} is the folder of one sweep; the folders of all scenarios would be put into it",
                self.out.display()
            );
        }
        // All folders are opened first, so that an unusable folder is found before the first trial.
        let opened = worlds(self.trials, registry)?.into_iter().map(|world| self.open(world));
        let mut folders = opened.collect::<Result<Vec<_>, Failure>>()?;
        let (mut judged, mut predicted) = (Vec::new(), Vec::new());
        for (standing, folder) in &mut folders {
            self.run(folder)?;
            let wanted = Wanted::of(folder.experiment())?;
            write_report(folder, wanted)?;
            write_authors_columns(&self.out, folder)?;
            let trials = folder.experiment().trials;
            judged.push(Judged::of(folder, *standing, trials)?);
            predicted.push((*standing, predictions(folder, trials)?));
        }
        write_claims(&self.out, &judged)?;
        write_predictions(&self.out, &predicted)?;
        write_power(&self.out, &judged)?;
        let examples = examples()?;
        write_examples(&self.out, &examples)?;
        let sections = sections(&judged, &examples, &predicted);
        let Some((_, first)) = folders.first() else { return Err(Failure::run("there are no scenarios")) };
        let program = first.experiment().program.digest();
        let page = write_page(&self.out, &judged, &sections, &program)?;
        let mut out = Report::default();
        for Section { title, table, note } in sections {
            out.say(&title);
            table.into_iter().for_each(|table| out.show(&title, table));
            out.say(if note.is_empty() { note } else { note + "\n" });
        }
        out.print()?;
        let (folder, page) = (self.out.display(), page.display());
        self.progress.tell(format_args!("results in {folder}, all of this as {page}"));
        check_trials(folders.iter().map(|(_, folder)| folder)).map(|()| Report::default())
    }

    /// Opens the folder of one scenario.
    fn open(&self, world: World) -> Result<(Standing, Folder), Failure> {
        let World { standing, experiment } = world;
        let opening = Opening { is_fresh: self.fresh, ..Opening::default() };
        let place = self.out.join(&experiment.name);
        Ok((standing, opened(&place, experiment, opening)?))
    }

    /// Runs the missing trials.
    fn run(&self, folder: &mut Folder) -> Result<(), Failure> {
        let (name, trials) = (&folder.experiment().name, folder.experiment().trials);
        let policies = POLICIES.len();
        self.progress.tell(format_args!("{name}: {trials} trials of each of {policies} policies"));
        self.progress.run_missing(folder, None, Some(TRIAL_LIMIT))?;
        folder.finish(&STOP)
    }
}
