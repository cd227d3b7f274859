//! The reference: the cost of the physics alone. Robots drive straight to random waypoints among fixed
//! boxes and push against anything in their way. Aerial robots collide with nothing.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rapier2d::dynamics::{RigidBodyBuilder, RigidBodyHandle};
use rapier2d::geometry::{ColliderBuilder, InteractionGroups};
use rapier2d::math::Vector;
use rapier2d::pipeline::PhysicsWorld;
use scenario::DebrisShape;
use xtask::density::{DT_S, RADIUS_M, SPEED_MPS, aerial, boxes, side};

/// A raw world of rapier.
pub struct Raw {
    world: PhysicsWorld,
    robots: Vec<(RigidBodyHandle, Vector)>,
    draws: ChaCha8Rng,
    side: f32,
}

impl Raw {
    /// A world with all robots at their first places.
    pub fn new(robots: u32) -> Self {
        let side = side(robots) as f32;
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::ZERO;
        world.integration_parameters.dt = DT_S as f32;
        let (half, outside) = (side / 2.0, side + 1.0);
        for (at, [w, h]) in [
            ([half, -1.0], [outside, 1.0]),
            ([half, outside], [outside, 1.0]),
            ([-1.0, half], [1.0, outside]),
            ([outside, half], [1.0, outside]),
        ] {
            world.insert(RigidBodyBuilder::fixed().translation(at.into()), ColliderBuilder::cuboid(w, h));
        }
        for piece in boxes(robots, |_| false) {
            let DebrisShape::Box(width, height) = piece.shape else { unreachable!("only boxes are drawn") };
            let body = RigidBodyBuilder::fixed()
                .translation(Vector::new(piece.at[0] as f32, piece.at[1] as f32))
                .rotation(piece.rotation_deg.to_radians() as f32);
            world.insert(body, ColliderBuilder::cuboid(width as f32 / 2.0, height as f32 / 2.0));
        }
        let mut draws = ChaCha8Rng::seed_from_u64(1);
        let place = |draws: &mut ChaCha8Rng| {
            Vector::new(draws.random_range(1.0..side - 1.0), draws.random_range(1.0..side - 1.0))
        };
        let robots = (0..robots)
            .map(|i| {
                let body = RigidBodyBuilder::dynamic()
                    .translation(place(&mut draws))
                    .lock_rotations()
                    .can_sleep(false);
                let mut collider = ColliderBuilder::ball(RADIUS_M as f32);
                if i < aerial(robots) {
                    collider = collider.collision_groups(InteractionGroups::none());
                }
                (world.insert(body, collider).0, place(&mut draws))
            })
            .collect();
        Self { world, robots, draws, side }
    }

    /// One step of driving and physics.
    pub fn step(&mut self) {
        for (handle, waypoint) in &mut self.robots {
            let body = &mut self.world.bodies[*handle];
            let way = *waypoint - body.translation();
            if way.length() < 0.5 {
                let draws = &mut self.draws;
                *waypoint = Vector::new(
                    draws.random_range(1.0..self.side - 1.0),
                    draws.random_range(1.0..self.side - 1.0),
                );
            }
            body.set_linvel(way.normalize_or_zero() * SPEED_MPS as f32, true);
        }
        self.world.step();
    }
}
