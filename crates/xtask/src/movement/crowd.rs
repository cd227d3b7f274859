//! A crowd of robots in a room, and its way out into a hall: a door, or a corridor between two doors. It is
//! measured where and how people in experiments were.

use rand::{RngExt, SeedableRng, rngs::ChaCha8Rng};
use scenario::{DebrisFile, DebrisShape, Errand, LayoutError, Normal, RoleFile, Row, Scenario, ScenarioFile};
use usar_sim::event::Event;
use usar_sim::robot::STANDING_MPS;
use usar_sim::simulation::{Advance, Simulation};
use usar_sim::world::Robot;

use super::literature::FREE_SPEED_MPS;
use crate::worlds::base;

/// Radius of a robot, in metres: the default of `JuPedSim`'s pedestrians.
pub const RADIUS_M: f64 = 0.2;

/// A robot reaches its preferred speed in half a second, the relaxation time of Helbing and Molnár (1995).
pub const RELAXATION_S: f64 = 0.5;

/// Density of the waiting crowd, in robots a square metre, as in Seyfried et al. (2009).
const CROWD_PER_M2: f64 = 3.3;

/// Height of the room and of the hall, and distance of the crowd from the door, in metres.
const HEIGHT_M: f64 = 6.0;
const TO_DOOR_M: f64 = 2.0;

/// The seed moves each start by up to this much along both axes, in metres.
const JITTER_M: f64 = 0.04;

/// Distance between the places in the hall where robots end, and of these from the door, in metres.
const PLACES_M: f64 = 1.1;
const TO_PLACES_M: f64 = 4.0;

/// Thickness of the doors at the ends of a corridor, in metres.
const DOOR_M: f64 = 0.2;

/// Length of the area in the middle of a corridor in which density and speed are measured, in metres.
const AREA_M: f64 = 2.0;

/// Time between two samples of density and speed, in seconds.
const SAMPLE_S: f64 = 0.5;

/// Share at either end that is no part of the steady state: of those who cross, or of the time.
const UNSTEADY: f64 = 0.1;

/// Larger than every world, so that all robots know all walls.
const SENSING_M: f64 = 200.0;

/// A stretch of a way out: its length and width, in metres.
#[derive(Debug, Clone, Copy)]
pub struct Stretch {
    /// Length, in metres.
    pub length_m: f64,
    /// Width, in metres.
    pub width_m: f64,
}

/// A crowd and its way out.
#[derive(Debug, Clone)]
pub struct Crowd {
    /// Number of robots.
    pub robots: u32,
    /// The stretches of the way out, from the room to the hall.
    pub way: Vec<Stretch>,
}

/// Density and mean speed along a corridor at one time.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Robots a square metre.
    pub per_m2: f64,
    /// Mean speed towards the exit, in metres per second.
    pub speed_mps: f64,
    /// Share of the robots that stand.
    pub standing: f64,
}

/// What was measured of a crowd.
#[derive(Debug, Clone)]
pub struct Passage {
    /// Robots a second through the way out in the steady state; `None` if too few came through.
    pub flow_per_s: Option<f64>,
    /// Number of robots that came through.
    pub through: usize,
    /// Whether a robot gave up, because it came no nearer; the measurement ended then.
    pub jammed: bool,
    /// Samples in the middle of the longest stretch, in the steady state.
    pub samples: Vec<Sample>,
}

impl Crowd {
    /// A crowd before a door of this width and depth.
    pub fn at_door(robots: u32, width_m: f64, length_m: f64) -> Self {
        Self { robots, way: vec![Stretch { length_m, width_m }] }
    }

    /// A crowd before a corridor of 8 m by 1.8 m, as in the Hermes experiments, with a door at either end.
    pub fn at_corridor(robots: u32, entrance_m: f64, exit_m: f64) -> Self {
        let door = |width_m| Stretch { length_m: DOOR_M, width_m };
        let corridor = Stretch { length_m: 8.0, width_m: 1.8 };
        Self { robots, way: vec![door(entrance_m), corridor, door(exit_m)] }
    }

    /// Robots side by side in the waiting crowd, and the number of ranks.
    fn ranks(&self) -> [u32; 2] {
        let abreast = (HEIGHT_M * libm::sqrt(CROWD_PER_M2)) as u32;
        [abreast, self.robots.div_ceil(abreast)]
    }

    /// Where the way out begins and ends along x.
    fn ends(&self) -> [f64; 2] {
        let [_, ranks] = self.ranks();
        let begin = (f64::from(ranks) / libm::sqrt(CROWD_PER_M2) + TO_DOOR_M + 1.0).ceil();
        [begin, begin + self.way.iter().map(|stretch| stretch.length_m).sum::<f64>()]
    }

