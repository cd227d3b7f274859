//! One instance of a problem: robots with goals, and walls; and its text as a scenario.

use std::fmt::Write;

use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use scenario::Point;
use serde::Serialize;

/// Radius of every robot, in metres.
pub const RADIUS_M: f64 = 0.25;

/// Top speed of every robot, in metres per second.
pub const SPEED_MPS: f64 = 1.0;

/// Every robot reaches its top speed in half a second, nearly the same time as the default role (2.25 m/s
/// at 4 m/s²).
pub const ACCELERATION_MPS2: f64 = 2.0;

/// Larger than every world, so that all robots know all walls from the start.
const SENSING_M: f64 = 100.0;

/// The seed moves each start by up to this much along both axes, in metres.
const JITTER_M: f64 = 0.03;

/// Lowest and highest battery level that the seed draws, in percent. The level is the robot's priority. It
/// stays constant, because nothing costs energy.
const ENERGY: [f64; 2] = [50.0, 100.0];

/// A robot of a world.
#[derive(Debug, Clone, Copy, Serialize)]
pub(super) struct Robot {
    start: Point,
    /// Its goal; a robot without one is parked.
    goal: Option<Point>,
    energy: f64,
}

/// An instance of a problem.
#[derive(Debug, Clone, Serialize)]
pub(super) struct World {
    size: Point,
    robots: Vec<Robot>,
    /// Lower left and upper right corner of each wall.
    walls: Vec<[Point; 2]>,
}

impl World {
    /// An empty room of this width and height, in metres.
    pub(super) fn new(width: f64, height: f64) -> Self {
        Self { size: [width, height], robots: Vec::new(), walls: Vec::new() }
    }

    /// Adds a robot that has to go from one place to another.
    pub(super) fn robot(&mut self, start: Point, goal: Point) {
        self.robots.push(Robot { start, goal: Some(goal), energy: 0.0 });
    }

    /// Adds a robot without a goal.
    pub(super) fn parked(&mut self, at: Point) {
        self.robots.push(Robot { start: at, goal: None, energy: 0.0 });
    }

    /// Adds a wall between these corners.
    pub(super) fn wall(&mut self, low: Point, high: Point) {
        self.walls.push([low, high]);
    }

    /// Whether a disc of this radius around a place is clear of the walls and inside the room.
    pub(super) fn is_clear(&self, [x, y]: Point, radius: f64) -> bool {
        let inside = |v: f64, size: f64| (radius..=size - radius).contains(&v);
        let off = |[low, high]: &[Point; 2]| {
            let (dx, dy) = (x - x.clamp(low[0], high[0]), y - y.clamp(low[1], high[1]));
            libm::hypot(dx, dy) >= radius
        };
        inside(x, self.size[0]) && inside(y, self.size[1]) && self.walls.iter().all(off)
    }

    /// Draws battery levels and moves each start by a few centimetres.
    pub(super) fn jitter(&mut self, draws: &mut ChaCha8Rng) {
        for robot in &mut self.robots {
            robot.start = robot.start.map(|x| x + draws.random_range(-JITTER_M..JITTER_M));
            robot.energy = draws.random_range(ENERGY[0]..ENERGY[1]);
        }
    }

    /// A duration for `usar run`: 25 % more than the longest straight distance, times five, plus half a
    /// minute, rounded up to tens of seconds.
    fn duration_s(&self) -> f64 {
        let ways = self.robots.iter().filter_map(|robot| {
            let goal = robot.goal?;
            Some(libm::hypot(goal[0] - robot.start[0], goal[1] - robot.start[1]))
        });
        let seconds = 5.0 * 1.25 * ways.fold(0.0, f64::max) / SPEED_MPS + 30.0;
        (seconds / 10.0).ceil() * 10.0
    }

    /// The scenario as text, without the comment at its head.
    pub(super) fn text(&self, name: &str, description: &str) -> String {
        let mut text = String::new();
        self.write(&mut text, name, description).expect("memory");
        text
    }

    fn write(&self, to: &mut String, name: &str, description: &str) -> std::fmt::Result {
        let [width, height] = self.size;
        writeln!(to, "(\n    name: {name:?},\n    description: {description:?},")?;
        let duration_s = self.duration_s();
        writeln!(to, "    duration_s: {duration_s:.1}, dt_s: 0.02, arena_m: ({width:.1}, {height:.1}),")?;
        writeln!(
            to,
            "    roles: [(name: \"robot\", radius_m: {RADIUS_M:?}, speed_mps: {SPEED_MPS:?}, \
             acceleration_mps2: {ACCELERATION_MPS2:?}, sensing_m: {SENSING_M:?})],"
        )?;
        let free = "(per_step: 0.0, per_metre: 0.0, per_second: 0.0)";
        writeln!(to, "    costs: (energy: {free},\n        hp: {free}),\n    team: [")?;
        for Robot { start: [x, y], energy, .. } in &self.robots {
            writeln!(
                to,
                "        (role: \"robot\", count: 1, center: ({x:.3}, {y:.3}), width_m: 0.0, levels: \
                 (energy: {energy:.1}, hp: 100.0)),"
            )?;
        }
        writeln!(to, "    ],\n    errands: [")?;
        for (id, robot) in self.robots.iter().enumerate() {
            if let Some([x, y]) = robot.goal {
                writeln!(to, "        (robot: {id}, to: [({x:.3}, {y:.3})]),")?;
            }
        }
        writeln!(to, "    ],")?;
        if !self.walls.is_empty() {
            writeln!(to, "    debris: [")?;
            for [low, high] in &self.walls {
                let (w, h) = (high[0] - low[0], high[1] - low[1]);
                let (x, y) = (f64::midpoint(low[0], high[0]), f64::midpoint(low[1], high[1]));
                writeln!(to, "        (shape: Box({w:.3}, {h:.3}), at: ({x:.4}, {y:.4})),")?;
            }
            writeln!(to, "    ],")?;
        }
        writeln!(to, ")")
    }
}
