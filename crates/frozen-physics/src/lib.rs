//! A rapier2d world as bytes and back, to go on bit for bit.
//!
//! A crate of its own for one reason: reading and writing every type of the engine is more code than the
//! whole simulator. Here it is compiled once and hardly optimised (`Cargo.toml` of the workspace), not again
//! with every change of the simulator.

use rapier2d::pipeline::PhysicsWorld;

/// The whole world as bytes (postcard).
///
/// # Errors
/// Never in a sound world: all its parts can be written to memory.
pub fn freeze(world: &PhysicsWorld) -> Result<Vec<u8>, postcard::Error> {
    postcard::to_stdvec(world)
}

/// The world that was frozen.
///
/// # Errors
/// The bytes are not those of a world.
pub fn thaw(bytes: &[u8]) -> Result<PhysicsWorld, postcard::Error> {
    postcard::from_bytes(bytes)
}
