//! Shapes in the plane and their places.

mod outline;
mod places;
mod zone;

pub use outline::Outline;
pub use places::{Found, Places};
pub use zone::RadiationZone;

use parry2d::math::Vector;

/// A point in the precision of the physics.
pub fn vector([x, y]: [f64; 2]) -> Vector {
    Vector::new(x as f32, y as f32)
}
