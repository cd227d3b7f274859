//! The seam to the physics engine: the only file that names `rapier2d`.
//!
//! Bodies in a plane seen from above, without gravity. Ground robots are discs that touch walls, debris and each other; aerial robots
//! touch walls and each other. Debris is fixed, or rubs on the ground with Coulomb friction.

use parry2d::math::{Pose, Vector};
use rapier2d::dynamics::{
    GenericJointBuilder, IntegrationParameters, JointAxesMask, JointAxis, RigidBodyBuilder, RigidBodyHandle,
};
use rapier2d::geometry::{ColliderBuilder, Group, InteractionGroups, InteractionTestMode};
use rapier2d::pipeline::PhysicsWorld;

use crate::ids::RobotId;
use crate::scenario::{DebrisFile, Scenario};
use crate::world::{Debris, Robot};

const GROUND: Group = Group::GROUP_1;
const AERIAL: Group = Group::GROUP_2;
const DEBRIS: Group = Group::GROUP_3;
const WALL: Group = Group::GROUP_4;

/// Half the thickness of the arena's walls, in metres; they stand outside the arena.
const HALF_WALL_M: f32 = 1.0;

/// Friction between bodies that touch.
const BODY_FRICTION: f32 = 0.2;

/// Overlaps are corrected at most this fast, in metres per second: 0.8 mm in a step of 0.02 s, so that no robot jumps.
const CORRECTION_MPS: f32 = 0.04;

/// Contacts are foreseen as many steps ahead at top speed, so that robots that meet head-on touch instead of overlapping first.
const APPROACH_STEPS: f32 = 2.0;

/// Standard gravity, in metres per second squared: the weight with which movable debris rubs on the ground.
const GRAVITY: f32 = 9.806_65;

/// How hard the ground opposes the sliding of debris, per second, up to the limit of friction: stiff against any slow push.
const GROUND_GRIP: f32 = 1.0e3;

/// The rigid bodies of one trial.
pub struct Physics {
    world: PhysicsWorld,
    robots: Vec<RigidBodyHandle>,
    /// Bodies of movable debris; fixed debris never moves.
    debris: Vec<Option<RigidBodyHandle>>,
}

impl Physics {
    /// Builds all bodies.
    pub(crate) fn new(
        scenario: &Scenario,
        robots: &[Robot],
        files: &[DebrisFile],
        debris: &[Debris],
    ) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::ZERO;
        world.integration_parameters = parameters(scenario.dt_s as f32);
        insert_walls(&mut world, scenario.arena_m.map(|size| size as f32));
        let ground = world.insert_body(RigidBodyBuilder::fixed());
        let debris = files
            .iter()
            .zip(debris)
            .map(|(file, piece)| insert_debris(&mut world, ground, file, piece))
            .collect();
        let robots =
            robots.iter().map(|robot| insert_robot(&mut world, robot, scenario.dt_s as f32)).collect();
        Self { world, robots, debris }
    }

    /// Changes a robot's velocity by as much as its drive allowed.
    pub(crate) fn drive(&mut self, robot: RobotId, velocity_change: Vector) {
        let body = &mut self.world.bodies[self.robots[robot.index()]];
        body.apply_impulse(velocity_change * body.mass(), true);
    }

    /// Moves time on by one step.
    pub(crate) fn integrate(&mut self) {
        self.world.step();
    }

    /// Position and velocity of a robot.
    pub(crate) fn robot_motion(&self, robot: RobotId) -> (Vector, Vector) {
        let body = &self.world.bodies[self.robots[robot.index()]];
        (body.translation(), body.linvel())
    }

    /// Poses of the debris, in order; `None` for fixed debris.
    pub(crate) fn debris_poses(&self) -> impl Iterator<Item = Option<Pose>> + '_ {
        self.debris.iter().map(|handle| handle.map(|handle| *self.world.bodies[handle].position()))
    }

    /// Whether the engine disabled a body because its state was no longer finite.
    pub(crate) fn is_broken(&self) -> bool {
        !self.world.quarantine().is_empty()
    }
}

/// Every parameter of the engine, set here and nowhere else: none is left to a default that a new version may change.
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
        contact_recycling: true,
        normalized_contact_recycle_distance: 0.05,
        friction_in_bias_pass: false,
        warmstart_joints: false,
        soft_bodies: rapier2d::dynamics::SoftBodiesSettings::default(), // there are none
    }
}

fn groups(membership: Group, touches: Group) -> InteractionGroups {
    InteractionGroups::new(membership, touches, InteractionTestMode::And)
}

fn insert_walls(world: &mut PhysicsWorld, [width, height]: [f32; 2]) {
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

fn insert_robot(world: &mut PhysicsWorld, robot: &Robot, dt: f32) -> RigidBodyHandle {
    let collision = if robot.is_aerial() {
        groups(AERIAL, AERIAL | WALL)
    } else {
        groups(GROUND, GROUND | DEBRIS | WALL)
    };
    let body = RigidBodyBuilder::dynamic()
        .translation(robot.position)
        .lock_rotations()
        .can_sleep(false)
        .soft_ccd_prediction(APPROACH_STEPS * robot.spec.speed_mps as f32 * dt)
        .build();
    let collider = ColliderBuilder::ball(robot.radius())
        .mass(robot.spec.mass_kg as f32)
        .friction(BODY_FRICTION)
        .restitution(0.0)
        .collision_groups(collision);
    world.insert(body, collider).0
}

fn insert_debris(
    world: &mut PhysicsWorld,
    ground: RigidBodyHandle,
    file: &DebrisFile,
    piece: &Debris,
) -> Option<RigidBodyHandle> {
    let outline = &piece.outline;
    let builder =
        if file.movable.is_some() { RigidBodyBuilder::dynamic() } else { RigidBodyBuilder::fixed() };
    let mut collider = ColliderBuilder::new(outline.shape.clone())
        .friction(BODY_FRICTION)
        .restitution(0.0)
        .collision_groups(groups(DEBRIS, GROUND | DEBRIS | WALL));
    if let Some(movable) = file.movable {
        collider = collider.mass(movable.mass_kg as f32);
    }
    let (handle, _) = world.insert(builder.pose(outline.pose), collider);
    let movable = file.movable?;
    // Friction with the ground: motors that hold still in x, y and rotation, up to the force mu m g. The solver treats x and y apart,
    // so the limit is exact along them and up to 1.41 times larger on the diagonal.
    let limit = (movable.friction * movable.mass_kg) as f32 * GRAVITY;
    let arm = 2.0 / 3.0 * outline.shape.compute_local_bounding_sphere().radius;
    let mut joint = GenericJointBuilder::new(JointAxesMask::empty()).local_anchor1(outline.pose.translation);
    for (axis, limit) in [(JointAxis::LinX, limit), (JointAxis::LinY, limit), (JointAxis::AngX, limit * arm)]
    {
        joint = joint.motor_velocity(axis, 0.0, GROUND_GRIP).motor_max_force(axis, limit);
    }
    world.insert_impulse_joint(ground, handle, joint);
    Some(handle)
}
