//! Messages: what robots send to the base and to their group-mates, what they hide or make up, and when it is
//! heard.

use parry2d::math::Vector;
use rand::RngExt;
use scenario::Lie;
use scenario::seed::{Purpose, stream_at};

use super::channel::{Ends, Sending};
use super::{Now, Telemetry};
use crate::belief::KnownRobot;
use crate::event::{Event, EventLog};
use crate::ids::RobotId;
use crate::model::MediumModel;
use crate::report::{Message, Report, Speaker, Statement};

/// A report to one hearer.
#[derive(Clone, Copy)]
pub(super) struct Parcel<'r> {
    /// The report of a robot.
    pub(super) report: &'r Report,
    /// Who is to hear it: a robot, or the base.
    pub(super) to: Option<RobotId>,
    /// Whether the same sending reaches somebody else.
    pub(super) is_sent: bool,
}

impl Telemetry {
    /// Sends what a robot says to the base and, where robots decide, to all others: it is one sending. At
    /// home it is heard at once, unless the scenario says otherwise.
    pub(super) fn send(&mut self, says: Statement, robot: &KnownRobot, now: &Now<'_>, log: &mut EventLog) {
        let report = now.report(robot.id, says);
        let is_sent = self.carry(Parcel { report: &report, to: None, is_sent: false }, now, log);
        self.tell_peers(&report, is_sent, now, log);
    }

    /// A robot tells its group-mates what it noticed, as far as it is honest.
    pub fn say_to_mates(&mut self, report: &Report, mates: &[RobotId], now: &Now<'_>, log: &mut EventLog) {
        let (Speaker::Robot(from), Some(rules)) = (report.from, &now.model.telemetry) else { return };
        let Some(report) = self.deceive(report, from, now).filter(|_| rules.medium.is_some()) else { return };
        let is_there = |mate: &&RobotId| **mate != from && now.team[mate.index()].is_able();
        for mate in mates.iter().filter(is_there) {
            self.carry(Parcel { report: &report, to: Some(*mate), is_sent: false }, now, log);
        }
    }

    /// Carries a report to a mate, or to the base: over the medium, if there is one between them. Returns
    /// whether it is sent over the medium.
    pub(super) fn carry(&mut self, parcel: Parcel<'_>, now: &Now<'_>, log: &mut EventLog) -> bool {
        let Parcel { report, to, is_sent } = parcel;
        let (Speaker::Robot(sender), Some(rules)) = (report.from, &now.model.telemetry) else { return false };
        let ends = Ends { from: sender, to };
        if self.is_mute[sender.index()] {
            return false;
        }
        let robot = &now.team[sender.index()];
        let is_home = |id: RobotId| (now.presence)(&now.team[id.index()]).is_home;
        let is_between = |medium: &&MediumModel| {
            let is_in_field = report.says.is_about_the_field();
            is_in_field || !medium.is_perfect_at_home || !is_home(sender) || !to.is_none_or(is_home)
        };
        let medium = rules.medium.as_ref().filter(is_between);
        let (at, time_s) = (robot.position, now.time_s());
        let heard_s = medium.map_or(Some(time_s), |medium| {
            let to = to.map_or(medium.base, |mate| now.team[mate.index()].position);
            self.channel.send(medium, Sending { seed: rules.seed, ends, at, to, time_s, is_sent })
        });
        let is_deaf = to.is_some_and(|mate| self.is_mute[mate.index()]);
        match heard_s.filter(|_| !is_deaf) {
            Some(heard_s) => {
                let (sent_s, by_radio) = (time_s, medium.is_some());
                let report = report.clone();
                self.under_way.push(Message { sender, to, sent_s, heard_s, by_radio, report });
            }
            None if is_logged(report, to) => log.push(Event::Lost { robot: sender, to }),
            None => {}
        }
        medium.is_some()
    }

    /// The messages that mates hear by now, in the order in which they arrive.
    pub fn heard_by_mates(&mut self, time_s: f64, log: &mut EventLog) -> Vec<Message> {
        self.arrived(|message| message.to.is_some() && message.report.says.is_about_the_field(), time_s, log)
    }

    /// Lets the base hear the messages that have arrived by now, and each robot what is about the team.
    pub(super) fn deliver(&mut self, time_s: f64, log: &mut EventLog) {
        let is_theirs = |message: &Message| message.to.is_none() || !message.report.says.is_about_the_field();
        for message in self.arrived(is_theirs, time_s, log) {
            match message.to {
                Some(robot) => self.peers[robot.index()].hear(message),
                None => self.heard.hear(message),
            }
        }
    }

    /// Takes the messages that these hearers hear by now, in the order in which they arrive.
    fn arrived(
        &mut self,
        is_theirs: impl Fn(&Message) -> bool,
        time_s: f64,
        log: &mut EventLog,
    ) -> Vec<Message> {
        let has_arrived = |message: &mut Message| message.heard_s <= time_s && is_theirs(message);
        let mut arrived: Vec<Message> = self.under_way.extract_if(.., has_arrived).collect();
        arrived.sort_by(|a, b| a.heard_s.total_cmp(&b.heard_s));
        for Message { sender, to, sent_s, heard_s, by_radio, report } in &arrived {
            if *by_radio {
                self.channel.note_heard(Ends { from: *sender, to: *to }, heard_s - sent_s);
            }
            if heard_s > sent_s && is_logged(report, *to) {
                log.push(Event::Heard { robot: *sender, to: *to, sent_s: *sent_s });
            }
        }
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
        let told = self.tells(rules, liar.id, now.time_s(), made_up)?;
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

/// Whether the fate of a message is an event. Of the many by which robots tell all others how they are, links
/// keep the count.
fn is_logged(report: &Report, to: Option<RobotId>) -> bool {
    to.is_none() || report.says.is_about_the_field()
}
