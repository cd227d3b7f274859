//! `usar sensitivity`: finds which parameters of a scenario matter, for outcomes and for differences.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use experiments::Failure;
use experiments::comparison::{Asked, Wishes};
use experiments::experiment::split_list;
use experiments::explore::{Evaluations, FIGURE, INDICES, Method, Row, Sensitivity, Space};
use experiments::files::NewFile;
use reports::{ranking, sensitivity_figure, sensitivity_table};
use rne_core::Registry;
use serde::Serialize;

use super::explored::ExploredArguments;
use super::{SCHEMA_VERSION, ShownArguments, print_table};
use crate::running::{STOP, progress_bar, stop_on_signals, tell};

/// Which parameters matter for the outcome, and which for the difference between policies?
#[derive(Debug, Args)]
#[command(after_help = "\
morris (elementary effects) ranks many parameters with few trials: along each trajectory one parameter after \
another moves by two thirds of its range. mu* is the mean size of the effect on the outcome, in units of the \
outcome over the whole range; mu has its sign; sigma is large where a parameter acts through others. sobol \
tells shares of the variance: of each parameter alone (first order) and with all in which it has a part \
(total). All points of a trajectory or sample have the same seeds, and each trajectory has its own; `chance` \
is what other seeds alone do. Intervals are bootstraps over trajectories or samples.

Each point is on disk as soon as its batch is done; the same command resumes where it stopped, and more \
--trajectories or --samples go on from there. The folder gets evaluations.csv (the log), indices.csv, \
indices.svg and sensitivity.json.

Examples:
  usar sensitivity scenarios/paper.ron --policies RNE,DIS \\
      --over mission.rest_s=0..60 --over 'radiation[*].radius_m=3..9' --over 'costs.energy.per_metre=0.1..1 \
      log'
  usar sensitivity scenarios/paper.ron --policies RNE,DIS --method sobol --samples 64 --over \
  mission.rest_s=0..60")]
pub(crate) struct Arguments {
    #[command(flatten)]
    explored: ExploredArguments,
    /// How sensitivity is measured
    #[arg(long, value_enum, default_value = "morris")]
    method: MethodName,
    /// Policies, separated by commas [default: the file's]
    #[arg(long)]
    policies: Option<String>,
    /// Metric; can be given several times [default: those that the sweep file names, or rescuees]
    #[arg(long)]
    metric: Vec<String>,
    /// Differences of each policy with this one [default: the file's, or the first]
    #[arg(long)]
    baseline: Option<String>,
    /// Trajectories of morris
    #[arg(long, default_value_t = 10, value_parser = clap::value_parser!(u32).range(2..=100_000))]
    trajectories: u32,
    /// Samples of sobol
    #[arg(long, default_value_t = 64, value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    samples: u32,
    /// Trials of each policy at a point
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    trials: u32,
    /// Seed of the first trial; far from those of experiments
    #[arg(long, default_value_t = 300_001, value_parser = clap::value_parser!(u64).range(..u64::MAX / 2))]
    first_seed: u64,
    /// Seed of the points
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for the log and the results [default: results/NAME-sensitivity]
    #[arg(long)]
    out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) shown: ShownArguments,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum MethodName {
    Morris,
    Sobol,
}

