//! The layout of one trial: what the scenario fixes, and what is drawn with the trial's seed.

use std::collections::{BTreeMap, BTreeSet};

use parry2d::bounding_volume::Aabb;
use parry2d::math::Vector;
use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use scenario::seed::{Purpose, normal, stream};
use scenario::shapes::{Outline, Places, vector};
use scenario::{
    Amount, DebrisFile, DebrisShape, Happening, LayoutError, Normal, Point, RoleKind, SampledCounts,
    Scenario, TaskFile, ZoneFile,
};
use teaming::{RoleId, TaskId};

use super::places::{RestSlots, rescuee_places};
use crate::ids::RobotId;
use crate::planning::Planner;

/// Draws for one sampled thing before the layout fails for lack of room.
pub(super) const SAMPLING_TRIES: u32 = 500;

/// Layouts drawn before the trial fails for lack of a passage.
const LAYOUT_ATTEMPTS: u32 = 20;

/// Least initial level, in percent: no robot starts with nothing.
const LEAST_LEVEL: f64 = 1.0;

/// The initial state of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RobotStart {
    /// Identity.
    pub id: RobotId,
    /// Its role.
    pub role: RoleId,
    /// Its place at home.
    pub home: Vector,
    /// Initial battery level, in percent.
    pub energy: f64,
    /// Initial health level, in percent.
    pub hp: f64,
}

/// One attempt to draw a layout.
pub(super) struct Attempt<'s> {
    pub(super) scenario: &'s Scenario,
    pub(super) keep_clear: &'s KeepClear,
    /// Seed of the trial.
    pub(super) seed: u64,
    /// Number of the attempt, from 0.
    pub(super) attempt: u32,
}

/// Everything that is drawn or fixed before a trial begins. It is the same for every policy.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Robots, by id.
    pub robots: Vec<RobotStart>,
    /// Debris: the scenario's, then sampled and scattered pieces, then pieces that events add.
    pub debris: Vec<DebrisFile>,
    /// Radiation zones: the scenario's, then sampled and scattered zones, then zones that events add.
    pub zones: Vec<ZoneFile>,
    /// Numbers of the pieces of debris that events place or remove, and whether each is there at the start.
    pub gates: BTreeMap<usize, bool>,
    /// Numbers of the radiation zones that are not there at the start.
    pub zones_later: BTreeSet<usize>,
}

impl Layout {
    /// Draws the layout of the trial with this seed. Sampled debris that leaves no passage is drawn again.
    ///
    /// # Errors
    /// No room for a sampled or scattered thing, or no passage between home, tasks and rest places.
    pub fn sample(scenario: &Scenario, trial_seed: u64) -> Result<Self, LayoutError> {
        let draws_nothing =
            scenario.tasks.iter().all(|task| task.sampled.debris == 0) && scenario.scatter.is_empty();
        let keep_clear = KeepClear::new(scenario);
        let attempts = if draws_nothing { 1 } else { LAYOUT_ATTEMPTS };
        let mut blocked = None;
        for attempt in 0..attempts {
            let mut layout = Self {
                robots: robot_starts(scenario, trial_seed),
                debris: scenario.obstacles(),
                zones: scenario.radiation.clone(),
                gates: BTreeMap::new(),
                zones_later: BTreeSet::new(),
            };
            let trial = Attempt { scenario, keep_clear: &keep_clear, seed: trial_seed, attempt };
            for (number, task) in scenario.tasks.iter().enumerate() {
                layout.sample_near(&trial, number, task)?;
            }
            layout.scatter(&trial)?;
            layout.add_later(scenario);
            if !scenario.errands.is_empty() {
                return Ok(layout); // robots find out which errands lead nowhere: see [`Self::out_of_reach`]
            }
            match layout.check_passages(scenario) {
                Ok(()) => return Ok(layout),
                Err(error) => blocked = Some(error),
            }
        }
        let radius_m = scenario.largest_radius_m(RoleKind::Ground);
        Err(blocked.unwrap_or_else(|| LayoutError::NoPassage { to: "anywhere".to_owned(), radius_m }))
    }

