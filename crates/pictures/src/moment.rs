//! The state at one frame of a recording.

use recording::{Frame, Recording};

use crate::error::PictureError;
use crate::ground::{self, Lies};
use crate::picture::{Look, Picture};
use crate::team;

/// Draws the state at a frame of a recording, numbered from 0.
///
/// # Errors
/// There is no such frame.
pub fn moment(recording: &Recording, number: usize, look: &Look) -> Result<Picture, PictureError> {
    let (frame, world) = (recording.frame(number)?, &recording.header.world);
    let mut sheet = ground::begun(look, world, &title(recording, number, &frame));
    let on = recording.zones_on(frame.step);
    ground::draw_zones(&mut sheet, &world.zones, |zone| on[zone], |_| false);
    ground::draw_debris(&mut sheet, &world.debris, &places(&frame), |_| false);
    ground::draw_rescuees(&mut sheet, world, |rescuee| frame.rescuees[rescuee].state);
    ground::draw_names(&mut sheet, world);
    team::draw_routes(&mut sheet, world, &frame);
    team::draw_claims(&mut sheet, world, &frame);
    team::draw_robots(&mut sheet, world, &frame);
    team::draw_links(&mut sheet, &frame);
    let entries = team::moment_entries(world, sheet.unit);
    Ok(ground::finished(sheet, world, entries, [world.debris.len(), world.zones.len()]))
}

/// The poses of debris at a frame.
pub(crate) fn places(frame: &Frame) -> Vec<Lies> {
    let lies = |piece: &recording::MovedDebris| {
        (piece.position_mm.map(|mm| f64::from(mm) / 1000.0), f64::from(piece.angle) / 10_000.0)
    };
    frame.debris.iter().map(lies).collect()
}

/// The state of a rescuee that was delivered, as recordings number it.
const DELIVERED: u8 = 3;

/// The title: the trial, the time, and what was brought home so far.
fn title(recording: &Recording, number: usize, frame: &Frame) -> String {
    let header = &recording.header;
    let round = recording.decisions.iter().filter(|decided| decided.step <= frame.step).count();
    let tenths = (header.time_s_of(number) * 10.0).round() as u64;
    let time = format!("{}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10);
    let round = if round == 0 { String::new() } else { format!(", round {round}") };
    let rescued = frame.rescuees.iter().filter(|one| one.state == DELIVERED).count();
    let total = if frame.rescuees.is_empty() {
        String::new()
    } else {
        format!(": {}", header.world.words.text(&format!("{rescued} rescued")))
    };
    format!("{}, {time}{round}{total}", name_of(recording))
}

/// A name of the trial in words.
pub(crate) fn name_of(recording: &Recording) -> String {
    let header = &recording.header;
    if header.world.tasks.is_empty() {
        format!("{}, seed {}", header.scenario.name, header.seed)
    } else {
        format!("{}, {}, seed {}", header.scenario.name, header.policy, header.seed)
    }
}
