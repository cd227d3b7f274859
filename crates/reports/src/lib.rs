//! Results for people: the figures and the page of a sweep, and tables for the terminal.
//!
//! [`write_report`] makes `report.html` in a sweep's folder; [`table`] has tables as text. Pages of other
//! crates extend `templates/page.html`.

mod case;
mod chart;
mod deceit;
mod decisions;
mod drawing;
mod explored;
mod figures;
mod maps;
mod overview;
mod paper;
mod report;
pub mod table;
mod wanted;

pub use chart::{Labels, Series, chart};
pub use deceit::deceit_figures;
pub use explored::{ranking, sensitivity_figure, sensitivity_table};
pub use figures::{distrust_map, regret_figures};
pub use maps::ShownTrial;
pub use paper::{ColumnLook, LEAST_TEXT_POINTS, column_figure};
pub use report::write_report;
pub use wanted::Wanted;
