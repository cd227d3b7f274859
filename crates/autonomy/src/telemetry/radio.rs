//! Radio between group-mates: what a robot tells them of the things that it noticed, and what it hides or
//! makes up.

use std::ops::Range;

use parry2d::math::Vector;
use rand::RngExt;
use scenario::Lie;
use scenario::seed::{Purpose, stream_at};
use serde::{Deserialize, Serialize};
use teaming::TaskId;

use super::channel::{Ends, Sending};
use super::{Now, Telemetry};
use crate::belief::KnownRobot;
use crate::event::{Event, EventLog};
use crate::ids::RobotId;
use crate::model::Model;
use crate::report::{Report, Speaker, Statement};

/// A report for a group-mate that is under way.
#[derive(Clone, Serialize, Deserialize)]
pub struct ForMate {
    heard_s: f64,
    sent_s: f64,
    from: RobotId,
    /// Who is to hear it.
    pub to: RobotId,
    /// The report.
    pub report: Report,
}

impl Telemetry {
    /// A robot tells its group-mates what it noticed, unless it hides it.
    pub fn tell_mates(&mut self, report: &Report, mates: &[RobotId], now: &Now<'_>, log: &mut EventLog) {
        let (Speaker::Robot(from), Some(rules)) = (report.from, &now.model.telemetry) else { return };
        let Some(medium) = rules.medium.as_ref().filter(|_| !self.is_mute[from.index()]) else { return };
        let is_hidden = matches!(report.says, Statement::ZoneIs { on: true, .. })
            && self.tells(rules, from, now, |lie| matches!(lie, Lie::HideRadiation)).is_some();
        if is_hidden {
            return;
        }
        let (at, time_s) = (now.team[from.index()].position, now.time_s());
        for to in mates.iter().copied().filter(|to| *to != from && now.team[to.index()].is_able()) {
            let ends = Ends { from, to: Some(to) };
            let there = now.team[to.index()].position;
            let sending = Sending { seed: rules.seed, ends, at, to: there, time_s };
            match self.channel.send(medium, sending).filter(|_| !self.is_mute[to.index()]) {
                Some(heard_s) => {
                    let report = report.clone();
                    self.for_mates.push(ForMate { heard_s, sent_s: time_s, from, to, report });
                }
                None => log.push(Event::Lost { robot: from, to: Some(to) }),
            }
        }
    }

    /// The reports that group-mates hear by now, in the order in which they arrive.
    pub fn heard_by_mates(&mut self, time_s: f64, log: &mut EventLog) -> Vec<ForMate> {
        let has_arrived = |told: &mut ForMate| told.heard_s <= time_s;
        let mut arrived: Vec<ForMate> = self.for_mates.extract_if(.., has_arrived).collect();
        arrived.sort_by(|a, b| a.heard_s.total_cmp(&b.heard_s));
        for ForMate { from, to, sent_s, heard_s, .. } in &arrived {
            self.channel.note_heard(Ends { from: *from, to: Some(*to) }, heard_s - sent_s);
        }
        let late = arrived.iter().filter(|told| told.heard_s > told.sent_s);
        log.extend(late.map(|told| Event::Heard {
            robot: told.from,
            to: Some(told.to),
            sent_s: told.sent_s,
        }));
        arrived
    }

    /// The rescuee that a liar makes up in this step, if it does: somewhere among those of its group's task.
    pub fn phantom(&self, liar: &KnownRobot, bounds: [Vector; 2], now: &Now<'_>) -> Option<Vector> {
        let rules = now.model.telemetry.as_ref()?;
        let [low, high] = bounds;
        if !liar.is_able() || low.x > high.x {
            return None;
        }
        let made_up = |lie: &Lie| matches!(lie, Lie::PhantomRescuee { .. });
        let told = self.tells(rules, liar.id, now, made_up)?;
        let Lie::PhantomRescuee { every_s } = told.lie else { return None };
        let steps = |seconds: f64| (seconds / now.model.dt_s()).round() as u64;
        let into = now.step.saturating_sub(steps(told.window_s[0]));
        let every = steps(every_s).max(1);
        if !now.model.is_due(into, every) {
            return None;
        }
        let mut draws = stream_at(rules.seed, Purpose::Phantom, u64::from(liar.id.0), into / every);
        let [x, y] = [draws.random::<f32>(), draws.random()];
        Some(Vector::new(low.x + x * (high.x - low.x), low.y + y * (high.y - low.y)))
    }
}

impl Model {
    /// How many numbers robots have for rescuees: those that exist, then those that liars make up.
    pub(crate) fn rescuee_numbers(&self) -> usize {
        self.task_ids().last().map_or(0, |task| self.phantoms_of(task).end)
    }

    /// The numbers of the rescuees that liars make up for a task, one for each robot.
    pub fn phantoms_of(&self, task: TaskId) -> Range<usize> {
        let has_phantoms = self.telemetry.as_ref().is_some_and(|rules| rules.has_phantoms);
        let robots = if has_phantoms { self.robots.len() } else { 0 };
        let first = self.rescuees.len() + task.index() * robots;
        first..first + robots
    }
}
