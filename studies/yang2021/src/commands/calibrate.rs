//! `usar yang2021 calibrate`: fits parameters of a scenario to recorded trials of the distance
//! baseline.

mod choose;

use experiments::comparison::short;
use experiments::explore::Parameter;
use experiments::files::NewFile;
use experiments::job::interrupted;
use rayon::prelude::*;
use ron_tree::{Node, edited};
use scenario::Scenario;
use yang2021::calibration::{
    Calibration, Evaluation, Fit, Log, POLICY, Spread, Target, best, open, the_policy, write_fit,
};
use yang2021::table::fit_table;

use usar::arguments::{ProgressArguments, SetArguments, ShownArguments, count, seed, share};
use usar::input::load;
use usar::prelude::*;

/// Name of the calibrated scenario.
const CALIBRATED: &str = "calibrated.ron";

/// Fit a scenario's free parameters to recorded trials of the distance baseline (DIS)
#[derive(Debug, Args)]
#[command(after_help = "\
Only DIS is ever run: how other policies fare in the calibrated world is a result, not an aim.

A parameter is a field of the scenario and its range; with `+` it sets several fields, each in a fixed \
ratio; `[*]` is every entry of a list; `log` searches the range by factors. Each must be written in FILE: \
what is found takes its place there, and comments stay.

The misfit is the sum, over the columns that the target shares with trials.csv (rescuees, energy, HP of each \
task; rounds), of the squared distance of the means in standard errors, plus the squared logarithm of the \
ratio of the standard deviations in standard errors, so that few recorded trials bind less: of a true model \
it is about twice the number of columns. A value near an end of its range adds up to 4. The search is by \
least squares: each distance is modelled as linear in the parameters, by a regression on the candidates near \
the present one, and the model's minimum is tried next. Each evaluation is on disk as soon as it is done; \
the same command resumes where it stopped, and more --evaluations go on from there. The folder gets \
evaluations.jsonl (the log), calibrated.ron, fit.csv and calibration.json.

With --choose, the results of several calibrations run the same seeds, which none was fitted to. The one \
with the least misfit is the choice. Then the recorded trials and the seeds are drawn anew 4,000 times: a \
candidate that is the nearest in at least 5 % of the draws cannot be told from the choice by these data. \
--out is a CSV then; \
identified.csv beside it says how well the values of each are known, and which trade off.

