//! Random worlds in which every robot can reach all its goals, each from one seed.
//!
//! Feasibility is determined by a separate flood fill instead of the planner under test. Its points lie on
//! a fine grid and keep a robot's radius and clearance from all debris and walls. The largest connected
//! part of these points is feasible.

use parry2d::bounding_volume::{Aabb, BoundingVolume};
use parry2d::math::Vector;
use rand::RngExt;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use scenario::shapes::Outline;
use scenario::{
    DebrisFile, DebrisShape, Errand, Movable, Point, Row, Scenario, ScenarioFile, TaskFile, ZoneFile,
    parse_ron,
};
use teaming::TaskId;
use usar_sim::ids::RobotId;
use usar_sim::model::RestSlots;

/// The scenario from which the robots have their roles and needs.
const PAPER: &str = include_str!("../../../scenarios/paper.ron");

/// What all worlds have.
const NOTHING: &str = "(name: \"\", duration_s: 0.0, dt_s: 0.02, arena_m: (0.0, 0.0), team: [], \
    initial_levels: (energy: (mean: 90.0, sd: 5.0), hp: (mean: 90.0, sd: 10.0)))";

/// Distance between the points of the flood fill, in metres.
const CELL_M: f64 = 0.15;

/// A door leads at most this far beyond the distance from walls: half a wall and the error of the grid, in
/// metres.
const DOOR_M: f64 = 0.4;

/// Radius of all robots and the clearance of their routes, in metres.
const KEEP_OFF_M: f64 = 0.55;

/// No debris lies within this distance of a door, in metres.
const APRON_M: f32 = 2.0;

/// The world of a seed: errands for even seeds, a rescue mission for odd ones; 2 to 50 robots.
pub fn world(seed: u64) -> Scenario {
    let mut draws = ChaCha8Rng::seed_from_u64(seed);
    for _ in 0..200 {
        let file = if seed.is_multiple_of(2) { errands(seed, &mut draws) } else { mission(seed, &mut draws) };
        if let Some(file) = file {
            return Scenario::try_from(file).unwrap_or_else(|problems| panic!("seed {seed}: {problems:?}"));
        }
    }
    panic!("seed {seed}: no feasible world in 200 draws");
}

fn errands(seed: u64, draws: &mut ChaCha8Rng) -> Option<ScenarioFile> {
    let robots = draws.random_range(2..=50_u32);
    let side = (f64::from(robots) * draws.random_range(15.0..40.0)).sqrt() + 8.0;
    let arena = [side * draws.random_range(1.0..1.6), side];
    let debris = debris(draws, arena, 0.0, robots, [0.02, 0.15]);
    let free = FreeSpace::new(arena, &debris);
    let mut taken: Vec<Point> = Vec::new();
    let mut team = Vec::new();
    for _ in 0..robots {
        let role = match draws.random_range(0..8_u32) {
            0 => "observer",
            1..4 => "supplier",
            _ => "carrier",
        };
        let center = free.draw(draws, &taken)?;
        taken.push(center);
        team.push(Row::of_one(role, center));
    }
    let mut errands = Vec::new();
    for robot in 0..robots {
        if draws.random_range(0..10_u32) == 0 {
            continue; // stands at home, in whoever's way
        }
        let mut to = Vec::new();
        for _ in 0..draws.random_range(0..3_u32) {
            to.push(free.draw(draws, &[])?);
        }
        let last = free.draw(draws, &taken)?;
        taken.push(last);
        to.push(last);
        errands.push(Errand { robot, to });
    }
    if errands.is_empty() {
        return None;
    }
    Some(ScenarioFile { team, errands, debris, ..base(seed, arena, 300.0) })
}

