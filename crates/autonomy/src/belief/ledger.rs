//! The ledger of the base: what it can witness of each round, and what the robots say that it cost them.

use std::sync::OnceLock;

use scenario::CostUnit;
use serde::{Deserialize, Serialize};
use teaming::{GroupOutcome, MemberOutcome, RoundOutcome, TaskId};

use super::robot::KnownRobot;
use crate::hash::part;
use crate::ids::RobotId;

/// What the base knows of the rounds.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Ledger {
    /// The rounds, the last one open until it ends.
    rounds: Vec<RoundOutcome>,
    is_open: bool,
    /// When the last round began, in seconds.
    start_s: f64,
    /// What each robot has spent so far: all falls of the energy and HP that it reported, in percent.
    spent: Vec<[f64; 2]>,
    /// The same when the last round began.
    spent_at_start: Vec<[f64; 2]>,
    /// The hash of all rounds but the last, which alone can change.
    #[serde(skip)]
    digest: OnceLock<u128>,
}

impl Ledger {
    pub(super) fn empty(robots: usize) -> Self {
        let nothing = vec![[0.0; 2]; robots];
        Self {
            rounds: Vec::new(),
            is_open: false,
            start_s: 0.0,
            spent: nothing.clone(),
            spent_at_start: nothing,
            digest: OnceLock::new(),
        }
    }

    /// The rounds that are over.
    pub fn rounds(&self) -> &[RoundOutcome] {
        &self.rounds[..self.rounds.len() - usize::from(self.is_open)]
    }

    /// Whether a round has begun and not ended.
    pub(crate) fn is_open(&self) -> bool {
        self.is_open
    }

    /// The ledger as it counts in the hash chain.
    pub(super) fn to_hash(&self) -> impl Serialize + '_ {
        let Self { rounds, is_open, start_s, spent, spent_at_start, digest } = self;
        let before = rounds.len().saturating_sub(1);
        let digest = *digest.get_or_init(|| part(&&rounds[..before]));
        (digest, &rounds[before..], is_open, start_s, spent, spent_at_start)
    }

    /// Notes the levels that a robot reports after others.
    pub(super) fn note_levels(&mut self, robot: RobotId, before: [f64; 2], now: [f64; 2]) {
        for ((spent, before), now) in self.spent[robot.index()].iter_mut().zip(before).zip(now) {
            *spent += (before - now).max(0.0);
        }
    }

    /// Groups left home.
    pub(crate) fn begin(&mut self, round: u32, groups: &[Vec<RobotId>], time_s: f64) {
        let member = |id: &RobotId| MemberOutcome { id: id.0, ..MemberOutcome::default() };
        let group = |(task, ids): (u16, &Vec<RobotId>)| GroupOutcome {
            task: TaskId(task),
            rescued: 0,
            energy: 0.0,
            hp: 0.0,
            members: ids.iter().map(member).collect(),
        };
        let groups = (0..).zip(groups).map(group).collect();
        self.digest.take();
        self.rounds.push(RoundOutcome { round, duration_s: 0.0, groups });
        (self.is_open, self.start_s) = (true, time_s);
        self.spent_at_start.clone_from(&self.spent);
    }

    /// A robot delivered a rescuee of a task.
    pub(crate) fn note_delivery(&mut self, robot: RobotId, task: TaskId) {
        let Some(round) = self.rounds.last_mut() else { return };
        if let Some(group) = round.groups.get_mut(task.index()) {
            group.rescued += 1;
        }
        let members = round.groups.iter_mut().flat_map(|group| &mut group.members);
        members.filter(|member| member.id == robot.0).for_each(|member| member.rescued += 1);
    }

    /// The round is over. `turned_back` tells which robots went to rest in it.
    pub(crate) fn end(
        &mut self,
        team: &[KnownRobot],
        unit: CostUnit,
        time_s: f64,
        turned_back: impl Fn(RobotId) -> bool,
    ) {
        let Some(round) = self.rounds.last_mut() else { return };
        round.duration_s = time_s - self.start_s;
        self.is_open = false;
        for group in &mut round.groups {
            for member in &mut group.members {
                let robot = &team[member.id as usize];
                let [energy, hp] = [0, 1].map(|level| {
                    self.spent[robot.id.index()][level] - self.spent_at_start[robot.id.index()][level]
                });
                member.energy = unit.of_percent(energy, robot.spec.energy);
                member.hp = unit.of_percent(hp, robot.spec.hp);
                member.turned_back = turned_back(robot.id);
                member.lost = !robot.is_able();
            }
            group.energy = group.members.iter().map(|member| member.energy).sum();
            group.hp = group.members.iter().map(|member| member.hp).sum();
        }
    }
}
