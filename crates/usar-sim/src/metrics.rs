//! The counts and totals of a trial, gathered from events and charges.

use serde::{Deserialize, Serialize};
use teaming::{MemberOutcome, TaskId};

use crate::event::{CutOffCause, Event, ReturnCause};
use crate::ids::RobotId;
use crate::tally::Tally;
use crate::world::World;

/// The results of one group in one round.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RoundRecord {
    /// Number of the round, from 1.
    pub round: u32,
    /// The group's task.
    pub task: TaskId,
    /// When the round began, in seconds.
    pub start_s: f64,
    /// When the round ended, in seconds; `None` if the end of the trial cut the round short.
    pub end_s: Option<f64>,
    /// The members' results, by id.
    pub members: Vec<MemberOutcome>,
    /// Rescuees taken on board.
    pub secured: u32,
    /// Rescuees delivered.
    pub rescued: u32,
    /// Energy spent by the members, in the unit of the scenario's costs.
    pub energy: f64,
    /// HP lost by the members, in the unit of the scenario's costs.
    pub hp: f64,
    /// Members that turned back before the group did.
    pub turned_back: u32,
    /// Why the group went home.
    pub return_cause: Option<ReturnCause>,
}

/// Results and costs of one task.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct TaskTotals {
    /// Rescuees delivered.
    pub rescued: u32,
    /// Rescuees taken on board, delivered or not.
    pub secured: u32,
    /// Energy spent, in the unit of the scenario's costs.
    pub energy: f64,
    /// HP lost, in the unit of the scenario's costs.
    pub hp: f64,
}

/// Counts of events in a trial. An arm of [`Metrics::listen`] counts here. The record holds the counts, and a
/// line in the lab's table of metrics shows each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counts {
    /// Times that a robot turned back to rest.
    pub turned_back: u32,
    /// Conflict sets that formed; under the default right of way, times that a robot began to wait before a
    /// passage.
    pub conflicts: u32,
    /// Times that a conflict set was deadlocked; under the default right of way, times that a robot got stuck
    /// behind another.
    pub deadlocks: u32,
    /// Times that the turn passed to another member of a deadlocked set.
    pub rotations: u32,
    /// Times that a robot made room for another.
    pub retreats: u32,
    /// Times that a deadlocked set backed off.
    pub back_offs: u32,
    /// Errands done, in a scenario with errands.
    pub errands_done: u32,
    /// Places that robots gave up on because they knew no way there.
    pub unreachable: u32,
}

/// How often robots came to a place for a rescuee in vain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Finds {
    /// Another robot had taken the rescuee, or was loading it: it was known twice, or no longer waited.
    pub doubles: u32,
    /// Nobody ever was there.
    pub ghosts_visited: u32,
}

/// A robot that did not get home or to rest, so that the team did not wait for it, or to the place of an
/// errand.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CutOff {
    /// The robot.
    pub robot: u32,
    /// When it was cut off first, in seconds.
    pub first_s: f64,
    /// How often it was cut off.
    pub times: u32,
    /// The place that it could not reach the first time, in metres.
    pub place: [f32; 2],
    /// The cause, the first time.
    pub cause: CutOffCause,
}

/// The metrics of a running trial.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Metrics {
    /// Totals of each task.
    pub tasks: Vec<TaskTotals>,
    /// Energy and HP that robots spent outside any group, in the unit of the scenario's costs.
    pub ungrouped: [f64; 2],
    /// Rounds, each with one record per task.
    pub rounds: Vec<RoundRecord>,
    /// Rounds that ended before the trial did.
    pub completed_rounds: u32,
    /// When each rescuee was delivered, in seconds, ascending.
    pub delivered_s: Vec<f64>,
    /// How often things happened.
    pub counts: Counts,
    /// How often robots came for rescuees in vain.
    pub finds: Finds,
    /// Robots that were cut off, in the order in which each was cut off first.
    pub cut_off: Vec<CutOff>,
    /// Totals of each robot, by id.
    pub(crate) robots: Vec<Tally>,
    /// The task of each robot's group in the current round.
    task_of: Vec<Option<TaskId>>,
}

impl Metrics {
    /// Metrics of a trial in which nothing has happened yet.
    pub(crate) fn new(tasks: usize, robots: Vec<Tally>) -> Self {
        let (tasks, task_of) = (vec![TaskTotals::default(); tasks], vec![None; robots.len()]);
        Self { tasks, robots, task_of, ..Self::default() }
    }

    /// Charges the energy and HP that a robot spent in this step, to the robot and to its group.
    pub(crate) fn charge(&mut self, robot: RobotId, [energy, hp]: [f64; 2]) {
        let own = &mut self.robots[robot.index()].spent;
        *own = [own[0] + energy, own[1] + hp];
        let Some(task) = self.task_of[robot.index()] else {
            self.ungrouped[0] += energy;
            self.ungrouped[1] += hp;
            return;
        };
        let totals = &mut self.tasks[task.index()];
        totals.energy += energy;
        totals.hp += hp;
        if let Some(round) = self.current(task) {
            round.energy += energy;
            round.hp += hp;
            if let Some(member) = round.member(robot) {
                member.energy += energy;
                member.hp += hp;
            }
        }
    }