fn mission(seed: u64, draws: &mut ChaCha8Rng) -> Option<ScenarioFile> {
    let robots = draws.random_range(2..=50_u32);
    let carriers = (robots / 2).max(1);
    let suppliers = (robots / 3).max(1);
    let observers = robots - carriers.min(robots) - suppliers.min(robots - carriers);
    let side = 30.0 + f64::from(robots).sqrt() * draws.random_range(2.0..5.0);
    let arena = [side * 1.3, side];
    let spacing = draws.random_range(1.2..2.2);
    let row = |role: &str, count: u32, y: f64| {
        let width_m = spacing * f64::from(count.saturating_sub(1));
        Row { count, width_m, ..Row::of_one(role, [arena[0] / 2.0, y]) }
    };
    let mut team = vec![row("carrier", carriers, 2.0), row("supplier", suppliers, 4.0)];
    if observers > 0 {
        team.push(row("observer", observers, 6.0));
    }
    let task = |name: &str, difficulty: u32, x: f64| TaskFile {
        name: name.to_owned(),
        difficulty,
        center: [x, arena[1] - 5.0],
        size_m: [6.0, 3.0],
        grid: [8, 5],
        rest: [x, arena[1] * 0.35 + 2.0],
        ..TaskFile::default()
    };
    let tasks = vec![task("hard", 2, arena[0] * 0.2), task("easy", 1, arena[0] * 0.8)];
    let debris = debris(draws, arena, 8.0, robots, [0.01, 0.08]);
    let radiation = (0..draws.random_range(0..4_u32))
        .map(|_| ZoneFile {
            at: [draws.random_range(0.0..arena[0]), draws.random_range(8.0..arena[1])],
            radius_m: draws.random_range(1.0..4.0),
            name: None,
        })
        .collect();
    let file = ScenarioFile { team, tasks, debris, radiation, ..base(seed, arena, 300.0) };
    let free = FreeSpace::new(arena, &file.debris);
    let scenario = Scenario::try_from(file.clone()).ok()?;
    let slots = RestSlots::of(&scenario);
    let slots = (0..robots).flat_map(|i| [0, 1].map(|task| slots.at(TaskId(task), RobotId(i))));
    let slots = slots.map(|slot| [f64::from(slot.x), f64::from(slot.y)]);
    let homes = file.team.iter().flat_map(Row::places);
    let centers = file.tasks.iter().map(|task| task.center);
    let reachable = slots.chain(homes).chain(centers).all(|place| free.contains(place));
    reachable.then_some(file)
}

/// Debris that covers a share of the arena above a line; some worlds also have a wall with a door.
fn debris(draws: &mut ChaCha8Rng, arena: Point, above: f64, robots: u32, cover: [f64; 2]) -> Vec<DebrisFile> {
    let mut left = draws.random_range(cover[0]..cover[1]) * arena[0] * (arena[1] - above);
    let mut debris = Vec::new();
    while left > 0.0 {
        let size = draws.random_range(0.3..1.2);
        let (shape, covered) = match draws.random_range(0..3_u32) {
            0 => (DebrisShape::Disc(size), std::f64::consts::PI * size * size),
            1 => {
                let corners = (0..5).map(|k| {
                    let angle = f64::from(k) * std::f64::consts::TAU / 5.0;
                    [size * angle.cos(), size * angle.sin()]
                });
                (DebrisShape::Polygon(corners.collect()), 2.4 * size * size)
            }
            _ => {
                let long = draws.random_range(1.0..4.0);
                (DebrisShape::Box(size, long * size), long * size * size)
            }
        };
        left -= covered;
        let small = size < 0.45 && draws.random_range(0..3_u32) == 0;
        debris.push(DebrisFile {
            shape,
            at: [draws.random_range(0.0..arena[0]), draws.random_range(above..arena[1])],
            rotation_deg: draws.random_range(0.0..180.0),
            movable: small.then_some(Movable { mass_kg: 30.0, friction: 0.5 }),
            name: None,
        });
    }
    if draws.random_range(0..3_u32) == 0 {
        // One lane for every twelve robots. With fewer lanes, robots would queue for longer than a robot
        // may stall, even under perfect right of way.
        let lanes = f64::from(robots.div_ceil(12));
        let (x, door) = (arena[0] * draws.random_range(0.35..0.65), lanes * draws.random_range(1.3..1.8));
        let (from, to) = (above, arena[1]);
        let at = draws.random_range(from + 2.0..to - 2.0 - door);
        // Debris in the door would block its lanes.
        let doorway = Aabb::new(Vector::new(x as f32, at as f32), Vector::new(x as f32, (at + door) as f32));
        debris.retain(|piece| {
            let outline = piece.outline();
            let bounds = outline.shape.compute_aabb(&outline.pose);
            !bounds.intersects(&doorway.loosened(APRON_M))
        });
        for (low, high) in [(from, at), (at + door, to)] {
            debris.push(DebrisFile::fixed(DebrisShape::Box(0.4, high - low), [x, f64::midpoint(low, high)]));
        }
    }
    debris
}

