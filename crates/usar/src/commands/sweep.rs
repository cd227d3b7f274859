//! `usar sweep`: paired trials of several policies, a table, and a folder of results that survives
//! interruptions.

mod precision;

use std::sync::Arc;
use std::time::Duration;

use experiments::experiment::{Experiment, Shard};
use experiments::metric::Values;
use experiments::sweep::disk::trials_in;
use experiments::sweep::folder::{Folder, Opening};
use experiments::sweep::host::Hosts;
use reports::table::policy_table;

use self::precision::Precision;
use crate::arguments::{MeasureArgument, ProgressArguments, Selection, ShownArguments, count, opened};
use crate::builds::check_kind;
use crate::input::{check_trials, tell_doubts, tell_warnings_of_all};
use crate::library;
#[cfg(feature = "exports")]
use crate::parquets::write_parquets;
use crate::prelude::*;
use crate::recordings::{Recorded, record_trials};

/// With more cases, tables are left to `usar compare` and `usar report`.
const MAX_TABLES: usize = 8;

/// Run paired trials of several policies, and keep the results
#[derive(Debug, Args)]
#[command(after_help = "\
Each trial of a policy has the initial levels of that of every other policy with the same seed. \
FILE is a scenario, or a sweep file: a scenario with policies, trials and axes (scenarios/sweeps/).

Each trial is on disk as soon as it is done. The same command again resumes where the last one stopped, and \
skips what is finished; more --trials only adds. Nothing in the folder depends on --jobs or on \
interruptions. It holds trials.csv (a row per trial), rounds.csv, groups.csv, robots.csv, series.csv, \
hashes.csv (for `usar verify`), links.csv, journal.jsonl, manifest.json, the file as given \
(experiment.ron), and its scenario as run (resolved.ron).

Exit status: 0 when all trials gave numbers, 1 when one did not, 2 for bad input, 3 for a disk error, 130 \
after Ctrl-C.

Examples:
  usar sweep scenarios/paper.ron
  usar sweep scenarios/paper.ron --policies RNE,RANDOM --trials 100 --out results/many
  usar sweep scenarios/paper.ron --policies 'RNE,sum=RNE(score: Sum)' --out results/sum
  usar sweep scenarios/trust/tunnel.ron --policies 'RNE,RNE <- Kalman' --out results/kalman
  usar sweep scenarios/paper.ron --recordings 1          (then: usar view results/paper --policy RNE,DIS)
  usar sweep scenarios/paper.ron --tables parquet        (the tables as Parquet files as well)
  usar sweep scenarios/sweeps/energy.ron --shard 2/8     (then `usar cluster merge`)
  usar sweep scenarios/paper.ron --precision 'rescuees.hard: RNE-DIS: 2.0' --max-trials 500")]
