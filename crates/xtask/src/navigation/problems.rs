//! The problems, each with its source: open space, narrow places, crowds.
//!
//! Sources, as the problems name them:
//! - ORCA: van den Berg, Guy, Lin, Manocha, "Reciprocal n-body collision avoidance", ISRR 2009 (Springer
//!   2011). Robots on a circle swap to the antipodal places.
//! - CADRL: Chen, Liu, Everett, How, "Decentralized non-communicating multiagent collision avoidance with
//!   deep reinforcement learning", ICRA 2017. Crossings and swaps.
//! - Social mini-games: Chandra, Zinage, Bakolas, Stone, Biswas, arXiv 2308.10966. Doorway, hallway,
//!   intersection.
//! - MAPF: Stern et al., "Multi-agent pathfinding: definitions, variants, and benchmarks", Symposium on
//!   Combinatorial Search 2019. Swapping conflicts, which corridors force; random obstacles; permutations.
//!
//! The papers leave sizes open or use other robots. Here sizes follow from the robot. It needs 0.8 m of
//! width, because its routes keep 0.15 m from walls. One lane is 0.9 m wide, too narrow for two robots side
//! by side. Two lanes are 1.6 m wide: two robots pass with all their margins.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use usar_sim::scenario::Point;

use super::world::World;

/// Width of a lane for one robot, in metres.
const LANE_M: f64 = 0.9;

/// Width of two lanes, in metres.
const TWO_LANES_M: f64 = 1.6;

/// Thickness of a wall with a door, in metres.
const DOOR_DEPTH_M: f64 = 0.4;

/// Distance between robots that start side by side, in metres.
const SPACING_M: f64 = 1.1;

/// Distance between robots among which no other robot fits through, in metres.
const DENSE_M: f64 = 0.9;

/// Number of draws of a random place before a room counts as full.
const DRAWS: u32 = 2000;

/// Robots that start side by side in one column.
const ABREAST: u32 = 5;

/// Width of a room at the end of a corridor for up to five robots, and height of any such room, in metres.
const ROOM_M: [f64; 2] = [3.0, 6.0];

/// The papers, as the headers of the files name them.
const ORCA: &str = "antipodal circle of van den Berg et al. 2011 (ORCA)";
const CADRL: &str = "crossing of Chen et al. 2017 (CADRL)";
const MINI_GAME: &str = "social mini-game of Chandra et al., arXiv 2308.10966";
const MAPF: &str = "swapping conflicts of Stern et al. 2019 (MAPF)";
const BENCHMARK: &str = "random obstacles and permutations of Stern et al. 2019 (MAPF)";
const OWN: &str = "a problem of this project, on which the paper's right of way fails";

/// A kind of world; each seed gives one instance.
#[derive(Clone, Copy)]
pub struct Problem {
    /// Name of the problem and of its file.
    pub name: &'static str,
    /// Task of the robots.
    pub what: &'static str,
    /// Source of the problem.
    pub source: &'static str,
    make: fn(&mut ChaCha8Rng) -> World,
}

impl Problem {
    const fn new(
        name: &'static str,
        what: &'static str,
        source: &'static str,
        make: fn(&mut ChaCha8Rng) -> World,
    ) -> Self {
        Self { name, what, source, make }
    }

    /// The instance of a seed.
    pub(super) fn world(&self, seed: u64) -> World {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let mut world = (self.make)(&mut draws);
        world.jitter(&mut draws);
        world
    }

    /// The scenario of a seed, as text.
    pub fn text(&self, seed: u64) -> String {
        let world = self.world(seed);
        let Self { name, what, source, .. } = self;
        format!(
            "// {what}.\n// After: {source}.\n// Seed {seed} of the benchmark of right of way; written by \
             `just navigation --write`.\n{}",
            world.text(name, what)
        )
    }
}

