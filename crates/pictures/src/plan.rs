//! The world before the trial.

use recording::World;
use scenario::Errand;

use crate::ground;
use crate::legend::{Entry, Sign};
use crate::picture::{Look, Picture};
use crate::shapes::shapes_of;
use crate::sheet::Sheet;
use crate::svg::{Num, Path};
use crate::team::{self, colour_of, draw_number, sign_radius};
use crate::theme::{INK, PAPER, SOFT};

/// A world before the trial.
#[derive(Debug, Clone, Copy)]
pub struct Plan<'w> {
    /// Title above the map.
    pub title: &'w str,
    /// The world of one seed.
    pub world: &'w World,
    /// The errands of robots, in scenarios without a mission.
    pub errands: &'w [Errand],
    /// The number of the first piece of debris, and of the first radiation zone, that was sampled for this
    /// seed. Earlier numbers belong to the scenario.
    pub first_sampled: [usize; 2],
}

/// Draws a world before the trial: walls, debris, radiation, tasks, rest places, homes, sensing ranges and
/// errands.
pub fn plan(plan: &Plan, look: &Look) -> Picture {
    let Plan { world, first_sampled: [debris, zones], .. } = *plan;
    let mut sheet = ground::begun(look, world, plan.title);
    ground::draw_zones(&mut sheet, &world.zones, |_| true, |number| number >= zones);
    draw_ranges(&mut sheet, world);
    ground::draw_debris(&mut sheet, &world.debris, &ground::as_placed(&world.debris), |number| {
        number >= debris
    });
    ground::draw_rescuees(
        &mut sheet,
        world,
        |number| if world.rescuees_later.contains(&number) { 2 } else { 0 },
    );
    draw_errands(&mut sheet, plan);
    draw_team(&mut sheet, world);
    ground::draw_names(&mut sheet, world);
    let mut entries = team::entries(world);
    entries.retain(|entry| entry.means != "no group");
    entries.push(Entry::new(Sign::Disc(range_looks(sheet.unit)), "sensing range"));
    if !plan.errands.is_empty() {
        entries.push(Entry::new(Sign::Line(errand_looks(SOFT, sheet.unit)), "errands"));
    }
    ground::finished(sheet, world, entries, [debris, zones])
}

fn range_looks(unit: f64) -> String {
    let (line, dash) = (Num(0.7 * unit), Num(1.5 * unit));
    format!(
        "fill=\"{SOFT}\" fill-opacity=\"0.02\" stroke=\"{SOFT}\" stroke-opacity=\"0.6\" \
         stroke-width=\"{line}\" stroke-dasharray=\"{dash}\""
    )
}

fn errand_looks(colour: &str, unit: f64) -> String {
    let (line, dash) = (Num(1.1 * unit), Num(4.0 * unit));
    format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{line}\" stroke-dasharray=\"{dash}\"")
}

/// Draws the ranges within which robots notice debris and radiation, at full health and at home.
fn draw_ranges(sheet: &mut Sheet, world: &World) {
    let looks = range_looks(sheet.unit);
    for (number, robot) in world.robots.iter().enumerate() {
        let (at, radius) = (sheet.at(robot.home), world.body_of(number).sensing_m * sheet.scale);
        sheet.svg.disc(at, radius, &looks);
    }
}

/// Draws straight lines between the places of each errand, with a ring at each place.
fn draw_errands(sheet: &mut Sheet, plan: &Plan) {
    for errand in plan.errands {
        let number = errand.robot as usize;
        let Some(robot) = plan.world.robots.get(number) else { continue };
        let colour = colour_of(plan.world, number, None);
        let (mut way, mut rings) = (Path::default(), Path::default());
        let places = std::iter::once(robot.home).chain(errand.to.iter().copied());
        way.line(places.map(|place| sheet.at(place)).collect::<Vec<_>>());
        let radius = sign_radius(sheet, plan.world, number);
        errand.to.iter().for_each(|place| rings.disc(sheet.at(*place), radius));
        sheet.svg.path(&way, &errand_looks(colour, sheet.unit));
        let line = Num(1.1 * sheet.unit);
        let looks = format!("fill=\"{PAPER}\" stroke=\"{colour}\" stroke-width=\"{line}\"");
        sheet.svg.path(&rings, &looks);
    }
}

/// Draws the robots at home, with their numbers if there is room.
fn draw_team(sheet: &mut Sheet, world: &World) {
    let shapes = shapes_of(&world.roles);
    let has_numbers = world.robots.len() <= 60 && sheet.scale > 9.0 * sheet.unit;
    for (number, robot) in world.robots.iter().enumerate() {
        let (mut sign, at) = (Path::default(), sheet.at(robot.home));
        let radius = sign_radius(sheet, world, number);
        shapes[robot.role].add(at, radius, &mut sign);
        let colour = if world.tasks.is_empty() { colour_of(world, number, None) } else { INK };
        let looks =
            format!("fill=\"{colour}\" stroke=\"{PAPER}\" stroke-width=\"{}\"", Num(0.7 * sheet.unit));
        sheet.svg.path(&sign, &looks);
        if has_numbers {
            draw_number(sheet, number, at, radius);
        }
    }
}
