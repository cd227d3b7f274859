//! The knowledge of a group about the world: members share it at once, and the team pools it at home.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use crate::geometry::RadiationZone;
use crate::planning::{KnownObstacle, ObstacleKey, ObstacleMap};
use crate::scenario::Scenario;
use crate::world::{Robot, World};

/// A piece of knowledge that concerns routes.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) enum News {
    /// An obstacle became known at its present place.
    Obstacle(ObstacleKey),
    /// A radiation zone became known.
    Zone(u32),
    /// A place is free again.
    Opening(Opening),
}

/// A place that is free again: a piece of debris was pushed away, or a radiation zone was switched off.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(crate) struct Opening {
    /// Middle of the place.
    center: Vector,
    /// Radius round the middle that contains the whole place, in metres.
    reach: f32,
}

impl Opening {
    /// A lower bound for the length of any path from `a` to `b` through this place, in metres.
    pub(crate) fn least_way(&self, a: Vector, b: Vector) -> f32 {
        let to_here = |point: Vector| ((point - self.center).length() - self.reach).max(0.0);
        to_here(a) + to_here(b)
    }
}

/// A mark in the news: how much of it has been taken into account.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub(crate) struct Seen {
    pool: u32,
    news: usize,
}

/// Knowledge of a group, or of the team at home.
#[derive(Clone, Serialize, Deserialize)]
pub struct Knowledge {
    /// For each piece of debris, the number of its latest known sighting; 0 if unknown.
    pub debris: Vec<u32>,
    /// For each radiation zone, how many of its switches are known. With an odd number, the zone is known to
    /// be on.
    pub zones: Vec<u8>,
    /// For each rescuee, whether it was seen.
    pub rescuees: Vec<bool>,
    /// For each robot, whether it is known to have stopped for good.
    pub wrecks: Vec<bool>,
    /// Number of times that the groups have pooled their knowledge. Between two poolings, each group's
    /// knowledge extends the team's.
    pool: u32,
    /// The news that concern routes, in the order in which they were learned.
    news: Vec<News>,
    /// One map for each class of radii. Follows from `debris` and `wrecks`.
    #[serde(skip)]
    obstacles: Vec<ObstacleMap>,
    /// Follows from `zones`.
    #[serde(skip)]
    known_zones: Vec<(u32, RadiationZone)>,
    /// How much obstacles are inflated.
    #[serde(skip)]
    inflation: Inflation,
}

/// How much obstacles are inflated: by the radius of each class of ground robots, and by their clearance.
#[derive(Debug, Clone, Default)]
pub struct Inflation {
    /// Radii of the classes in ascending order, in metres.
    pub radii: Vec<f32>,
    /// Distance that robots keep from obstacles beyond their radius, in metres.
    pub clearance: f32,
}

impl Inflation {
    /// The inflation for the robots of a scenario.
    #[must_use]
    pub fn of(scenario: &Scenario) -> Self {
        Self {
            radii: scenario.ground_radii_m().iter().map(|radius| *radius as f32).collect(),
            clearance: scenario.planning.clearance_m as f32,
        }
    }
}

impl Knowledge {
    /// Knowledge of nothing.
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

    /// The known obstacles, inflated for a robot of this radius, in metres: those of the smallest class whose
    /// radius is at least as large.
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

    /// The mark after all present news.
    pub(crate) fn seen(&self) -> Seen {
        Seen { pool: self.pool, news: self.news.len() }
    }

    /// The news since a mark. All news, if the groups have pooled their knowledge since the mark.
    pub(crate) fn news_since(&self, seen: Seen) -> &[News] {
        let from = if seen.pool == self.pool { seen.news.min(self.news.len()) } else { 0 };
        &self.news[from..]
    }

    /// Notes a piece of debris at its present place.
    pub fn learn_debris(&mut self, world: &World, number: usize) {
        self.learn_sighting(world, number, world.debris[number].sightings.len() as u32);
    }

    fn learn_sighting(&mut self, world: &World, number: usize, sighting: u32) {
        if sighting > self.debris[number] {
            self.debris[number] = sighting;
            self.insert(|knowledge, radius| knowledge.debris_obstacle(world, number, radius));
        }
    }

    /// Notes a radiation zone in its present state.
    pub fn learn_zone(&mut self, world: &World, number: usize) {
        self.learn_switch(world, number, world.switches_of(number));
    }

    /// Notes a radiation zone as it was after this many switches.
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

    /// Notes a robot that has stopped for good.
    pub fn learn_wreck(&mut self, world: &World, number: usize) {
        let robot = &world.robots[number];
        let Some(at) = robot.wreck_at else { return };
        if !std::mem::replace(&mut self.wrecks[number], true) && !robot.is_aerial() {
            self.insert(|knowledge, radius| knowledge.wreck_obstacle(robot, at, radius));
        }
    }

    /// Adds all that these groups know.
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

    /// A piece of debris as it is known, as an obstacle for robots of this radius.
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

    /// Restores the fields that a snapshot leaves out: they follow from the other fields.
    pub(crate) fn restore(&mut self, world: &World, inflation: Inflation) {
        self.inflation = inflation;
        self.obstacles = self.inflation.radii.iter().map(|radius| self.map(world, *radius)).collect();
        let known_zones =
            world.zones.iter().zip(0_u32..).filter(|(_, number)| self.zones[*number as usize] % 2 == 1);
        self.known_zones = known_zones.map(|(zone, number)| (number, *zone)).collect();
    }

    /// The map of all known obstacles for robots of this radius.
    fn map(&self, world: &World, radius: f32) -> ObstacleMap {
        let known = (0..self.debris.len()).filter(|number| self.debris[*number] > 0);
        let debris = known.map(|number| self.debris_obstacle(world, number, radius));
        let wrecks = world.robots.iter().filter(|robot| self.wrecks[robot.id.index()] && !robot.is_aerial());
        let wrecks = wrecks.filter_map(|robot| Some(self.wreck_obstacle(robot, robot.wreck_at?, radius)));
        debris.chain(wrecks).collect()
    }

    /// Adds an obstacle to the maps of all classes. The news use its outline for the largest robots.
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