    fn sample_near(&mut self, trial: &Attempt, number: usize, task: &TaskFile) -> Result<(), LayoutError> {
        let &Attempt { scenario, keep_clear, seed, attempt } = trial;
        let SampledCounts { debris, radiation } = task.sampled;
        let strip = Strip::new(scenario, task);
        let no_room = |what, number: u32, count| LayoutError::NoRoom {
            task: task.name.clone(),
            what,
            number: number + 1,
            count,
            tries: SAMPLING_TRIES,
        };
        // Each thing has a stream of its own, so that one more thing leaves the others where they are.
        let entity = |i: u32| stream_of_task(number) | u64::from(attempt) << 32 | u64::from(i);
        for i in 0..debris {
            let mut draws = stream(seed, Purpose::SampledDebris, entity(i));
            let gap = scenario.sampled.gap_m;
            let place = strip.draw(&mut draws, scenario.sampled.debris_radius_m, |at, radius| {
                keep_clear.allows(at, radius + gap)
                    && self
                        .debris
                        .iter()
                        .all(|other| f64::from(other.outline().distance_to(vector(at))) >= radius + gap)
            });
            let (at, radius) = place.ok_or_else(|| no_room("debris", i, debris))?;
            self.debris.push(DebrisFile::fixed(DebrisShape::Disc(radius), at));
        }
        for i in 0..radiation {
            let mut draws = stream(seed, Purpose::SampledRadiation, entity(i));
            let place = strip
                .draw(&mut draws, scenario.sampled.zone_radius_m, |at, radius| keep_clear.allows(at, radius));
            let (at, radius_m) = place.ok_or_else(|| no_room("radiation", i, radiation))?;
            self.zones.push(ZoneFile { at, radius_m, name: None });
        }
        Ok(())
    }

    /// Adds the things that events open, close or add, after everything else: panels of doors, debris that
    /// falls and radiation that appears. Also notes the named debris that events open and close.
    fn add_later(&mut self, scenario: &Scenario) {
        for (panel, is_closed) in scenario.panels() {
            self.gates.insert(self.debris.len(), is_closed);
            self.debris.push(panel);
        }
        for moment in &scenario.timeline {
            if let Some(falling) = moment.event.falling() {
                self.gates.insert(self.debris.len(), false);
                self.debris.push(falling);
            }
            if let Some(source) = moment.event.source() {
                self.zones_later.insert(self.zones.len());
                self.zones.push(source);
            }
        }
        for moment in &scenario.timeline {
            let (Happening::Opens(name) | Happening::Closes(name)) = &moment.event else { continue };
            let number = self.debris.iter().position(|piece| piece.name.as_ref() == Some(name));
            if let Some(number) = number {
                self.gates.entry(number).or_insert(true);
            }
        }
    }

    /// Number of the piece of debris that falls in an event of the timeline.
    pub(super) fn falling(&self, scenario: &Scenario, moment: usize) -> usize {
        let after = scenario.timeline[moment..].iter().filter(|moment| moment.event.falling().is_some());
        self.debris.len() - after.count()
    }

    /// Number of the radiation source that appears in an event of the timeline.
    pub(super) fn appearing(&self, scenario: &Scenario, moment: usize) -> usize {
        let after = scenario.timeline[moment..].iter().filter(|moment| moment.event.source().is_some());
        self.zones.len() - after.count()
    }

    /// The debris that may block a passage for good: events neither place nor remove it.
    pub(super) fn lasting(&self) -> Vec<Outline> {
        let stays = |(number, _): &(usize, &DebrisFile)| !self.gates.contains_key(number);
        self.debris.iter().enumerate().filter(stays).map(|(_, file)| file.outline()).collect()
    }

    /// Checks that each ground robot can reach every place that a mission needs. Robots of one radius are
    /// checked together, the largest first.
    fn check_passages(&self, scenario: &Scenario) -> Result<(), LayoutError> {
        let (planner, outlines) = (Planner::new(scenario), self.lasting());
        for radius_m in scenario.ground_radii_m().into_iter().rev() {
            let (places, Some(first)) = self.places_needed(scenario, radius_m) else { continue };
            if let Some((to, _)) = planner.ways(radius_m as f32, &outlines).first_unreachable(first, &places)
            {
                return Err(LayoutError::NoPassage { to: to.clone(), radius_m });
            }
        }
        Ok(())
    }

    /// The places that ground robots of this class need, with their names, and the home of the first of them.
    fn places_needed(&self, scenario: &Scenario, radius_m: f64) -> (Vec<(String, Vector)>, Option<Vector>) {
        let radii = scenario.ground_radii_m();
        let bodies = scenario.bodies().flat_map(|(body, count)| {
            let class = radii.iter().copied().find(|radius| *radius >= body.radius_m);
            (0..count).map(move |_| body.kind == RoleKind::Ground && class == Some(radius_m))
        });
        let ground: Vec<&RobotStart> = self
            .robots
            .iter()
            .zip(bodies)
            .filter(|(_, is_of_class)| *is_of_class)
            .map(|(robot, _)| robot)
            .collect();
        let place = |task: &TaskFile| (format!("task {:?}", task.name), vector(task.center));
        let mut places: Vec<(String, Vector)> = scenario.tasks.iter().map(place).collect();
        // Neighbouring places follow one another, because each search starts from the place before.
        places.extend(ground.iter().map(|robot| ("a robot's home".to_owned(), robot.home)));
        let slots = RestSlots::of(scenario);
        for (number, task) in (0..).zip(&scenario.tasks) {
            let name = format!("the rest place of task {:?}", task.name);
            let slot = |robot: &&RobotStart| slots.at(TaskId(number), robot.id);
            places.extend(ground.iter().map(|robot| (name.clone(), slot(robot))));
        }
        (places, ground.first().map(|robot| robot.home))
    }
}

