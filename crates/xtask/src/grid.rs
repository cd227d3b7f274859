//! Maps of the grid benchmarks of multi-agent pathfinding as scenarios with errands: a cell is a metre, blocked
//! cells are boxes, and an agent is a robot of 0.25 m.
//!
//! The formats are those of the `MovingAI` benchmarks (Sturtevant, "Benchmarks for grid-based pathfinding", 2012;
//! Stern et al., "Multi-agent pathfinding: definitions, variants, and benchmarks", 2019): `.map` has a header
//! and a line of letters for each row, `.scen` a line for each agent.

use rand::seq::SliceRandom;
use rand::{SeedableRng, rngs::ChaCha8Rng};
use thiserror::Error;
use usar_sim::scenario::{DebrisFile, DebrisShape, Errand, RoleFile, Row, Scenario, ScenarioFile};

use crate::worlds::base;

/// A text that is no map or no list of agents.
#[derive(Debug, Error)]
#[error("line {line}: {rule}, found {found:?}")]
pub struct GridError {
    /// Number of the line, from 1.
    line: usize,
    rule: &'static str,
    found: String,
}

/// A cell: its column and its row, from the upper left corner.
type Cell = [usize; 2];

/// A map.
pub struct Grid {
    width: usize,
    /// For each cell, row by row from the top, whether it is free.
    free: Vec<bool>,
}

/// The way of an agent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Agent {
    from: Cell,
    to: Cell,
}

impl Grid {
    /// Reads a `.map`. `.`, `G` and `S` are free.
    ///
    /// # Errors
    /// The text is no map.
    pub fn parse(text: &str) -> Result<Self, GridError> {
        let mut lines = text.lines().enumerate();
        let is_map = |(_, line): &(usize, &str)| line.trim() == "map";
        if !lines.by_ref().any(|line| is_map(&line)) {
            return Err(GridError { line: 1, rule: "must have a line `map`", found: String::new() });
        }
        let rows: Vec<(usize, &str)> = lines.filter(|(_, row)| !row.trim().is_empty()).collect();
        let width = rows.first().map_or(0, |(_, row)| row.trim().len());
        let mut free = Vec::new();
        for (line, row) in rows {
            let cells = row.trim().bytes();
            if cells.len() != width {
                let rule = "must be as long as the first row";
                return Err(GridError { line: line + 1, rule, found: row.to_owned() });
            }
            free.extend(cells.map(|cell| matches!(cell, b'.' | b'G' | b'S')));
        }
        Ok(Self { width, free })
    }

    /// Reads a `.scen`: the first `robots` of its agents.
    ///
    /// # Errors
    /// A line does not name two free cells of this map.
    pub fn agents(&self, text: &str, robots: usize) -> Result<Vec<Agent>, GridError> {
        let lines = text.lines().enumerate().skip(1).filter(|(_, line)| !line.trim().is_empty());
        let agent = |(line, text): (usize, &str)| {
            let numbers: Vec<usize> =
                text.split_whitespace().skip(4).map_while(|word| word.parse().ok()).collect();
            let &[x, y, to_x, to_y, ..] = &numbers[..] else {
                let rule = "must have bucket, map, width, height, and start and goal by column and row";
                return Err(GridError { line: line + 1, rule, found: text.to_owned() });
            };
            let agent = Agent { from: [x, y], to: [to_x, to_y] };
            if !self.is_free(agent.from) || !self.is_free(agent.to) {
                let rule = "must lead from a free cell to a free cell";
                return Err(GridError { line: line + 1, rule, found: text.to_owned() });
            }
            Ok(agent)
        };
        lines.take(robots).map(agent).collect()
    }

    /// Agents with different starts and different goals in the largest part of the map, drawn by a seed.
    pub fn drawn(&self, robots: usize, seed: u64) -> Vec<Agent> {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let (mut starts, mut goals) = (self.largest_part(), self.largest_part());
        starts.shuffle(&mut draws);
        goals.shuffle(&mut draws);
        starts.into_iter().zip(goals).take(robots).map(|(from, to)| Agent { from, to }).collect()
    }

