//! `usar study regret`: the distance of each policy's decisions to the best ones.

use experiments::experiment::{Experiment, Overrides};
use experiments::files::NewFile;
use experiments::oracle::{DEFAULT_LIMIT, Objective};
use experiments::regret::{
    Analysis, Choices, Criteria, DecisionRow, Estimate, SUMMARY, Study, StudyFolder, TABLE, analyse,
};
use reports::regret_figures;

use crate::arguments::{
    MeasureArgument, ProgressArguments, ShownArguments, WorldArgument, limit, parse_policy,
};
use crate::library;
use crate::prelude::*;

/// How far does each policy's decision stay behind the best one? A study over all rounds of many trials
#[derive(Debug, Args)]
#[command(after_help = "\
Plays every assignment at every decision of the trials of a sweep file; trial by trial, each of its policies \
in turn decides. Tells each policy's regret, how often grouping matters at all, how much of what can be \
achieved each policy achieves, and which features of an assignment go with its outcome. The paper's team has \
240 assignments: about two minutes of one core for each trial.

The folder has `decisions.jsonl` (every outcome), `regret.csv` (a row for each decision, policy and metric) \
and `summary.json`. An interrupted study resumes; with a folder instead of a file, only its tables and \
figures are made anew.

Examples:
  usar study regret scenarios/sweeps/regret.ron
  usar study regret scenarios/sweeps/regret.ron --trials 10 --out results/quick
  usar study regret scenarios/sweeps/regret.ron --then RNE --rounds 2 --out results/regret-trial
  usar study regret results/regret --metric rescue_rate")]
pub(crate) struct Arguments {
    /// Sweep file or scenario (RON), or the folder of a study
    #[arg(value_name = "FILE|DIR", value_parser = library::path)]
    file: PathBuf,
    #[command(flatten)]
    world: WorldArgument,
    /// Trials of each policy, in each case or candidate [default: the file's]
    #[arg(long)]
    trials: Option<u32>,
    /// Play to the end of the trial, in which this policy decides the rest [default: to the end of the round]
    #[arg(long, value_name = "POLICY")]
    then: Option<String>,
    /// Rounds to play, separated by commas [default: all]
    #[arg(long, value_delimiter = ',')]
    rounds: Vec<u32>,
    /// Most assignments of a decision to play, or problems to solve
    #[arg(long, hide_short_help = true, default_value_t = DEFAULT_LIMIT, value_parser = limit())]
    limit: u64,
    /// Metric, e.g. `rescuees.total`; can be given several times [default: `rescuees`, `rescue_rate` and
    /// `energy_per_rescuee`]
    #[arg(long)]
    metric: Vec<String>,
    /// File or folder to write [default: results/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Simulate even if it takes very long: more bodies x steps than docs/limits.md has
    #[arg(long, hide_short_help = true)]
    allow_expensive: bool,
    #[command(flatten)]
    progress: ProgressArguments,
    #[command(flatten)]
    shown: ShownArguments,
    #[command(flatten)]
    measure: MeasureArgument,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let registry = &self.measure.chosen_in(registry)?;
        let folder = if self.file.is_dir() { StudyFolder::read(&self.file)? } else { self.play(registry)? };
        let objectives = self.objectives(&folder.study.tasks)?;
        let measure = registry.a_measure();
        let measure = measure.ok_or_else(|| Failure::input("there is no trust measure"))?;
        let analyses = objectives
            .iter()
            .map(|objective| analyse(&folder, &Criteria { objective, measure: &measure }, registry));
        let analyses = analyses.collect::<Result<Vec<_>, Failure>>()?;
        write_tables(&folder.folder.path, &analyses)?;
        for (name, content) in regret_figures(&analyses)? {
            NewFile::write(&folder.folder.path, &name, &content)?;
        }
        let mut out = told(&folder, &analyses);
        out.rows("analyses", &analyses)?;
        Ok(out)
    }

    fn objectives(&self, tasks: &[String]) -> Result<Vec<Objective>, Failure> {
        let defaults = ["rescuees", "rescue_rate", "energy_per_rescuee"].map(str::to_owned);
        let names = if self.metric.is_empty() { &defaults[..] } else { &self.metric };
        let parse = |name: &String| Objective::parse(name, tasks).map_err(Failure::input_at("--metric"));
        names.iter().map(parse).collect()
    }

    /// Plays the missing trials of the study.
    fn play(&self, registry: &Registry) -> Result<StudyFolder, Failure> {
        let overrides =
            Overrides { trials: self.trials, scenario: self.world.scenario.clone(), ..Overrides::default() };
        let experiment = Experiment::load(&self.file, &overrides, registry)?;
        experiment.check(self.allow_expensive)?;
        let then = self.then.as_deref().map(|text| parse_policy("--then", text, registry)).transpose()?;
        let choices =
            Choices { then: then.map(|spec| spec.plain()), rounds: self.rounds.clone(), limit: self.limit };
        let study = Study::of(&experiment, &choices)?;
        self.objectives(&study.tasks)?; // a wrong name is told before the work, not after it
        let path = self.out.clone().unwrap_or_else(|| Path::new("results").join(&experiment.name));
        let mut folder = StudyFolder::open(&path, &study)?;
        let missing = folder.missing().len();
        if missing == 0 {
            return Ok(folder);
        }
        self.progress.tell_resumed(folder.folder.entries.len(), "trials");
        self.progress.work(missing, "trials", |bar| {
            folder.play_missing(&experiment, &STOP, || bar.inc(1)).map(|()| folder)
        })?
    }
}

