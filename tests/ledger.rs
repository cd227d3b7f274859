//! An independent account of a trial: nothing appears or vanishes, and nothing teleports.

use std::collections::BTreeMap;

use usar_sim::event::Event;
use usar_sim::ids::{RescueeId, RobotId};
use usar_sim::world::{RescueeState, World};

/// What the events say, kept apart from the world and compared with it at every event.
pub struct Ledger {
    /// Who is on board of whom.
    pub on_board: BTreeMap<RescueeId, RobotId>,
    /// Who was delivered by whom.
    pub delivered: BTreeMap<RescueeId, RobotId>,
    resources: Vec<u32>,
    levels: Vec<[f64; 2]>,
    may_rise: Vec<bool>,
    places: Vec<[f32; 2]>,
    /// Events heard.
    pub events: usize,
    /// Robots that ended stranded or disabled.
    pub lost: usize,
}

impl Ledger {
    /// Hears the events of a step and compares them with the world as it is then; panics where they do not agree.
    pub fn hear(&mut self, events: &[Event], world: &World, dt: f32) {
        events.iter().for_each(|event| self.hear_one(event, world));
        self.check(world, dt);
        if !events.is_empty() {
            self.compare(world);
        }
    }

    /// Before the first step.
    pub fn of(world: &World) -> Self {
        Self {
            on_board: BTreeMap::new(),
            delivered: BTreeMap::new(),
            resources: vec![0; world.robots.len()],
            levels: world.robots.iter().map(|robot| [robot.energy, robot.hp]).collect(),
            may_rise: vec![false; world.robots.len()],
            places: world.robots.iter().map(|robot| robot.position.into()).collect(),
            events: 0,
            lost: 0,
        }
    }

    fn hear_one(&mut self, event: &Event, world: &World) {
        self.events += 1;
        match event {
            Event::Restocked { robot, resources } => {
                let spec = world.robots[robot.index()].spec;
                assert_eq!(*resources, spec.resources, "{robot} takes along what it can");
                self.resources[robot.index()] = *resources;
            }
            Event::Loaded { robot, rescuee, resource_of } => {
                assert!(self.on_board.insert(*rescuee, *robot).is_none(), "{rescuee} was already on board");
                assert!(!self.delivered.contains_key(rescuee), "{rescuee} was already rescued");
                let left = &mut self.resources[resource_of.index()];
                *left = left.checked_sub(1).expect("a resource that was not there");
                let load = self.on_board.values().filter(|carrier| *carrier == robot).count();
                assert!(load <= world.robots[robot.index()].spec.capacity as usize, "{robot} is overloaded");
            }
            Event::Delivered { robot, rescuee, .. } => {
                assert_eq!(
                    self.on_board.remove(rescuee),
                    Some(*robot),
                    "{rescuee} was not on board of {robot}"
                );
                self.delivered.insert(*rescuee, *robot);
            }
            Event::Stranded { .. } | Event::Disabled { .. } => self.lost += 1,
            Event::RestEnded { robot } => self.may_rise[robot.index()] = true,
            _ => {}
        }
    }

    /// The world agrees with what was heard; levels fall, but for robots that rested; nobody jumps.
    fn check(&mut self, world: &World, dt: f32) {
        for robot in &world.robots {
            let i = robot.id.index();
            let rising = std::mem::take(&mut self.may_rise[i]);
            let levels = [robot.energy, robot.hp];
            for (now, before) in levels.into_iter().zip(self.levels[i]) {
                assert!((0.0..=100.0).contains(&now), "{}: level {now}", robot.id);
                assert!(now <= before || rising, "{}: {before} rose to {now}", robot.id);
            }
            self.levels[i] = levels;
            assert!(robot.position.is_finite() && robot.velocity.is_finite());
            let [x, y] = self.places[i];
            let moved = ((robot.position.x - x).powi(2) + (robot.position.y - y).powi(2)).sqrt();
            let top = robot.spec.speed_mps as f32;
            assert!(moved <= 1.5 * top * dt + 1e-3, "{} moved {moved} m in one step", robot.id);
            self.places[i] = robot.position.into();
        }
    }

    fn compare(&self, world: &World) {
        for robot in &world.robots {
            let load: Vec<RescueeId> = self
                .on_board
                .iter()
                .filter(|(_, carrier)| **carrier == robot.id)
                .map(|(id, _)| *id)
                .collect();
            let mut carried = robot.load.clone();
            carried.sort_unstable();
            assert_eq!(carried, load, "{}", robot.id);
            assert_eq!(robot.resources, self.resources[robot.id.index()], "{}", robot.id);
        }
        for rescuee in &world.rescuees {
            match rescuee.state {
                RescueeState::Waiting => {
                    assert!(
                        !self.on_board.contains_key(&rescuee.id) && !self.delivered.contains_key(&rescuee.id)
                    );
                }
                RescueeState::OnBoard(robot) => assert_eq!(self.on_board.get(&rescuee.id), Some(&robot)),
                RescueeState::Rescued => assert!(self.delivered.contains_key(&rescuee.id)),
            }
        }
    }
}