/// The part of a sampled thing's entity that identifies its task. The first task has the highest bit and the
/// second none, as when there were only two tasks. So the draws of published trials stay as they were.
fn stream_of_task(number: usize) -> u64 {
    match number {
        0 => 1 << 63,
        1 => 0,
        number => (number as u64) << 56,
    }
}

fn robot_starts(scenario: &Scenario, seed: u64) -> Vec<RobotStart> {
    let homes = scenario.team.iter().flat_map(|row| row.places().map(move |at| (row, at)));
    let level = |purpose, robot: u32, Normal { mean, sd }: Normal| {
        normal(&mut stream(seed, purpose, u64::from(robot)), mean, sd).clamp(LEAST_LEVEL, 100.0)
    };
    let of_row =
        |purpose, robot: u32, amount: &Amount| amount.draw(&mut stream(seed, purpose, u64::from(robot)));
    homes
        .zip(0..)
        .map(|((row, home), id)| {
            let (energy, hp) = match &row.levels {
                None => (
                    level(Purpose::EnergyLevel, id, scenario.initial_levels.energy),
                    level(Purpose::HpLevel, id, scenario.initial_levels.hp),
                ),
                Some(levels) => (
                    of_row(Purpose::EnergyLevel, id, &levels.energy),
                    of_row(Purpose::HpLevel, id, &levels.hp),
                ),
            };
            RobotStart { id: RobotId(id), role: scenario.role_of(row), home: vector(home), energy, hp }
        })
        .collect()
}

/// The strip between home and a task in which things are sampled.
struct Strip {
    from: Point,
    along: Point,
    half_width: f64,
    arena: Point,
}

impl Strip {
    fn new(scenario: &Scenario, task: &TaskFile) -> Self {
        let from = scenario.team[0].center;
        let to = task.center;
        Self {
            from,
            along: [to[0] - from[0], to[1] - from[1]],
            half_width: scenario.sampled.strip_m,
            arena: scenario.arena_m,
        }
    }

    /// A place and a radius that are accepted; `None` after [`SAMPLING_TRIES`] tries.
    fn draw(
        &self,
        draws: &mut ChaCha8Rng,
        radii: [f64; 2],
        accept: impl Fn(Point, f64) -> bool,
    ) -> Option<(Point, f64)> {
        let length = libm::hypot(self.along[0], self.along[1]).max(1e-9);
        for _ in 0..SAMPLING_TRIES {
            let [t, u, size] = [(); 3].map(|()| draws.random::<f64>());
            let aside = (2.0 * u - 1.0) * self.half_width / length;
            let radius = radii[0] + (radii[1] - radii[0]) * size;
            let at = [
                self.from[0] + t * self.along[0] - aside * self.along[1],
                self.from[1] + t * self.along[1] + aside * self.along[0],
            ];
            let inside = (0..2).all(|k| at[k] >= radius && at[k] <= self.arena[k] - radius);
            if inside && accept(at, radius) {
                return Some((at, radius));
            }
        }
        None
    }
}

/// Homes, rest places and rescuees, each with the radius of the robot that stands there.
pub(super) struct KeepClear {
    list: Vec<(Point, f64)>,
    /// The same by place.
    places: Places,
}

impl KeepClear {
    fn new(scenario: &Scenario) -> Self {
        if !scenario.is_drawn() {
            return Self { list: Vec::new(), places: Places::default() };
        }
        let radius = scenario.largest_radius_m(RoleKind::Ground);
        let point = |v: Vector| [f64::from(v.x), f64::from(v.y)];
        let mut list: Vec<(Point, f64)> =
            scenario.team.iter().flat_map(scenario::Row::places).map(|home| (home, radius)).collect();
        let block = RestSlots::of(scenario);
        for task in (0..).take(scenario.tasks.len()).map(TaskId) {
            let slots = (0..scenario.robots()).map(|i| block.at(task, RobotId(i)));
            list.extend(slots.map(|slot| (point(slot), radius)));
        }
        list.extend(rescuee_places(scenario).map(|(_, at)| (point(at), 0.0)));
        let bounds =
            |(at, own): &(Point, f64)| Aabb::from_half_extents(vector(*at), Vector::splat(*own as f32));
        Self { places: list.iter().map(bounds).collect(), list }
    }

    /// Whether a disc of this radius, in metres, keeps clear of all of them.
    pub(super) fn allows(&self, at: Point, radius: f64) -> bool {
        let near = self.places.near(vector(at), radius as f32);
        near.into_iter()
            .map(|number| &self.list[number])
            .all(|(place, own)| libm::hypot(at[0] - place[0], at[1] - place[1]) >= radius + own)
    }
}