/// Writes the tables of a study into its folder.
fn write_tables(path: &Path, analyses: &[Analysis]) -> Result<(), Failure> {
    let header = [
        "metric", "trial", "seed", "driver", "round", "policy", "rank", "value", "regret", "best", "mean",
        "worst", "played", "is_exact",
    ];
    let row = |analysis: &Analysis, row: &DecisionRow| {
        let before =
            [analysis.metric.clone(), row.trial.to_string(), row.seed.to_string(), row.driver.clone()];
        let policy = [row.round.to_string(), row.policy.clone(), row.rank.to_string()];
        let values = [row.value, row.regret, row.best, row.mean, row.worst].map(|value| value.to_string());
        let after = [row.played.to_string(), row.is_exact.to_string()];
        before.into_iter().chain(policy).chain(values).chain(after).collect()
    };
    let rows = analyses.iter().flat_map(|analysis| analysis.rows.iter().map(move |one| row(analysis, one)));
    NewFile::write(path, TABLE, tables::csv(header, rows)?.as_bytes())?;
    let summary = serde_json::to_vec_pretty(analyses).map_err(Failure::run)?;
    NewFile::write(path, SUMMARY, &summary).map(drop)
}

/// A number with three significant digits, and its interval.
fn with_interval(estimate: Option<&Estimate>, scale: f64, unit: &str) -> String {
    let Some(Estimate { value, interval }) = estimate else { return "-".to_owned() };
    let number = |value: f64| experiments::comparison::digits(value * scale, 3);
    match interval {
        None => format!("{}{unit}", number(*value)),
        Some([low, high]) => format!("{}{unit} ({} to {})", number(*value), number(*low), number(*high)),
    }
}

fn told(folder: &StudyFolder, analyses: &[Analysis]) -> Report {
    let study = &folder.study;
    let end = study
        .then
        .as_ref()
        .map_or("of its round".to_owned(), |then| format!("of the trial, in which {then} goes on"));
    let rounds: Vec<String> = study.rounds.iter().map(u32::to_string).collect();
    let rounds =
        if rounds.is_empty() { "every round".to_owned() } else { format!("round {}", rounds.join(", ")) };
    let mut out = Report::from(format!(
        "{}: {} of {} trials, {rounds}; each decision played in all ways to the end {end}\n\
         Means over trials, in brackets 95 % intervals (bootstrap over trials)",
        study.name,
        folder.folder.entries.len(),
        study.seeds.len()
    ));
    analyses.iter().for_each(|analysis| tell_analysis(&mut out, analysis));
    out
}

fn tell_analysis(out: &mut Report, analysis: &Analysis) {
    let Analysis { metric, decisions, exact, .. } = analysis;
    let percent = |share: &Option<Estimate>| with_interval(share.as_ref(), 100.0, " %");
    let plain = |value: &Option<Estimate>| with_interval(value.as_ref(), 1.0, "");
    out.say(format!("\n{metric}: {decisions} decisions, {exact} of them with all assignments"));
    let matters = percent(&analysis.matters);
    out.say(format!("  grouping matters (best and worst assignment differ) in {matters} of the decisions"));
    let choices = [("best", &analysis.best), ("fair draw", &analysis.drawn), ("worst", &analysis.worst)];
    out.extend(choices.map(|(name, estimate)| format!("  {name:<9} {}", plain(estimate))));
    let rows = analysis.policies.iter().map(|one| {
        let shares = [&one.best, &one.outranked, &one.achieved].map(percent);
        [one.policy.clone(), plain(&one.regret)].into_iter().chain(shares).map(right)
    });
    let header = ["policy", "regret", "best choice", "better ones", "achieved"];
    out.show("analyses", Table::of(header, rows));
    let header = ["feature of an assignment", "rank correlation with the outcome", "decisions"];
    let rows = analysis
        .features
        .iter()
        .map(|row| [row.feature.clone(), plain(&row.correlation), row.decisions.to_string()].map(right));
    out.show("analyses", Table::of(header, rows));
}
