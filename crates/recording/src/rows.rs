//! The parts of a frame: numbers that are stored in every frame, and rows that are stored only when they
//! change.

use usar_sim::simulation::Simulation;

use crate::frame::{GroupFrame, MovedDebris, RescueeFrame, RobotState, Route, Stored, push_sets};

/// The first numbers of a robot's motion are positions. They are predicted by extrapolation from the two
/// frames before; the other numbers are predicted to stay the same.
pub(crate) const POSITIONS: usize = 2;

/// The streams of rows that are stored only when they change.
pub(crate) const STREAMS: [&str; 6] = ["robots", "routes", "rescuees", "debris", "groups", "conflicts"];

/// Index of the rescuees in [`STREAMS`].
pub(crate) const RESCUEES: usize = 2;

/// Whether a row of a stream never changes.
pub(crate) fn is_fixed(simulation: &Simulation, stream: usize, row: usize) -> bool {
    let piece = |row: usize| &simulation.world().debris[row];
    stream == 3 && piece(row).is_fixed() && !piece(row).is_gate()
}

/// Appends the current numbers of one row of a stream.
pub(crate) fn write_row(simulation: &Simulation, stream: usize, row: usize, out: &mut Vec<i32>) {
    match stream {
        0 => RobotState::of(simulation, row).write(out),
        1 => Route::write_now(simulation, row, out),
        RESCUEES => RescueeFrame::of(simulation, row).write(out),
        3 => MovedDebris::of(simulation, row).write(out),
        4 => GroupFrame::write_now(simulation, row, out),
        _ => push_sets(simulation, out),
    }
}
