//! What a group knows of the world: shared by its members at once, pooled by the whole team at home.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use super::obstacles::{KnownObstacle, ObstacleKey};
use crate::world::{RadiationZone, Robot, World};

/// A place that was found to be free again: a piece of debris was pushed away from there.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Opening {
    /// The revision of the knowledge in which it is known.
    pub revision: u32,
    /// Middle of the place.
    pub center: Vector,
    /// No way through the place that was closed before is farther from the middle than this, in metres.
    pub reach: f32,
}

impl Opening {
    /// A lower bound for the length of any way from `a` to `b` that leads through here, in metres.
    #[must_use]
    pub fn least_way(&self, a: Vector, b: Vector) -> f32 {
        let to_here = |point: Vector| ((point - self.center).length() - self.reach).max(0.0);
        to_here(a) + to_here(b)
    }
}

/// Knowledge of a group, or of the team at home.
#[derive(Clone, Serialize, Deserialize)]
pub struct Knowledge {
    /// For each piece of debris, the number of its sightings that are known; 0 is unknown.
    pub debris: Vec<u32>,
    /// For each radiation zone, whether it is known.
    pub zones: Vec<bool>,
    /// For each rescuee, whether it was seen.
    pub rescuees: Vec<bool>,
    /// For each robot, whether it is known to stand for good.
    pub wrecks: Vec<bool>,
    /// Counts the changes that concern routes.
    pub revision: u32,
    /// Follows from `debris` and `wrecks`.
    #[serde(skip)]
    obstacles: Vec<KnownObstacle>,
    openings: Vec<Opening>,
    /// Follows from `zones`.
    #[serde(skip)]
    known_zones: Vec<(u32, RadiationZone)>,
    radius: f32,
    clearance: f32,
}

impl Knowledge {
    /// Nothing is known. Obstacles will be inflated for robots of `radius` that keep `clearance`, in metres.
    #[must_use]
    pub fn nothing(world: &World, radius: f32, clearance: f32) -> Self {
        Self {
            debris: vec![0; world.debris.len()],
            zones: vec![false; world.zones.len()],
            rescuees: vec![false; world.rescuees.len()],
            wrecks: vec![false; world.robots.len()],
            revision: 0,
            obstacles: Vec::new(),
            openings: Vec::new(),
            known_zones: Vec::new(),
            radius,
            clearance,
        }
    }

    /// The known obstacles, in order of their keys.
    #[must_use]
    pub fn obstacles(&self) -> &[KnownObstacle] {
        &self.obstacles
    }

    /// Places that were found to be free again since a revision.
    pub fn openings_since(&self, revision: u32) -> impl Iterator<Item = &Opening> {
        self.openings.iter().rev().take_while(move |opening| opening.revision > revision)
    }

    /// The known radiation zones, with their numbers.
    #[must_use]
    pub fn known_zones(&self) -> &[(u32, RadiationZone)] {
        &self.known_zones
    }

    /// Takes note of a piece of debris as it lies now.
    pub fn learn_debris(&mut self, world: &World, number: usize) {
        self.learn_sighting(world, number, world.debris[number].sightings.len() as u32);
    }

    fn learn_sighting(&mut self, world: &World, number: usize, sighting: u32) {
        if sighting > self.debris[number] {
            self.debris[number] = sighting;
            let obstacle = self.debris_obstacle(world, number);
            let is_it =
                |o: &KnownObstacle| matches!(o.key, ObstacleKey::Debris(n, _) if n as usize == number);
            if let Some(at) = self.obstacles.iter().position(is_it) {
                let (center, reach) = self.obstacles.remove(at).bounds();
                self.openings.push(Opening { revision: self.revision + 1, center, reach });
            }
            self.insert(obstacle);
        }
    }

    /// Takes note of a radiation zone.
    pub fn learn_zone(&mut self, world: &World, number: usize) {
        if !std::mem::replace(&mut self.zones[number], true) {
            let at = self.known_zones.partition_point(|(other, _)| (*other as usize) < number);
            self.known_zones.insert(at, (number as u32, world.zones[number]));
            self.revision += 1;
        }
    }

    /// Takes note of a robot that stands for good.
    pub fn learn_wreck(&mut self, world: &World, number: usize) {
        let robot = &world.robots[number];
        let Some(at) = robot.wreck_at else { return };
        if !std::mem::replace(&mut self.wrecks[number], true) && !robot.is_aerial() {
            self.insert(self.wreck_obstacle(robot, at));
        }
    }

    /// Takes over all that another group knows.
    pub fn learn_all(&mut self, world: &World, other: &Self) {
        for (number, sighting) in other.debris.iter().enumerate() {
            self.learn_sighting(world, number, *sighting);
        }
        let known = |list: &[bool]| -> Vec<usize> { (0..list.len()).filter(|i| list[*i]).collect() };
        known(&other.zones).into_iter().for_each(|number| self.learn_zone(world, number));
        known(&other.wrecks).into_iter().for_each(|number| self.learn_wreck(world, number));
        for (own, other) in self.rescuees.iter_mut().zip(&other.rescuees) {
            *own |= other;
        }
    }

    /// A piece of debris as it is known.
    fn debris_obstacle(&self, world: &World, number: usize) -> KnownObstacle {
        let sighting = self.debris[number];
        let outline = &world.debris[number].sightings[sighting as usize - 1];
        let key = ObstacleKey::Debris(number as u32, sighting);
        KnownObstacle::new(key, outline, self.radius, self.clearance)
    }

    fn wreck_obstacle(&self, robot: &Robot, at: Vector) -> KnownObstacle {
        KnownObstacle::wreck(robot.id.0, at, robot.radius(), self.radius, self.clearance)
    }

    /// Makes anew what a snapshot leaves out because it follows from the rest.
    pub(crate) fn restore(&mut self, world: &World) {
        let known = (0..self.debris.len()).filter(|number| self.debris[*number] > 0);
        let debris = known.map(|number| self.debris_obstacle(world, number));
        let wrecks = world.robots.iter().filter(|robot| self.wrecks[robot.id.index()] && !robot.is_aerial());
        let wrecks = wrecks.filter_map(|robot| Some(self.wreck_obstacle(robot, robot.wreck_at?)));
        self.obstacles = debris.chain(wrecks).collect(); // in order of their keys
        let known_zones = world.zones.iter().zip(0_u32..).filter(|(_, number)| self.zones[*number as usize]);
        self.known_zones = known_zones.map(|(zone, number)| (number, *zone)).collect();
    }

    fn insert(&mut self, obstacle: KnownObstacle) {
        let at = self.obstacles.partition_point(|other| other.key < obstacle.key);
        self.obstacles.insert(at, obstacle);
        self.revision += 1;
    }
}
