//! Shapes in the plane and their places.

mod outline;
mod places;
mod zone;

pub use outline::Outline;
pub use places::{Found, Places};
pub use zone::RadiationZone;
