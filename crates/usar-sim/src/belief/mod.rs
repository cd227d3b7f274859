//! Beliefs: what a group, or the team at home, holds true. A belief is a fold over the reports that were
//! heard. It has numbers, places and shapes of its own, so that it can be late, wrong, or about things that do
//! not exist.

mod news;
mod shared;
mod table;

use parry2d::math::{Pose, Vector};
use parry2d::shape::SharedShape;
use serde::{Deserialize, Serialize};

pub(crate) use news::{News, Opening, Seen};
pub use shared::Beliefs;
pub use table::Table;

use crate::geometry::{Outline, RadiationZone};
use crate::planning::{KnownObstacle, ObstacleKey, ObstacleMap};
use crate::report::{Report, Statement};
use crate::scenario::Scenario;

/// A belief about the things of the world, by their numbers.
#[derive(Clone, Serialize, Deserialize)]
pub struct Belief {
    /// Debris.
    pub debris: Table<KnownDebris>,
    /// Radiation zones.
    pub zones: Table<KnownZone>,
    /// Rescuees.
    pub rescuees: Table<KnownRescuee>,
    /// Robots that have stopped for good.
    pub wrecks: Table<KnownWreck>,
    /// Number of times that this belief was pooled. Between two poolings, each group's belief extends the
    /// team's.
    pool: u32,
    /// The news that concern routes, in the order in which they were heard.
    news: Vec<News>,
    /// One map for each class of radii. Follows from `debris` and `wrecks`.
    #[serde(skip)]
    obstacles: Vec<ObstacleMap>,
    /// Follows from `zones`.
    #[serde(skip)]
    zones_on: Vec<(u32, RadiationZone)>,
    /// How much obstacles are inflated.
    #[serde(skip)]
    inflation: Inflation,
}

/// A piece of debris, as reported.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct KnownDebris {
    /// Its shape.
    pub shape: SharedShape,
    /// Its place.
    pub pose: Pose,
    /// The step of the last report.
    pub at_step: u64,
    /// Standard deviation of its place, in metres.
    pub sd_m: f32,
}

impl KnownDebris {
    /// The shape at its place.
    #[must_use]
    pub fn outline(&self) -> Outline {
        Outline { shape: self.shape.clone(), pose: self.pose }
    }
}

/// A radiation zone, as reported.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct KnownZone {
    /// Its source and radius.
    pub disc: RadiationZone,
    /// Whether it radiates.
    pub on: bool,
    /// The step of the last report.
    pub at_step: u64,
    /// Standard deviation of its place, in metres.
    pub sd_m: f32,
}

/// A rescuee, as reported.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct KnownRescuee {
    /// Where it waits; none if it no longer waits.
    pub waits_at: Option<Vector>,
    /// The step of the last report.
    pub at_step: u64,
    /// Standard deviation of its place, in metres.
    pub sd_m: f32,
}

/// A robot that has stopped for good, as reported.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct KnownWreck {
    /// Its place.
    pub at: Vector,
    /// Its radius, in metres.
    pub radius: f32,
    /// Whether it is in nobody's way, because it flies.
    pub is_aerial: bool,
    /// The step of the last report.
    pub at_step: u64,
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

