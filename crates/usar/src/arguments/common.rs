//! Single options that several commands have.

use std::ops::{Bound, RangeBounds};

use clap::builder::RangedU64ValueParser;
use clap::{ArgMatches, ValueEnum};
use experiments::experiment::{Experiment, PolicySpec, split_list, with_settings};
use reports::table::{Format, is_wide};
use usar_sim::scenario::Scenario;

use crate::bad_value::BadValue;
use crate::input::tell_warnings;
use crate::prelude::*;

/// Fields of a scenario that are set on the command line.
#[derive(Debug, Args)]
pub(crate) struct SetArguments {
    /// Set a field of the scenario, by its path, to a value in RON, e.g. `costs.energy.per_step=0.009`; can
    /// be given several times
    #[arg(long, value_name = "PATH=VALUE")]
    pub(crate) set: Vec<String>,
}

impl SetArguments {
    /// The scenario in a file, with its fields set.
    pub(crate) fn load(&self, file: &Path) -> Result<Scenario, Failure> {
        let (written, text) = Scenario::load(file).map_err(Failure::input)?;
        let scenario = with_settings(&written, &self.set)?;
        tell_warnings(&scenario, &text, file);
        Ok(scenario)
    }
}

/// A case of a sweep.
#[derive(Debug, Args)]
pub(crate) struct CaseArgument {
    /// Case of a sweep with axes, from 1 [default: 1, or all in a report]
    #[arg(long)]
    case: Option<usize>,
}

impl CaseArgument {
    /// The index of the case; `None` if no case is named.
    pub(crate) fn named(&self, experiment: &Experiment) -> Result<Option<usize>, Failure> {
        let cases = experiment.cases.len();
        match self.case {
            Some(case) if !(1..=cases).contains(&case) => {
                Err(Failure::input(format!("--case: must be from 1 to {cases}, found {case}")))
            }
            case => Ok(case.map(|case| case - 1)),
        }
    }

    /// The index of the case, by default the first.
    pub(crate) fn index(&self, experiment: &Experiment) -> Result<usize, Failure> {
        Ok(self.named(experiment)?.unwrap_or(0))
    }
}

/// Policies by name.
#[derive(Debug, Args)]
pub(crate) struct PoliciesArgument {
    /// Policies, separated by commas, by their labels or with their options in brackets, and with an estimator
    /// after `<-` [default: those of the sweep]
    #[arg(long)]
    pub(crate) policies: Option<String>,
}

impl PoliciesArgument {
    /// The names one by one.
    pub(crate) fn list(&self) -> Option<Vec<String>> {
        let list = self.policies.as_deref().map(split_list);
        list.map(|names| names.into_iter().map(str::to_owned).collect())
    }
}

/// The trust measure by which decisions are looked at.
#[derive(Debug, Clone, Args)]
pub(crate) struct MeasureArgument {
    /// Trust measure for a look at decisions, with its options [default: the policy's own; RNE where it has
    /// none and a measure is needed]
    #[arg(long, value_name = "MEASURE", hide_short_help = true)]
    measure: Option<String>,
}

impl MeasureArgument {
    /// The registry in which the named measure is chosen.
    pub(crate) fn chosen_in(&self, registry: &Registry) -> Result<Registry, Failure> {
        let mut registry = registry.clone();
        let chosen = self.measure.as_deref().map(|text| registry.choose_measure(text)).transpose();
        chosen.map_err(Failure::input_at("--measure"))?;
        Ok(registry)
    }
}

/// Whether files are replaced.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct ReplaceArgument {
    /// Replace files that are there already
    #[arg(long)]
    pub(crate) force: bool,
}

/// Whether the result is JSON.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct JsonArgument {
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// How tables are written.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct ShownArguments {
    /// How tables are written; with csv and latex, as with --json, sentences go to stderr
    #[arg(long, value_enum, default_value = "table", conflicts_with = "json")]
    format: FormatName,
    #[command(flatten)]
    pub(crate) as_json: JsonArgument,
}

impl ShownArguments {
    /// Whether the result is JSON.
    pub(crate) fn is_json(self) -> bool {
        self.as_json.json
    }
}

/// Whether tables have all their columns.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct WideArgument {
    /// Show all columns and tables, as in a terminal of 120 columns or more
    #[arg(long)]
    wide: bool,
}

impl WideArgument {
    /// Whether tables have all their columns: on request, and where there is room.
    pub(crate) fn is_wide(self) -> bool {
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
pub(crate) fn format_of(command: &ArgMatches) -> Format {
    let format = command.try_get_one::<FormatName>("format").ok().flatten();
    let is_json = command.try_get_one::<bool>("json").is_ok_and(|json| json == Some(&true));
    match format {
        Some(_) if is_json => Format::Json,
        None | Some(FormatName::Table) => Format::Table,
        Some(FormatName::Md) => Format::Markdown,
        Some(FormatName::Csv) => Format::Csv,
        Some(FormatName::Latex) => Format::Latex,
    }
}

/// Parses a policy that an option names.
pub(crate) fn parse_policy(flag: &str, text: &str, registry: &Registry) -> Result<PolicySpec, Failure> {
    PolicySpec::parse(text, registry).map_err(Failure::input_at(flag))
}

/// Parses a number within limits.
pub(crate) fn count(limits: impl RangeBounds<u32>) -> RangedU64ValueParser<u32> {
    let wide = |bound: Bound<&u32>| bound.map(|bound| u64::from(*bound));
    RangedU64ValueParser::new().range((wide(limits.start_bound()), wide(limits.end_bound())))
}

/// Parses how many assignments are played.
pub(crate) fn limit() -> RangedU64ValueParser<u64> {
    RangedU64ValueParser::new().range(2..=1_000_000)
}

/// Parses the seed of a trial.
pub(crate) fn one_seed(text: &str) -> Result<u64, BadValue> {
    text.parse().map_err(|_| BadValue::new("a whole number from 0 on", text))
}

/// Parses the first of many seeds.
pub(crate) fn seed() -> RangedU64ValueParser<u64> {
    RangedU64ValueParser::new().range(..u64::MAX / 2)
}

/// Parses a time interval from the command line.
pub(crate) fn seconds(text: &str) -> Result<f64, BadValue> {
    let seconds = text.parse().ok().filter(|seconds| (0.001..=100_000.0).contains(seconds));
    seconds.ok_or_else(|| BadValue::new("a number from 0.001 to 100000", text))
}

/// Parses a share of a range from the command line.
pub(crate) fn share(text: &str) -> Result<f64, BadValue> {
    let share = text.parse().ok().filter(|share| *share > 0.0 && *share <= 1.0);
    share.ok_or_else(|| BadValue::new("above 0 and at most 1", text))
}

/// Parses numbers separated by commas.
pub(crate) fn numbers(flag: &str, text: &str) -> Result<Vec<f64>, Failure> {
    let number = |(i, part): (usize, &str)| {
        part.trim().parse::<f64>().map_err(|_| {
            Failure::input(format!("{flag}: entry {} must be a number, found {:?}", i + 1, part.trim()))
        })
    };
    text.split(',').enumerate().map(number).collect()
}
