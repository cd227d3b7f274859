//! The problems of `problems.ron`, and the draws of a seed: crowds in rooms and on a grid, starts, battery
//! levels.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use ron_tree::Node;
use scenario::Point;
use serde::Deserialize;

use super::world::World;

/// Number of draws of a random place before a room counts as full.
const DRAWS: u32 = 2000;

/// A kind of world; each seed gives one instance.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Problem {
    /// Name of the problem and of its file.
    pub name: String,
    /// Task of the robots.
    pub what: String,
    /// Source of the problem.
    pub source: String,
    layout: Layout,
}

/// Where robots and walls are, before a seed moves the starts.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
enum Layout {
    /// Robots with their goals, robots without one, and walls by two corners.
    Fixed {
        size: Point,
        robots: Vec<[Point; 2]>,
        #[serde(default)]
        parked: Vec<Point>,
        #[serde(default)]
        walls: Vec<[Point; 2]>,
    },
    /// A room with boxes, drawn by the seed.
    Room { robots: u32 },
    /// A square grid with a permutation drawn by the seed.
    Grid { columns: usize, spacing_m: f64 },
}

/// All problems, in the order of the table.
pub fn problems() -> Vec<Problem> {
    let tree = Node::parse(include_str!("problems.ron")).expect("problems.ron is RON");
    tree.read_as().unwrap_or_else(|problem| panic!("problems.ron: {problem}"))
}

impl Problem {
    /// The instance of a seed.
    pub(super) fn world(&self, seed: u64) -> World {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let mut world = match &self.layout {
            Layout::Fixed { size: [width, height], robots, parked, walls } => {
                let mut world = World::new(*width, *height);
                robots.iter().for_each(|[start, goal]| world.robot(*start, *goal));
                parked.iter().for_each(|at| world.parked(*at));
                walls.iter().for_each(|[low, high]| world.wall(*low, *high));
                world
            }
            Layout::Room { robots } => room(&mut draws, *robots),
            Layout::Grid { columns, spacing_m } => grid(&mut draws, *columns, *spacing_m),
        };
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

/// A random permutation of the places of a grid in which every robot changes its place.
fn grid(draws: &mut ChaCha8Rng, columns: usize, spacing: f64) -> World {
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
