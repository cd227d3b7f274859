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
            world.integrate(|_, _| 0.0, |_, _| 0.0, |_| false);
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
        (0..200).for_each(|_| world.integrate(|_, _| 0.0, |_, _| 0.0, |_| false));
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
        (0..100).for_each(|_| world.integrate(|_, _| 0.0, |_, _| 0.0, |_| false));
        world.debris_poses().next().unwrap().1.translation.x - 15.0
    };
    let limit = 0.5 * 20.0 * GRAVITY;
    assert!(way_pushed_by(0.9 * limit) < 0.01);
    // Half the limit is left to accelerate 20 kg for 2 s.
    let expected = 0.5 * (0.5 * limit / 20.0) * 2.0 * 2.0;
    let way = way_pushed_by(1.5 * limit);
    assert!((way - expected).abs() < 0.05 * expected, "{way} m, not {expected} m");
}

/// A dense crowd among boxes, in which each robot heads for one place after another and gives way to nobody.
struct Crowd {
    world: Physics,
    bodies: Vec<RobotBody>,
    boxes: Vec<Outline>,
}

const ARENA: Vector = Vector::splat(30.0);

/// Which of the boxes can be pushed.
const PUSHABLE: usize = 1;

impl Crowd {
    fn new(count: usize) -> Self {
        let place = |i: usize| Vector::new(1.0 + (i % 10) as f32 * 1.9, 1.0 + (i / 10) as f32 * 1.9);
        let body = |i: usize| RobotBody {
            position: place(i),
            is_aerial: i.is_multiple_of(5),
            radius: 0.3 + 0.02 * (i % 4) as f32,
            mass: 20.0 + i as f32,
            top_speed: 1.5,
        };
        let bodies: Vec<RobotBody> = (0..count).map(body).collect();
        let boxes = vec![cuboid([2.0, 1.0], [6.0, 16.0]), cuboid([0.6, 0.6], [24.0, 24.0])];
        let piece = |(i, outline): (usize, &Outline)| {
            let masses = (i == PUSHABLE).then_some([10.0, 5.0]);
            DebrisBody { outline: outline.clone(), is_gate: false, masses }
        };
        let pieces: Vec<DebrisBody> = boxes.iter().enumerate().map(piece).collect();
        Self { world: Physics::new(DT, ARENA, &bodies, &pieces), bodies, boxes }
    }

    fn step(&mut self, step: usize) {
        for i in 0..self.bodies.len() {
            let goal = (i * 37 + step / 200 * 53) % 900;
            let goal = Vector::new((goal % 30) as f32, (goal / 30) as f32);
            let (at, velocity) = self.world.robot_motion(RobotId(i as u32));
            let wished = (goal - at).clamp_length_max(1.5);
            self.world.drive(RobotId(i as u32), (wished - velocity).clamp_length_max(DT));
        }
        for (number, pose) in self.world.debris_poses() {
            self.boxes[number].pose = pose;
        }
        let boxes = &self.boxes;
        let to_boxes = |at: Vector, reach: f32| {
            let distance = |piece: &Outline| piece.shape.distance_to_point(&piece.pose, at, true);
            boxes.iter().map(distance).fold(reach, f32::min)
        };
        let to_pushable = |at: Vector, reach: f32| {
            let piece = &boxes[PUSHABLE];
            piece.shape.distance_to_point(&piece.pose, at, true).min(reach)
        };
        self.world.integrate(to_boxes, to_pushable, |_| false);
    }

    /// How deep two robots of one layer are in each other at most, in metres.
    fn overlap(&self) -> f32 {
        let at = |i: usize| self.world.robot_motion(RobotId(i as u32)).0;
        let pairs = (0..self.bodies.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
        let in_layer = pairs.filter(|[i, j]| self.bodies[*i].is_aerial == self.bodies[*j].is_aerial);
        let depth =
            |[i, j]: [usize; 2]| self.bodies[i].radius + self.bodies[j].radius - (at(i) - at(j)).length();
        in_layer.map(depth).fold(0.0, f32::max)
    }
}

#[test]
fn a_large_team_is_stepped_in_part_and_moves_as_one_that_is_stepped_as_a_whole() {
    let (mut part, mut whole) = (Crowd::new(60), Crowd::new(60));
    whole.world.keep_engine_on();
    let (mut stepped, mut farthest_apart, mut deepest) = (0, 0.0_f32, [0.0_f32; 2]);
    for step in 0..3000 {
        part.step(step);
        whole.step(step);
        stepped += (0..60).filter(|i| part.world.quiet.is_near(*i)).count();
        deepest = [deepest[0].max(part.overlap()), deepest[1].max(whole.overlap())];
        let apart = |i: u32| part.world.robot_motion(RobotId(i)).0 - whole.world.robot_motion(RobotId(i)).0;
        if step < 100 {
            farthest_apart = (0..60).map(|i| apart(i).length()).fold(farthest_apart, f32::max);
        }
    }
    assert!(part.world.steps()[1] > 1000, "{:?}", part.world.steps());
    assert!(stepped < 3000 * 60 / 2, "{stepped}");
    assert!(farthest_apart < 0.001, "{farthest_apart} m");
    assert!(deepest[0] < 0.003 && deepest[0] < deepest[1], "{deepest:?} m");
}

#[test]
fn a_large_team_goes_on_from_a_snapshot_with_the_same_bits() {
    let mut crowd = Crowd::new(60);
    let mut again = Crowd::new(60);
    let mut asleep = 0;
    for step in 0..3000 {
        if step % 250 == 130 {
            again.world = postcard::from_bytes(&postcard::to_stdvec(&crowd.world).unwrap()).unwrap();
            again.world.restore(DT, ARENA, &again.bodies);
            again.boxes.clone_from(&crowd.boxes);
            assert_eq!(again.world.debris_is_awake, crowd.world.debris_is_awake, "step {step}");
            asleep += usize::from(!crowd.world.debris_is_awake);
        }
        crowd.step(step);
        again.step(step);
        assert!(crowd.world.motions() == again.world.motions(), "step {step}");
    }
    assert!(asleep > 0, "the piece was never asleep");
}