/// All problems: first open space, then narrow places, then crowds.
pub const PROBLEMS: [Problem; 33] = [
    Problem::new("circle_2", "Two robots swap places", ORCA, |_| circle(2)),
    Problem::new("circle_4", "4 robots on a circle swap to the opposite places", ORCA, |_| circle(4)),
    Problem::new("circle_8", "8 robots on a circle swap to the opposite places", ORCA, |_| circle(8)),
    Problem::new("circle_16", "16 robots on a circle swap to the opposite places", ORCA, |_| circle(16)),
    Problem::new("circle_32", "32 robots on a circle swap to the opposite places", ORCA, |_| circle(32)),
    Problem::new("circle_50", "50 robots on a circle swap to the opposite places", ORCA, |_| circle(50)),
    Problem::new("crossing_4", "Two groups of 2 cross at a right angle", CADRL, |_| crossing(2)),
    Problem::new("crossing_8", "Two groups of 4 cross at a right angle", CADRL, |_| crossing(4)),
    Problem::new("crossing_16", "Two groups of 8 cross at a right angle", CADRL, |_| crossing(8)),
    Problem::new("crossing_24", "Two groups of 12 cross at a right angle", CADRL, |_| crossing(12)),
    Problem::new("doorway_2", "Two robots side by side want through one door", MINI_GAME, |_| bottleneck(2)),
    Problem::new("hallway_2", "Two robots meet head-on in a hallway wide enough for both", MINI_GAME, |_| {
        hallway()
    }),
    Problem::new("intersection_2", "Two robots cross where two hallways cross", MINI_GAME, |_| {
        intersection(2)
    }),
    Problem::new("intersection_4", "Four robots cross where two hallways cross", MINI_GAME, |_| {
        intersection(4)
    }),
    Problem::new("bay_1v1", "Two robots swap ends of a one-lane corridor with a bay", MAPF, |_| bay(1)),
    Problem::new("bay_2v2", "Two pairs swap ends of a one-lane corridor with a bay for two", MAPF, |_| {
        bay(2)
    }),
    Problem::new("two_lanes_1v1", "Two robots swap ends of a two-lane corridor", MAPF, |_| {
        corridor(1, 10.0, TWO_LANES_M)
    }),
    Problem::new("two_lanes_5v5", "Groups of 5 swap ends of a two-lane corridor", MAPF, |_| {
        corridor(5, 10.0, TWO_LANES_M)
    }),
    Problem::new("two_lanes_10v10", "Groups of 10 swap ends of a two-lane corridor", MAPF, |_| {
        corridor(10, 10.0, TWO_LANES_M)
    }),
    Problem::new("one_lane_1v1", "Two robots swap ends of a short one-lane corridor", MAPF, |_| {
        corridor(1, 4.0, LANE_M)
    }),
    Problem::new("one_lane_2v2", "Two pairs swap ends of a short one-lane corridor", MAPF, |_| {
        corridor(2, 4.0, LANE_M)
    }),
    Problem::new("doorway_5v5", "Groups of 5 change rooms through one door", MINI_GAME, |_| {
        corridor(5, DOOR_DEPTH_M, LANE_M)
    }),
    Problem::new("doorway_10v10", "Groups of 10 change rooms through one door", MINI_GAME, |_| {
        corridor(10, DOOR_DEPTH_M, LANE_M)
    }),
    Problem::new(
        "lane_crossing_8",
        "Two robots from each of four rooms go straight on where two one-lane corridors cross",
        MINI_GAME,
        |_| lane_crossing(),
    ),
    Problem::new("bottleneck_10", "10 robots go the same way through one door", MINI_GAME, |_| {
        bottleneck(10)
    }),
    Problem::new("bottleneck_20", "20 robots go the same way through one door", MINI_GAME, |_| {
        bottleneck(20)
    }),
    Problem::new("room_20", "20 robots in a room, a tenth of it obstacles", BENCHMARK, |draws| {
        room(draws, 20)
    }),
    Problem::new("room_50", "50 robots in a room, a tenth of it obstacles", BENCHMARK, |draws| {
        room(draws, 50)
    }),
    Problem::new("room_100", "100 robots in a room, a tenth of it obstacles", BENCHMARK, |draws| {
        room(draws, 100)
    }),
    Problem::new("parked_row", "Three robots go round a row of four parked robots", OWN, |_| parked_row()),
    Problem::new("parked_across", "Three parked robots abreast close the way of a fourth", OWN, |_| {
        parked_across()
    }),
    Problem::new("swap_42", "Two groups of 21 swap sides of a room that they fill", OWN, |_| swap()),
    Problem::new("grid_16", "16 robots on a grid take each other's places at random", BENCHMARK, |draws| {
        grid(draws)
    }),
];