    fn is_free(&self, [x, y]: Cell) -> bool {
        x < self.width && y < self.height() && self.free[y * self.width + x]
    }

    fn height(&self) -> usize {
        self.free.len() / self.width.max(1)
    }

    /// The largest part of the map whose cells are connected by their sides.
    fn largest_part(&self) -> Vec<Cell> {
        let mut seen = vec![false; self.free.len()];
        let mut largest = Vec::new();
        for start in 0..self.free.len() {
            let mut part = Vec::new();
            let mut open = vec![[start % self.width, start / self.width]];
            while let Some([x, y]) = open.pop() {
                if self.is_free([x, y]) && !std::mem::replace(&mut seen[y * self.width + x], true) {
                    part.push([x, y]);
                    open.extend([[x.wrapping_sub(1), y], [x + 1, y], [x, y.wrapping_sub(1)], [x, y + 1]]);
                }
            }
            if part.len() > largest.len() {
                largest = part;
            }
        }
        largest
    }

    /// The blocked cells as boxes: runs of a row, with the same run in the rows below.
    fn boxes(&self) -> Vec<[Cell; 2]> {
        let mut done = vec![false; self.free.len()];
        let mut boxes = Vec::new();
        for y in 0..self.height() {
            for x in 0..self.width {
                let is_open =
                    |done: &[bool], x: usize, y: usize| !self.is_free([x, y]) && !done[y * self.width + x];
                let to_x = (x..self.width).find(|x| !is_open(&done, *x, y)).unwrap_or(self.width);
                if to_x == x {
                    continue;
                }
                let is_end = |y: &usize| !(x..to_x).all(|x| is_open(&done, x, *y));
                let to_y = (y..self.height()).find(is_end).unwrap_or(self.height());
                (y..to_y).for_each(|y| done[y * self.width + x..y * self.width + to_x].fill(true));
                boxes.push([[x, y], [to_x, to_y]]);
            }
        }
        boxes
    }

    /// The scenario in which agents go their ways.
    ///
    /// # Panics
    /// The scenario breaks a rule, which would be a fault of this file.
    pub fn scenario(&self, agents: &[Agent], name: &str, duration_s: f64) -> Scenario {
        let at = |[x, y]: [f64; 2]| [x, self.height() as f64 - y];
        let middle = |cell: Cell| at(cell.map(|x| x as f64 + 0.5));
        let role = RoleFile {
            name: "robot".to_owned(),
            radius_m: 0.25,
            speed_mps: 1.0,
            acceleration_mps2: 2.0,
            sensing_m: 1000.0,
            ..RoleFile::default()
        };
        let debris = |[low, high]: [Cell; 2]| {
            let shape = DebrisShape::Box((high[0] - low[0]) as f64, (high[1] - low[1]) as f64);
            let middle = [0, 1].map(|k| f64::midpoint(low[k] as f64, high[k] as f64));
            DebrisFile::fixed(shape, at(middle))
        };
        let mut file: ScenarioFile = base(0, [self.width as f64, self.height() as f64], duration_s);
        name.clone_into(&mut file.name);
        file.team = agents.iter().map(|agent| Row::of_one(&role.name, middle(agent.from))).collect();
        file.errands =
            (0..).zip(agents).map(|(robot, agent)| Errand { robot, to: vec![middle(agent.to)] }).collect();
        file.debris = self.boxes().into_iter().map(debris).collect();
        file.roles = vec![role];
        for rates in [&mut file.costs.energy, &mut file.costs.hp] {
            (rates.per_step, rates.per_metre, rates.per_second) = (0.0, 0.0, 0.0);
        }
        Scenario::try_from(file).unwrap_or_else(|problems| panic!("{name}: {problems:?}"))
    }
}
