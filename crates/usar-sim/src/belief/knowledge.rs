//! What a group knows of the world: shared by its members at once, pooled by the whole team at home.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use crate::geometry::RadiationZone;
use crate::planning::{KnownObstacle, ObstacleKey, ObstacleMap};
use crate::scenario::Scenario;
use crate::world::{Robot, World};

/// What was learned that concerns routes.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) enum News {
    /// An obstacle is known, where it is now.
    Obstacle(ObstacleKey),
    /// A radiation zone is known.
    Zone(u32),
    /// A place is free again.
    Opening(Opening),
}

/// A place that was found to be free again: a piece of debris was pushed away from there.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct Opening {
    /// Middle of the place.
    center: Vector,
    /// No way through the place that was closed before is farther from the middle than this, in metres.
    reach: f32,
}

impl Opening {
    /// A lower bound for the length of any way from `a` to `b` that leads through here, in metres.
    pub(crate) fn least_way(&self, a: Vector, b: Vector) -> f32 {
        let to_here = |point: Vector| ((point - self.center).length() - self.reach).max(0.0);
        to_here(a) + to_here(b)
    }
}

/// How much of some knowledge has been taken into account.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Seen {
    pool: u32,
    news: usize,
}

/// Knowledge of a group, or of the team at home.
#[derive(Clone, Serialize, Deserialize)]
pub struct Knowledge {
    /// For each piece of debris, the number of its sightings that are known; 0 is unknown.
    pub debris: Vec<u32>,
    /// For each radiation zone, how many of its switches are known; an odd number is a zone that is known to
    /// be on.
    pub zones: Vec<u8>,
    /// For each rescuee, whether it was seen.
    pub rescuees: Vec<bool>,
    /// For each robot, whether it is known to stand for good.
    pub wrecks: Vec<bool>,
    /// How often the groups have pooled what they know. Between two times, what a group knows goes on from what the team knew.
    pool: u32,
    /// What concerns routes, in the order in which it was learned.
    news: Vec<News>,
    /// One for each class of radii. Follows from `debris` and `wrecks`.
    #[serde(skip)]
    obstacles: Vec<ObstacleMap>,
    /// Follows from `zones`.
    #[serde(skip)]
    known_zones: Vec<(u32, RadiationZone)>,
    /// By how much obstacles are inflated.
    #[serde(skip)]
    inflation: Inflation,
}

/// By how much obstacles are inflated: for each class of ground robots by their radius, and by the clearance that they keep.
#[derive(Debug, Clone, Default)]
pub struct Inflation {
    /// Radii of the classes, rising, in metres.
    pub radii: Vec<f32>,
    /// What robots keep from obstacles beyond their radius, in metres.
    pub clearance: f32,
}

impl Inflation {
    /// For the robots of a scenario.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        Self {
            radii: scenario.ground_radii_m().iter().map(|radius| *radius as f32).collect(),
            clearance: scenario.planning.clearance_m as f32,
        }
    }
}

impl Knowledge {
    /// Nothing is known.
    #[must_use]
    pub fn nothing(world: &World, inflation: Inflation) -> Self {
        Self {
            debris: vec![0; world.debris.len()],
            zones: vec![0; world.zones.len()],
            rescuees: vec![false; world.rescuees.len()],
            wrecks: vec![false; world.robots.len()],
            pool: 0,
            news: Vec::new(),
            obstacles: vec![ObstacleMap::default(); inflation.radii.len()],
            known_zones: Vec::new(),
            inflation,
        }
    }

    /// The known obstacles as they are in the way of a robot of this radius, in metres: of the smallest class that holds it.
    #[must_use]
    pub fn obstacles(&self, radius: f32) -> &ObstacleMap {
        let class = self.inflation.radii.partition_point(|other| *other < radius);
        &self.obstacles[class.min(self.obstacles.len() - 1)]
    }

    /// The known radiation zones, with their numbers.
    #[must_use]
    pub fn known_zones(&self) -> &[(u32, RadiationZone)] {
        &self.known_zones
    }

    /// A mark up to which everything that is known now has been seen.
    pub(crate) fn seen(&self) -> Seen {
        Seen { pool: self.pool, news: self.news.len() }
    }

    /// What was learned since a mark; everything, where the mark is from before the groups last pooled what they know.
    pub(crate) fn news_since(&self, seen: Seen) -> &[News] {
        let from = if seen.pool == self.pool { seen.news.min(self.news.len()) } else { 0 };
        &self.news[from..]
    }

    /// Takes note of a piece of debris as it lies now.
    pub fn learn_debris(&mut self, world: &World, number: usize) {
        self.learn_sighting(world, number, world.debris[number].sightings.len() as u32);
    }

