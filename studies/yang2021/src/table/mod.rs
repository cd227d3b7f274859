//! Tables of the study, for people.

mod claims;
mod fit;
mod predictions;
mod readings;

pub(crate) use claims::{claims_table, examples_table, power_table, ranges_table, verdicts_table};
pub use fit::{choice_table, fit_table};
pub(crate) use predictions::predictions_table;
pub use readings::{averaged_table, readings_table, rivals_table};
