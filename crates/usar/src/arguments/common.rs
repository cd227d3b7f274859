//! Single options that several commands have.

use std::ops::{Bound, RangeBounds};

use clap::builder::RangedU64ValueParser;
use clap::{ArgMatches, ValueEnum};
use experiments::experiment::{Experiment, PolicySpec, split_list, with_settings};
use experiments::oracle::LIMITS;
use scenario::Scenario;
use tables::{Format, is_wide};

use crate::bad_value::BadValue;
use crate::input::tell_warnings;
use crate::prelude::*;

/// Fields of a scenario that are set on the command line.
#[derive(Debug, Args)]
pub struct SetArguments {
    /// Set a field of the scenario, by its path, to a value in RON, e.g. `costs.energy.per_step=0.009`; can
    /// be given several times
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
}

impl SetArguments {
    /// The scenario in a file, with its fields set.
    ///
    /// # Errors
    /// All problems of the file, or of a field that is set.
    pub fn load(&self, file: &Path) -> Result<Scenario, Failure> {
        let (written, text) = Scenario::load(file).map_err(Failure::input)?;
        let scenario = with_settings(&written, &self.set)?;
        tell_warnings(&scenario, &text, file);
        Ok(scenario)
    }
}

/// A case of a sweep.
#[derive(Debug, Args)]
pub struct CaseArgument {
    /// Case of a sweep with axes, from 1 [default: 1, or all in a report]
    #[arg(long)]
    case: Option<usize>,
}

impl CaseArgument {
    /// The index of the case; `None` if no case is named.
    ///
    /// # Errors
    /// The sweep has no such case.
    pub fn named(&self, experiment: &Experiment) -> Result<Option<usize>, Failure> {
        let cases = experiment.cases.len();
        match self.case {
            Some(case) if !(1..=cases).contains(&case) => {
                Err(Failure::input(format!("--case: must be from 1 to {cases}, found {case}")))
            }
            case => Ok(case.map(|case| case - 1)),
        }
    }

    /// The index of the case, by default the first.
    ///
    /// # Errors
    /// The sweep has no such case.
    pub fn index(&self, experiment: &Experiment) -> Result<usize, Failure> {
        Ok(self.named(experiment)?.unwrap_or(0))
    }
}

/// Policies by name.
#[derive(Debug, Args)]
pub struct PoliciesArgument {
    /// Policies, separated by commas, by their labels or with their options in brackets, and with an
    /// estimator after `<-` [default: those of the sweep]
    #[arg(long)]
    pub policies: Option<String>,
}

impl PoliciesArgument {
    /// The names one by one.
    pub fn list(&self) -> Option<Vec<String>> {
        let list = self.policies.as_deref().map(split_list);
        list.map(|names| names.into_iter().map(str::to_owned).collect())
    }
}

/// The trust measure by which decisions are looked at.
#[derive(Debug, Clone, Args)]
pub struct MeasureArgument {
    /// Trust measure for a look at decisions, with its options [default: the policy's own; RNE where it has
    /// none and a measure is needed]
    #[arg(long, value_name = "MEASURE", hide_short_help = true)]
    measure: Option<String>,
}

impl MeasureArgument {
    /// The registry in which the named measure is chosen.
    ///
    /// # Errors
    /// There is no such measure, or it does not take the options.
    pub fn chosen_in(&self, registry: &Registry) -> Result<Registry, Failure> {
        let mut registry = registry.clone();
        let chosen = self.measure.as_deref().map(|text| registry.choose_measure(text)).transpose();
        chosen.map_err(Failure::input_at("--measure"))?;
        Ok(registry)
    }
}

/// Whether programs that a file names are started.
#[derive(Debug, Clone, Copy, Args)]
pub struct ProgramsArgument {
    /// Start the programs that a file names as policies, and allow them from now on
    #[arg(long, global = true, hide_short_help = true)]
    pub run_programs: bool,
}

/// Whether files are replaced.
#[derive(Debug, Clone, Copy, Args)]
pub struct ReplaceArgument {
    /// Replace files that are there already
    #[arg(long)]
    pub force: bool,
}

