//! What robots say of themselves, and which lies they tell.

use std::collections::BTreeMap;

use rand::seq::SliceRandom;
use scenario::Lie;
use scenario::seed::{Purpose, stream_at};
use teaming::NeedId;

use super::gauge::{Reading, read};
use super::lie::Topic;
use super::{Now, Telemetry};
use crate::belief::KnownRobot;
use crate::event::EventLog;
use crate::ids::RobotId;
use crate::model::{LieModel, TelemetryModel};
use crate::report::{Levels, Statement};

/// Levels and needs of one robot have numbers of their own in streams of random numbers.
const TOPICS: u64 = 128;

/// The robots in the order in which they speak at a step. It is drawn where they wait for one another on the
/// channel; it is that of their ids where nobody waits.
pub fn in_turn<'t>(robots: impl Iterator<Item = &'t KnownRobot>, now: &Now<'_>) -> Vec<&'t KnownRobot> {
    let mut robots: Vec<&KnownRobot> = robots.collect();
    if let Some(rules) = now.model.telemetry.as_ref().filter(|rules| rules.has_turns()) {
        robots.shuffle(&mut stream_at(rules.seed, Purpose::Turn, 0, now.step));
    }
    robots
}

impl Telemetry {
    /// The lie of a kind that a robot tells now.
    pub(super) fn tells<'r>(
        &self,
        rules: &'r TelemetryModel,
        by: RobotId,
        time_s: f64,
        is_it: impl Fn(&Lie) -> bool,
    ) -> Option<&'r LieModel> {
        let lies = self.told[by.index()].iter().map(|told| &rules.lies[told.lie as usize]);
        lies.into_iter().find(|lie| is_it(&lie.lie) && lie.is_told_at(time_s))
    }

    /// Lets robots read their gauges and say how they are. What some say under the names of others, they say
    /// after all of them.
    pub(super) fn report_all<'t>(
        &mut self,
        robots: impl Iterator<Item = &'t KnownRobot>,
        now: &Now<'_>,
        log: &mut EventLog,
    ) {
        let Some(rules) = &now.model.telemetry else { return };
        let robots = in_turn(robots, now);
        let reports: Vec<Levels> = robots.iter().map(|robot| self.levels_said(robot, rules, now)).collect();
        for (robot, report) in robots.iter().zip(&reports) {
            self.send(Statement::LevelsAre(report.clone()), robot, now, log);
            let read = self.read[robot.id.index()].unwrap_or(report.levels);
            let known = Levels { levels: read, needs: BTreeMap::new(), ..report.clone() };
            self.know(robot.id, Statement::LevelsAre(known), now);
        }
        for (robot, report) in robots.into_iter().zip(reports) {
            let other =
                self.tells(rules, robot.id, now.time_s(), |lie| matches!(lie, Lie::Impersonate { .. }));
            if let Some(Lie::Impersonate { name }) = other.map(|lie| &lie.lie) {
                let false_one = Levels { of: *name, by: *name, ..report };
                self.send(Statement::LevelsAre(false_one), robot, now, log);
            }
        }
    }

    /// What a robot says of how it is, by its gauges and its lies.
    fn levels_said(&mut self, robot: &KnownRobot, rules: &TelemetryModel, now: &Now<'_>) -> Levels {
        let id = robot.id;
        let gauges = &rules.gauges[robot.role.index()];
        let last = self.read[id.index()];
        let reading = |level: usize, is: f64| {
            let of = u64::from(id.0) * TOPICS + level as u64;
            let reading = Reading { seed: rules.seed, of, step: now.step, time_s: now.time_s() };
            let shown = read(&gauges[level], is, reading);
            shown.or(last.map(|last| last[level])).unwrap_or_else(|| is.clamp(0.0, 100.0))
        };
        let read = [reading(0, robot.energy), reading(1, robot.hp)];
        self.read[id.index()] = Some(read);
        let (levels, needs) = self.said(robot, read, now);
        Levels {
            of: id.0,
            by: id.0,
            round: now.round,
            sent_s: now.time_s(),
            heard_s: now.time_s(),
            levels,
            needs,
            sd: [gauges[0].sd, gauges[1].sd],
        }
    }

    /// What a robot says of its levels and needs, when it read these levels.
    fn said(
        &mut self,
        robot: &KnownRobot,
        read: [f64; 2],
        now: &Now<'_>,
    ) -> ([f64; 2], BTreeMap<usize, f64>) {
        let (mut levels, mut needs) = (read, BTreeMap::new());
        let Some(rules) = &now.model.telemetry else { return (levels, needs) };
        let mut told = std::mem::take(&mut self.told[robot.id.index()]);
        for told in &mut told {
            let lie = &rules.lies[told.lie as usize];
            if !lie.lie.is_about_levels() || !lie.is_told_at(now.time_s()) {
                continue;
            }
            let honest = robot.with_levels(read).needs(&now.model.needs);
            let honest = honest.map(|needs| needs.values().to_vec()).unwrap_or_default();
            let fresh = robot.fresh_needs(&now.model.needs);
            let of_fresh =
                |need: NeedId| 100.0 * honest[need.index()] / fresh[need.index()].max(f64::MIN_POSITIVE);
            let topics: Vec<f64> =
                read.into_iter().chain(lie.on_needs.iter().map(|need| of_fresh(*need))).collect();
            if told.at_onset.is_empty() {
                told.at_onset.clone_from(&topics);
            }
            let topic = |place: usize, number: usize, others: Option<f64>| Topic {
                seed: rules.seed,
                of: u64::from(robot.id.0) * TOPICS + number as u64,
                step: now.step,
                time_s: now.time_s(),
                at_onset: told.at_onset[place],
                others,
            };
            for level in (0..2).filter(|level| lie.on_levels[*level]) {
                let others = self.heard_by(Some(robot.id)).mean_of_others(robot, now.team, level);
                levels[level] = lie.said(read[level], &topic(level, level, others), 100.0);
            }
            let most = if rules.clip { 100.0 } else { f64::MAX };
            for (place, need) in lie.on_needs.iter().enumerate() {
                let said = lie.said(topics[2 + place], &topic(2 + place, 2 + need.index(), None), most);
                needs.insert(need.index(), (said * fresh[need.index()] / 100.0).min(1e12));
            }
        }
        self.told[robot.id.index()] = told;
        (levels, needs)
    }
}
