//! Arguments that several commands have: one group for each thing, with one text for each option.

mod common;
mod family;
mod parameters;
mod picture;
mod progress;
mod selection;
mod trial;

pub use common::{
    CaseArgument, MeasureArgument, ProgramsArgument, ReplaceArgument, SetArguments, ShownArguments, count,
    one_seed, parse_policy, seed, share,
};
pub(crate) use common::{JsonArgument, PoliciesArgument, WideArgument, format_of, limit, numbers, seconds};
pub(crate) use family::{ComparisonArguments, FamilyArguments};
pub(crate) use parameters::ParameterArguments;
pub(crate) use picture::{LookArguments, PictureFile, width};
pub use progress::{ProgressArguments, opened};
pub(crate) use progress::{default_jobs, progress_bar};
pub(crate) use selection::{Selection, WorldArgument};
pub(crate) use trial::{Trial, TrialArguments};
