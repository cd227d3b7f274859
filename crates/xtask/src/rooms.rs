//! Random rooms, each from one seed: walls that meet in a T or cross, doors, robots of two radii, movable
//! debris, steps of 0.01 to 0.05 s. Even seeds have errands, odd seeds a rescue mission. At first, every
//! robot can reach every place of its own. Pushed debris may close a passage later.
//!
//! Two families: a few robots and doors for two ([`rooms`]), and a crowd and doors from one lane on
//! ([`doors`]).

use std::ops::Range;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use scenario::{DebrisFile, DebrisShape, Errand, Movable, Point, Row, Scenario, ScenarioFile, TaskFile};
use teaming::TaskId;
use usar_sim::ids::RobotId;
use usar_sim::model::RestSlots;

use crate::worlds::{FreeSpace, base};

/// Thickness of walls, in metres.
const WALL_M: f64 = 0.3;

/// Clearance of routes, plus the error of the flood fill's grid, in metres.
const KEEP_OFF_M: f64 = 0.15 + 0.05;

/// No debris lies within this distance of a door's middle, in metres.
const APRON_M: f64 = 2.5;

/// How narrow doors are at least, beyond the diameter of the largest robot, in metres: its clearance on both
/// sides, and a hand's breadth.
const NARROW_M: f64 = 0.35;

/// The widest of such doors, in metres.
const WIDE_M: f64 = 4.0;

/// Area for each robot of a crowd, in square metres.
const AREA_M2: Range<f64> = 5.0..40.0;

/// The rooms scenario of a seed: 2 to 12 robots, doors in which two pass or nearly so.
pub fn rooms(seed: u64) -> Scenario {
    feasible(seed, 0x0072_006f_006f_006d, false)
}

/// The same with 2 to 60 robots, and doors of `NARROW_M` more than the largest robot to `WIDE_M`.
pub fn doors(seed: u64) -> Scenario {
    feasible(seed, 0x0064_006f_006f_0072, true)
}

fn feasible(seed: u64, family: u64, is_crowd: bool) -> Scenario {
    let mut draws = ChaCha8Rng::seed_from_u64(seed ^ family);
    for _ in 0..400 {
        if let Some(scenario) = draw(seed, &mut draws, is_crowd) {
            return scenario;
        }
    }
    panic!("seed {seed}: no feasible rooms in 400 draws");
}

/// Radii of the carriers and suppliers, in metres; they differ in two worlds of three.
fn radii(draws: &mut ChaCha8Rng) -> [f64; 2] {
    let first = draws.random_range(0.25..0.6);
    if draws.random_range(0..3_u32) == 0 { [first; 2] } else { [first, draws.random_range(0.2..0.6)] }
}

fn draw(seed: u64, draws: &mut ChaCha8Rng, is_crowd: bool) -> Option<Scenario> {
    let columns = draws.random_range(2..=3_usize);
    let rows = draws.random_range(1..=2_usize);
    let mut side: f64 = draws.random_range(12.0..18.0);
    let crowd = is_crowd.then(|| draws.random_range(2..=60_u32));
    if let Some(robots) = crowd {
        let area = f64::from(robots) * draws.random_range(AREA_M2);
        side = side.max((area / (columns * rows) as f64).sqrt());
    }
    let arena = [side * columns as f64, side * rows as f64 + 2.0];
    let radii = radii(draws);
    let largest = 2.0 * radii[0].max(radii[1]);
    let least = largest + 2.0 * KEEP_OFF_M;
    let widths = if is_crowd { largest + NARROW_M..WIDE_M } else { least + 0.1..least + 1.5 };
    let (debris, doors) = debris(draws, arena, [columns, rows], widths);
    let mut file = base(seed, arena, 120.0);
    file.name = format!("rooms-{seed}");
    file.dt_s = [0.01, 0.02, 0.05][draws.random_range(0..3_usize)];
    file.debris = debris;
    file.roles[0].radius_m = radii[0];
    file.roles[1].radius_m = radii[1];
    let doors = if is_crowd { doors } else { Vec::new() };
    let kinds = radii.map(|radius| FreeSpace::through(arena, &file.debris, radius + KEEP_OFF_M, &doors));
    let robots = crowd.unwrap_or_else(|| draws.random_range(2..=12_u32));
    let mut taken = Vec::new();
    for robot in 0..robots {
        let role = if robot == 0 { 0 } else { draws.random_range(0..5_usize) / 2 };
        let center = kinds[role.min(1)].draw(draws, &taken)?;
        taken.push(center);
        let role = file.roles[role].name.clone();
        file.team.push(Row::of_one(&role, center));
    }
    if seed.is_multiple_of(2) { errands(file, draws, &kinds, taken) } else { mission(file, draws, &kinds) }
}

/// The free space of the robots of a row of the team.
fn free_for<'k>(file: &ScenarioFile, robot: usize, kinds: &'k [FreeSpace; 2]) -> &'k FreeSpace {
    &kinds[usize::from(file.team[robot].role != file.roles[0].name)]
}

fn errands(
    mut file: ScenarioFile,
    draws: &mut ChaCha8Rng,
    kinds: &[FreeSpace; 2],
    mut taken: Vec<Point>,
) -> Option<Scenario> {
    for robot in 0..file.team.len() {
        let to = free_for(&file, robot, kinds).draw(draws, &taken)?;
        taken.push(to);
        file.errands.push(Errand { robot: robot as u32, to: vec![to] });
    }
    Scenario::try_from(file).ok()
}