/// The paper's scenario.
pub fn paper() -> Scenario {
    Scenario::parse(PAPER, "paper.ron".as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

/// A world without anything in it, for robots of the paper's roles with its needs.
pub(crate) fn base(seed: u64, arena_m: Point, duration_s: f64) -> ScenarioFile {
    let paper = paper();
    let nothing: ScenarioFile =
        parse_ron(NOTHING, "nothing.ron".as_ref()).expect("a scenario without robots");
    let (roles, needs) = (paper.roles.clone(), paper.needs.clone());
    ScenarioFile { name: format!("world-{seed}"), duration_s, arena_m, roles, needs, ..nothing }
}

/// The largest connected part of the free plane, as a grid.
pub struct FreeSpace {
    columns: usize,
    inside: Vec<bool>,
}

impl FreeSpace {
    /// The largest connected part of the free plane among this debris.
    pub fn new(arena: Point, debris: &[DebrisFile]) -> Self {
        Self::through(arena, debris, KEEP_OFF_M, &[])
    }

    /// The same for robots whose centres keep this far off debris and walls, in metres, with doors that are
    /// wide enough for a robot, perhaps narrower than the flood fill can tell: their middles. Nobody has a
    /// place in such a door.
    pub fn through(arena: Point, debris: &[DebrisFile], keep_off_m: f64, doors: &[Point]) -> Self {
        let outlines: Vec<Outline> = debris.iter().map(DebrisFile::outline).collect();
        let (columns, rows) = ((arena[0] / CELL_M) as usize, (arena[1] / CELL_M) as usize);
        let point = |i: usize| [(i % columns) as f64 * CELL_M, (i / columns) as f64 * CELL_M];
        let free: Vec<bool> = (0..columns * rows)
            .map(|i| {
                let [x, y] = point(i);
                let off_walls = x.min(y).min(arena[0] - x).min(arena[1] - y) >= keep_off_m;
                let at = Vector::new(x as f32, y as f32);
                off_walls && outlines.iter().all(|outline| outline.distance_to(at) >= keep_off_m as f32)
            })
            .collect();
        let in_a_door = |i: usize| {
            let [x, y] = point(i);
            doors.iter().any(|door| (x - door[0]).hypot(y - door[1]) < keep_off_m + DOOR_M)
        };
        let passable: Vec<bool> = (0..free.len()).map(|i| free[i] || in_a_door(i)).collect();
        let mut part = vec![usize::MAX; free.len()];
        let mut sizes = Vec::new();
        for start in 0..free.len() {
            if !passable[start] || part[start] != usize::MAX {
                continue;
            }
            let (mut open, mut size) = (vec![start], 0);
            part[start] = sizes.len();
            while let Some(i) = open.pop() {
                size += 1;
                let next = [(i % columns > 0).then(|| i - 1), (i % columns + 1 < columns).then(|| i + 1)];
                let next = next.into_iter().chain([i.checked_sub(columns), Some(i + columns)]).flatten();
                for j in next.filter(|j| *j < free.len()) {
                    if passable[j] && part[j] == usize::MAX {
                        part[j] = sizes.len();
                        open.push(j);
                    }
                }
            }
            sizes.push(size);
        }
        let largest = (0..sizes.len()).max_by_key(|k| sizes[*k]);
        Self { columns, inside: (0..free.len()).map(|i| free[i] && Some(part[i]) == largest).collect() }
    }

    /// Whether a robot can stand at a place and reach the rest of the free plane.
    pub fn contains(&self, [x, y]: Point) -> bool {
        let (column, row) = ((x / CELL_M).round() as usize, (y / CELL_M).round() as usize);
        column < self.columns && self.inside.get(row * self.columns + column).copied().unwrap_or(false)
    }

    /// A free place away from the taken places.
    pub fn draw(&self, draws: &mut ChaCha8Rng, taken: &[Point]) -> Option<Point> {
        (0..300).find_map(|_| {
            let i = draws.random_range(0..self.inside.len());
            let place = [(i % self.columns) as f64 * CELL_M, (i / self.columns) as f64 * CELL_M];
            let apart = |other: &Point| (place[0] - other[0]).hypot(place[1] - other[1]) >= 1.3;
            (self.inside[i] && taken.iter().all(apart)).then_some(place)
        })
    }
}