/// Robots on a circle, each with the opposite place as its goal. The circle has at least a metre of rim for
/// each robot.
fn circle(robots: u32) -> World {
    let radius = f64::max(4.0, f64::from(robots) / std::f64::consts::TAU);
    let middle = (radius + 2.0).ceil();
    let mut world = World::new(2.0 * middle, 2.0 * middle);
    for i in 0..robots {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(robots);
        let (x, y) = (radius * libm::cos(angle), radius * libm::sin(angle));
        world.robot([middle + x, middle + y], [middle - x, middle - y]);
    }
    world
}

/// A group from the west to the east and a group from the south to the north, whose paths cross in the
/// middle.
fn crossing(each: u32) -> World {
    let abreast = if each <= 4 { 2 } else { 4 };
    let rows = each.div_ceil(abreast);
    let middle = 9.0;
    let mut world = World::new(2.0 * middle, 2.0 * middle);
    for i in 0..each {
        let beside = middle + f64::from(i % abreast) - f64::from(abreast - 1) / 2.0;
        let start = middle - 5.0 - f64::from(i / abreast);
        let goal = start + 10.0 + f64::from(rows - 1);
        world.robot([start, beside], [goal, beside]);
        world.robot([beside, start], [beside, goal]);
    }
    world
}

/// Places of a group in a room of this height: columns side by side, the first next to the exit at `x`.
fn columns(robots: u32, exit_x: f64, height: f64) -> impl Iterator<Item = Point> {
    (0..robots).map(move |i| {
        let column = i / ABREAST;
        let in_column = (robots - column * ABREAST).min(ABREAST);
        let y = height / 2.0 + SPACING_M * (f64::from(i % ABREAST) - f64::from(in_column - 1) / 2.0);
        [exit_x - 2.0 - SPACING_M * f64::from(column), y]
    })
}

/// Width of a room for this many robots, in metres.
fn room_width(robots: u32) -> f64 {
    ROOM_M[0] + SPACING_M * f64::from((robots - 1) / ABREAST)
}

/// Two rooms and a corridor of this length and width between them, along the middle.
fn rooms(room: f64, length: f64, width: f64) -> World {
    let height = ROOM_M[1];
    let mut world = World::new(2.0 * room + length, height);
    world.wall([room, 0.0], [room + length, (height - width) / 2.0]);
    world.wall([room, f64::midpoint(height, width)], [room + length, height]);
    world
}

/// Two groups swap the ends of a corridor; each robot goes to the opposite place.
fn corridor(each: u32, length: f64, width: f64) -> World {
    let room = room_width(each);
    let mut world = rooms(room, length, width);
    for [x, y] in columns(each, room, ROOM_M[1]) {
        let opposite = 2.0 * room + length - x;
        world.robot([x, y], [opposite, y]);
        world.robot([opposite, y], [x, y]);
    }
    world
}

/// A group goes through a door from one room to the next; the robots in front go farthest.
fn bottleneck(robots: u32) -> World {
    let room = room_width(robots);
    let mut world = rooms(room, DOOR_DEPTH_M, LANE_M);
    for [x, y] in columns(robots, room, ROOM_M[1]) {
        world.robot([x, y], [x + room + DOOR_DEPTH_M + 1.0, y]);
    }
    world
}

