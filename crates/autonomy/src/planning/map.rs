//! The obstacles that a group knows, inflated for robots of one radius, found by place.

use std::collections::BTreeMap;

use parry2d::math::Vector;
use scenario::Scenario;
use scenario::shapes::Places;

use super::obstacles::{KnownObstacle, ObstacleKey, contains};

/// How much obstacles are inflated: by the radius of each class of ground robots, and by their clearance.
#[derive(Debug, Clone)]
pub struct Inflation {
    /// Radii of the classes in ascending order, in metres.
    pub radii: Vec<f32>,
    /// Distance that robots keep from obstacles beyond their radius, in metres.
    pub clearance: f32,
}

impl Inflation {
    /// The inflation for the robots of a scenario.
    pub fn of(scenario: &Scenario) -> Self {
        Self {
            radii: scenario.ground_radii_m().iter().map(|radius| *radius as f32).collect(),
            clearance: scenario.planning.clearance_m as f32,
        }
    }

    /// Empty maps, one for each class of radii.
    pub fn maps(&self) -> Vec<ObstacleMap> {
        let map = |radius: &f32| ObstacleMap {
            radius: *radius,
            clearance: self.clearance,
            ..ObstacleMap::default()
        };
        self.radii.iter().map(map).collect()
    }
}

/// Obstacles, one for each key. Searches by place return obstacles in no particular order; callers that
/// depend on an order sort by key.
#[derive(Debug, Clone, Default)]
pub struct ObstacleMap {
    /// Radius of the robots for which obstacles are inflated, in metres.
    pub radius: f32,
    /// Distance that they keep from obstacles beyond their radius, in metres.
    pub clearance: f32,
    obstacles: Vec<KnownObstacle>,
    slots: BTreeMap<ObstacleKey, usize>,
    places: Places,
    digest: u64,
}

impl ObstacleMap {
    /// Adds an obstacle, or replaces what was known of it. Returns the obstacle that was known by this key
    /// before.
    pub fn insert(&mut self, obstacle: KnownObstacle) -> Option<KnownObstacle> {
        let next = self.obstacles.len();
        let slot = *self.slots.entry(obstacle.key).or_insert(next);
        self.places.put(slot, *obstacle.bounds());
        self.digest = self.digest.wrapping_add(obstacle.digest_with_key());
        if slot == next {
            self.obstacles.push(obstacle);
            return None;
        }
        let before = std::mem::replace(&mut self.obstacles[slot], obstacle);
        self.digest = self.digest.wrapping_sub(before.digest_with_key());
        Some(before)
    }

    /// A hash of the whole map: maps with the same obstacles have the same.
    pub(crate) fn digest(&self) -> u64 {
        self.digest
    }

    /// Numbers of the obstacles that [`Self::near`] returns. They hold as long as the digest.
    pub(crate) fn numbers_near(&self, point: Vector, range: f32) -> impl Iterator<Item = usize> {
        self.places.near(point, range).into_iter()
    }

    /// The obstacle of a number.
    pub(crate) fn number(&self, number: usize) -> &KnownObstacle {
        &self.obstacles[number]
    }

    /// The obstacle of this key, if there is one.
    pub fn get(&self, key: ObstacleKey) -> Option<&KnownObstacle> {
        self.slots.get(&key).map(|slot| &self.obstacles[*slot])
    }

    /// All obstacles, in order of their keys.
    pub fn iter(&self) -> impl Iterator<Item = &KnownObstacle> {
        self.slots.values().map(|slot| &self.obstacles[*slot])
    }

    /// Obstacles whose inflated outlines may reach within this range of a point, in metres.
    pub fn near(&self, point: Vector, range: f32) -> impl Iterator<Item = &KnownObstacle> {
        self.places.near(point, range).into_iter().map(|slot| &self.obstacles[slot])
    }

    /// Obstacles whose inflated outlines the line from `a` to `b` may touch.
    pub fn along(&self, a: Vector, b: Vector) -> impl Iterator<Item = &KnownObstacle> {
        self.places.along(a, b).into_iter().map(|slot| &self.obstacles[slot])
    }

    /// Obstacles whose inflated outlines may reach within this range of the line from `a` to `b`, in metres.
    pub fn beside(&self, a: Vector, b: Vector, range: f32) -> impl Iterator<Item = &KnownObstacle> {
        self.places.beside(a, b, range).into_iter().map(|slot| &self.obstacles[slot])
    }

    /// Whether an obstacle cuts the line from `a` to `b`.
    pub(crate) fn cuts(&self, a: Vector, b: Vector) -> bool {
        self.along(a, b).any(|obstacle| obstacle.cuts(a, b))
    }

    /// Whether a point is so near to an obstacle that routes do not lead through it.
    pub(crate) fn covers(&self, point: Vector) -> bool {
        self.near(point, 0.0).any(|obstacle| contains(&obstacle.planned, point))
    }
}

impl FromIterator<KnownObstacle> for ObstacleMap {
    fn from_iter<T: IntoIterator<Item = KnownObstacle>>(obstacles: T) -> Self {
        let mut map = Self::default();
        obstacles.into_iter().for_each(|obstacle| {
            map.insert(obstacle);
        });
        map
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planning::obstacles::crosses;
    use scenario::shapes::Outline;

    fn disc(number: u32, at: [f32; 2]) -> KnownObstacle {
        KnownObstacle::new(ObstacleKey::Debris(number), &Outline::disc(at.into(), 1.0), 0.4, 0.15)
    }

    #[test]
    fn obstacles_are_found_where_they_were_seen_last() {
        let mut map: ObstacleMap = (0..50).map(|i| disc(i, [10.0 * i as f32, 5.0])).collect();
        let numbers = |map: &ObstacleMap, at: [f32; 2]| -> Vec<ObstacleKey> {
            map.near(at.into(), 1.0).map(|obstacle| obstacle.key).collect()
        };
        assert_eq!(numbers(&map, [200.0, 5.0]), [ObstacleKey::Debris(20)]);
        assert!(map.cuts([195.0, 5.0].into(), [205.0, 5.0].into()));
        let before = map.insert(disc(20, [200.0, 50.0])).unwrap();
        assert!(contains(&before.planned, [200.0, 5.0].into()));
        assert!(
            numbers(&map, [200.0, 5.0]).is_empty() && !map.cuts([195.0, 5.0].into(), [205.0, 5.0].into())
        );
        assert!(map.covers([200.0, 50.0].into()) && !map.covers([200.0, 5.0].into()));
        assert_eq!(map.iter().count(), 50);
        let across = map.along([0.0, 5.0].into(), [490.0, 5.0].into());
        assert_eq!(across.count(), 49);
    }

    #[test]
    fn whatever_cuts_a_way_is_found_along_it() {
        let map: ObstacleMap =
            (0..100).map(|i| disc(i, [(i % 10) as f32 * 4.0, (i / 10) as f32 * 4.0])).collect();
        for i in 0..400_u16 {
            let a = Vector::new(f32::from(i % 20) * 2.0, f32::from(i / 20) * 2.0);
            let b = Vector::new(f32::from(i % 7) * 6.0, f32::from(i % 13) * 3.0);
            let all = map.iter().any(|obstacle| crosses(&obstacle.tight, a, b));
            assert_eq!(map.cuts(a, b), all, "{a} {b}");
        }
    }
}
