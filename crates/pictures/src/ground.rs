//! The surroundings of robots: the floor, the places of the tasks, radiation, debris and rescuees.

use recording::World;
use scenario::{DebrisFile, DebrisShape, Point, ZoneFile};

use crate::legend::{Entry, Sign};
use crate::picture::{Look, Picture};
use crate::shapes::corners;
use crate::sheet::Sheet;
use crate::svg::{Anchor, Lettering, Num, Path};
use crate::theme::{
    DEBRIS, FAINT, GROUND, INK, MOVABLE, RADIATION, RADIATION_EDGE, RESCUEE, SOFT, WALL, colour,
};

/// Distance between the grid lines of the floor, in metres.
const GRID_M: f64 = 10.0;

/// Largest number of grid lines of the floor in one direction.
const MOST_LINES: f64 = 60.0;

/// A sheet with the floor and the places of a world, whose window is open.
pub(crate) fn begun<'l>(look: &'l Look, world: &World, title: &str) -> Sheet<'l> {
    let mut sheet = Sheet::new(look, world.arena_m, title);
    draw_floor(&mut sheet);
    let [corner, size] = sheet.map();
    sheet.svg.begin_window(corner, size);
    draw_places(&mut sheet, world);
    sheet
}

/// The picture with its walls and its legend: these entries, then those of the ground; `first_sampled` as in
/// a [`Plan`](crate::Plan).
pub(crate) fn finished(
    mut sheet: Sheet,
    world: &World,
    mut legend: Vec<Entry>,
    first_sampled: [usize; 2],
) -> Picture {
    sheet.svg.end_window();
    draw_walls(&mut sheet);
    legend.extend(entries(world, sheet.unit, first_sampled));
    sheet.finish(legend)
}

/// Draws the arena's floor.
fn draw_floor(sheet: &mut Sheet) {
    let [corner, size] = sheet.map();
    sheet.svg.rect(corner, size, 0.0, &format!("fill=\"{GROUND}\""));
    let mut lines = Path::default();
    let step = GRID_M * sheet.scale;
    if size[0].max(size[1]) / step <= MOST_LINES {
        let floor = corner[1] + size[1];
        let places =
            |length: f64| (1_u32..).map(f64::from).map(move |i| i * step).take_while(move |x| *x < length);
        for x in places(size[0]) {
            lines.line([[corner[0] + x, corner[1]], [corner[0] + x, floor]]);
        }
        for y in places(size[1]) {
            lines.line([[corner[0], floor - y], [corner[0] + size[0], floor - y]]);
        }
    }
    let width = Num(0.5 * sheet.unit);
    sheet.svg.path(&lines, &format!("stroke=\"{FAINT}\" stroke-width=\"{width}\" fill=\"none\""));
}

/// Draws the walls around the arena.
fn draw_walls(sheet: &mut Sheet) {
    let [[x, y], [width, height]] = sheet.map();
    let wall = (0.3 * sheet.scale).clamp(2.0 * sheet.unit, 5.0 * sheet.unit);
    let looks = format!("fill=\"none\" stroke=\"{WALL}\" stroke-width=\"{}\"", Num(wall));
    sheet.svg.rect([x - wall / 2.0, y - wall / 2.0], [width + wall, height + wall], 0.0, &looks);
}

/// Draws a box around a place, in metres, with round corners.
fn draw_box(sheet: &mut Sheet, center: Point, size: Point, looks: &str) {
    let corner = sheet.at([center[0] - size[0] / 2.0, center[1] + size[1] / 2.0]);
    sheet.svg.rect(corner, size.map(|length| length * sheet.scale), 1.2 * sheet.scale, looks);
}