/// Whether the result is JSON.
#[derive(Debug, Clone, Copy, Args)]
pub struct JsonArgument {
    /// Print the sentences and the tables as one object of JSON
    #[arg(long)]
    pub json: bool,
}

/// How tables are written.
#[derive(Debug, Clone, Copy, Args)]
pub struct ShownArguments {
    /// How tables are written; with csv and latex, as with --json, sentences go to stderr
    #[arg(long, value_enum, default_value = "table", conflicts_with = "json")]
    format: FormatName,
    #[command(flatten)]
    pub(crate) as_json: JsonArgument,
}

impl ShownArguments {
    /// Whether the result is JSON.
    pub fn is_json(self) -> bool {
        self.as_json.json
    }
}

/// Whether tables have all their columns.
#[derive(Debug, Clone, Copy, Args)]
pub struct WideArgument {
    /// Show all columns and tables, as in a terminal of 120 columns or more
    #[arg(long)]
    wide: bool,
}

impl WideArgument {
    /// Whether tables have all their columns: on request, and where there is room.
    pub fn is_wide(self) -> bool {
        self.wide || is_wide()
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FormatName {
    Table,
    Md,
    Csv,
    Latex,
}

/// The format of tables that the arguments of a command select.
pub fn format_of(command: &ArgMatches) -> Format {
    let format = command.try_get_one::<FormatName>("format").ok().flatten();
    let is_json = command.try_get_one::<bool>("json").is_ok_and(|json| json == Some(&true));
    match format {
        _ if is_json => Format::Json,
        None | Some(FormatName::Table) => Format::Table,
        Some(FormatName::Md) => Format::Markdown,
        Some(FormatName::Csv) => Format::Csv,
        Some(FormatName::Latex) => Format::Latex,
    }
}

/// Parses a policy that an option names.
///
/// # Errors
/// There is no such policy, or it does not take the options.
pub fn parse_policy(flag: &str, text: &str, registry: &Registry) -> Result<PolicySpec, Failure> {
    PolicySpec::parse(text, registry).map_err(Failure::input_at(flag))
}

/// Parses a number within limits.
pub fn count(limits: impl RangeBounds<u32>) -> RangedU64ValueParser<u32> {
    let wide = |bound: Bound<&u32>| bound.map(|bound| u64::from(*bound));
    RangedU64ValueParser::new().range((wide(limits.start_bound()), wide(limits.end_bound())))
}

/// Parses how many assignments are played.
pub fn limit() -> RangedU64ValueParser<u64> {
    RangedU64ValueParser::new().range(LIMITS)
}

/// Parses the seed of a trial.
///
/// # Errors
/// It is no whole number from 0 on.
pub fn one_seed(text: &str) -> Result<u64, BadValue> {
    text.parse().map_err(|_| BadValue::new("a whole number from 0 on", text))
}

/// Parses the first of many seeds.
pub fn seed() -> RangedU64ValueParser<u64> {
    RangedU64ValueParser::new().range(..u64::MAX / 2)
}

/// Parses a time interval from the command line.
pub fn seconds(text: &str) -> Result<f64, BadValue> {
    let seconds = text.parse().ok().filter(|seconds| (0.001..=100_000.0).contains(seconds));
    seconds.ok_or_else(|| BadValue::new("a number from 0.001 to 100000", text))
}

/// Parses a share of a range from the command line.
///
/// # Errors
/// It is no number above 0 and at most 1.
pub fn share(text: &str) -> Result<f64, BadValue> {
    let share = text.parse().ok().filter(|share| *share > 0.0 && *share <= 1.0);
    share.ok_or_else(|| BadValue::new("above 0 and at most 1", text))
}

/// Parses numbers separated by commas.
pub fn numbers(flag: &str, text: &str) -> Result<Vec<f64>, Failure> {
    let number = |(i, part): (usize, &str)| {
        part.trim().parse::<f64>().map_err(|_| {
            Failure::input(format!("{flag}: entry {} must be a number, found {:?}", i + 1, part.trim()))
        })
    };
    text.split(',').enumerate().map(number).collect()
}