    /// The energy and HP that the whole team was charged so far, in the unit of the scenario's costs.
    pub(crate) fn spent(&self) -> [f64; 2] {
        self.tasks.iter().fold(self.ungrouped, |[energy, hp], task| [energy + task.energy, hp + task.hp])
    }

    /// Receives the events of a step. `time_s` is their time, in seconds.
    pub fn listen(&mut self, events: &[Event], world: &World, time_s: f64) {
        for event in events {
            match event {
                Event::RoundStarted { round, groups } => self.begin_round(*round, groups, time_s),
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
                    self.tasks[task.index()].secured += 1;
                    self.current(task).into_iter().for_each(|round| round.secured += 1);
                }
                Event::Delivered { robot, rescuee, .. } => {
                    let task = world.rescuees[rescuee.index()].task;
                    self.delivered_s.push(time_s);
                    self.tasks[task.index()].rescued += 1;
                    self.current(task).into_iter().for_each(|round| round.rescued += 1);
                    self.note_member(*robot, |member| member.rescued += 1);
                }
                Event::TurnedBack { robot, .. } => {
                    self.counts.turned_back += 1;
                    if let Some(round) = self.task_of[robot.index()].and_then(|task| self.current(task)) {
                        round.turned_back += 1;
                    }
                    self.note_member(*robot, |member| member.turned_back = true);
                }
                Event::Stranded { robot } | Event::Disabled { robot } => {
                    self.note_member(*robot, |member| member.lost = true);
                }
                Event::ConflictStarted { .. } => self.counts.conflicts += 1,
                Event::Deadlocked { .. } => self.counts.deadlocks += 1,
                Event::TurnPassed { .. } => self.counts.rotations += 1,
                Event::MadeRoom { .. } => self.counts.retreats += 1,
                Event::BackedOff { .. } => self.counts.back_offs += 1,
                Event::ErrandDone { .. } => self.counts.errands_done += 1,
                Event::Unreachable { .. } => self.counts.unreachable += 1,
                Event::CutOff { robot, place, cause } => self.note_cut_off(*robot, *place, *cause, time_s),
                // Nothing to count. A new kind of event must be added here or above.
                Event::Restocked { .. }
                | Event::DebrisDiscovered { .. }
                | Event::ZoneDiscovered { .. }
                | Event::Sighted { .. }
                | Event::RestStarted { .. }
                | Event::RestEnded { .. }
                | Event::Finished
                | Event::MissionOver
                | Event::Standstill
                | Event::Heard { .. }
                | Event::Lost { .. }
                | Event::BeganToLie { .. }
                | Event::BecameHonest { .. }
                | Event::Slowed { .. }
                | Event::Faded { .. }
                | Event::Muted { .. }
                | Event::DebrisFell { .. }
                | Event::WayClosed { .. }
                | Event::WayOpened { .. }
                | Event::CalledOff { .. }
                | Event::SourceAppeared { .. }
                | Event::SourceDied { .. }
                | Event::Damaged { .. }
                | Event::RescueesAppeared { .. }
                | Event::TaskBegan { .. }
                | Event::TaskEnded { .. } => {}
            }
        }
    }

    fn note_cut_off(&mut self, robot: RobotId, place: [f32; 2], cause: CutOffCause, first_s: f64) {
        self.counts.unreachable += u32::from(cause == CutOffCause::NoWay);
        match self.cut_off.iter_mut().find(|other| other.robot == robot.0) {
            Some(known) => known.times += 1,
            None => self.cut_off.push(CutOff { robot: robot.0, first_s, times: 1, place, cause }),
        }
    }

    fn begin_round(&mut self, round: u32, groups: &[Vec<RobotId>], time_s: f64) {
        self.task_of.fill(None);
        for (task, members) in (0..).map(TaskId).zip(groups) {
            members.iter().for_each(|id| self.task_of[id.index()] = Some(task));
            self.rounds.push(RoundRecord::new(round, task, time_s, members));
        }
    }

    fn note_member(&mut self, robot: RobotId, note: impl FnOnce(&mut MemberOutcome)) {
        let round = self.task_of[robot.index()].and_then(|task| self.current(task));
        if let Some(member) = round.and_then(|round| round.member(robot)) {
            note(member);
        }
    }

    /// The record of a task in the current round.
    fn current(&mut self, task: TaskId) -> Option<&mut RoundRecord> {
        let tasks = self.tasks.len();
        let first = self.rounds.len().checked_sub(tasks)?;
        self.rounds.get_mut(first + task.index())
    }
}

impl RoundRecord {
    fn new(round: u32, task: TaskId, start_s: f64, members: &[RobotId]) -> Self {
        let member = |id: &RobotId| MemberOutcome { id: id.0, ..MemberOutcome::default() };
        Self {
            round,
            task,
            start_s,
            end_s: None,
            members: members.iter().map(member).collect(),
            secured: 0,
            rescued: 0,
            energy: 0.0,
            hp: 0.0,
            turned_back: 0,
            return_cause: None,
        }
    }

    fn member(&mut self, robot: RobotId) -> Option<&mut MemberOutcome> {
        let place = self.members.binary_search_by_key(&robot.0, |member| member.id).ok()?;
        Some(&mut self.members[place])
    }
}
