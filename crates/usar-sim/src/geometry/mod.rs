//! Shapes in the plane and where they are.

mod outline;
mod places;
mod zone;

pub use outline::Outline;
pub use places::{Found, Places};
pub use zone::RadiationZone;