    fn learn_sighting(&mut self, world: &World, number: usize, sighting: u32) {
        if sighting > self.debris[number] {
            self.debris[number] = sighting;
            self.insert(|knowledge, radius| knowledge.debris_obstacle(world, number, radius));
        }
    }

    /// Takes note of a radiation zone.
    pub fn learn_zone(&mut self, world: &World, number: usize) {
        self.learn_switch(world, number, world.switches_of(number));
    }

    /// Takes note of a radiation zone as it was after so many switches.
    fn learn_switch(&mut self, world: &World, number: usize, switches: u8) {
        let before = self.zones[number];
        self.zones[number] = before.max(switches);
        let [was_on, is_on] = [before, self.zones[number]].map(|switches| switches % 2 == 1);
        let at = self.known_zones.partition_point(|(other, _)| (*other as usize) < number);
        let zone = world.zones[number];
        if is_on && !was_on {
            self.known_zones.insert(at, (number as u32, zone));
            self.news.push(News::Zone(number as u32));
        } else if was_on && !is_on {
            self.known_zones.remove(at);
            self.news.push(News::Opening(Opening { center: zone.center, reach: zone.radius }));
        }
    }

    /// Takes note of a robot that stands for good.
    pub fn learn_wreck(&mut self, world: &World, number: usize) {
        let robot = &world.robots[number];
        let Some(at) = robot.wreck_at else { return };
        if !std::mem::replace(&mut self.wrecks[number], true) && !robot.is_aerial() {
            self.insert(|knowledge, radius| knowledge.wreck_obstacle(robot, at, radius));
        }
    }

    /// Takes over all that some groups know.
    pub fn pool(&mut self, world: &World, groups: &[Self]) {
        groups.iter().for_each(|group| self.learn_all(world, group));
        self.pool += 1;
    }

    fn learn_all(&mut self, world: &World, other: &Self) {
        for (number, sighting) in other.debris.iter().enumerate() {
            self.learn_sighting(world, number, *sighting);
        }
        let known = |list: &[bool]| -> Vec<usize> { (0..list.len()).filter(|i| list[*i]).collect() };
        for (number, switches) in other.zones.iter().enumerate() {
            self.learn_switch(world, number, *switches);
        }
        known(&other.wrecks).into_iter().for_each(|number| self.learn_wreck(world, number));
        for (own, other) in self.rescuees.iter_mut().zip(&other.rescuees) {
            *own |= other;
        }
    }

    /// A piece of debris as it is known, for robots of a radius.
    fn debris_obstacle(&self, world: &World, number: usize, radius: f32) -> KnownObstacle {
        let sighting = self.debris[number];
        let outline = &world.debris[number].sightings[sighting as usize - 1];
        KnownObstacle::new(
            ObstacleKey::Debris(number as u32),
            sighting,
            outline,
            radius,
            self.inflation.clearance,
        )
    }

    fn wreck_obstacle(&self, robot: &Robot, at: Vector, radius: f32) -> KnownObstacle {
        KnownObstacle::wreck(robot.id.0, at, robot.radius(), radius, self.inflation.clearance)
    }

    /// Makes anew what a snapshot leaves out because it follows from the rest.
    pub(crate) fn restore(&mut self, world: &World, inflation: Inflation) {
        self.inflation = inflation;
        self.obstacles = self.inflation.radii.iter().map(|radius| self.map(world, *radius)).collect();
        let known_zones =
            world.zones.iter().zip(0_u32..).filter(|(_, number)| self.zones[*number as usize] % 2 == 1);
        self.known_zones = known_zones.map(|(zone, number)| (number, *zone)).collect();
    }

    /// All known obstacles, for robots of a radius.
    fn map(&self, world: &World, radius: f32) -> ObstacleMap {
        let known = (0..self.debris.len()).filter(|number| self.debris[*number] > 0);
        let debris = known.map(|number| self.debris_obstacle(world, number, radius));
        let wrecks = world.robots.iter().filter(|robot| self.wrecks[robot.id.index()] && !robot.is_aerial());
        let wrecks = wrecks.filter_map(|robot| Some(self.wreck_obstacle(robot, robot.wreck_at?, radius)));
        debris.chain(wrecks).collect()
    }

    /// Adds an obstacle to the maps of all classes. News of it are those of the largest robots.
    fn insert(&mut self, obstacle: impl Fn(&Self, f32) -> KnownObstacle) {
        let mut news = None;
        for class in 0..self.obstacles.len() {
            let obstacle = obstacle(self, self.inflation.radii[class]);
            let key = obstacle.key;
            let before = self.obstacles[class].insert(obstacle);
            news = Some((key, before.map(|before| before.middle_and_reach())));
        }
        let Some((key, opening)) = news else { return };
        let opening = opening.map(|(center, reach)| News::Opening(Opening { center, reach }));
        self.news.extend(opening.into_iter().chain([News::Obstacle(key)]));
    }
}