fn mission(mut file: ScenarioFile, draws: &mut ChaCha8Rng, kinds: &[FreeSpace; 2]) -> Option<Scenario> {
    let both = |place: Point| kinds.iter().all(|free| free.contains(place));
    for (name, difficulty) in [("hard", 2), ("easy", 1)] {
        let center = kinds[0].draw(draws, &[]).filter(|center| both(*center))?;
        file.tasks.push(TaskFile {
            name: name.to_owned(),
            difficulty,
            center,
            size_m: [2.0, 1.0],
            grid: [4, 3],
            rest: center,
            ..TaskFile::default()
        });
    }
    let scenario = Scenario::try_from(file.clone()).ok()?;
    let slots = RestSlots::of(&scenario);
    for (task, number) in file.tasks.iter_mut().zip(0..) {
        let from = |robot| slots.at(TaskId(number), RobotId(robot));
        let offsets: Vec<Point> = (0..scenario.robots())
            .map(|robot| {
                [f64::from(from(robot).x) - task.center[0], f64::from(from(robot).y) - task.center[1]]
            })
            .collect();
        let are_free = |rest: &Point| offsets.iter().all(|[x, y]| both([rest[0] + x, rest[1] + y]));
        task.rest = (0..200).find_map(|_| kinds[1].draw(draws, &[]).filter(are_free))?;
    }
    Scenario::try_from(file).ok()
}

/// Walls with doors of these widths, and pieces of debris that cover a share of the rooms. Beside them, the
/// middles of the doors.
fn debris(
    draws: &mut ChaCha8Rng,
    arena: Point,
    [columns, rows]: [usize; 2],
    widths: Range<f64>,
) -> (Vec<DebrisFile>, Vec<Point>) {
    let (mut debris, mut doors) = (Vec::new(), Vec::new());
    let [width, height] = [arena[0] / columns as f64, arena[1] / rows as f64];
    for column in 1..columns {
        let x = width * column as f64;
        let (pieces, middles) = wall(draws, [x, 0.0], [x, arena[1]], rows, &widths);
        debris.extend(pieces);
        doors.extend(middles);
    }
    for row in 1..rows {
        // A cross if the wall continues beyond the first wall that it meets, a T if it ends there.
        let to = if draws.random_range(0..2_u32) == 0 { columns } else { 1 };
        let y = height * row as f64;
        let (pieces, middles) = wall(draws, [0.0, y], [width * to as f64, y], to, &widths);
        debris.extend(pieces);
        doors.extend(middles);
    }
    let mut left = draws.random_range(0.0..0.04) * arena[0] * arena[1];
    while left > 0.0 {
        let size = draws.random_range(0.2..1.0);
        let at = [draws.random_range(0.0..arena[0]), draws.random_range(0.0..arena[1])];
        left -= 2.0 * size * size;
        let apart = |door: &Point| (door[0] - at[0]).hypot(door[1] - at[1]) > APRON_M;
        if !doors.iter().all(apart) {
            continue;
        }
        let shape = match draws.random_range(0..3_u32) {
            0 => DebrisShape::Disc(size),
            1 => DebrisShape::Polygon(vec![[size, 0.0], [-size, size], [-size, -size]]),
            _ => DebrisShape::Box(2.0 * size, draws.random_range(0.2..1.0)),
        };
        let can_be_pushed = size < 0.6 && draws.random_range(0..2_u32) == 0;
        debris.push(DebrisFile {
            shape,
            at,
            rotation_deg: draws.random_range(0.0..180.0),
            movable: can_be_pushed.then(|| Movable { mass_kg: draws.random_range(5.0..80.0), friction: 0.5 }),
            name: None,
        });
    }
    (debris, doors)
}

/// The pieces of a straight wall along one axis, and the middles of its doors, one in each of `parts` equal
/// parts.
fn wall(
    draws: &mut ChaCha8Rng,
    from: Point,
    to: Point,
    parts: usize,
    widths: &Range<f64>,
) -> (Vec<DebrisFile>, Vec<Point>) {
    let (mut pieces, mut doors) = (Vec::new(), Vec::new());
    let length = (to[0] - from[0]) + (to[1] - from[1]);
    let along = |at: f64| [0, 1].map(|k| from[k] + (to[k] - from[k]) * at / length);
    let mut begin = 0.0;
    let mut add = |begin: f64, end: f64| {
        let [low, high] = [along(begin), along(end)];
        let size = [0, 1].map(|k| (high[k] - low[k]).max(WALL_M));
        let at = [0, 1].map(|k| f64::midpoint(low[k], high[k]));
        pieces.push(DebrisFile::fixed(DebrisShape::Box(size[0], size[1]), at));
    };
    for part in 0..parts {
        let (low, high) = (length * part as f64 / parts as f64, length * (part + 1) as f64 / parts as f64);
        let door = draws.random_range(widths.clone());
        let at = draws.random_range(low + 2.0..high - 2.0 - door);
        doors.push(along(at + door / 2.0));
        add(begin, at);
        begin = at + door;
    }
    add(begin, length);
    (pieces, doors)
}
