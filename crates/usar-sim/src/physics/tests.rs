//! Bodies alone, without a simulation.

use parry2d::math::Rotation;
use parry2d::shape::SharedShape;

use super::*;

const DT: f32 = 0.02;
const RADIUS: f32 = 0.4;

fn cuboid(size: [f32; 2], at: [f32; 2]) -> Outline {
    let pose = Pose::from_parts(at.into(), Rotation::identity());
    Outline { shape: SharedShape::cuboid(size[0] / 2.0, size[1] / 2.0), pose }
}

/// A robot of `top_speed` m/s at (5, 5) and one piece of debris; movable with its mass and friction.
fn world(top_speed: f32, outline: &Outline, movable: Option<[f32; 2]>) -> Physics {
    let robot =
        RobotBody { position: Vector::splat(5.0), is_aerial: false, radius: RADIUS, mass: 50.0, top_speed };
    let masses = movable.map(|[mass, friction]| [mass, mass * friction]);
    let piece = DebrisBody { outline: outline.clone(), is_gate: false, masses };
    Physics::new(DT, Vector::new(40.0, 10.0), &[robot], &[piece])
}

#[test]
fn nobody_gets_through_the_thinnest_wall_at_the_highest_speed() {
    let (thinnest, fastest) = (0.1, 20.0); // a rule of scenarios: speed times step is at most the radius
    let wall = cuboid([thinnest, 9.9], [20.0, 5.0]);
    for angle in [0.0, 0.5, 1.2] {
        let mut world = world(fastest, &wall, None);
        let wished = Vector::new(libm::cosf(angle), libm::sinf(angle)) * fastest;
        let mut farthest: f32 = 0.0;
        for _ in 0..500 {
            let (_, velocity) = world.robot_motion(RobotId(0));
            world.drive(RobotId(0), (wished - velocity).clamp_length_max(100.0 * DT));
            world.integrate(|_, _| 0.0, |_| false);
            farthest = farthest.max(world.robot_motion(RobotId(0)).0.x);
        }
        let touching = 20.0 - thinnest / 2.0 - RADIUS;
        assert!((touching - 0.01..touching + 0.05).contains(&farthest), "{angle}: {farthest}");
    }
}

#[test]
fn a_piece_that_slides_is_braked_by_friction_whatever_its_mass() {
    for (mass, friction) in [(10.0, 0.5), (200.0, 0.5), (30.0, 0.2)] {
        let mut world = world(1.0, &cuboid([1.0, 1.0], [15.0, 5.0]), Some([mass, friction]));
        let handle = world.debris[0].unwrap();
        let speed: f32 = 3.0;
        world.world.bodies[handle].set_linvel(Vector::new(speed, 0.0), true);
        (0..200).for_each(|_| world.integrate(|_, _| 0.0, |_| false));
        let way = world.debris_poses().next().unwrap().1.translation.x - 15.0;
        let expected = speed * speed / (2.0 * friction * GRAVITY);
        assert!((way - expected).abs() < 0.05 * expected + 0.02, "{mass} kg: {way} m, not {expected} m");
    }
}

#[test]
fn a_piece_is_pushed_by_more_than_its_friction_only() {
    let way_pushed_by = |newton: f32| {
        let mut world = world(1.0, &cuboid([1.0, 1.0], [15.0, 5.0]), Some([20.0, 0.5]));
        let handle = world.debris[0].unwrap();
        world.world.bodies[handle].add_force(Vector::new(newton, 0.0), true);
        (0..100).for_each(|_| world.integrate(|_, _| 0.0, |_| false));
        world.debris_poses().next().unwrap().1.translation.x - 15.0
    };
    let limit = 0.5 * 20.0 * GRAVITY;
    assert!(way_pushed_by(0.9 * limit) < 0.01);
    let expected = 0.5 * (0.5 * limit / 20.0) * 2.0 * 2.0; // half the limit is left to accelerate 20 kg for 2 s
    let way = way_pushed_by(1.5 * limit);
    assert!((way - expected).abs() < 0.05 * expected, "{way} m, not {expected} m");
}
