//! Snapshots of trials as files.

use experiments::experiment::PolicySpec;
use experiments::limits::SNAPSHOT_BYTES;
use ron_tree::file;
use scenario::Scenario;
use usar_sim::record::Status;
use usar_sim::simulation::Simulation;
use usar_sim::snapshot::{Identity, START_BYTES, check_start};

use crate::prelude::*;

/// A snapshot that was read from a file.
pub(super) struct Snapshot {
    path: PathBuf,
    bytes: Vec<u8>,
    /// The trial to which the snapshot belongs.
    pub(super) identity: Identity,
}

impl Snapshot {
    /// Reads a file and checks its integrity.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let most = SNAPSHOT_BYTES.most as u64;
        let (start, length) =
            file::read_start(path, START_BYTES, most).map_err(Failure::input_at(path.display()))?;
        check_start(&start, length).map_err(Failure::input_at(path.display()))?;
        let bytes = file::read(path, most).map_err(Failure::input_at(path.display()))?;
        let identity = Identity::of(&bytes).map_err(Failure::input_at(path.display()))?;
        Ok(Self { path: path.to_owned(), bytes, identity })
    }

    /// The trial, at the step where the snapshot was taken.
    pub(super) fn restore(&self, scenario: &Scenario) -> Result<Simulation, Failure> {
        Simulation::restore(scenario, &self.bytes).map_err(Failure::input_at(self.path.display()))
    }
}

/// Runs a trial up to a time, in seconds, and writes a snapshot of it, completely or not at all.
pub(super) fn save(
    simulation: &mut Simulation,
    spec: &PolicySpec,
    path: &Path,
    seconds: f64,
) -> Result<(), Failure> {
    let mut session = session_of(spec, simulation.scenario(), simulation.seed())?;
    let (now, end) = (simulation.time_s(), simulation.scenario().duration_s);
    if !(now..=end).contains(&seconds) {
        refuse!("--save-at: must be from {now} to {end} s, found {seconds}");
    }
    let to = Destination::new("--save", path, false)?;
    while simulation.time_s() < seconds {
        if let Some(status) = simulation.step(&mut *session) {
            if let Status::Failed(reason) = status {
                return Err(Failure::run(reason));
            }
            let (status, time_s) = (status.name().replace('_', " "), simulation.time_s());
            refuse!("--save-at: the trial ended at {time_s} s already: {status}");
        }
    }
    to.write(&simulation.snapshot(&spec.plain()))
}
