//! The requested content of a report.

use experiments::Failure;
use experiments::comparison::{Asked, Wishes};
use experiments::experiment::Experiment;

use crate::maps::ShownTrial;

/// The requested content of a report.
pub struct Wanted {
    /// The comparisons.
    pub asked: Asked,
    /// Its title; `None` for the sweep's name.
    pub title: Option<String>,
    /// The case that gets a page, from 0; `None` for all.
    pub case: Option<usize>,
    /// Trials whose trajectories are drawn, with their replays. They are on the page of the selected case,
    /// or of the first.
    pub shown: Vec<ShownTrial>,
}

impl Wanted {
    /// The content that a sweep's file asks for, without any shown trial.
    ///
    /// # Errors
    /// The sweep file's questions are invalid.
    pub fn of(experiment: &Experiment) -> Result<Self, Failure> {
        let asked = Asked::of(experiment, &Wishes::default())?;
        Ok(Self { asked, title: None, case: None, shown: Vec::new() })
    }
}
