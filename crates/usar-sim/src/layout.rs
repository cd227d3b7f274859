//! The layout of one trial: what the scenario fixes, and what is drawn from the trial's seed.

use parry2d::math::Vector;
use rand::RngExt;
use rne_core::{Difficulty, Role};

use crate::ids::RobotId;
use crate::planning::Planner;
use crate::scenario::{
    DebrisFile, DebrisShape, LayoutError, Normal, Point, SampledCounts, Scenario, ScenarioFile, ZoneFile,
};
use crate::seed::{Purpose, normal, stream};
use crate::world::{debris_outline, rescuee_positions, rest_slot, row_positions};

/// Draws for one sampled thing before it is said that there is no room.
const SAMPLING_TRIES: u32 = 500;

/// Least initial level, in percent: a robot starts with something.
const LEAST_LEVEL: f64 = 1.0;

/// Where and how a robot starts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RobotStart {
    /// Identity.
    pub id: RobotId,
    /// What it is for.
    pub role: Role,
    /// Its place at home.
    pub home: Vector,
    /// Initial battery level, in percent.
    pub energy: f64,
    /// Initial health level, in percent.
    pub hp: f64,
}

/// Everything that is decided before a trial begins. The same for every policy.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Robots, by id.
    pub robots: Vec<RobotStart>,
    /// Debris: the scenario's, then the sampled.
    pub debris: Vec<DebrisFile>,
    /// Radiation zones: the scenario's, then the sampled.
    pub zones: Vec<ZoneFile>,
}

impl Layout {
    /// Draws the layout of the trial with this seed.
    ///
    /// # Errors
    /// No room for what is to be sampled, or no passage between home, tasks and rest places.
    pub fn sample(scenario: &Scenario, trial_seed: u64) -> Result<Self, LayoutError> {
        let mut layout = Self {
            robots: robot_starts(scenario, trial_seed),
            debris: scenario.debris.clone(),
            zones: scenario.radiation.clone(),
        };
        for task in Difficulty::ALL {
            layout.sample_near(scenario, task, trial_seed)?;
        }
        layout.check_passages(scenario)?;
        Ok(layout)
    }

    fn sample_near(&mut self, scenario: &Scenario, task: Difficulty, seed: u64) -> Result<(), LayoutError> {
        let SampledCounts { debris, radiation } = scenario.sampled.of(task);
        if debris + radiation == 0 {
            return Ok(());
        }
        let mut strip = Strip::new(scenario, task, seed);
        let no_room = |what, number: u32, count| LayoutError::NoRoom {
            task: task.name(),
            what,
            number: number + 1,
            count,
            tries: SAMPLING_TRIES,
        };
        for i in 0..debris {
            let place = strip.draw(scenario.sampled.debris_radius_m, |at, radius| {
                strip_clear(scenario, at, radius + scenario.sampled.gap_m)
                    && self.debris.iter().all(|other| {
                        let distance = debris_outline(other).distance_to(vector(at));
                        f64::from(distance) >= radius + scenario.sampled.gap_m
                    })
            });
            let (at, radius) = place.ok_or_else(|| no_room("debris", i, debris))?;
            self.debris.push(DebrisFile {
                shape: DebrisShape::Disc(radius),
                at,
                rotation_deg: 0.0,
                movable: None,
            });
        }
        for i in 0..radiation {
            let place = strip
                .draw(scenario.sampled.zone_radius_m, |at, radius| strip_clear(scenario, at, radius + 0.5));
            let (at, radius_m) = place.ok_or_else(|| no_room("radiation", i, radiation))?;
            self.zones.push(ZoneFile { at, radius_m });
        }
        Ok(())
    }