#[derive(Serialize)]
struct Output<'a> {
    schema_version: u32,
    scenario: &'a str,
    method: Method,
    trials: u32,
    indices: &'a [Row],
    in_words: Vec<String>,
    points_without_numbers: usize,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let study = self.study(registry)?;
        let name = format!("{}-sensitivity", study.space.experiment.name);
        let folder = self.out.clone().unwrap_or_else(|| Path::new("results").join(name));
        let mut evaluations = study.open(&folder, self.explored.fresh)?;
        stop_on_signals();
        if !self.evaluate(&study, &mut evaluations)? {
            return Err(Failure::Interrupted(format!(
                "stopped; what is done is in {}, and the same command goes on",
                folder.display()
            )));
        }
        let rows = study.indices(self.blocks(), &evaluations);
        let [svg, csv] = sensitivity_figure(&rows)?;
        NewFile::write(&folder, INDICES, &csv)?;
        if !svg.is_empty() {
            NewFile::write(&folder, FIGURE, &svg)?;
        }
        self.print(out, &study, &evaluations, &rows)?;
        if !self.explored.quiet {
            tell(format_args!("results in {}", folder.display()));
        }
        Ok(())
    }

    fn blocks(&self) -> u32 {
        match self.method {
            MethodName::Morris => self.trajectories,
            MethodName::Sobol => self.samples,
        }
    }

    fn study(&self, registry: &Registry) -> Result<Sensitivity, Failure> {
        let policies = self.policies.as_deref();
        let policies = policies.map(|list| split_list(list).into_iter().map(str::to_owned).collect());
        let experiment = self.explored.experiment(policies, self.trials, registry)?;
        let wishes =
            Wishes { metrics: self.metric.clone(), baseline: self.baseline.clone(), ..Wishes::default() };
        let mut asked = Asked::of(&experiment, &wishes)?;
        // The sweep file's baseline may be a policy that does not run here.
        let is_run = |label: &String| experiment.policies.iter().any(|policy| policy.label == *label);
        asked.baseline = asked.baseline.filter(|label| self.baseline.is_some() || is_run(label));
        if !asked.is_declared {
            asked.metrics.truncate(1);
        }
        let outcomes = Space::outcomes(&experiment, &asked.metrics, asked.choice())?;
        let space = Space::new(experiment, &self.explored.over, outcomes)?;
        let method = match self.method {
            MethodName::Morris => Method::Morris,
            MethodName::Sobol => Method::Sobol,
        };
        Ok(Sensitivity { space, method, seed: self.seed, first_seed: self.first_seed })
    }

    fn evaluate(&self, study: &Sensitivity, evaluations: &mut Evaluations) -> Result<bool, Failure> {
        let (points, quiet, jobs) = (study.count(self.blocks()), self.explored.quiet, self.explored.jobs());
        let there = evaluations.count(self.blocks());
        if there > 0 && !quiet {
            tell(format_args!("{there} of {points} points are there already"));
        }
        let pool = self.explored.pool()?;
        let progress = progress_bar(points, "points", jobs, quiet || there == points);
        progress.set_position(there as u64);
        let is_whole = pool.install(|| {
            study.evaluate(self.blocks(), evaluations, &STOP, |done| progress.set_position(done as u64))
        });
        progress.finish_and_clear();
        is_whole
    }

    fn print(
        &self,
        out: &mut dyn Write,
        study: &Sensitivity,
        evaluations: &Evaluations,
        rows: &[Row],
    ) -> Result<(), Failure> {
        let outcomes = || study.space.outcomes.iter();
        let of = |name: String| rows.iter().filter(|row| row.outcome.name() == name).collect::<Vec<&Row>>();
        let panels: Vec<Vec<&Row>> = outcomes().map(|outcome| of(outcome.name())).collect();
        let failures = study.failures(self.blocks(), evaluations);
        if self.explored.json || self.shown.is_json() {
            let output = Output {
                schema_version: SCHEMA_VERSION,
                scenario: &study.space.experiment.base.name,
                method: study.method,
                trials: self.trials,
                indices: rows,
                in_words: outcomes().zip(&panels).map(|(outcome, rows)| ranking(outcome, rows)).collect(),
                points_without_numbers: failures.map_or(0, |(count, _)| count),
            };
            return Ok(writeln!(out, "{}", serde_json::to_string(&output).map_err(Failure::run)?)?);
        }
        for (outcome, rows) in outcomes().zip(&panels) {
            writeln!(out, "{}", outcome.name())?;
            print_table(out, &sensitivity_table(rows))?;
        }
        for (outcome, rows) in outcomes().zip(&panels) {
            writeln!(out, "{}", ranking(outcome, rows))?;
        }
        if let Some((count, reason)) = failures {
            writeln!(out, "\n{count} points have no number and leave out their blocks; the first: {reason}")?;
        }
        writeln!(out, "\n{}", self.footnote(study))?;
        Ok(())
    }

    fn footnote(&self, study: &Sensitivity) -> String {
        let (blocks, points) = (self.blocks(), study.count(self.blocks()));
        let (what, shown) = match self.method {
            MethodName::Morris => (
                "trajectories",
                "A parameter is told apart from chance if the\n\
                 interval of its mean effect excludes 0, or its effects are larger than those of other seeds \
                 (95 %).",
            ),
            MethodName::Sobol => (
                "samples",
                "A parameter is told apart from chance if the interval of its share alone is above 0.",
            ),
        };
        format!(
            "{blocks} {what}, {points} points, {} trials of each policy at a point. {shown}\nIntervals are \
             one by one, not corrected.",
            self.trials
        )
    }
}
