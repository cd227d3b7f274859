//! Radiation zones: discs, whose effects add up where they overlap.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

/// A source of radiation and the radius of its effect.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RadiationZone {
    /// The source.
    pub center: Vector,
    /// Radius, in metres.
    pub radius: f32,
}

impl RadiationZone {
    /// Whether a point lies inside.
    pub fn contains(&self, point: Vector) -> bool {
        (point - self.center).length_squared() <= self.radius * self.radius
    }

    /// Length of the part of a straight line that lies inside the zone, in metres.
    pub fn length_inside(&self, from: Vector, to: Vector) -> f32 {
        let way = to - from;
        let length = way.length();
        if length <= f32::EPSILON {
            return 0.0;
        }
        let direction = way / length;
        let nearest = (self.center - from).dot(direction);
        let squared_half_chord =
            self.radius * self.radius - (self.center - from - direction * nearest).length_squared();
        if squared_half_chord <= 0.0 {
            return 0.0;
        }
        let half_chord = squared_half_chord.sqrt();
        ((nearest + half_chord).min(length) - (nearest - half_chord).max(0.0)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_length_inside_is_the_chord_cut_to_the_way() {
        let zone = RadiationZone { center: Vector::new(5.0, 0.0), radius: 3.0 };
        let length = |from: [f32; 2], to: [f32; 2]| zone.length_inside(from.into(), to.into());
        assert!((length([0.0, 0.0], [10.0, 0.0]) - 6.0).abs() < 1e-5);
        assert!((length([5.0, 0.0], [10.0, 0.0]) - 3.0).abs() < 1e-5);
        assert!((length([4.0, 0.0], [6.0, 0.0]) - 2.0).abs() < 1e-5);
        assert!(length([0.0, 4.0], [10.0, 4.0]) == 0.0);
        assert!(length([9.0, 0.0], [20.0, 0.0]) == 0.0);
        assert!(length([1.0, 0.0], [1.0, 0.0]) == 0.0);
    }
}