    /// Every place that a mission needs can be reached from home by the largest ground robot.
    fn check_passages(&self, scenario: &Scenario) -> Result<(), LayoutError> {
        let planner = Planner::new(scenario);
        let outlines: Vec<_> = self.debris.iter().map(debris_outline).collect();
        let home = self.robots.first().map_or(Vector::ZERO, |robot| robot.home);
        let places = [
            ("the hard task", scenario.tasks.hard.center),
            ("the easy task", scenario.tasks.easy.center),
            ("the hard task's rest place", scenario.tasks.hard.rest),
            ("the easy task's rest place", scenario.tasks.easy.rest),
        ];
        for (to, place) in places {
            if !planner.is_reachable(&outlines, home, vector(place)) {
                let radius_m = scenario.ground_radius_m();
                return Err(LayoutError::NoPassage { from: "home", to, radius_m });
            }
        }
        Ok(())
    }
}

fn robot_starts(scenario: &Scenario, seed: u64) -> Vec<RobotStart> {
    let homes = scenario.team.iter().flat_map(|row| row_positions(row).map(|at| (row.role, at)));
    let level = |purpose, robot: u32, Normal { mean, sd }: Normal| {
        normal(&mut stream(seed, purpose, u64::from(robot)), mean, sd).clamp(LEAST_LEVEL, 100.0)
    };
    homes
        .zip(0..)
        .map(|((role, home), id)| RobotStart {
            id: RobotId(id),
            role,
            home: vector(home),
            energy: level(Purpose::EnergyLevel, id, scenario.initial_levels.energy),
            hp: level(Purpose::HpLevel, id, scenario.initial_levels.hp),
        })
        .collect()
}

/// The strip between home and a task, with the stream of draws for it.
struct Strip {
    from: Point,
    along: Point,
    half_width: f64,
    arena: Point,
    draws: rand::rngs::ChaCha8Rng,
}

impl Strip {
    fn new(scenario: &ScenarioFile, task: Difficulty, seed: u64) -> Self {
        let from = scenario.team[0].center;
        let to = scenario.tasks.of(task).center;
        Self {
            from,
            along: [to[0] - from[0], to[1] - from[1]],
            half_width: scenario.sampled.strip_m,
            arena: scenario.arena_m,
            draws: stream(seed, Purpose::Layout, u64::from(task == Difficulty::Hard)),
        }
    }

    /// A place and a radius that are accepted, or nothing after many tries.
    fn draw(&mut self, radii: [f64; 2], accept: impl Fn(Point, f64) -> bool) -> Option<(Point, f64)> {
        let length = libm::hypot(self.along[0], self.along[1]).max(1e-9);
        for _ in 0..SAMPLING_TRIES {
            let [t, side, size] = [(); 3].map(|()| self.draws.random::<f64>());
            let side = (2.0 * side - 1.0) * self.half_width / length;
            let radius = radii[0] + (radii[1] - radii[0]) * size;
            let at = [
                self.from[0] + t * self.along[0] - side * self.along[1],
                self.from[1] + t * self.along[1] + side * self.along[0],
            ];
            let inside = (0..2).all(|k| at[k] >= radius && at[k] <= self.arena[k] - radius);
            if inside && accept(at, radius) {
                return Some((at, radius));
            }
        }
        None
    }
}

/// No home, rest place or rescuee within `radius` metres.
fn strip_clear(scenario: &Scenario, at: Point, radius: f64) -> bool {
    let robots: u32 = scenario.team.iter().map(|row| row.count).sum();
    let far = |other: Point, other_radius: f64| {
        libm::hypot(at[0] - other[0], at[1] - other[1]) >= radius + other_radius
    };
    let point = |v: Vector| [f64::from(v.x), f64::from(v.y)];
    let rests = Difficulty::ALL
        .into_iter()
        .flat_map(|task| (0..robots).map(move |i| rest_slot(scenario, task, RobotId(i), robots)));
    scenario.team.iter().flat_map(row_positions).all(|home| far(home, scenario.ground_radius_m()))
        && rests.into_iter().all(|slot| far(point(slot), scenario.ground_radius_m()))
        && rescuee_positions(scenario).iter().all(|rescuee| far(point(rescuee.position), 0.0))
}

fn vector(at: Point) -> Vector {
    Vector::new(at[0] as f32, at[1] as f32)
}
