//! The team: the positions, routes and levels of robots, and the robots for which they wait.

use recording::{Frame, RobotFrame, World};

use crate::legend::{Entry, Sign};
use crate::shapes::shapes_of;
use crate::sheet::Sheet;
use crate::svg::{Anchor, At, Lettering, Num, Path};
use crate::theme::{ENERGY, FAINT, HP, INK, PAPER, SOFT, UNGROUPED, WAIT, colour, group_colour};

/// In a larger team, robots are drawn without levels and numbers.
const LARGE_TEAM: usize = 60;

/// Robots are drawn with their numbers if a metre has at least this many pixels of a sheet of normal width.
const NUMBERS_FROM: f64 = 9.0;

/// The colour of a robot: that of its group, or, in scenarios without tasks, a colour by its number.
pub(crate) fn colour_of(world: &World, robot: usize, task: Option<u32>) -> &'static str {
    if world.tasks.is_empty() { colour(robot) } else { group_colour(task) }
}

/// The radius of a robot's sign, in pixels.
pub(crate) fn sign_radius(sheet: &Sheet, world: &World, robot: usize) -> f64 {
    let least = if world.robots.len() > LARGE_TEAM { 2.0 } else { 4.2 };
    (world.body_of(robot).radius_m * sheet.scale).max(least * sheet.unit)
}

/// Draws the routes of the robots, and their ends.
pub(crate) fn draw_routes(sheet: &mut Sheet, world: &World, frame: &Frame) {
    for (number, robot) in frame.robots.iter().enumerate() {
        let colour = colour_of(world, number, robot.state.task);
        let mut way = Path::default();
        if let Some(end) = robot.route.ahead_mm.last() {
            let places =
                std::iter::once(robot.motion.position_mm).chain(robot.route.ahead_mm.iter().copied());
            way.line(places.map(|place| sheet.at_mm(place)).collect::<Vec<_>>());
            let ([x, y], arm) = (sheet.at_mm(*end), 2.2 * sheet.unit);
            way.line([[x - arm, y - arm], [x + arm, y + arm]]);
            way.line([[x - arm, y + arm], [x + arm, y - arm]]);
        }
        let width = Num(0.9 * sheet.unit);
        let looks =
            format!("fill=\"none\" stroke=\"{colour}\" stroke-opacity=\"0.45\" stroke-width=\"{width}\"");
        sheet.svg.path(&way, &looks);
    }
}

/// Draws rings around the rescuees that robots have claimed.
pub(crate) fn draw_claims(sheet: &mut Sheet, world: &World, frame: &Frame) {
    let radius = (0.15 * sheet.scale).clamp(sheet.unit, 5.0 * sheet.unit) + 2.2 * sheet.unit;
    for (place, rescuee) in world.rescuees.iter().zip(&frame.rescuees).filter(|(_, now)| now.state == 1) {
        let by = rescuee.robot.and_then(|robot| frame.robots.get(robot as usize));
        let colour = group_colour(by.and_then(|robot| robot.state.task));
        let looks = format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{}\"", Num(1.2 * sheet.unit));
        let at = sheet.at(*place);
        sheet.svg.disc(at, radius, &looks);
    }
}

/// Draws the robots with their levels; robots that cannot act any more are crossed out.
pub(crate) fn draw_robots(sheet: &mut Sheet, world: &World, frame: &Frame) {
    let shapes = shapes_of(&world.roles);
    let is_large = frame.robots.len() > LARGE_TEAM;
    let has_numbers = !is_large && sheet.scale > NUMBERS_FROM * sheet.unit;
    let halo = Num(if is_large { 0.0 } else { 1.1 * sheet.unit });
    let mut lost = Path::default();
    for (number, robot) in frame.robots.iter().enumerate() {
        let (at, radius) = (sheet.at_mm(robot.motion.position_mm), sign_radius(sheet, world, number));
        let mut sign = Path::default();
        shapes[world.robots[number].role].add(at, radius, &mut sign);
        let colour = colour_of(world, number, robot.state.task);
        let looks =
            format!("fill=\"{colour}\" stroke=\"{PAPER}\" stroke-width=\"{halo}\" paint-order=\"stroke\"");
        sheet.svg.path(&sign, &looks);
        if robot.state.condition != 0 {
            let [x, y] = at;
            lost.line([[x - radius, y - radius], [x + radius, y + radius]]);
            lost.line([[x + radius, y - radius], [x - radius, y + radius]]);
        }
        if !is_large {
            draw_levels(sheet, robot, at, radius);
        }
        if has_numbers {
            draw_number(sheet, number, at, radius);
        }
    }
    sheet.svg.path(&lost, &format!("stroke=\"{INK}\" stroke-width=\"{}\"", Num(1.8 * sheet.unit)));
}

