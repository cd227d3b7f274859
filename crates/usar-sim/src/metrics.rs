//! The paper's metrics and what explains them, gathered by listening to events and charges.

use rne_core::Difficulty;
use serde::{Deserialize, Serialize};

use crate::event::{Event, ReturnCause};
use crate::mission::task_index;
use crate::world::World;

/// What one group did in one round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoundRecord {
    /// Number of the round, from 1.
    pub round: u32,
    /// The group's task.
    pub task: Difficulty,
    /// When the round began, in seconds.
    pub start_s: f64,
    /// When every robot was home again, in seconds; `None` for a round that the end of the trial cut short.
    pub end_s: Option<f64>,
    /// Ids of the members.
    pub members: Vec<u32>,
    /// Rescuees taken on board.
    pub secured: u32,
    /// Rescuees delivered.
    pub rescued: u32,
    /// Percent points of energy spent by the members.
    pub energy: f64,
    /// Percent points of HP lost by the members.
    pub hp: f64,
    /// Members that turned back before the group did.
    pub turned_back: u32,
    /// Why the group went home.
    pub return_cause: Option<ReturnCause>,
}

/// What was done and spent for one task.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct TaskTotals {
    /// Rescuees delivered.
    pub rescued: u32,
    /// Rescuees taken on board, delivered or not.
    pub secured: u32,
    /// Percent points of energy spent.
    pub energy: f64,
    /// Percent points of HP lost.
    pub hp: f64,
}

/// The metrics of a trial as it goes on.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Metrics {
    /// Totals of the hard and of the easy task.
    pub tasks: [TaskTotals; 2],
    /// Percent points of energy and HP that robots spent outside any group, on their way to rest and back.
    pub ungrouped: [f64; 2],
    /// Rounds, each with one record per task.
    pub rounds: Vec<RoundRecord>,
    /// Rounds that ended with everybody home.
    pub completed_rounds: u32,
    /// Times that a robot turned back.
    pub turned_back: u32,
    /// Conflict sets that formed.
    pub conflicts: u32,
    /// Times that a conflict set came to nothing.
    pub deadlocks: u32,
    /// Times that the turn passed to another member of a deadlocked set.
    pub rotations: u32,
    /// Times that a robot made room for another.
    pub retreats: u32,
    /// Times that a deadlocked set backed off.
    pub back_offs: u32,
    /// Errands done.
    pub errands_done: u32,
    /// Places that robots gave up on.
    pub unreachable: u32,
    /// The task of each robot's group in the current round.
    task_of: Vec<Option<Difficulty>>,
}

impl Metrics {
    /// Nothing yet.
    #[must_use]
    pub fn new(robots: usize) -> Self {
        Self { task_of: vec![None; robots], ..Self::default() }
    }

    /// Charges what a robot spent in this step.
    pub fn charge(&mut self, robot: usize, energy: f64, hp: f64) {
        if let Some(task) = self.task_of[robot] {
            let totals = &mut self.tasks[task_index(task)];
            totals.energy += energy;
            totals.hp += hp;
            if let Some(round) = self.current(task) {
                round.energy += energy;
                round.hp += hp;
            }
        } else {
            self.ungrouped[0] += energy;
            self.ungrouped[1] += hp;
        }
    }

    /// Listens to what happened at this time, in seconds.
    pub fn listen(&mut self, events: &[Event], world: &World, time_s: f64) {
        for event in events {
            match event {
                Event::RoundStarted { round, hard, easy } => {
                    self.task_of.fill(None);
                    for (task, members) in [(Difficulty::Hard, hard), (Difficulty::Easy, easy)] {
                        members.iter().for_each(|id| self.task_of[id.index()] = Some(task));
                        let members = members.iter().map(|id| id.0).collect();
                        self.rounds.push(RoundRecord::new(*round, task, time_s, members));
                    }
                }
                Event::RoundEnded { round } => {
                    self.completed_rounds += 1;
                    let ended = self.rounds.iter_mut().filter(|record| record.round == *round);
                    ended.for_each(|record| record.end_s = Some(time_s));
                }
                Event::GroupReturned { task, cause } => {
                    if let Some(round) = self.current(*task) {
                        round.return_cause = Some(*cause);
                    }
                }
                Event::Loaded { rescuee, .. } => {
                    let task = world.rescuees[rescuee.index()].task;
                    self.tasks[task_index(task)].secured += 1;
                    self.current(task).into_iter().for_each(|round| round.secured += 1);
                }
                Event::Delivered { rescuee, .. } => {
                    let task = world.rescuees[rescuee.index()].task;
                    self.tasks[task_index(task)].rescued += 1;
                    self.current(task).into_iter().for_each(|round| round.rescued += 1);
                }
                Event::TurnedBack { robot, .. } => {
                    self.turned_back += 1;
                    if let Some(round) = self.task_of[robot.index()].and_then(|task| self.current(task)) {
                        round.turned_back += 1;
                    }
                }
                Event::ConflictStarted { .. } => self.conflicts += 1,
                Event::Deadlocked { .. } => self.deadlocks += 1,
                Event::TurnPassed { .. } => self.rotations += 1,
                Event::MadeRoom { .. } => self.retreats += 1,
                Event::BackedOff { .. } => self.back_offs += 1,
                Event::ErrandDone { .. } => self.errands_done += 1,
                Event::Unreachable { .. } => self.unreachable += 1,
                _ => {}
            }
        }
    }

    /// The record of a task in the current round.
    fn current(&mut self, task: Difficulty) -> Option<&mut RoundRecord> {
        self.rounds.iter_mut().rev().take(2).find(|record| record.task == task)
    }
}

impl RoundRecord {
    fn new(round: u32, task: Difficulty, start_s: f64, members: Vec<u32>) -> Self {
        Self {
            round,
            task,
            start_s,
            end_s: None,
            members,
            secured: 0,
            rescued: 0,
            energy: 0.0,
            hp: 0.0,
            turned_back: 0,
            return_cause: None,
        }
    }
}
