//! `usar study sensitivity`: finds which parameters of a scenario matter, for outcomes and for differences.

use clap::ValueEnum;
use experiments::comparison::{Asked, Wishes};
use experiments::explore::{Evaluations, FIGURE, INDICES, Method, Row, Sensitivity, Space};
use experiments::files::NewFile;
use experiments::job::interrupted;
use reports::{ranking, sensitivity_figure, sensitivity_table};

use crate::arguments::{ComparisonArguments, ParameterArguments, ShownArguments, count, seed};
use crate::prelude::*;

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
--trajectories or --samples go on from there. The folder gets evaluations.jsonl (the log), indices.csv, \
indices.svg and sensitivity.json.

Examples:
  usar study sensitivity scenarios/paper.ron --policies RNE,DIS \\
      --over mission.rest_s=0..60 --over 'radiation[*].radius_m=3..9' --over 'costs.energy.per_metre=0.1..1 \
      log'
  usar study sensitivity scenarios/paper.ron --policies RNE,DIS --method sobol --samples 64 --over \
  mission.rest_s=0..60")]
pub(crate) struct Arguments {
    #[command(flatten)]
    parameters: ParameterArguments,
    /// How sensitivity is measured
    #[arg(long, value_enum, default_value = "morris")]
    method: MethodName,
    #[command(flatten)]
    comparison: ComparisonArguments,
    /// Trajectories of morris
    #[arg(long, default_value_t = 10, value_parser = count(2..=100_000))]
    trajectories: u32,
    /// Samples of sobol
    #[arg(long, default_value_t = 64, value_parser = count(2..=1_000_000))]
    samples: u32,
    /// Trials of each policy, in each case or candidate
    #[arg(long, default_value_t = 4, value_parser = count(1..=100_000))]
    trials: u32,
    /// Seed of the first trial
    #[arg(long, hide_short_help = true, default_value_t = 300_001, value_parser = seed())]
    first_seed: u64,
    /// Seed of all that the command itself draws
    #[arg(long, default_value_t = 1, hide_short_help = true)]
    draw_seed: u64,
    #[command(flatten)]
    shown: ShownArguments,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum MethodName {
    Morris,
    Sobol,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let study = self.study(registry)?;
        let folder = self.parameters.folder(&study.space.experiment, "sensitivity");
        let mut evaluations = study.open(&folder, self.parameters.fresh)?;
        if !self.evaluate(&study, &mut evaluations)? {
            return Err(interrupted(&folder, "what is done is"));
        }
        let rows = study.indices(self.blocks(), &evaluations);
        let [svg, csv] = sensitivity_figure(&rows)?;
        NewFile::write(&folder, INDICES, &csv)?;
        if !svg.is_empty() {
            NewFile::write(&folder, FIGURE, &svg)?;
        }
        self.told(&study, &evaluations, &rows)?.print()?;
        self.parameters.progress.tell(format_args!("results in {}", folder.display()));
        Ok(Report::default())
    }

    fn blocks(&self) -> u32 {
        match self.method {
            MethodName::Morris => self.trajectories,
            MethodName::Sobol => self.samples,
        }
    }

    fn study(&self, registry: &Registry) -> Result<Sensitivity, Failure> {
        let policies = self.comparison.policies.list();
        let experiment = self.parameters.experiment(policies, self.trials, registry)?;
        // The policies are those that run.
        let wishes = Wishes { policies: None, ..self.comparison.wishes() };
        let mut asked = Asked::of(&experiment, &wishes)?;
        // The sweep file's baseline may be a policy that does not run here.
        let is_run = |label: &String| experiment.policies.iter().any(|policy| policy.label == *label);
        asked.baseline = asked.baseline.filter(|label| self.comparison.baseline.is_some() || is_run(label));
        if !asked.is_declared {
            asked.metrics.truncate(1);
        }
        let outcomes = Space::outcomes(&experiment, &asked.metrics, asked.choice())?;
        let space = Space::new(experiment, &self.parameters.over, outcomes)?;
        let method = match self.method {
            MethodName::Morris => Method::Morris,
            MethodName::Sobol => Method::Sobol,
        };
        Ok(Sensitivity { space, method, seed: self.draw_seed, first_seed: self.first_seed })
    }

    fn evaluate(&self, study: &Sensitivity, evaluations: &mut Evaluations) -> Result<bool, Failure> {
        let (points, there) = (study.count(self.blocks()), study.evaluated(self.blocks(), evaluations));
        let progress = &self.parameters.progress;
        progress.tell_resumed(there, &format!("of {points} points"));
        progress.work(points, "points", |bar| {
            bar.set_position(there as u64);
            study.evaluate(self.blocks(), evaluations, &STOP, |done| bar.set_position(done as u64))
        })?
    }

    fn told(&self, study: &Sensitivity, evaluations: &Evaluations, rows: &[Row]) -> Result<Report, Failure> {
        let outcomes = || study.space.outcomes.iter();
        let of = |name: String| rows.iter().filter(|row| row.outcome.name() == name).collect::<Vec<&Row>>();
        let panels: Vec<Vec<&Row>> = outcomes().map(|outcome| of(outcome.name())).collect();
        let failures = study.failures(self.blocks(), evaluations);
        let mut out = Report::default();
        for (outcome, rows) in outcomes().zip(&panels) {
            out.say(outcome.name());
            out.show("indices", sensitivity_table(rows));
        }
        out.rows("indices", rows)?;
        out.extend(outcomes().zip(&panels).map(|(outcome, rows)| ranking(outcome, rows)));
        out.extend(failures.map(|(count, reason)| {
            format!("\n{count} points have no number and leave out their blocks; the first: {reason}")
        }));
        out.say(format!("\n{}", self.footnote(study)));
        Ok(out)
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