Examples:
  usar yang2021 calibrate scenarios/paper.ron --target scenarios/reference/dis_trials.csv \\
      --over 'costs.energy.per_metre=0.1..1 log' --over 'radiation[*].radius_m=3..14' \\
      --over 'roles.carrier.speed_mps + roles.supplier.speed_mps + roles.observer.speed_mps*0.66667=1.5..6' \\
      --set costs.energy.per_step=0.0 --set mission.energy_turn_back=WhenHome
  usar yang2021 calibrate --choose results/calibration/* --target scenarios/reference/dis_trials.csv")]
pub(crate) struct Arguments {
    /// Scenario (RON)
    #[arg(required_unless_present = "choose")]
    file: Option<PathBuf>,
    /// Recorded trials (CSV with a column `method` that says DIS)
    #[arg(long, value_name = "CSV")]
    target: PathBuf,
    /// A parameter and its range: `PATH=LOW..HIGH`; `PATH + PATH*RATIO=LOW..HIGH log` sets several fields and
    /// goes by factors; `[*]` is every entry of a list; `PATH=[VALUE, VALUE]` chooses; can be given several
    /// times
    #[arg(long, value_name = "PATH=LOW..HIGH", required_unless_present = "choose")]
    over: Vec<String>,
    #[command(flatten)]
    set: SetArguments,
    /// Choose among the results of these folders of finished calibrations
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = ["file", "over", "set", "fresh"])]
    choose: Vec<PathBuf>,
    /// Candidates to ask for, the start among them
    #[arg(long, default_value_t = 100, value_parser = count(1..=1_000_000))]
    evaluations: u32,
    /// Trials of each policy, in each case or candidate [default: 10; to choose 40]
    #[arg(long, value_parser = count(2..=100_000))]
    trials: Option<u32>,
    /// Seed of the first trial [default: 100001; to choose 200001]
    #[arg(long, hide_short_help = true, value_parser = seed())]
    first_seed: Option<u64>,
    /// Trials, with seeds from 1, on which what was found is looked at afterwards
    #[arg(long, default_value_t = 100, hide_short_help = true, value_parser = count(2..=100_000))]
    fresh_trials: u32,
    /// How far the first candidates are from the scenario as it is, as a share of each range
    #[arg(long, default_value_t = 0.1, value_name = "SHARE", value_parser = share, hide_short_help = true)]
    first_step: f64,
    /// File or folder to write [default: results/NAME-calibration; to choose none]
    #[arg(long)]
    out: Option<PathBuf>,
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
        if !self.choose.is_empty() {
            return choose::execute(self, registry);
        }
        let calibration = self.calibration(registry)?;
        let name = format!("{}-calibration", calibration.base.name);
        let folder = self.out.clone().unwrap_or_else(|| Path::new("results").join(name));
        let mut log = open(&folder, &calibration, self.fresh)?;
        let is_whole = self.search(&calibration, &mut log)?;
        let stopped = |log: &Log| interrupted(&folder, format!("{} evaluations are", log.entries.len()));
        if !is_whole {
            return Err(stopped(&log));
        }
        let best = best(&log).ok_or_else(|| {
            let reason = log.entries.first().and_then(|evaluation| evaluation.failure.clone());
            Failure::run(format!("no candidate could be run: {}", reason.unwrap_or_default()))
        })?;
        let text = calibration.fitted_text(best).map_err(Failure::run)?;
        NewFile::write(&folder, CALIBRATED, text.as_bytes())?;
        let fresh = self.progress.work(1, "fresh trials", |_| {
            let seeds = (1..=u64::from(self.fresh_trials)).into_par_iter();
            calibration.measure(&best.values, seeds, &STOP).map_err(Failure::run)
        })??;
        let Some(fresh) = fresh else { return Err(stopped(&log)) };
        let fresh: Vec<Spread> = fresh.iter().filter_map(|values| Spread::of(values)).collect();
        let rows = Fit::rows(&calibration, &best.spreads, &fresh);
        write_fit(&folder, &rows)?;
        self.told(&calibration, &log, best, &rows).print()?;
        self.progress.tell(format_args!("results in {}", folder.display()));
        Ok(Report::default())
    }

    fn calibration(&self, registry: &Registry) -> Result<Calibration, Failure> {
        let first_seed = self.first_seed.unwrap_or(100_001);
        if first_seed <= u64::from(self.fresh_trials) {
            refuse!(
                "--first-seed: must be beyond the fresh trials, whose seeds are 1 to {}, found {}",
                self.fresh_trials,
                first_seed
            );
        }
        let file = self.file.as_deref().unwrap_or(Path::new(""));
        let (given, text) = load(file)?;
        let known = given.tree();
        let mut settings = Vec::new();
        for entry in &self.set.set {
            let pair = entry.split_once('=');
            let (path, value) =
                pair.ok_or_else(|| Failure::input(format!("--set: must be path=value, found {entry:?}")))?;
            let path = path.trim();
            if known.get(path).is_none() {
                refuse!("--set: {}", known.unknown(path, "a scenario"));
            }
            settings.push((path.to_owned(), value.to_owned()));
        }
        let text = edited(&text, &settings).map_err(Failure::input_at("--set"))?;
        let base = Scenario::parse(&text, file).map_err(Failure::input)?;
        let fields = Node::parse(&text).map_err(Failure::run)?;
        let parse = |spec: &String| Parameter::parse(spec, &fields, &known);
        let free = self.over.iter().map(parse).collect::<Result<Vec<_>, _>>();
        let free = free.map_err(Failure::input_at("--over"))?;
        if let Some((path, _)) = settings.iter().find(|(path, _)| free.iter().any(|free| free.is_of(path))) {
            refuse!("--set: {path} is free");
        }
        let target = Target::load(&self.target, &base)?;
        let (trials, first_step) = (self.trials.unwrap_or(10), self.first_step);
        let policy = the_policy(registry)?;
        let calibration = Calibration { text, base, policy, free, target, trials, first_seed, first_step };
        calibration.check()?;
        Ok(calibration)
    }

    fn search(&self, calibration: &Calibration, log: &mut Log) -> Result<bool, Failure> {
        let there = log.entries.len();
        self.progress.tell_resumed(there, "evaluations");
        if there == 0 && !self.progress.quiet {
            say_what_is_moved(calibration)?;
        }
        self.progress.work(self.evaluations as usize, "evaluations", |bar| {
            calibration.search(self.evaluations as usize, log, &STOP, |asked, least| {
                bar.set_position(asked as u64);
                bar.set_message(format!("(least misfit {})", short(least)));
            })
        })?
    }

    fn told(&self, calibration: &Calibration, log: &Log, best: &Evaluation, rows: &[Fit]) -> Report {
        let evaluations = log.entries.len();
        let free = calibration.free.iter().zip(&best.values);
        let mut out = Report::of(free.map(|(free, value)| free.found(*value)));
        if log.entries.first().is_some_and(|first| first.values == best.values) {
            out.say("no candidate is nearer to the data than the start");
        }
        out.show("fit", fit_table(rows));
        let (trials, first) = (calibration.trials, calibration.first_seed);
        let last = first + u64::from(trials) - 1;
        out.say(format!(
            "mean ± sample standard deviation of {POLICY}; fitted: {trials} trials (seeds {first} to \
             {last}), misfit {} after {evaluations} evaluations;\n\
             fresh: {} trials (seeds from 1) that no candidate was judged by; data: {} trials",
            short(best.misfit),
            self.fresh_trials,
            calibration.target.trials
        ));
        let missing = &calibration.target.missing;
        if !missing.is_empty() {
            out.say(format!("not in the data, and not looked at: {}", missing.join(", ")));
        }
        out
    }
}

/// Notes the parameters whose start differs from the scenario, because the scenario's value is outside the
/// range.
fn say_what_is_moved(calibration: &Calibration) -> Result<(), Failure> {
    let values = calibration.present()?.into_iter().zip(calibration.start()?);
    for (free, (is, begins)) in
        calibration.free.iter().zip(values).filter(|(_, (is, begins))| is.to_bits() != begins.to_bits())
    {
        tell(format_args!("note: {} is {is}, outside its range; the search begins at {begins}", free.name));
    }
    Ok(())
}
