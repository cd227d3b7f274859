//! Agents with random starts, goals, radii and speeds in a square: the problems of CADRL (Chen, Liu, Everett
//! and How, 2017, arXiv 1609.07845), drawn by the rules of the authors' public code (`generate_rand_case` in
//! github.com/mit-acl/gym-collision-avoidance, with the ranges of `gen_results_multi.py` there).

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use scenario::{Body, Errand, LayoutError, Point, Row, Scenario};
use serde::Serialize;
use usar_sim::event::Event;
use usar_sim::simulation::{Advance, Simulation};

use super::crowd::{RELAXATION_S, keep_fresh, role};
use crate::worlds::base;

/// Ranges of speeds, in metres per second, and of radii, in metres.
const SPEED_MPS: [f64; 2] = [0.5, 1.2];
const RADIUS_M: [f64; 2] = [0.3, 0.5];

/// Distance beyond their radii that starts, goals and ways keep from each other, in metres.
const CLOSE_M: f64 = 0.2;

/// Share of half the square's side within which a goal is from one side of the square.
const AT_SIDE: f64 = 0.1;

/// Factor by which the square grows with each draw.
const GROWTH: f64 = 1.01;

/// Free space around all starts and goals, in metres.
const AROUND_M: f64 = 3.0;

/// An agent.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Agent {
    /// Where it starts, from the middle of the square, in metres.
    pub start: Point,
    /// Where it goes.
    pub goal: Point,
    /// Its radius, in metres.
    pub radius_m: f64,
    /// Its preferred speed, in metres per second.
    pub speed_mps: f64,
}

/// What came of a case.
#[derive(Debug, Clone, Copy)]
pub struct Outcome {
    /// Whether two bodies overlapped.
    pub collided: bool,
    /// Whether an agent did not arrive.
    pub stuck: bool,
    /// Mean of the agents' times beyond those of straight lines at their preferred speeds, in seconds.
    pub extra_s: f64,
    /// The same of the agents when each is alone.
    pub extra_alone_s: f64,
}

impl Agent {
    /// Time on the straight line at the preferred speed, in seconds.
    pub fn straight_s(&self) -> f64 {
        distance(self.start, self.goal) / self.speed_mps
    }

    fn at(&self, seconds: f64) -> Point {
        let share = (seconds / self.straight_s()).min(1.0);
        [0, 1].map(|k| self.start[k] + share * (self.goal[k] - self.start[k]))
    }

    /// Whether both can go straight at their preferred speeds and keep clear of each other.
    fn is_clear_of(&self, other: &Self) -> bool {
        let [mine, others] = [self, other].map(Self::straight_s);
        let (sooner, later) = (mine.min(others), mine.max(others));
        let apart = |[from, to]: [f64; 2]| {
            // Both move evenly between the two times, so that the way between them is a straight line.
            let between = |time| [0, 1].map(|k| self.at(time)[k] - other.at(time)[k]);
            to_origin(between(from), between(to))
        };
        let closest = self.radius_m + other.radius_m + CLOSE_M;
        [[0.0, sooner], [sooner, later]].into_iter().all(|times| apart(times) >= closest)
    }
}

fn distance(a: Point, b: Point) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

/// Distance of the origin from the line between two points.
fn to_origin(a: Point, b: Point) -> f64 {
    let way = [0, 1].map(|k| b[k] - a[k]);
    let square = way[0] * way[0] + way[1] * way[1];
    let along = if square > 0.0 { -(a[0] * way[0] + a[1] * way[1]) / square } else { 0.0 };
    let nearest = [0, 1].map(|k| a[k] + along.clamp(0.0, 1.0) * way[k]);
    libm::hypot(nearest[0], nearest[1])
}

