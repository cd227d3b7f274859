//! The timeline of one trial: its actions and their steps, with things given by their numbers.

use std::ops::Range;

use scenario::{Happening, Scenario};
use teaming::TaskId;

use super::Layout;
use super::places::rescuee_blocks;
use crate::ids::RobotId;

/// An action of the timeline, with things given by their numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// A piece of debris falls.
    Fall(usize),
    /// A piece of debris closes a passage.
    Close(usize),
    /// A piece of debris is taken away.
    Open(usize),
    /// A radiation source appears.
    Appear(usize),
    /// A radiation source dies.
    Die(usize),
    /// A robot breaks down.
    Fail(RobotId),
    /// A robot loses these percent points of energy and HP.
    Lose(RobotId, [f64; 2]),
    /// A robot begins to tell a lie, by its number.
    Lie(RobotId, usize),
    /// A robot tells no more lies.
    BeHonest(RobotId),
    /// A robot has this share of its speed left.
    Slow(RobotId, f64),
    /// A robot spends so many times the energy.
    Fade(RobotId, f64),
    /// A robot is no longer heard.
    Mute(RobotId),
    /// These rescuees of a task appear.
    Rescuees(TaskId, Range<usize>),
    /// A task begins.
    Begin(TaskId),
    /// A task ends.
    End(TaskId),
}

/// An action and the step at whose beginning it happens.
#[derive(Debug, Clone, PartialEq)]
pub struct Due {
    /// The step.
    pub step: u64,
    /// The action.
    pub action: Action,
}

/// The timeline of a trial, in the order of its steps.
pub(super) fn timeline(scenario: &Scenario, layout: &Layout) -> Vec<Due> {
    let blocks = rescuee_blocks(scenario);
    let piece = |name: &str| layout.debris.iter().position(|piece| piece.name.as_deref() == Some(name));
    let source = |name: &str| layout.zones.iter().position(|zone| zone.name.as_deref() == Some(name));
    let task = |name: &str| {
        let place = scenario.tasks.iter().position(|task| task.name == name);
        TaskId(place.unwrap_or_default() as u16)
    };
    let action = |(number, event): (usize, &Happening)| {
        Some(match event {
            Happening::DebrisFalls { .. } => Action::Fall(layout.falling(scenario, number)),
            Happening::Opens(name) => Action::Open(piece(name)?),
            Happening::Closes(name) => Action::Close(piece(name)?),
            Happening::SourceAppears { .. } => Action::Appear(layout.appearing(scenario, number)),
            Happening::SourceDies(name) => Action::Die(source(name)?),
            Happening::RobotFails(robot) => Action::Fail(RobotId(*robot)),
            Happening::RobotLoses { robot, energy, hp } => Action::Lose(RobotId(*robot), [*energy, *hp]),
            Happening::RobotLies { robot, .. } => Action::Lie(RobotId(*robot), lie_of(scenario, number)),
            Happening::RobotIsHonest(robot) => Action::BeHonest(RobotId(*robot)),
            Happening::RobotSlows { robot, factor } => Action::Slow(RobotId(*robot), *factor),
            Happening::BatteryFades { robot, factor } => Action::Fade(RobotId(*robot), *factor),
            Happening::RobotDrops(robot) => Action::Mute(RobotId(*robot)),
            Happening::RescueesAppear { task: name, .. } => {
                let block = blocks.iter().find(|block| block.moment == Some(number))?;
                Action::Rescuees(task(name), block.ids.clone())
            }
            Happening::TaskBegins(name) => Action::Begin(task(name)),
            Happening::TaskEnds(name) => Action::End(task(name)),
        })
    };
    let due = |(number, moment): (usize, &scenario::Moment)| {
        let step = (moment.at_s / scenario.dt_s).round() as u64;
        action((number, &moment.event)).map(|action| Due { step, action })
    };
    scenario.moments().into_iter().filter_map(due).collect()
}

/// The number of the lie of an event among all lies of the trial: those of the list of deceit come first.
fn lie_of(scenario: &Scenario, event: usize) -> usize {
    let is_lie = |moment: &&scenario::Moment| matches!(moment.event, Happening::RobotLies { .. });
    scenario.deceit.len() + scenario.timeline[..event].iter().filter(is_lie).count()
}
