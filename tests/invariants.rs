//! The invariant checker: sound trials pass it, and every seeded fault is caught in the step in which it is
//! seeded.

use parry2d::math::Vector;
use usar_sim::event::{Event, Place};
use usar_sim::ids::{RescueeId, RobotId};
use usar_sim::invariant::Invariants;
use usar_sim::record::Status;
use usar_sim::simulation::Simulation;
use usar_sim::world::{RescueeState, World};

use crate::support::{paper, policy};

/// What a fault can tamper with: the time, the events and the world that the checker is shown.
struct Shown<'a> {
    time_s: f64,
    events: Vec<Event>,
    world: &'a mut World,
    /// A robot with somebody on board.
    robot: usize,
}

type Fault = (&'static str, fn(&mut Shown));

/// Each fault, with a part of what the checker says of it.
const FAULTS: [Fault; 25] = [
    ("moved 1.0", |s| s.world.robots[s.robot].position.x += 1.0),
    ("moved 0.0", |s| s.world.robots[s.robot].position.y += 0.075),
    ("NaN", |s| s.world.robots[s.robot].position.x = f32::NAN),
    ("inf", |s| s.world.robots[s.robot].velocity.y = f32::INFINITY),
    ("speed", |s| s.world.robots[s.robot].velocity = Vector::new(7.0, 0.0)),
    ("acceleration", |s| {
        let robot = &mut s.world.robots[s.robot];
        robot.velocity = -robot.velocity - Vector::new(0.5, 0.0);
    }),
    ("overlaps", |s| {
        let movable = s.world.debris.iter().position(|piece| !piece.is_fixed()).unwrap();
        s.world.debris[movable].pose.translation = s.world.robots[s.robot].position;
    }),
    ("debris 0 is fixed", |s| s.world.debris[0].pose.translation.x += 0.1),
    ("energy NaN", |s| s.world.robots[s.robot].energy = f64::NAN),
    ("energy 101", |s| s.world.robots[s.robot].energy = 101.0),
    ("energy -1", |s| s.world.robots[s.robot].energy = -1.0),
    ("energy rose", |s| s.world.robots[s.robot].energy += 0.01),
    ("HP rose", |s| s.world.robots[s.robot].hp += 0.001),
    ("HP -0.5", |s| s.world.robots[s.robot].hp = -0.5),
    ("resources", |s| s.world.robots[s.robot].resources += 1),
    ("rescuees on board", |s| {
        let twice = s.world.robots[s.robot].load[0];
        s.world.robots[s.robot].load.push(twice);
    }),
    ("rescuees on board", |s| s.world.robots[s.robot].load.clear()),
    ("rescuees, should be", |s| s.world.rescuees.truncate(399)),
    ("Rescued, should be", |s| s.world.rescuees[0].state = RescueeState::Rescued),
    ("should be OnBoard", |s| {
        let id = s.world.robots[s.robot].load[0];
        s.world.rescuees[id.index()].state = RescueeState::OnBoard(RobotId(s.robot as u32 + 1));
    }),
    ("room for", |s| {
        let capacity = s.world.robots[s.robot].spec.capacity;
        s.world.robots[s.robot].load = (0..=capacity).map(RescueeId).collect();
    }),
    ("time went", |s| s.time_s -= 1.0),
    ("loaded rescuee", |s| {
        let (robot, rescuee) = (RobotId(s.robot as u32), s.world.robots[s.robot].load[0]);
        s.events.push(Event::Loaded { robot, rescuee, resource_of: robot });
    }),
    ("delivered rescuee", |s| {
        let robot = RobotId(s.robot as u32);
        s.events.push(Event::Delivered { robot, rescuee: RescueeId(399), place: Place::Home });
    }),
    ("rested", |s| s.events.push(Event::RestEnded { robot: RobotId(s.robot as u32) })),
];

#[test]
fn each_of_25_faults_is_caught_within_one_step() {
    let scenario = paper();
    let mut policy = policy("RNE");
    for (said, fault) in FAULTS {
        let mut trial = Simulation::new(&scenario, 1).unwrap();
        let mut check = Invariants::new(trial.model(), trial.world());
        let robot = loop {
            assert_eq!(trial.step(&mut *policy), None);
            check.listen(trial.time_s(), trial.events(), trial.world()).unwrap();
            let carries = |robot: &&usar_sim::world::Robot| {
                !robot.load.is_empty() && robot.velocity.length() > 1.0 && robot.hp < 99.0
            };
            if let Some(robot) = trial.world().robots.iter().find(carries) {
                break robot.id.index();
            }
        };
        assert_eq!(trial.step(&mut *policy), None);
        let (time_s, events) = (trial.time_s(), trial.events().to_vec());
        let mut shown = Shown { time_s, events, world: trial.world_mut(), robot };
        fault(&mut shown);
        let broken = check.listen(shown.time_s, &shown.events, shown.world).unwrap_err().to_string();
        assert!(broken.contains(said), "{said}: {broken}");
    }
}

#[test]
fn a_violation_ends_the_trial_as_failed_with_robot_step_and_values() {
    let scenario = paper();
    let mut policy = policy("RNE");
    let mut trial = Simulation::new(&scenario, 1).unwrap().checked();
    for _ in 0..100 {
        assert_eq!(trial.step(&mut *policy), None);
    }
    trial.world_mut().robots[3].energy = 150.0;
    let Some(Status::Failed(reason)) = trial.step(&mut *policy) else { panic!("the trial goes on") };
    assert!(reason.starts_with("invariant violated at 2.02 s: robot 3: energy 1"), "{reason}");
}
