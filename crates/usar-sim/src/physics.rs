//! The interface to the physics engine. No other file names `rapier2d`.
//!
//! Bodies in a plane seen from above, without gravity. Ground robots are discs that touch walls, debris and
//! each other. Aerial robots touch walls and each other. Debris is fixed, or rubs on the ground with Coulomb
//! friction. The engine runs only in steps in which something can touch or slides. In the others, robots
//! coast to the same places, bit for bit; in a large team, so do those that can touch nothing (`quiet.rs`).

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use parry2d::math::{Pose, Vector};
use rapier2d::dynamics::{
    GenericJointBuilder, IntegrationParameters, JointAxesMask, JointAxis, RigidBody, RigidBodyBuilder,
    RigidBodyHandle,
};
use rapier2d::geometry::{ColliderBuilder, Group, InteractionGroups, InteractionTestMode};
use rapier2d::pipeline::PhysicsWorld;
use serde::{Deserialize, Serialize};

use crate::ids::RobotId;
use crate::quiet::{Disc, Fixed, Quiet};
use scenario::shapes::Outline;

/// Features of the engine that change numerical results, for the manifests of results.
pub const ENGINE_FEATURES: [&str; 1] = ["rapier2d/enhanced-determinism"];

const GROUND: Group = Group::GROUP_1;
const AERIAL: Group = Group::GROUP_2;
const DEBRIS: Group = Group::GROUP_3;
const WALL: Group = Group::GROUP_4;

/// Half the thickness of the arena's walls, in metres; they stand outside the arena.
const HALF_WALL_M: f32 = 1.0;

/// Friction between bodies that touch.
const BODY_FRICTION: f32 = 0.2;

/// Greatest speed at which overlaps are corrected, in metres per second: 0.8 mm in a step of 0.02 s, so that
/// no robot jumps.
const CORRECTION_MPS: f32 = 0.04;

/// Number of steps at top speed for which contacts are predicted. So robots that meet head-on touch instead
/// of overlapping first.
const APPROACH_STEPS: f32 = 2.0;

/// Movable debris is thin if the fastest robot goes farther in a step than this share of the piece's narrower
/// side.
const THIN_SHARE: f32 = 0.125;

/// Standard gravity, in metres per second squared: the weight with which movable debris rubs on the ground.
const GRAVITY: f32 = 9.806_65;

/// From this number of robots on, the engine steps only those that can touch something. In a smaller team,
/// that would save little.
const ISLANDS_FROM: usize = 36;

/// Where the engine's bodies of robots stand that it does not step, and how far from one another, in metres.
const PARKED_AT: Vector = Vector::splat(-1000.0);
const PARKED_APART: Vector = Vector::new(0.0, 100.0);

/// Gain with which the ground opposes the sliding of debris, per second, up to the limit of friction: stiff
/// against any slow push.
const GROUND_GRIP: f32 = 1.0e3;

/// The properties of a robot that the engine needs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RobotBody {
    /// Centre, in metres.
    pub position: Vector,
    /// Whether it flies over debris and ground robots.
    pub is_aerial: bool,
    /// Radius of its disc, in metres.
    pub radius: f32,
    /// Mass, in kilograms.
    pub mass: f32,
    /// Top speed, in metres per second.
    pub top_speed: f32,
}

/// The properties of a piece of debris that the engine needs.
#[derive(Clone)]
pub(crate) struct DebrisBody {
    /// Its shape and place.
    pub outline: Outline,
    /// Whether events put this fixed piece to other places.
    pub is_gate: bool,
    /// Mass, and mass times the coefficient of friction with the ground, in kilograms; `None` for a fixed
    /// piece.
    pub masses: Option<[f32; 2]>,
}

/// The rigid bodies of one trial.
#[derive(Serialize, Deserialize)]
pub struct Physics {
    #[serde(with = "as_bytes")]
    world: PhysicsWorld,
    robots: Vec<RigidBodyHandle>,
    /// Bodies of movable debris; fixed debris never moves.
    debris: Vec<Option<RigidBodyHandle>>,
    /// Bodies of the debris that events place or remove, by number.
    gates: BTreeMap<usize, RigidBodyHandle>,
    /// Where the robots are, and how they move.
    quiet: Quiet,
    /// Whether the engine has a piece of debris awake: it moves, or has not lain still for long.
    #[serde(skip)]
    debris_is_awake: bool,
    /// Steps done since the last restoring, and those in which the engine ran.
    #[serde(skip)]
    steps: [u64; 2],
    /// Whether the engine runs in every step.
    #[serde(skip)]
    is_always_on: bool,
}