/// The case of a seed: no agent can go straight past all those drawn before it.
pub fn case(agents: u32, seed: u64) -> Vec<Agent> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut half = 0.5 + f64::from(agents) / 2.0;
    let mut drawn: Vec<Agent> = Vec::new();
    while drawn.len() < agents as usize {
        let radius_m = random.random_range(RADIUS_M[0]..RADIUS_M[1]);
        let speeds = [0, 1].map(|_| random.random_range(SPEED_MPS[0]..SPEED_MPS[1]));
        let speed_mps = f64::max(speeds[0], speeds[1]);
        let agent = loop {
            half *= GROWTH;
            let start = [0, 1].map(|_| random.random_range(-half..half));
            let mut goal = [0, 1].map(|_| random.random_range(-half..half));
            let (axis, sign) =
                (random.random_range(0..2_usize), [-1.0, 1.0][random.random_range(0..2_usize)]);
            goal[axis] = sign * half * (1.0 - AT_SIDE * random.random_range(0.0..1.0));
            let agent = Agent { start, goal, radius_m, speed_mps };
            let is_apart = |other: &Agent| {
                let least = radius_m + other.radius_m + CLOSE_M;
                distance(start, other.start) >= least && distance(goal, other.goal) >= least
            };
            let is_in_a_way = drawn.is_empty() || drawn.iter().any(|other| !agent.is_clear_of(other));
            if is_in_a_way && drawn.iter().all(is_apart) && distance(start, goal) > half / 2.0 {
                break agent;
            }
        };
        drawn.push(agent);
    }
    drawn
}

/// The case as a scenario.
fn scenario(agents: &[Agent], seed: u64, duration_s: f64) -> Scenario {
    let places = agents.iter().flat_map(|agent| [agent.start, agent.goal]);
    let middle = places.flatten().map(f64::abs).fold(0.0, f64::max) + AROUND_M;
    let mut file = base(seed, [2.0 * middle; 2], duration_s);
    let shifted = |at: Point| at.map(|x| x + middle);
    file.roles = vec![role(SPEED_MPS[1])];
    for (id, agent) in (0..).zip(agents) {
        let body = Body {
            radius_m: Some(agent.radius_m),
            speed_mps: Some(agent.speed_mps),
            acceleration_mps2: Some(agent.speed_mps / RELAXATION_S),
            ..Body::default()
        };
        file.team.push(Row { body: Some(body), ..Row::of_one("robot", shifted(agent.start)) });
        file.errands.push(Errand { robot: id, to: vec![shifted(agent.goal)] });
    }
    keep_fresh(&mut file);
    Scenario::try_from(file).unwrap_or_else(|problems| panic!("{agents:?}: {problems:?}"))
}

/// Arrival times, and whether two bodies overlapped.
fn arrivals(agents: &[Agent], seed: u64) -> Result<Arrivals, LayoutError> {
    let longest = agents.iter().map(Agent::straight_s).fold(0.0, f64::max);
    let mut simulation = Simulation::new(&scenario(agents, seed, 5.0 * longest + 30.0), seed)?;
    let mut arrivals = Arrivals { times_s: vec![None; agents.len()], collided: false };
    while matches!(simulation.advance(), Advance::Running) {
        for event in simulation.events() {
            if let Event::ErrandDone { robot } = event {
                arrivals.times_s[robot.index()] = Some(simulation.time_s());
            }
        }
        let robots = &simulation.world().robots;
        for (i, a) in robots.iter().enumerate() {
            let overlaps =
                |b: &usar_sim::world::Robot| (a.position - b.position).length() < a.radius() + b.radius();
            arrivals.collided |= robots[i + 1..].iter().any(overlaps);
        }
    }
    Ok(arrivals)
}

struct Arrivals {
    times_s: Vec<Option<f64>>,
    collided: bool,
}

/// Runs the case of a seed.
///
/// # Errors
/// The world has no room for the agents.
pub fn run(count: u32, seed: u64) -> Result<Outcome, LayoutError> {
    let agents = case(count, seed);
    let extra = |agent: &Agent, time_s: f64| (time_s - agent.straight_s()) / f64::from(count);
    let together = arrivals(&agents, seed)?;
    let times = together.times_s.iter().zip(&agents);
    let extra_s = times.filter_map(|(time_s, agent)| Some(extra(agent, (*time_s)?))).sum();
    let mut extra_alone_s = 0.0;
    for agent in &agents {
        let alone = arrivals(&[*agent], seed)?;
        extra_alone_s += alone.times_s[0].map_or(f64::NAN, |time_s| extra(agent, time_s));
    }
    let stuck = together.times_s.contains(&None);
    Ok(Outcome { collided: together.collided, stuck, extra_s, extra_alone_s })
}
