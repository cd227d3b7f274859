//! Every event of a trial as a line of JSON.

use std::fs::File;
use std::io::{self, BufWriter};

use recording::told;
use usar_sim::simulation::Simulation;

use crate::output::{create_new, trouble};
use crate::prelude::*;

/// The file that is being written.
pub(super) struct EventLines {
    path: PathBuf,
    file: BufWriter<File>,
}

impl EventLines {
    /// Begins a new file.
    pub(super) fn begin(path: &Path) -> Result<Self, Failure> {
        let file = create_new("--events", path)?;
        Ok(Self { path: path.to_owned(), file: BufWriter::new(file) })
    }

    /// Writes the events of a step. Call it after each step.
    pub(super) fn listen(&mut self, simulation: &Simulation) -> Result<(), Failure> {
        for told in told(simulation) {
            let line = serde_json::to_string(&told).map_err(Failure::run)?;
            writeln!(self.file, "{line}").map_err(|error| self.trouble(&error))?;
        }
        Ok(())
    }

    /// Flushes the last lines to the file.
    pub(super) fn finish(mut self) -> Result<(), Failure> {
        self.file.flush().map_err(|error| self.trouble(&error))
    }

    fn trouble(&self, error: &io::Error) -> Failure {
        trouble("--events", &self.path, error)
    }
}