impl Physics {
    /// Builds all bodies in an arena of this width and height, in metres, for steps of `dt` seconds.
    pub(crate) fn new(dt: f32, arena: Vector, robots: &[RobotBody], debris: &[DebrisBody]) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::ZERO;
        world.integration_parameters = parameters(dt);
        world.broad_phase.adaptive_change_detection_margin = true; // fewer updates of the tree of boxes
        insert_walls(&mut world, arena);
        let ground = world.insert_body(RigidBodyBuilder::fixed());
        let drivers = robots.iter().filter(|robot| !robot.is_aerial);
        let longest_step = drivers.map(|robot| robot.top_speed).fold(0.0, f32::max) * dt;
        let mut gates = BTreeMap::new();
        let insert = |(number, piece): (usize, &DebrisBody)| {
            let (handle, is_movable) = insert_debris(&mut world, ground, piece, longest_step);
            if piece.is_gate {
                gates.insert(number, handle);
            }
            is_movable.then_some(handle)
        };
        let debris: Vec<Option<RigidBodyHandle>> = debris.iter().enumerate().map(insert).collect();
        let handles = robots.iter().map(|robot| insert_robot(&mut world, robot, dt)).collect();
        let resting = |robot: &RobotBody| Disc { at: robot.position, ..Disc::default() };
        let quiet = Quiet::new(dt, arena, robots.iter().map(resting).collect());
        let (debris_is_awake, steps, is_always_on) = (false, [0; 2], false);
        let mut physics =
            Self { world, robots: handles, debris, gates, quiet, debris_is_awake, steps, is_always_on };
        physics.restore(dt, arena, robots);
        physics
    }

    /// Restores what snapshots leave out because it does not change.
    pub(crate) fn restore(&mut self, dt: f32, arena: Vector, robots: &[RobotBody]) {
        (self.quiet.dt, self.quiet.arena) = (dt, arena);
        self.quiet.by_island = robots.len() >= ISLANDS_FROM;
        self.debris_is_awake = is_awake(&self.world, &self.debris);
        for ((disc, robot), handle) in self.quiet.discs.iter_mut().zip(robots).zip(&self.robots) {
            let body = &self.world.bodies[*handle];
            let masses = [body.mass(), body.mass_properties().local_mprops.inv_mass];
            disc.fixed = Fixed { radius: robot.radius, is_aerial: robot.is_aerial, masses };
        }
    }

    /// Has the engine step the whole team, however large, in steps in which it runs.
    pub fn step_whole_team(&mut self) {
        self.quiet.by_island = false;
    }

    /// Has the engine run in every step, for everybody: the reference for quiet steps.
    pub fn keep_engine_on(&mut self) {
        self.is_always_on = true;
    }

    /// Steps done, and those of them in which the engine ran.
    pub fn steps(&self) -> [u64; 2] {
        self.steps
    }

    /// Changes a robot's velocity by this vector, in metres per second.
    pub(crate) fn drive(&mut self, robot: RobotId, velocity_change: Vector) {
        let disc = &mut self.quiet.discs[robot.index()];
        let [mass, inverse] = disc.fixed.masses;
        disc.velocity += velocity_change * mass * inverse;
    }

    /// The bodies of the debris that events place or remove.
    pub(crate) fn gates(&self) -> &BTreeMap<usize, RigidBodyHandle> {
        &self.gates
    }

    /// Puts a piece of debris that events place or remove to a place.
    pub(crate) fn put_debris(&mut self, number: usize, pose: Pose) {
        if let Some(handle) = self.gates.get(&number) {
            self.world.bodies[*handle].set_position(pose, true);
            self.quiet.forget();
            self.debris_is_awake = self.debris.iter().any(Option::is_some);
        }
    }

    /// Advances time by one step. `to_debris` is the distance from a point to the nearest piece of debris, at
    /// most the given reach, in metres, and `to_pushable` to the nearest that can be pushed. `pieces_touch`
    /// tells whether a piece that can be pushed touches another piece, or the border of this arena.
    pub(crate) fn integrate(
        &mut self,
        to_debris: impl Fn(Vector, f32) -> f32,
        to_pushable: impl Fn(Vector, f32) -> f32,
        pieces_touch: impl FnOnce(Vector) -> bool,
    ) {
        self.steps[0] += 1;
        if self.is_always_on || self.debris_is_awake || pieces_touch(self.quiet.arena) {
            self.quiet.take(true);
        } else if !self.quiet.find_near(to_debris, to_pushable) {
            self.quiet.coast();
            return;
        }
        self.steps[1] += 1;
        self.step_engine();
    }

    /// Lets the engine do a step with the robots that it is to move; the others coast.
    fn step_engine(&mut self) {
        let Self { world, robots, debris, quiet, .. } = self;
        for (i, handle) in robots.iter().enumerate() {
            if quiet.is_near(i) {
                put(&mut world.bodies[*handle], &quiet.discs[i]);
            } else if !world.bodies[*handle].is_sleeping() {
                park(&mut world.bodies[*handle], i);
            }
        }
        quiet.coast();
        world.step();
        for (i, handle) in robots.iter().enumerate() {
            let body = &world.bodies[*handle];
            if quiet.is_near(i) {
                quiet.moved(i, body.translation(), body.linvel());
            }
        }
        self.debris_is_awake = is_awake(world, debris);
        if self.debris_is_awake {
            quiet.forget();
        }
    }

    /// Position and velocity of a robot.
    pub(crate) fn robot_motion(&self, robot: RobotId) -> (Vector, Vector) {
        let disc = &self.quiet.discs[robot.index()];
        (disc.at, disc.velocity)
    }

    /// Pose, velocity and angular velocity of every body that can move: a part of the hash chain.
    pub(crate) fn motions(&self) -> Vec<(Pose, Vector, f32)> {
        let discs = self.quiet.discs.iter();
        let robots = discs.map(|disc| (Pose::from_translation(disc.at), disc.velocity, 0.0));
        let motion = |handle: &RigidBodyHandle| {
            let body = &self.world.bodies[*handle];
            (*body.position(), body.linvel(), body.angvel())
        };
        robots.chain(self.debris.iter().flatten().map(motion)).collect()
    }

    /// Numbers and poses of the movable debris, in order.
    pub(crate) fn debris_poses(&self) -> impl Iterator<Item = (usize, Pose)> + '_ {
        let movable =
            self.debris.iter().enumerate().filter_map(|(number, handle)| Some((number, (*handle)?)));
        movable.map(|(number, handle)| (number, *self.world.bodies[handle].position()))
    }

    /// Whether the engine disabled a body because its state was no longer finite.
    pub(crate) fn is_broken(&self) -> bool {
        !self.world.quarantine().is_empty()
    }
}

