//! The trajectories of all robots in a trial, on one map.

use recording::Recording;

use crate::error::PictureError;
use crate::ground;
use crate::legend::{Entry, Sign};
use crate::moment::{name_of, places};
use crate::picture::{Look, Picture};
use crate::shapes::shapes_of;
use crate::sheet::Sheet;
use crate::svg::{Num, Path};
use crate::team::{self, colour_of};
use crate::theme::{INK, PAPER};

/// Largest distance between a drawn line and the trajectory that it shows, in pixels.
const BESIDE: f64 = 0.15;

/// A part of a robot's trajectory during which its group stays the same.
struct Stretch {
    robot: usize,
    task: Option<u32>,
    places_mm: Vec<[i32; 2]>,
}

/// Draws the trajectories of all robots in a trial: thin lines in the colours of their groups, from the
/// robots' homes to their last positions.
///
/// # Errors
/// The recording has no frames.
pub fn trails(recording: &Recording, look: &Look) -> Result<Picture, PictureError> {
    let world = &recording.header.world;
    let last = recording.frame(recording.frames().saturating_sub(1))?;
    let title = format!("{}: ways of all robots", name_of(recording));
    let mut sheet = ground::begun(look, world, &title);
    ground::draw_zones(&mut sheet, &world.zones, |_| true, |_| false);
    ground::draw_debris(&mut sheet, &world.debris, &places(&last), |_| false);
    ground::draw_rescuees(&mut sheet, world, |_| 0);
    for stretch in stretches(recording)? {
        let colour = colour_of(world, stretch.robot, stretch.task);
        let width = Num(0.8 * sheet.unit);
        let looks = format!(
            "fill=\"none\" stroke=\"{colour}\" stroke-opacity=\"0.5\" stroke-width=\"{width}\" \
             stroke-linejoin=\"round\""
        );
        let way = way(&sheet, &stretch);
        sheet.svg.path(&way, &looks);
    }
    ground::draw_names(&mut sheet, world);
    let shapes = shapes_of(&world.roles);
    for (number, robot) in last.robots.iter().enumerate() {
        let mut end = Path::default();
        let at = sheet.at_mm(robot.motion.position_mm);
        shapes[world.robots[number].role].add(at, 2.6 * sheet.unit, &mut end);
        sheet.svg.path(&end, &end_looks(colour_of(world, number, robot.state.task), sheet.unit));
    }
    let mut entries = team::entries(world);
    entries.push(Entry::new(Sign::Disc(end_looks(INK, sheet.unit)), "the end of a way"));
    Ok(ground::finished(sheet, world, entries, [world.debris.len(), world.zones.len()]))
}

fn end_looks(colour: &str, unit: f64) -> String {
    format!("fill=\"{PAPER}\" stroke=\"{colour}\" stroke-width=\"{}\"", Num(unit))
}

/// The trajectories of all robots, split where their groups change.
fn stretches(recording: &Recording) -> Result<Vec<Stretch>, PictureError> {
    let robots = recording.header.world.robots.len();
    let mut underway: Vec<Option<Stretch>> = (0..robots).map(|_| None).collect();
    let mut done = Vec::new();
    for number in 0..recording.frames() {
        let frame = recording.frame(number)?;
        for (robot, (now, stretch)) in frame.robots.iter().zip(&mut underway).enumerate() {
            let (place, task) = (now.motion.position_mm, now.state.task);
            match stretch {
                Some(stretch) if stretch.task == task => {
                    if stretch.places_mm.last() != Some(&place) {
                        stretch.places_mm.push(place);
                    }
                }
                _ => {
                    let start = stretch.as_ref().and_then(|before| before.places_mm.last().copied());
                    let places_mm = start.into_iter().chain([place]).collect();
                    done.extend(stretch.replace(Stretch { robot, task, places_mm }));
                }
            }
        }
    }
    done.extend(underway.into_iter().flatten());
    Ok(done)
}

/// A stretch as a line with as few corners as possible.
fn way(sheet: &Sheet, stretch: &Stretch) -> Path {
    let mut way = Path::default();
    let places: Vec<[f64; 2]> = stretch.places_mm.iter().map(|place| sheet.at_mm(*place)).collect();
    if let [first, .., _] = places[..] {
        let mut corners = vec![first];
        add_corners(&places, &mut corners);
        way.line(corners);
    }
    way
}

/// Adds the corners of a line after its first point: those without which it would be farther than [`BESIDE`]
/// from its points (Ramer 1972; Douglas and Peucker 1973).
fn add_corners(line: &[[f64; 2]], corners: &mut Vec<[f64; 2]>) {
    let [first, inside @ .., last] = line else { return };
    let far = inside.iter().enumerate().fold((0, 0.0), |far, (i, point)| {
        let distance = distance_to([*first, *last], *point);
        if distance >= far.1 { (i + 1, distance) } else { far }
    });
    match far {
        (corner, distance) if distance > BESIDE => {
            add_corners(&line[..=corner], corners);
            add_corners(&line[corner..], corners);
        }
        _ => corners.push(*last),
    }
}

/// The distance of a point to a segment.
fn distance_to([a, b]: [[f64; 2]; 2], [x, y]: [f64; 2]) -> f64 {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let square = dx * dx + dy * dy;
    let along = ((x - a[0]) * dx + (y - a[1]) * dy) / square;
    if square == 0.0 || along <= 0.0 {
        (x - a[0]).hypot(y - a[1])
    } else if along >= 1.0 {
        (x - b[0]).hypot(y - b[1])
    } else {
        (((a[1] - y) * dx - (a[0] - x) * dy) / square).abs() * dx.hypot(dy)
    }
}