/// A hallway of two lanes, closed at both ends.
fn hallway() -> World {
    let (length, height) = (12.0, 2.0);
    let wall = (height - TWO_LANES_M) / 2.0;
    let mut world = World::new(length, height);
    world.wall([0.0, 0.0], [length, wall]);
    world.wall([0.0, height - wall], [length, height]);
    world.robot([1.0, 1.0], [length - 1.0, 1.0]);
    world.robot([length - 1.0, 1.0], [1.0, 1.0]);
    world
}

/// Two crossing hallways of two lanes: two robots at a right angle, or one from each side.
fn intersection(robots: u32) -> World {
    let size = 12.0;
    let (middle, wall) = (size / 2.0, (size - TWO_LANES_M) / 2.0);
    let mut world = World::new(size, size);
    for (x, y) in [(0.0, 0.0), (size - wall, 0.0), (0.0, size - wall), (size - wall, size - wall)] {
        world.wall([x, y], [x + wall, y + wall]);
    }
    let ends = [[1.0, middle], [middle, 1.0], [size - 1.0, middle], [middle, size - 1.0]];
    for i in 0..robots as usize {
        world.robot(ends[i], ends[(i + 2) % 4]);
    }
    world
}

/// A one-lane corridor that is too long to back out of. A bay half way along it has room for all robots of
/// one side.
fn bay(each: u32) -> World {
    let (room, length, depth) = (ROOM_M[0], 10.0, 1.0);
    let (height, half) = (ROOM_M[1], 0.05 + LANE_M / 2.0 * f64::from(each));
    let (edge, middle) = (f64::midpoint(height, LANE_M), room + length / 2.0);
    let mut world = World::new(2.0 * room + length, height);
    world.wall([room, 0.0], [room + length, height - edge]);
    world.wall([room, edge], [middle - half, height]);
    world.wall([middle + half, edge], [room + length, height]);
    world.wall([middle - half, edge + depth], [middle + half, height]);
    for [x, y] in columns(each, room, height) {
        let opposite = 2.0 * room + length - x;
        world.robot([x, y], [opposite, y]);
        world.robot([opposite, y], [x, y]);
    }
    world
}

/// Two crossing one-lane corridors, with a room at each of the four ends and two robots in each room.
fn lane_crossing() -> World {
    let (room, arm, half_room) = (ROOM_M[0], 3.0, 2.0);
    let size = 2.0 * (room + arm) + LANE_M;
    let (middle, lane) = (size / 2.0, room + arm);
    let corner = middle - half_room;
    let mut world = World::new(size, size);
    // The walls of the lower left corner; the other corners mirror them.
    let walls =
        [[[0.0, 0.0], [corner, corner]], [[room, corner], [lane, lane]], [[corner, room], [lane, corner]]];
    for [low, high] in walls {
        let mirrored =
            |flip: bool, low: f64, high: f64| if flip { [size - high, size - low] } else { [low, high] };
        for (flip_x, flip_y) in [(false, false), (true, false), (false, true), (true, true)] {
            let x = mirrored(flip_x, low[0], high[0]);
            let y = mirrored(flip_y, low[1], high[1]);
            world.wall([x[0], y[0]], [x[1], y[1]]);
        }
    }
    for beside in [middle - 0.6, middle + 0.6] {
        world.robot([1.0, beside], [size - 1.0, beside]);
        world.robot([size - 1.0, beside], [1.0, beside]);
        world.robot([beside, 1.0], [beside, size - 1.0]);
        world.robot([beside, size - 1.0], [beside, 1.0]);
    }
    world
}

/// Random boxes on a tenth of the floor, random starts and goals; six square metres for each robot.
fn room(draws: &mut ChaCha8Rng, robots: u32) -> World {
    loop {
        if let Some(world) = try_room(draws, robots) {
            return world;
        }
    }
}