/// Draws the places of the tasks, the rest places and the homes.
fn draw_places(sheet: &mut Sheet, world: &World) {
    let line = Num(sheet.unit);
    for (number, task) in world.tasks.iter().enumerate() {
        let colour = colour(number);
        let edge = format!("stroke=\"{colour}\" stroke-width=\"{line}\" stroke-opacity=\"0.55\"");
        let fill = format!("fill=\"{colour}\" fill-opacity=\"0.07\"");
        draw_box(sheet, task.center, task.size_m.map(|length| length + 3.0), &format!("{fill} {edge}"));
        let extent = |axis: usize| {
            let slots = world.robots.iter().map(|robot| (robot.rest[number][axis] - task.rest[axis]).abs());
            2.0 * slots.fold(0.0, f64::max) + 2.0
        };
        let dash = [4.0, 3.0].map(|length| Num(length * sheet.unit));
        let looks = format!("fill=\"none\" {edge} stroke-dasharray=\"{} {}\"", dash[0], dash[1]);
        draw_box(sheet, task.rest, [extent(0), extent(1)], &looks);
    }
    let mut homes = Path::default();
    let radius = (0.5 * sheet.scale).max(2.5 * sheet.unit);
    for robot in &world.robots {
        homes.disc(sheet.at(robot.home), radius);
    }
    sheet.svg.path(&homes, &format!("fill=\"{FAINT}\""));
}

/// Writes the names of the places.
pub(crate) fn draw_names(sheet: &mut Sheet, world: &World) {
    let size = 10.5 * sheet.unit;
    let write = |sheet: &mut Sheet, text: &str, [x, top]: Point, colour: &str| {
        let [x, y] = sheet.at([x, top]);
        // Without room above the place, the name is below the edge of the arena.
        let y = (y - 0.75 * size).max(sheet.map()[0][1] + 0.8 * size);
        sheet.svg.text(text, [x, y], &Lettering { size, anchor: Anchor::Middle, colour });
    };
    for (number, task) in world.tasks.iter().enumerate() {
        let top = task.center[1] + task.size_m[1] / 2.0 + 1.5;
        write(sheet, &task.name, [task.center[0], top], colour(number));
        let rest_top = world.robots.iter().map(|robot| robot.rest[number][1]).fold(task.rest[1], f64::max);
        write(sheet, "rest", [task.rest[0], rest_top + 1.0], SOFT);
    }
    if !world.tasks.is_empty() && !world.robots.is_empty() {
        let homes = || world.robots.iter().map(|robot| robot.home);
        let top = homes().map(|[_, y]| y).fold(0.0, f64::max);
        let middle = homes().map(|[x, _]| x).sum::<f64>() / world.robots.len() as f64;
        write(sheet, "home", [middle, top + 0.8], SOFT);
    }
}

/// Draws the radiation zones for which `is_there` is true; the sampled zones have a dashed outline.
pub(crate) fn draw_zones(
    sheet: &mut Sheet,
    zones: &[ZoneFile],
    is_there: impl Fn(usize) -> bool,
    is_sampled: impl Fn(usize) -> bool,
) {
    let (line, dash) = (Num(0.8 * sheet.unit), Num(2.5 * sheet.unit));
    for (number, zone) in zones.iter().enumerate().filter(|(number, _)| is_there(*number)) {
        let (at, radius) = (sheet.at(zone.at), zone.radius_m * sheet.scale);
        for share in [1.0, 0.8, 0.6, 0.4, 0.2] {
            sheet.svg.disc(at, share * radius, &format!("fill=\"{RADIATION}\" fill-opacity=\"0.1\""));
        }
        let dashes = if is_sampled(number) { format!(" stroke-dasharray=\"{dash}\"") } else { String::new() };
        let looks = format!(
            "fill=\"none\" stroke=\"{RADIATION_EDGE}\" stroke-opacity=\"0.6\" stroke-width=\"{line}\"{dashes}"
        );
        sheet.svg.disc(at, radius, &looks);
    }
}

/// The pose of a piece of debris: its place and its rotation in radians.
pub(crate) type Lies = (Point, f64);

/// The poses of debris at the start.
pub(crate) fn as_placed(debris: &[DebrisFile]) -> Vec<Lies> {
    debris.iter().map(|piece| (piece.at, piece.rotation_deg.to_radians())).collect()
}

/// Draws debris; the sampled pieces have a dashed outline.
pub(crate) fn draw_debris(
    sheet: &mut Sheet,
    debris: &[DebrisFile],
    lie: &[Lies],
    is_sampled: impl Fn(usize) -> bool,
) {
    let [mut fixed, mut movable, mut sampled] = [Path::default(), Path::default(), Path::default()];
    for (number, (piece, (at, angle))) in debris.iter().zip(lie).enumerate() {
        let path = if piece.movable.is_some() {
            &mut movable
        } else if is_sampled(number) {
            &mut sampled
        } else {
            &mut fixed
        };
        match &piece.shape {
            DebrisShape::Disc(radius) => path.disc(sheet.at(*at), radius * sheet.scale),
            shape => path.polygon(corners(shape, *at, *angle).into_iter().map(|at| sheet.at(at))),
        }
    }
    sheet.svg.path(&fixed, &fixed_looks(sheet.unit));
    sheet.svg.path(&sampled, &sampled_looks(sheet.unit));
    sheet.svg.path(&movable, &movable_looks(sheet.unit));
}

