//! In how many radiation zones each robot is.

use parry2d::math::Vector;
use scenario::shapes::RadiationZone;

use super::Robot;

/// Distance to a border in which rounding is lost, in metres.
const ROUNDING_M: f32 = 0.001;

/// The zones at a place.
#[derive(Debug, Clone, Copy)]
struct Counted {
    at: Vector,
    zones: usize,
    /// Distance to the nearest border of a zone, in metres: up to there, the number holds.
    free_m: f32,
}

/// The zones in which each robot is. A robot is counted anew once it may have crossed a border.
#[derive(Debug, Default)]
pub(super) struct ZoneCounts {
    of: Vec<Counted>,
}

impl ZoneCounts {
    /// Has every robot counted anew: a zone was switched.
    pub(super) fn forget(&mut self) {
        self.of.clear();
    }

    /// Counts the robots that may have crossed a border. `zones` are all zones, and whether each is on.
    pub(super) fn update<'z>(
        &mut self,
        robots: &[Robot],
        zones: &(impl Iterator<Item = (&'z RadiationZone, bool)> + Clone),
    ) {
        let unknown = Counted { at: Vector::ZERO, zones: 0, free_m: f32::NEG_INFINITY };
        self.of.resize(robots.len(), unknown);
        for (counted, robot) in self.of.iter_mut().zip(robots) {
            let (at, free_m) = (robot.position, counted.free_m);
            let is_free = free_m > 0.0 && (at - counted.at).length_squared() < free_m * free_m;
            if !is_free {
                let border = |zone: &RadiationZone| ((at - zone.center).length() - zone.radius).abs();
                let nearest = zones.clone().map(|(zone, _)| border(zone)).fold(f32::INFINITY, f32::min);
                let inside = zones.clone().filter(|(zone, is_on)| *is_on && zone.contains(at));
                *counted = Counted { at, zones: inside.count(), free_m: nearest - ROUNDING_M };
            }
        }
    }

    /// The number of zones that are on at the place of each robot, by id.
    pub(super) fn iter(&self) -> impl Iterator<Item = usize> {
        self.of.iter().map(|counted| counted.zones)
    }
}