/// Writes a robot's number beside it.
pub(crate) fn draw_number(sheet: &mut Sheet, number: usize, [x, y]: At, radius: f64) {
    let letters = Lettering { size: 9.0 * sheet.unit, anchor: Anchor::Start, colour: INK };
    sheet.svg.text(&number.to_string(), [x + radius + 3.0 * sheet.unit, y], &letters);
}

/// Draws energy and HP as two bars below a robot, and the rescuees on board as dots above it.
fn draw_levels(sheet: &mut Sheet, robot: &RobotFrame, [x, y]: At, radius: f64) {
    let unit = sheet.unit;
    let width = (2.0 * radius).clamp(10.0 * unit, 24.0 * unit);
    let levels = [(robot.motion.energy_millipercent, ENERGY), (robot.motion.hp_millipercent, HP)];
    for (row, (level, colour)) in levels.into_iter().enumerate() {
        let corner = [x - width / 2.0, y + radius + (2.0 + 2.4 * row as f64) * unit];
        let share = (f64::from(level) / 100_000.0).clamp(0.0, 1.0);
        sheet.svg.rect(corner, [width, 1.6 * unit], 0.0, &format!("fill=\"{FAINT}\""));
        sheet.svg.rect(corner, [width * share, 1.6 * unit], 0.0, &format!("fill=\"{colour}\""));
    }
    let load = robot.state.load.min(12);
    let mut dots = Path::default();
    for i in 0..load {
        let offset = (f64::from(i) - f64::from(load - 1) / 2.0) * 3.2 * unit;
        dots.disc([x + offset, y - radius - 3.0 * unit], 1.2 * unit);
    }
    sheet.svg.path(&dots, &format!("fill=\"{INK}\""));
}

/// Draws an arrow from each waiting robot to the robot for which it waits.
pub(crate) fn draw_links(sheet: &mut Sheet, frame: &Frame) {
    let (mut lines, mut heads, unit) = (Path::default(), Path::default(), sheet.unit);
    for robot in &frame.robots {
        let other = robot.state.waits_for.and_then(|other| frame.robots.get(other as usize));
        let Some(other) = other else { continue };
        let ([x, y], to) = (sheet.at_mm(robot.motion.position_mm), sheet.at_mm(other.motion.position_mm));
        let length = (to[0] - x).hypot(to[1] - y);
        if length < 1.0 {
            continue;
        }
        let [dx, dy] = [(to[0] - x) / length * unit, (to[1] - y) / length * unit];
        let end = [to[0] - dx * 7.0, to[1] - dy * 7.0];
        lines.line([[x, y], end]);
        let side = |turn: f64| [end[0] - turn * dy * 3.0, end[1] + turn * dx * 3.0];
        heads.polygon([[end[0] + dx * 5.0, end[1] + dy * 5.0], side(1.0), side(-1.0)]);
    }
    sheet.svg.path(&lines, &waiting_looks(unit));
    sheet.svg.path(&heads, &format!("fill=\"{WAIT}\""));
}

fn waiting_looks(unit: f64) -> String {
    format!("fill=\"none\" stroke=\"{WAIT}\" stroke-width=\"{}\"", Num(1.4 * unit))
}

/// The legend's entries for the colours and shapes of robots.
pub(crate) fn entries(world: &World) -> Vec<Entry> {
    let shapes = shapes_of(&world.roles);
    let is_used = |role: &usize| world.robots.iter().any(|robot| robot.role == *role);
    let roles = (0..world.roles.len()).filter(is_used);
    let mut entries: Vec<Entry> =
        roles.map(|role| Entry::new(Sign::Robot(shapes[role], SOFT), &world.roles[role].name)).collect();
    let task = |(number, task): (usize, &recording::TaskPlace)| {
        Entry::new(Sign::Square(format!("fill=\"{}\"", colour(number))), format!("group of {}", task.name))
    };
    entries.extend(world.tasks.iter().enumerate().map(task));
    if !world.tasks.is_empty() {
        entries.push(Entry::new(Sign::Square(format!("fill=\"{UNGROUPED}\"")), "no group"));
    }
    entries
}

/// The legend's entries for the signs beside robots.
pub(crate) fn moment_entries(world: &World, unit: f64) -> Vec<Entry> {
    let mut entries = entries(world);
    let bar = |colour: &str| Sign::Line(format!("stroke=\"{colour}\" stroke-width=\"{}\"", Num(2.5 * unit)));
    if world.robots.len() <= LARGE_TEAM {
        entries.push(Entry::new(bar(ENERGY), "energy"));
        entries.push(Entry::new(bar(HP), world.words.text("HP")));
    }
    entries.push(Entry::new(Sign::Line(waiting_looks(unit)), "waits for"));
    entries
}