fn fixed_looks(unit: f64) -> String {
    format!("fill=\"{DEBRIS}\" stroke=\"{WALL}\" stroke-opacity=\"0.6\" stroke-width=\"{}\"", Num(0.7 * unit))
}

fn sampled_looks(unit: f64) -> String {
    let (line, dash) = (Num(unit), Num(2.0 * unit));
    format!(
        "fill=\"{DEBRIS}\" fill-opacity=\"0.55\" stroke=\"{INK}\" stroke-width=\"{line}\" \
         stroke-dasharray=\"{dash}\""
    )
}

fn movable_looks(unit: f64) -> String {
    format!("fill=\"{MOVABLE}\" stroke=\"{WALL}\" stroke-width=\"{}\"", Num(unit))
}

/// Half the side of a rescuee's square, in pixels.
fn rescuee_size(sheet: &Sheet, count: usize) -> f64 {
    let least = if count > 1000 { 0.5 } else { 1.0 };
    (0.15 * sheet.scale).clamp(least * sheet.unit, 5.0 * sheet.unit)
}

/// Draws rescuees by their state: waiting or claimed, on board, delivered.
pub(crate) fn draw_rescuees(sheet: &mut Sheet, world: &World, state: impl Fn(usize) -> u8) {
    let half = rescuee_size(sheet, world.rescuees.len());
    let [mut waiting, mut gone, mut delivered] = [Path::default(), Path::default(), Path::default()];
    for (number, place) in world.rescuees.iter().enumerate() {
        let at = sheet.at(*place);
        match state(number) {
            0 | 1 => waiting.square(at, half),
            2 => gone.square(at, half),
            4 => {} // not there
            _ => delivered.square(at, 0.45 * half),
        }
    }
    sheet.svg.path(&waiting, &format!("fill=\"{RESCUEE}\""));
    let line = Num(0.6 * sheet.unit);
    sheet.svg.path(&gone, &format!("fill=\"none\" stroke=\"{SOFT}\" stroke-width=\"{line}\""));
    sheet.svg.path(&delivered, &format!("fill=\"{SOFT}\" fill-opacity=\"0.5\""));
}

/// The legend's entries for the signs of the ground that occur in the world. `debris` and
/// `zones` are the numbers of the first sampled piece of debris and of the first sampled zone.
fn entries(world: &World, unit: f64, [debris, zones]: [usize; 2]) -> Vec<Entry> {
    let mut entries = Vec::new();
    let mut add = |is_there: bool, sign: Sign, means: &str| {
        if is_there {
            entries.push(Entry::new(sign, world.words.text(means)));
        }
    };
    let is_movable = |piece: &DebrisFile| piece.movable.is_some();
    let (placed, drawn) = world.debris.split_at(debris.min(world.debris.len()));
    add(!world.rescuees.is_empty(), Sign::Square(format!("fill=\"{RESCUEE}\"")), "waiting to be rescued");
    add(!placed.iter().all(is_movable), Sign::Square(fixed_looks(unit)), "debris");
    add(
        !drawn.is_empty(),
        Sign::Square(sampled_looks(unit)),
        if world.debris_later.is_empty() {
            "debris of this seed"
        } else {
            "debris of this seed or of an event"
        },
    );
    add(world.debris.iter().any(is_movable), Sign::Square(movable_looks(unit)), "movable debris");
    let zone = format!("fill=\"{RADIATION}\" fill-opacity=\"0.35\" stroke=\"{RADIATION_EDGE}\"");
    let dashed = format!("{zone} stroke-dasharray=\"{}\"", Num(2.5 * unit));
    add(zones > 0 && !world.zones.is_empty(), Sign::Disc(zone), "radiation");
    add(
        zones < world.zones.len(),
        Sign::Disc(dashed),
        if world.zones_later.is_empty() {
            "radiation of this seed"
        } else {
            "radiation of this seed or of an event"
        },
    );
    entries
}
