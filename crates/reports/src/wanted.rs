//! What a report is to show, and what it consists of.

use experiments::Failure;
use experiments::comparison::{Asked, Wishes};
use experiments::experiment::Experiment;

use crate::maps::ShownTrial;

/// What a report is to show.
pub struct Wanted {
    /// The comparisons.
    pub asked: Asked,
    /// Its title; none for the sweep's name.
    pub title: Option<String>,
    /// The case that gets a page, from 0; none for all.
    pub case: Option<usize>,
    /// Trials whose ways are drawn, with their replays, on the page of the case that is asked for, or of the
    /// first.
    pub shown: Vec<ShownTrial>,
}

impl Wanted {
    /// What a sweep's file asks, and no trial.
    ///
    /// # Errors
    /// What it asks is not right.
    pub fn of(experiment: &Experiment) -> Result<Self, Failure> {
        let asked = Asked::of(experiment, &Wishes::default())?;
        Ok(Self { asked, title: None, case: None, shown: Vec::new() })
    }
}

/// The files of a report, by their names from the folder on.
pub(crate) type Files = Vec<(String, Vec<u8>)>;
