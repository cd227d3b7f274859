//! Every event of a trial as a line of JSON.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use experiments::Failure;
use recording::{Names, ToldEvent};
use usar_sim::simulation::Simulation;

/// The file that is being written.
pub(super) struct EventLines {
    path: PathBuf,
    file: BufWriter<File>,
}

impl EventLines {
    /// Begins a new file.
    pub(super) fn begin(path: &Path) -> Result<Self, Failure> {
        let file = File::create_new(path).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => {
                Failure::input(format!("--events: {} exists; nothing was overwritten", path.display()))
            }
            _ => Failure::storage(format!("cannot write {}: {error}", path.display())),
        })?;
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
        Failure::storage(format!("cannot write {}: {error}", self.path.display()))
    }
}

/// The events of the last step in words.
pub(super) fn told(simulation: &Simulation) -> impl Iterator<Item = ToldEvent> + '_ {
    let scenario = simulation.scenario();
    let tasks: Vec<&str> = scenario.tasks.iter().map(|task| task.name.as_str()).collect();
    let (step, dt_s) = (simulation.steps(), scenario.dt_s);
    let layout = simulation.layout();
    simulation.events().iter().map(move |event| {
        let names = Names { tasks: &tasks, debris: &layout.debris, zones: &layout.zones };
        ToldEvent::new(step, dt_s, event, names)
    })
}
