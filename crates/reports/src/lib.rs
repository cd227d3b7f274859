//! Results for people: the figures and the page of a sweep, and tables for the terminal.
//!
//! [`write_report`] makes `report.html` in a sweep's folder; [`table`] has tables as text. A page of another
//! crate takes its looks from [`STYLE`].

mod decisions;
mod drawing;
mod figures;
mod maps;
mod overview;
mod page;
mod regret;
pub mod table;

pub use maps::ShownTrial;
pub use page::{Wanted, write_report};
pub use regret::regret_figures;

/// The style sheet of all pages.
pub const STYLE: &str = include_str!("../templates/style.css");