/// Whether the engine has a piece of movable debris awake.
fn is_awake(world: &PhysicsWorld, debris: &[Option<RigidBodyHandle>]) -> bool {
    debris.iter().flatten().any(|handle| !world.bodies[*handle].is_sleeping())
}

/// Puts a body where a robot is, if it is not there.
fn put(body: &mut RigidBody, disc: &Disc) {
    if body.is_sleeping() {
        body.wake_up(true);
    }
    if body.translation() != disc.at {
        body.set_position(Pose::from_translation(disc.at), false);
    }
    if body.linvel() != disc.velocity {
        body.set_linvel(disc.velocity, false);
    }
}

/// Has the engine leave a robot's body alone, at a place of its own outside the arena.
fn park(body: &mut RigidBody, number: usize) {
    body.set_position(Pose::from_translation(PARKED_AT - PARKED_APART * number as f32), false);
    body.sleep();
}

/// The engine's world as bytes, for snapshots.
mod as_bytes {
    use rapier2d::pipeline::PhysicsWorld;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de, ser};

    pub(super) fn serialize<S: Serializer>(world: &PhysicsWorld, to: S) -> Result<S::Ok, S::Error> {
        frozen_physics::freeze(world).map_err(ser::Error::custom)?.serialize(to)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<PhysicsWorld, D::Error> {
        frozen_physics::thaw(&Vec::deserialize(from)?).map_err(de::Error::custom)
    }
}

/// Every parameter of the engine. All are set here, so that no changed default of a new version takes effect.
fn parameters(dt: f32) -> IntegrationParameters {
    IntegrationParameters {
        dt,
        min_ccd_dt: dt / 100.0,
        contact_softness: rapier2d::dynamics::SpringCoefficients {
            natural_frequency: 30.0,
            damping_ratio: 10.0,
        },
        static_contact_softness: rapier2d::dynamics::SpringCoefficients {
            natural_frequency: 60.0,
            damping_ratio: 10.0,
        },
        warmstart_coefficient: 1.0,
        length_unit: 1.0,
        normalized_allowed_linear_error: 0.005,
        normalized_max_corrective_velocity: CORRECTION_MPS,
        normalized_prediction_distance: 0.02,
        normalized_max_linear_velocity: 400.0,
        num_solver_iterations: 4,
        num_internal_pgs_iterations: 1,
        num_internal_stabilization_iterations: 1,
        max_ccd_substeps: 1,
        contact_clustering: true,
        contact_recycling: false, // recycled contacts let robots overlap by up to 17 mm, for no gain in time
        normalized_contact_recycle_distance: 0.05,
        friction_in_bias_pass: false,
        warmstart_joints: false,
        soft_bodies: rapier2d::dynamics::SoftBodiesSettings::default(), // there are none
    }
}