    /// The crowd as a scenario of errands; the seed draws the starts.
    pub fn file(&self, seed: u64, duration_s: f64) -> ScenarioFile {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let ([abreast, _], [begin, end]) = (self.ranks(), self.ends());
        let spacing = 1.0 / libm::sqrt(CROWD_PER_M2);
        let in_hall = (HEIGHT_M / PLACES_M) as u32;
        let columns = self.robots.div_ceil(in_hall);
        let length = end + TO_PLACES_M + PLACES_M * f64::from(columns);
        let mut file = base(seed, [length.ceil(), HEIGHT_M], duration_s);
        let beside =
            |k: u32, of: u32, gap: f64| HEIGHT_M / 2.0 + gap * (f64::from(k) - f64::from(of - 1) / 2.0);
        let mut jittered = |x: f64| x + draws.random_range(-JITTER_M..JITTER_M);
        for robot in 0..self.robots {
            let rank = f64::from(robot / abreast);
            let x = jittered(begin - TO_DOOR_M - spacing * rank);
            let center = [x, jittered(beside(robot % abreast, abreast, spacing))];
            // Those in front go farthest, so that nobody has to pass those who have arrived.
            let column = f64::from(columns - 1 - robot / in_hall);
            let x = end + TO_PLACES_M + PLACES_M * column;
            file.team.push(Row::of_one("robot", center));
            file.errands.push(Errand { robot, to: vec![[x, beside(robot % in_hall, in_hall, PLACES_M)]] });
        }
        file.debris = self.walls(begin);
        file.roles = vec![RoleFile { radius_m: RADIUS_M, ..role(FREE_SPEED_MPS) }];
        keep_fresh(&mut file);
        file
    }

    /// The walls on both sides of the way out, which begins here.
    fn walls(&self, begin: f64) -> Vec<DebrisFile> {
        let mut walls = Vec::new();
        let mut x = begin;
        for stretch in &self.way {
            let height = (HEIGHT_M - stretch.width_m) / 2.0;
            for y in [height / 2.0, HEIGHT_M - height / 2.0] {
                let shape = DebrisShape::Box(stretch.length_m, height);
                walls.push(DebrisFile::fixed(shape, [x + stretch.length_m / 2.0, y]));
            }
            x += stretch.length_m;
        }
        walls
    }

    /// Runs the crowd of a seed until all are through, until one gives up, or for as long as this.
    ///
    /// # Errors
    /// The world has no room for the crowd.
    ///
    /// # Panics
    /// The scenario breaks a rule, which would be a fault of this file.
    pub fn pass(&self, seed: u64, limit_s: f64) -> Result<Passage, LayoutError> {
        let scenario = Scenario::try_from(self.file(seed, limit_s))
            .unwrap_or_else(|problems| panic!("{self:?}: {problems:?}"));
        let mut simulation = Simulation::new(&scenario, seed)?;
        let [begin, end] = self.ends();
        let line = f64::midpoint(begin, end);
        let mut crossed: Vec<Option<f64>> = vec![None; self.robots as usize];
        let (mut jammed, mut samples, mut next_s) = (false, Vec::new(), 0.0);
        while matches!(simulation.advance(), Advance::Running) {
            let gives_up = |event: &Event| matches!(event, Event::Unreachable { .. } | Event::CutOff { .. });
            jammed = simulation.events().iter().any(gives_up);
            let (robots, time_s) = (&simulation.world().robots, simulation.time_s());
            for (robot, crossed) in robots.iter().zip(&mut crossed) {
                if f64::from(robot.position.x) > line {
                    crossed.get_or_insert(time_s);
                }
            }
            if time_s >= next_s {
                next_s += SAMPLE_S;
                let is_inside = |x: f64| (x - line).abs() <= AREA_M / 2.0;
                let inside = robots.iter().filter(|robot| is_inside(f64::from(robot.position.x)));
                samples.extend(self.sample(&inside.collect::<Vec<&Robot>>()));
            }
            if jammed || crossed.iter().all(Option::is_some) {
                break;
            }
        }
        let mut times: Vec<f64> = crossed.into_iter().flatten().collect();
        times.sort_by(f64::total_cmp);
        let unsteady = (UNSTEADY * samples.len() as f64).round() as usize;
        let samples = samples[unsteady..samples.len() - unsteady].to_vec();
        Ok(Passage { flow_per_s: steady_flow(&times), through: times.len(), jammed, samples })
    }

    /// Density, speed and standing share of the robots in the area; `None` without one.
    fn sample(&self, inside: &[&Robot]) -> Option<Sample> {
        let longest = self.way.iter().max_by(|a, b| a.length_m.total_cmp(&b.length_m))?;
        let count = inside.len() as f64;
        let speed = inside.iter().map(|robot| f64::from(robot.velocity.x)).sum::<f64>();
        let standing = inside.iter().filter(|robot| robot.velocity.length() <= STANDING_MPS).count() as f64;
        (count > 0.0).then(|| Sample {
            per_m2: count / (AREA_M * longest.width_m),
            speed_mps: speed / count,
            standing: standing / count,
        })
    }
}

/// Flow between the first tenth and the last tenth of those who cross a line at these times, in order.
pub fn steady_flow(times: &[f64]) -> Option<f64> {
    let last = times.len().checked_sub(1)?;
    let unsteady = (UNSTEADY * times.len() as f64).round() as usize;
    let (from, to) = (unsteady, last.checked_sub(unsteady)?);
    let seconds = times.get(to)? - times.get(from)?;
    (to > from && seconds > 0.0).then(|| (to - from) as f64 / seconds)
}

/// Everybody is in full health, and stays so: health decides how fast a robot is. Nothing costs energy.
pub(super) fn keep_fresh(file: &mut ScenarioFile) {
    file.initial_levels.hp = Normal { mean: 100.0, sd: 0.0 };
    for rates in [&mut file.costs.energy, &mut file.costs.hp] {
        (rates.per_step, rates.per_metre, rates.per_second) = (0.0, 0.0, 0.0);
    }
}

/// A role of this preferred speed, in metres per second, that knows all walls.
pub(super) fn role(speed_mps: f64) -> RoleFile {
    RoleFile {
        name: "robot".to_owned(),
        speed_mps,
        acceleration_mps2: speed_mps / RELAXATION_S,
        sensing_m: SENSING_M,
        ..RoleFile::default()
    }
}
