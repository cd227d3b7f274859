//! `Majority`: each robot tells all how it sees the groups, waits, and goes where most see it. Among places
//! with equally many votes it keeps its own, else it takes the first.
//!
//! By hand: robots 0, 1 and 2, two tasks. Robot 0 sees itself in the first group, 1 and 2 see robot 0 in the
//! second: robot 0 goes to the second. If it does not hear robot 2, one vote stands against one, and it keeps
//! its own place.

use serde::{Deserialize, Serialize};
use teaming::{Act, Assignment, Choice, PolicyError, Protocol, ProtocolKind, Talk, TaskId, Turn};

use super::is_fit;

/// Its options.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Majority {
    /// How long each waits for the views of the others, in seconds.
    wait_s: f64,
}

impl Default for Majority {
    fn default() -> Self {
        Self { wait_s: 1.0 }
    }
}

/// What a robot keeps in mind: how it sees the groups, and the votes for each place of its own.
#[derive(Default, Serialize, Deserialize)]
struct Votes {
    view: Option<Assignment>,
    of: Vec<u32>,
}

impl Votes {
    /// The place with most votes; on a tie the own one, else the first.
    fn place(&self, robot: u32) -> usize {
        let most = self.of.iter().max().copied().unwrap_or(0);
        let own = self.view.as_ref().and_then(|view| view.task_of(robot)).map(TaskId::index);
        let best = |place: &usize| self.of.get(*place) == Some(&most);
        own.filter(best).or_else(|| (0..self.of.len()).find(best)).unwrap_or(0)
    }

    /// The groups as the robot sees them, but for itself, which goes where most see it.
    fn decision(&self, robot: u32) -> Option<Assignment> {
        let place = self.place(robot);
        let mut view = self.view.clone()?;
        view.groups.iter_mut().chain([&mut view.idle]).for_each(|group| group.retain(|id| *id != robot));
        view.groups.get_mut(place)?.push(robot);
        Some(view.sorted())
    }
}

/// The kind.
pub fn kind() -> ProtocolKind {
    let about = "each tells how it sees the groups, and goes where most see it";
    let kind = ProtocolKind::made("Majority", about, |options: Majority, _| {
        is_fit(options.wait_s).map(|()| Talk::shared(options))
    });
    kind.from_sources(env!("SOURCES_PROTOCOL_MAJORITY"))
}

impl Protocol for Majority {
    fn turn(&self, turn: &Turn) -> Result<Act, PolicyError> {
        let mut votes: Votes = turn.mind();
        votes.of.resize(turn.question.tasks.len(), 0);
        let views = turn.heard::<Assignment>().filter_map(|(_, view)| view.task_of(turn.robot));
        for task in views {
            if let Some(count) = votes.of.get_mut(task.index()) {
                *count += 1;
            }
        }
        if let Some(view) = &turn.rule {
            if let Some(count) = view.task_of(turn.robot).and_then(|task| votes.of.get_mut(task.index())) {
                *count += 1;
            }
            votes.view = Some(view.clone());
            return Ok(Act::waits(self.wait_s).saying(view).keeping(&votes));
        }
        if turn.is_first() {
            return Ok(Act::asks());
        }
        if turn.since_s < self.wait_s {
            return Ok(Act::waits(self.wait_s - turn.since_s).keeping(&votes));
        }
        let joins = votes.decision(turn.robot).map(Choice::Groups);
        Ok(Act { joins, ..Act::default() }.keeping(&votes))
    }
}