fn groups(membership: Group, touches: Group) -> InteractionGroups {
    InteractionGroups::new(membership, touches, InteractionTestMode::And)
}

fn insert_walls(world: &mut PhysicsWorld, arena: Vector) {
    let [width, height] = [arena.x, arena.y];
    let (w, h, t) = (width / 2.0, height / 2.0, HALF_WALL_M);
    let walls = [
        (Vector::new(w, -t), w + 2.0 * t, t),
        (Vector::new(w, height + t), w + 2.0 * t, t),
        (Vector::new(-t, h), t, h + 2.0 * t),
        (Vector::new(width + t, h), t, h + 2.0 * t),
    ];
    for (center, half_width, half_height) in walls {
        world.insert(
            RigidBodyBuilder::fixed().translation(center),
            ColliderBuilder::cuboid(half_width, half_height)
                .friction(BODY_FRICTION)
                .collision_groups(groups(WALL, GROUND | AERIAL | DEBRIS)),
        );
    }
}

fn insert_robot(world: &mut PhysicsWorld, robot: &RobotBody, dt: f32) -> RigidBodyHandle {
    let collision =
        if robot.is_aerial { groups(AERIAL, AERIAL | WALL) } else { groups(GROUND, GROUND | DEBRIS | WALL) };
    let body = RigidBodyBuilder::dynamic()
        .translation(robot.position)
        .lock_rotations()
        .can_sleep(false)
        .soft_ccd_prediction(APPROACH_STEPS * robot.top_speed * dt)
        .build();
    let collider = ColliderBuilder::ball(robot.radius)
        .mass(robot.mass)
        .friction(BODY_FRICTION)
        .restitution(0.0)
        .collision_groups(collision);
    world.insert(body, collider).0
}

fn insert_debris(
    world: &mut PhysicsWorld,
    ground: RigidBodyHandle,
    piece: &DebrisBody,
    longest_step: f32,
) -> (RigidBodyHandle, bool) {
    let outline = &piece.outline;
    let builder =
        if piece.masses.is_some() { RigidBodyBuilder::dynamic() } else { RigidBodyBuilder::fixed() };
    // Without prediction, a thin piece that a fast robot pushes would be deep in the next body before the
    // engine notices the contact.
    let bounds = outline.shape.compute_local_aabb();
    let is_thin = longest_step > THIN_SHARE * bounds.extents().min_element();
    let foresight = if is_thin { APPROACH_STEPS * longest_step } else { 0.0 };
    let builder = builder.soft_ccd_prediction(foresight);
    let mut collider = ColliderBuilder::new(outline.shape.clone())
        .friction(BODY_FRICTION)
        .restitution(0.0)
        .collision_groups(groups(DEBRIS, GROUND | DEBRIS | WALL));
    if let Some([mass, _]) = piece.masses {
        collider = collider.mass(mass);
    }
    let (handle, _) = world.insert(builder.pose(outline.pose), collider);
    let Some([_, friction_mass]) = piece.masses else { return (handle, false) };
    // Friction with the ground: motors that hold the piece still in x, y and rotation, up to the force mu m
    // g. The solver treats x and y separately, so the limit is exact along the axes and up to 1.41 times
    // larger on the diagonal.
    let limit = friction_mass * GRAVITY;
    let arm = 2.0 / 3.0 * outline.shape.compute_local_bounding_sphere().radius;
    let mut joint = GenericJointBuilder::new(JointAxesMask::empty()).local_anchor1(outline.pose.translation);
    for (axis, limit) in [(JointAxis::LinX, limit), (JointAxis::LinY, limit), (JointAxis::AngX, limit * arm)]
    {
        joint = joint.motor_velocity(axis, 0.0, GROUND_GRIP).motor_max_force(axis, limit);
    }
    world.insert_impulse_joint(ground, handle, joint);
    (handle, true)
}