/// A draw of a room; `None` if there is no place left for something. Boxes are a metre from each other and
/// from the walls, so that every place can be reached. Starts are a metre apart, and so are goals.
fn try_room(draws: &mut ChaCha8Rng, robots: u32) -> Option<World> {
    let (share, gap, apart, off_walls) = (0.1, 1.0, 1.0, 0.5);
    let size = (10.0 * libm::sqrt(6.0 * f64::from(robots))).round() / 10.0;
    let mut world = World::new(size, size);
    let mut boxes: Vec<[Point; 2]> = Vec::new();
    let mut left = share * size * size;
    while left > 0.0 {
        let [low, high] = (0..DRAWS).find_map(|_| {
            let [w, h] = [0, 1].map(|_| f64::from(draws.random_range(6..=16_u32)) / 10.0);
            let (x, y) = (draws.random_range(gap..size - gap - w), draws.random_range(gap..size - gap - h));
            let is_off = |[low, high]: &[Point; 2]| {
                x > high[0] + gap || x + w < low[0] - gap || y > high[1] + gap || y + h < low[1] - gap
            };
            boxes.iter().all(is_off).then_some([[x, y], [x + w, y + h]])
        })?;
        boxes.push([low, high]);
        world.wall(low, high);
        left -= (high[0] - low[0]) * (high[1] - low[1]);
    }
    let [mut starts, mut goals]: [Vec<Point>; 2] = [Vec::new(), Vec::new()];
    for _ in 0..robots {
        for taken in [&mut starts, &mut goals] {
            let place = (0..DRAWS).find_map(|_| {
                let at = [0, 1].map(|_| draws.random_range(0.0..size));
                let is_off = |other: &Point| libm::hypot(at[0] - other[0], at[1] - other[1]) >= apart;
                (world.is_clear(at, off_walls) && taken.iter().all(is_off)).then_some(at)
            })?;
            taken.push(place);
        }
    }
    starts.into_iter().zip(goals).for_each(|(start, goal)| world.robot(start, goal));
    Some(world)
}

/// A row of parked robots with a way around it at one end.
fn parked_row() -> World {
    let mut world = World::new(10.0, 6.0);
    (0..3).for_each(|i| world.robot([1.0, 1.0 + f64::from(i)], [9.0, 1.0 + f64::from(i)]));
    (0..4).for_each(|i| world.parked([5.0, 0.45 + DENSE_M * f64::from(i)]));
    world
}

/// Three parked robots side by side in a passage, with gaps too narrow for a fourth robot: one of them has
/// to make room. It resembles `scenarios/minimal/row.ron`, where robots have a radius of 0.4 m and the
/// passage a width of 5.8 m.
fn parked_across() -> World {
    let (room, length, width) = (3.0, 6.0, 3.6);
    let mut world = rooms(room, length, width);
    let (middle, across) = (room + length / 2.0, ROOM_M[1] / 2.0);
    world.robot([1.0, across], [2.0 * middle - 1.0, across]);
    [-DENSE_M, 0.0, DENSE_M].into_iter().for_each(|beside| world.parked([middle, across + beside]));
    world
}

/// A room in which 42 robots take a fifth of the floor; each robot goes to the opposite place.
fn swap() -> World {
    let size = 6.3;
    let mut world = World::new(size, size);
    for i in 0..21_u32 {
        let (x, y) = (0.45 + DENSE_M * f64::from(i / 7), 0.45 + DENSE_M * f64::from(i % 7));
        world.robot([x, y], [size - x, y]);
        world.robot([size - x, y], [x, y]);
    }
    world
}

/// A random permutation of the places of a grid in which every robot changes its place.
fn grid(draws: &mut ChaCha8Rng) -> World {
    let (columns, spacing) = (4_usize, 1.2);
    let mut goals: Vec<usize> = (0..columns * columns).collect();
    while goals.iter().enumerate().any(|(i, goal)| i == *goal) {
        for i in (1..goals.len()).rev() {
            goals.swap(i, draws.random_range(0..=i));
        }
    }
    let place = |i: usize| [i % columns, i / columns].map(|k| spacing * (k as f64 + 0.5));
    let width = spacing * columns as f64;
    let mut world = World::new(width, width);
    goals.iter().enumerate().for_each(|(i, goal)| world.robot(place(i), place(*goal)));
    world
}
