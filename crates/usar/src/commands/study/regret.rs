//! `usar study regret`: the distance of each policy's decisions to the best ones.

use experiments::experiment::{Experiment, Overrides};
use experiments::files::NewFile;
use experiments::oracle::{DEFAULT_LIMIT, Objective};
use experiments::regret::{
    Analysis, Choices, Criteria, Estimate, SUMMARY, Study, StudyFolder, TABLE, analyse,
};
use reports::regret_figures;
use reports::table::{headed, right};
use serde_json::json;

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
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let registry = &self.measure.chosen_in(registry)?;
        let folder = if self.file.is_dir() { StudyFolder::read(&self.file)? } else { self.play(registry)? };
        let objectives = self.objectives(&folder.study.tasks)?;
        let measure = registry.a_measure();
        let measure = measure.ok_or_else(|| Failure::input("there is no trust measure"))?;
        let analyses = objectives
            .iter()
            .map(|objective| analyse(&folder, &Criteria { objective, measure: &measure }, registry));
        let analyses = analyses.collect::<Result<Vec<_>, Failure>>()?;
        write_tables(folder.path(), &analyses)?;
        for (name, content) in regret_figures(&analyses)? {
            NewFile::write(folder.path(), &name, &content)?;
        }
        if self.shown.is_json() {
            let name = &folder.study.name;
            let output = json!({"study": name, "analyses": analyses});
            return print_json(&output);
        }
        print(out, &folder, &analyses)
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
        self.progress.tell_resumed(folder.trials.len(), "trials");
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
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for analysis in analyses {
        for row in &analysis.rows {
            rows.push(vec![
                analysis.metric.clone(),
                row.trial.to_string(),
                row.seed.to_string(),
                row.driver.clone(),
                row.round.to_string(),
                row.policy.clone(),
                row.rank.to_string(),
                row.value.to_string(),
                row.regret.to_string(),
                row.best.to_string(),
                row.mean.to_string(),
                row.worst.to_string(),
                row.played.to_string(),
                row.is_exact.to_string(),
            ]);
        }
    }
    NewFile::write(path, TABLE, &csv_of(rows)?)?;
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

fn print(out: &mut dyn Write, folder: &StudyFolder, analyses: &[Analysis]) -> Result<(), Failure> {
    let study = &folder.study;
    let end = study
        .then
        .as_ref()
        .map_or("of its round".to_owned(), |then| format!("of the trial, in which {then} goes on"));
    let rounds: Vec<String> = study.rounds.iter().map(u32::to_string).collect();
    let rounds =
        if rounds.is_empty() { "every round".to_owned() } else { format!("round {}", rounds.join(", ")) };
    writeln!(
        out,
        "{}: {} of {} trials, {rounds}; each decision played in all ways to the end {end}\n\
         Means over trials, in brackets 95 % intervals (bootstrap over trials)",
        study.name,
        folder.trials.len(),
        study.seeds.len()
    )?;
    analyses.iter().try_for_each(|analysis| print_analysis(out, analysis))
}

fn print_analysis(out: &mut dyn Write, analysis: &Analysis) -> Result<(), Failure> {
    let Analysis { metric, decisions, exact, .. } = analysis;
    writeln!(out, "\n{metric}: {decisions} decisions, {exact} of them with all assignments")?;
    writeln!(
        out,
        "  grouping matters (best and worst assignment differ) in {} of the decisions",
        with_interval(analysis.matters.as_ref(), 100.0, " %")
    )?;
    for (name, estimate) in
        [("best", &analysis.best), ("fair draw", &analysis.drawn), ("worst", &analysis.worst)]
    {
        writeln!(out, "  {name:<9} {}", with_interval(estimate.as_ref(), 1.0, ""))?;
    }
    let mut table = headed(["policy", "regret", "best choice", "better ones", "achieved"]);
    for policy in &analysis.policies {
        table.add_row([
            right(&policy.policy),
            right(&with_interval(policy.regret.as_ref(), 1.0, "")),
            right(&with_interval(policy.best.as_ref(), 100.0, " %")),
            right(&with_interval(policy.outranked.as_ref(), 100.0, " %")),
            right(&with_interval(policy.achieved.as_ref(), 100.0, " %")),
        ]);
    }
    print_table(out, &table)?;
    let mut table = headed(["feature of an assignment", "rank correlation with the outcome", "decisions"]);
    for row in &analysis.features {
        table.add_row([
            right(&row.feature),
            right(&with_interval(row.correlation.as_ref(), 1.0, "")),
            right(&row.decisions.to_string()),
        ]);
    }
    print_table(out, &table)
}
