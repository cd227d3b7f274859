//! How the ways of two robots relate, and what follows for their avoidance.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

/// Time within which robots avoid a collision, in seconds. With a longer horizon, robots keep farther apart
/// than crowds allow. With a shorter one, they swerve too late.
const HORIZON_S: f32 = 1.5;

/// The longest of these times, in seconds.
pub(super) const LONGEST_HORIZON_S: f32 = CROSSING_HORIZON_S;

/// The same for robots that cross. Two groups that cross pass between one another if they begin in time.
const CROSSING_HORIZON_S: f32 = 2.0;

/// The same for a robot that makes room and the robot for which it does so. They come close on purpose.
const ROOM_HORIZON_S: f32 = 0.6;

/// Two ways cross if the cosine between their directions is nearer to zero than this.
const CROSSING: f32 = 0.3;

/// Two ways are parallel if the cosine between their directions is at least this.
const PARALLEL: f32 = 0.999;

/// How the ways of two robots relate. The relation is symmetric.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Encounter {
    /// One makes room for the other.
    MakesRoom,
    /// They cross, about at a right angle.
    Crossing,
    /// They go side by side or one behind the other.
    Parallel,
    /// They meet head-on or at another angle, or one of them has nowhere to go.
    Other,
}

impl Encounter {
    /// The encounter of two robots that wish to go in these directions (zero for a robot with nowhere to go),
    /// neither of which makes room for the other.
    pub(super) fn of(a: Vector, b: Vector) -> Self {
        let cos = a.dot(b);
        if a == Vector::ZERO || b == Vector::ZERO {
            Self::Other
        } else if cos.abs() < CROSSING {
            Self::Crossing
        } else if cos >= PARALLEL {
            Self::Parallel
        } else {
            Self::Other
        }
    }

    /// Time within which the two avoid a collision, in seconds.
    pub(super) fn horizon_s(self) -> f32 {
        match self {
            Self::MakesRoom => ROOM_HORIZON_S,
            Self::Crossing => CROSSING_HORIZON_S,
            Self::Parallel | Self::Other => HORIZON_S,
        }
    }

    /// Whether the two pass more easily if all keep to one side.
    pub(super) fn needs_a_side(self) -> bool {
        matches!(self, Self::MakesRoom | Self::Other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encounters_are_told_apart_by_the_angle() {
        let with = |degrees: f32| {
            let angle = degrees.to_radians();
            Encounter::of(Vector::X, Vector::new(libm::cosf(angle), libm::sinf(angle)))
        };
        for (degrees, encounter) in [
            (0.0, Encounter::Parallel),
            (2.0, Encounter::Parallel),
            (5.0, Encounter::Other),
            (45.0, Encounter::Other),
            (75.0, Encounter::Crossing),
            (90.0, Encounter::Crossing),
            (-105.0, Encounter::Crossing),
            (120.0, Encounter::Other),
            (180.0, Encounter::Other),
        ] {
            assert_eq!(with(degrees), encounter, "{degrees} degrees");
        }
        assert_eq!(Encounter::of(Vector::ZERO, Vector::X), Encounter::Other, "nowhere to go");
    }
}
