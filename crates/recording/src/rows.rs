//! What a frame is made of: numbers that stand in every frame, and rows that stand where they change.

use usar_sim::simulation::Simulation;

use crate::frame::{GroupFrame, Motion, MovedDebris, RescueeFrame, RobotState, Route, push_sets};

/// The numbers of each robot that stand in every frame.
pub(crate) const MOTION_FIELDS: [&str; 6] =
    ["x_mm", "y_mm", "vx_mm_s", "vy_mm_s", "energy_millipercent", "hp_millipercent"];

/// How many of these are positions, which are predicted from the two frames before; the others are predicted to stay.
pub(crate) const POSITIONS: usize = 2;

/// The streams of rows that stand only where they change.
pub(crate) const STREAMS: [&str; 6] = ["robots", "routes", "rescuees", "debris", "groups", "conflicts"];

/// Place of the rescuees in [`STREAMS`].
pub(crate) const RESCUEES: usize = 2;

/// Whether a row of a stream never changes.
pub(crate) fn is_fixed(simulation: &Simulation, stream: usize, row: usize) -> bool {
    let piece = |row: usize| &simulation.world().debris[row];
    stream == 3 && piece(row).is_fixed && !piece(row).is_gate
}

/// The numbers of one row of a stream, now.
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

/// The motion of a robot, now.
pub(crate) fn motion(simulation: &Simulation, robot: usize) -> [i32; MOTION_FIELDS.len()] {
    Motion::of(&simulation.world().robots[robot]).numbers()
}