impl Belief {
    /// A belief about nothing.
    #[must_use]
    pub fn nothing(inflation: Inflation) -> Self {
        Self {
            debris: Table::default(),
            zones: Table::default(),
            rescuees: Table::default(),
            wrecks: Table::default(),
            pool: 0,
            news: Vec::new(),
            obstacles: vec![ObstacleMap::default(); inflation.radii.len()],
            zones_on: Vec::new(),
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

    /// The radiation zones that are held to be on, with their numbers.
    #[must_use]
    pub fn zones_on(&self) -> &[(u32, RadiationZone)] {
        &self.zones_on
    }

    /// Takes a report into account. Returns whether it is newer than what was heard of the thing before.
    pub fn hear(&mut self, report: &Report) -> bool {
        let (at_step, sd_m) = (report.at_step, report.sd_m);
        match &report.says {
            Statement::DebrisLies { debris, shape, pose } => {
                let known = KnownDebris { shape: shape.clone(), pose: *pose, at_step, sd_m };
                self.hear_of_debris(*debris, known)
            }
            Statement::ZoneIs { zone, disc, on } => {
                self.hear_of_zone(*zone, KnownZone { disc: *disc, on: *on, at_step, sd_m })
            }
            Statement::RescueeWaits { rescuee, at } => {
                let known = KnownRescuee { waits_at: Some(*at), at_step, sd_m };
                self.hear_of_rescuee(rescuee.index(), known)
            }
            Statement::RescueeIsGone { rescuee } => {
                self.hear_of_rescuee(rescuee.index(), KnownRescuee { waits_at: None, at_step, sd_m })
            }
            Statement::WreckLies { robot, at, radius, is_aerial } => {
                let known = KnownWreck { at: *at, radius: *radius, is_aerial: *is_aerial, at_step };
                self.hear_of_wreck(robot.0, known)
            }
        }
    }

    fn hear_of_debris(&mut self, number: u32, heard: KnownDebris) -> bool {
        let known = self.debris.get(number as usize);
        if known.is_some_and(|known| known.at_step >= heard.at_step) {
            return false;
        }
        let is_moved = known.is_none_or(|known| known.pose != heard.pose);
        let outline = heard.outline();
        self.debris.set(number as usize, heard);
        if is_moved {
            self.insert(|inflation, radius| debris_obstacle(number, &outline, radius, inflation.clearance));
        }
        true
    }

    fn hear_of_zone(&mut self, number: u32, heard: KnownZone) -> bool {
        let known = self.zones.get(number as usize);
        if known.is_some_and(|known| known.at_step >= heard.at_step) {
            return false;
        }
        let was_on = known.is_some_and(|known| known.on);
        self.zones.set(number as usize, heard);
        let at = self.zones_on.partition_point(|(other, _)| *other < number);
        if heard.on && !was_on {
            self.zones_on.insert(at, (number, heard.disc));
            self.news.push(News::Zone(number));
        } else if was_on && !heard.on {
            self.zones_on.remove(at);
            self.news.push(News::Opening(Opening { center: heard.disc.center, reach: heard.disc.radius }));
        }
        true
    }

    fn hear_of_rescuee(&mut self, number: usize, heard: KnownRescuee) -> bool {
        let is_newer = self.rescuees.get(number).is_none_or(|known| known.at_step < heard.at_step);
        if is_newer {
            self.rescuees.set(number, heard);
        }
        is_newer
    }

    /// A wreck lies for good: the first report of it counts.
    fn hear_of_wreck(&mut self, number: u32, heard: KnownWreck) -> bool {
        if self.wrecks.get(number as usize).is_some() {
            return false;
        }
        self.wrecks.set(number as usize, heard);
        if !heard.is_aerial {
            self.insert(|inflation, radius| wreck_obstacle(number, &heard, radius, inflation.clearance));
        }
        true
    }

    /// Takes over all that others have heard and this belief has not.
    fn pool(&mut self, others: &[Self]) {
        for other in others {
            other.debris.iter().for_each(|(number, known)| {
                self.hear_of_debris(number, known.clone());
            });
            other.zones.iter().for_each(|(number, known)| {
                self.hear_of_zone(number, *known);
            });
            other.wrecks.iter().for_each(|(number, known)| {
                self.hear_of_wreck(number, *known);
            });
            other.rescuees.iter().for_each(|(number, known)| {
                self.hear_of_rescuee(number as usize, *known);
            });
        }
        self.pool += 1;
    }

    /// Makes again what follows from the other fields, after a snapshot was read.
    fn restore(&mut self, inflation: &Inflation) {
        self.obstacles =
            inflation.radii.iter().map(|radius| self.map(*radius, inflation.clearance)).collect();
        self.inflation = inflation.clone();
        let on = self.zones.iter().filter(|(_, known)| known.on);
        self.zones_on = on.map(|(number, known)| (number, known.disc)).collect();
    }

    /// The map of all known obstacles for robots of this radius.
    fn map(&self, radius: f32, clearance: f32) -> ObstacleMap {
        let debris = self.debris.iter();
        let debris =
            debris.map(|(number, known)| debris_obstacle(number, &known.outline(), radius, clearance));
        let wrecks = self.wrecks.iter().filter(|(_, known)| !known.is_aerial);
        debris.chain(wrecks.map(|(number, known)| wreck_obstacle(number, known, radius, clearance))).collect()
    }

    /// Adds an obstacle to the maps of all classes. The news use its outline for the largest robots.
    fn insert(&mut self, obstacle: impl Fn(&Inflation, f32) -> KnownObstacle) {
        let mut news = None;
        for (map, radius) in self.obstacles.iter_mut().zip(&self.inflation.radii) {
            let obstacle = obstacle(&self.inflation, *radius);
            let key = obstacle.key;
            let before = map.insert(obstacle);
            news = Some((key, before.map(|before| before.middle_and_reach())));
        }
        let Some((key, opening)) = news else { return };
        let opening = opening.map(|(center, reach)| News::Opening(Opening { center, reach }));
        self.news.extend(opening.into_iter().chain([News::Obstacle(key)]));
    }
}

fn debris_obstacle(number: u32, outline: &Outline, radius: f32, clearance: f32) -> KnownObstacle {
    KnownObstacle::new(ObstacleKey::Debris(number), outline, radius, clearance)
}

fn wreck_obstacle(number: u32, wreck: &KnownWreck, radius: f32, clearance: f32) -> KnownObstacle {
    KnownObstacle::wreck(number, wreck.at, wreck.radius, radius, clearance)
}

#[cfg(test)]
mod tests;
