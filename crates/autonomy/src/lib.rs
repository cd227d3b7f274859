//! What robots and their base know and decide: the half of the simulator that cannot see the world.
//!
//! A [`model::Model`] is what is fixed. [Reports](report::Report) come from sensors, a
//! [belief](belief::Belief) is a fold over those that were heard, and the [mission](mission::Mission), the
//! [routes](navigation::Navigator) and the [right of way](conflict) go by beliefs. What comes of it are
//! [intents](intent::Intent) and velocities; the world above this crate carries them out or refuses them.
//!
//! Nothing here can name what is true: the world is in a crate above.
//!
//! ```compile_fail,E0433
//! use usar_sim::world::World;
//! ```

pub mod belief;
pub mod by_x;
pub mod conflict;
pub mod event;
pub mod executor;
pub mod hash;
pub mod ids;
pub mod intent;
pub mod mission;
pub mod model;
pub mod navigation;
pub mod planning;
pub mod report;
pub mod robot;
pub mod telemetry;
pub mod vitals;
