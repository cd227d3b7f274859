//! Arguments that several commands have: one group for each thing, with one text for each option.

mod common;
mod family;
mod parameters;
mod picture;
mod progress;
mod selection;
mod trial;

pub(crate) use common::{
    CaseArgument, JsonArgument, MeasureArgument, PoliciesArgument, ReplaceArgument, SetArguments,
    ShownArguments, WideArgument, count, format_of, limit, numbers, one_seed, parse_policy, seconds, seed,
    share,
};
pub(crate) use family::{ComparisonArguments, FamilyArguments};
pub(crate) use parameters::ParameterArguments;
pub(crate) use picture::{LookArguments, PictureArguments, PictureFile, width};
pub(crate) use progress::{ProgressArguments, default_jobs, opened, progress_bar};
pub(crate) use selection::{Selection, WorldArgument};
pub(crate) use trial::{Trial, TrialArguments};