pub(crate) struct Arguments {
    /// Scenario or sweep file (RON)
    #[arg(value_parser = library::path)]
    file: PathBuf,
    #[command(flatten)]
    selection: Selection,
    #[command(flatten)]
    progress: ProgressArguments,
    /// File or folder to write [default: results/NAME]
    #[arg(long)]
    out: Option<PathBuf>,
    /// Start over: delete what an earlier run has left in the folder
    #[arg(long, hide_short_help = true)]
    fresh: bool,
    /// Take no lock, on a file system that has none: no other process may write there
    #[arg(long, hide_short_help = true)]
    no_lock: bool,
    /// Run part i of n only
    #[arg(long, value_name = "i/n", hide_short_help = true)]
    shard: Option<Shard>,
    /// Add trials until the 95 % interval of a difference is at most this far from its mean, e.g.
    /// 'rescuees.hard: RNE-DIS: 2.0'
    #[arg(long, value_name = "METRIC: A-B: BOUND", hide_short_help = true, conflicts_with = "shard")]
    precision: Option<String>,
    /// Most trials of each policy and case
    #[arg(long, default_value_t = 1000, requires = "precision", hide_short_help = true)]
    #[arg(value_parser = count(1..=1_000_000))]
    max_trials: u32,
    /// Longest time of a trial, in seconds of this machine
    #[arg(long, default_value_t = 600.0, value_name = "SECONDS", hide_short_help = true)]
    max_trial_s: f64,
    /// Simulate even if it takes very long: more bodies x steps than docs/limits.md has
    #[arg(long, hide_short_help = true)]
    allow_expensive: bool,
    /// Record trials for `usar view`: `all`, the first N of each policy, or `seeds=3,7`; files go to the
    /// folder `recordings/` of the results
    #[arg(long, value_name = "all|N|seeds=LIST", hide_short_help = true)]
    recordings: Option<Recorded>,
    /// Form of the tables: with `parquet`, Parquet files stand beside the CSV
    #[arg(
        long, value_name = "csv|parquet", hide_short_help = true, default_value = "csv",
        value_parser = ["csv", "parquet"]
    )]
    tables: String,
    #[command(flatten)]
    shown: ShownArguments,
    #[command(flatten)]
    measure: MeasureArgument,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        if !(self.max_trial_s > 0.0 && self.max_trial_s <= 1e9) {
            refuse!("--max-trial-s: must be above 0, found {}", self.max_trial_s);
        }
        check_kind("--tables", &self.tables)?;
        let registry = &self.measure.chosen_in(registry)?;
        let mut experiment = Experiment::load(&self.file, &self.selection.overrides(), registry)?;
        if !self.progress.quiet {
            let scenarios = experiment.cases.iter().map(|case| &case.scenario);
            tell_warnings_of_all(scenarios, &experiment.given, &self.file);
            tell_doubts(&experiment, &self.file);
        }
        let path = self.out.clone().unwrap_or_else(|| default_path(&experiment.name, self.shard));
        if (self.selection.trials.is_none() || self.precision.is_some())
            && !self.fresh
            && let Some(trials) = trials_in(&path)
            && trials > experiment.trials
        {
            experiment = experiment.with_trials(trials)?;
        }
        let precision =
            self.precision.as_deref().map(|text| Precision::parse(text, &experiment)).transpose()?;
        if precision.is_some() {
            let first = Precision::first_look(experiment.trials, self.most(&experiment));
            experiment = experiment.with_trials(first)?;
        }
        experiment.check(self.allow_expensive)?;
        experiment.check_start(&self.file)?;

        stop_on_signals();
        let opening = Opening { shard: self.shard, is_fresh: self.fresh, has_no_lock: self.no_lock };
        let mut folder = opened(&path, experiment, opening)?;
        self.run(&mut folder)?;
        let most = self.most(folder.experiment());
        while let Some(trials) = precision.as_ref().and_then(|rule| rule.next_look(&folder, most)) {
            folder.extend(Arc::new(folder.experiment().with_trials(trials)?))?;
            self.run(&mut folder)?;
        }
        folder.finish(&STOP)?;
        #[cfg(feature = "exports")]
        if self.tables == "parquet" {
            write_parquets(&folder)?;
        }
        if let Some(which) = &self.recordings {
            record_trials(&mut folder, which, &STOP)?;
        }
        let verdict = precision.as_ref().map(|precision| precision.verdict(&folder));
        let mut out = told(&folder);
        out.extend(&verdict);
        out.print()?;
        verdict.map_or(Ok(()), |verdict| Hosts::note_rule(folder.path(), verdict))?;
        self.progress.tell(format_args!("results in {}", path.display()));
        check_trials([&folder]).map(|()| Report::default())
    }

    /// Largest number of trials with --precision.
    fn most(&self, experiment: &Experiment) -> u32 {
        self.max_trials.min(experiment.most_trials())
    }

    /// Runs the missing trials.
    fn run(&self, folder: &mut Folder) -> Result<(), Failure> {
        let longest = Duration::from_secs_f64(self.max_trial_s);
        self.progress.run_missing(folder, self.shard, Some(longest))
    }
}

fn default_path(name: &str, shard: Option<Shard>) -> PathBuf {
    let part = shard.map_or(String::new(), |shard| format!("-{}-of-{}", shard.number, shard.of));
    Path::new("results").join(format!("{name}{part}"))
}

/// The table of each case, and the number of trials behind it.
pub(crate) fn told(folder: &Folder) -> Report {
    let mut out = Report::default();
    let experiment = folder.experiment();
    for (i, case) in experiment.cases.iter().enumerate().take(MAX_TABLES) {
        let place = experiment.describe(case);
        let place = place.trim_end_matches(": ");
        if !place.is_empty() {
            out.say(place);
        }
        out.show(if place.is_empty() { "policies" } else { place }, policy_table(folder, i));
    }
    if experiment.cases.len() > MAX_TABLES {
        let more = experiment.cases.len() - MAX_TABLES;
        out.say(format!("... and {more} further cases: see trials.csv, or `usar report`"));
    }
    out.say(footnote(folder));
    out
}

fn footnote(folder: &Folder) -> String {
    let experiment = folder.experiment();
    let (first, last) = (experiment.seed(1), experiment.seed(experiment.trials));
    let failed = folder.results().values().filter(|measured| measured.metrics.is_none()).count();
    let column = experiment.metrics.named("stalled").ok();
    let stand = |values: &Values| column.and_then(|at| values.get(at)).is_some_and(|robots| robots > 0.0);
    let measured = folder.results().values().filter_map(|measured| measured.metrics.as_ref());
    let stalled = measured.filter(|values| stand(values)).count();
    let stalled = match stalled {
        0 => String::new(),
        _ => format!(
            "\n{} ended with robots that had something to do and got no nearer to it: see the column stalled",
            counted(stalled, "trial")
        ),
    };
    let shard = folder.manifest().shard;
    let missing = experiment.count(shard) - folder.results().len();
    let gaps = match (failed, missing) {
        (0, 0) => String::new(),
        _ => format!("\n{failed} trials failed, {missing} are missing: these are not in the means"),
    };
    let part = shard.map_or(String::new(), |shard| format!(", shard {} of {}", shard.number, shard.of));
    format!(
        "mean ± sample standard deviation over {} paired trials (seeds {first} to {last}{part}); {} \
         delivered, as ratios of sums; totals include what robots spent outside a group, on their way to \
         rest{gaps}{stalled}",
        experiment.count(shard) / experiment.policies.len() / experiment.cases.len().max(1),
        experiment.base.words.text("energy and HP in points per rescuee"),
    )
}
