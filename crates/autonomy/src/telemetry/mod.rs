//! Telemetry: what robots say of themselves and of their mates, and what the base hears of it.
//!
//! A robot reads its gauges (`gauge`), says something of them (`speech`, `lie`) and looks at its mates
//! (`witness`); messages go through a channel (`channel`) to the base (`heard`). By the same channel robots
//! tell their mates of debris, radiation and rescuees where the scenario says so (`radio`). Where a scenario
//! has no reports, no medium and no deceit, there is no telemetry, and the base knows how every robot is.

mod channel;
mod deceit;
mod gauge;
mod heard;
mod known;
mod lie;
mod peers;
mod radio;
mod speech;
mod witness;

use std::collections::BTreeMap;

use rne_core::NeedVector;
use scenario::{Lie, Measure};
use serde::{Deserialize, Serialize};
use teaming::{Evidence, Member, MemberOutcome, RoundOutcome};

pub use channel::{Channel, Ends, Link};
pub use heard::{Heard, named};
pub use known::known;
pub use peers::Mail;
pub(crate) use peers::seed_of;
pub use speech::in_turn;

use crate::belief::KnownRobot;
use crate::event::EventLog;
use crate::hash::part;
use crate::ids::RobotId;
use crate::model::{Model, TelemetryModel};
use crate::report::{Message, Report, Speaker, Statement};
use heard::Trip;
use lie::{Told, said_of_mate};
use peers::Peer;
use witness::Witnesses;

/// The state of the telemetry.
#[derive(Clone, Serialize, Deserialize)]
pub struct Telemetry {
    /// What the base heard.
    heard: Heard,
    /// Messages under way, in the order in which they were sent.
    under_way: Vec<Message>,
    /// The channel.
    channel: Channel,
    /// The lies that each robot tells.
    told: Vec<Vec<Told>>,
    /// The last reading of each robot's gauges.
    read: Vec<Option<[f64; 2]>>,
    /// Whether the radio of each robot is broken.
    is_mute: Vec<bool>,
    witnesses: Witnesses,
    trips: Vec<Trip>,
    /// Whether each robot is to take a new name when it is home.
    takes_new_name: Vec<bool>,
    /// What each robot heard of the others, where robots decide.
    peers: Vec<Peer>,
}

/// Where a robot is in the mission.
#[derive(Debug, Clone, Copy)]
pub struct Presence {
    /// Whether it is at home.
    pub is_home: bool,
    /// Whether it works in the field.
    pub is_in_field: bool,
    /// Whether it is at its rest place.
    pub is_resting: bool,
    /// What is known to slow it, as a share of its speed: no guide, a load.
    pub known_loss: f64,
}

/// The trial at one step, as telemetry needs it.
pub struct Now<'n> {
    /// The model.
    pub model: &'n Model,
    /// The robots as they know themselves.
    pub team: &'n [KnownRobot],
    /// Where each is.
    pub presence: &'n dyn Fn(&KnownRobot) -> Presence,
    /// The step.
    pub step: u64,
    /// The round.
    pub round: u32,
}

impl Now<'_> {
    fn time_s(&self) -> f64 {
        self.step as f64 * self.model.dt_s()
    }

    /// What a robot says now.
    pub(crate) fn report(&self, robot: RobotId, says: Statement) -> Report {
        Report { from: Speaker::Robot(robot), says, at_step: self.step, sd_m: 0.0 }
    }
}

impl Telemetry {
    /// The state before the first report; `None` where the model has no telemetry.
    pub fn of(model: &Model) -> Option<Box<Self>> {
        let (rules, robots) = (model.telemetry.as_ref()?, model.robots.len());
        let told = |lies: &Vec<usize>| lies.iter().map(|lie| Told::new(*lie)).collect();
        Some(Box::new(Self {
            heard: Heard::nothing(robots, model.mission.low_energy.threshold),
            under_way: Vec::new(),
            channel: Channel::default(),
            told: rules.told_by.iter().map(told).collect(),
            read: vec![None; robots],
            is_mute: vec![false; robots],
            witnesses: Witnesses::of_nobody(robots),
            trips: vec![Trip::default(); robots],
            takes_new_name: vec![false; robots],
            peers: Peer::all(model),
        }))
    }

    /// The hash of the state.
    pub fn digest(&self) -> u128 {
        let Self { heard, under_way, channel, told, read, is_mute, witnesses, trips, takes_new_name, peers } =
            self;
        let base = (heard, under_way, channel, told, read, is_mute, witnesses, trips, takes_new_name);
        let peers: Vec<_> = peers.iter().map(Peer::to_hash).collect();
        if peers.is_empty() { part(&base) } else { part(&(base, peers)) }
    }

    /// What the base heard.
    pub fn heard(&self) -> &Heard {
        &self.heard
    }

    /// The links on which anything was sent.
    pub fn links(&self) -> impl Iterator<Item = (&Ends, &Link)> {
        self.channel.links()
    }

    /// How many messages each robot has sent since this was asked last, where they cost something.
    pub fn take_unpaid(&mut self) -> BTreeMap<RobotId, u32> {
        self.channel.take_unpaid()
    }

    /// A robot begins to tell one of the lies of the timeline.
    pub fn begin_lie(&mut self, robot: RobotId, lie: usize) {
        self.told[robot.index()].push(Told::new(lie));
    }

    /// A robot tells no more lies.
    pub fn be_honest(&mut self, robot: RobotId) {
        self.told[robot.index()].clear();
    }

    /// The radio of a robot breaks.
    pub fn mute(&mut self, robot: RobotId) {
        self.is_mute[robot.index()] = true;
    }

    /// The part of a step: robots look at their mates, report when it is time, and are heard. `sighted_mps`
    /// is how fast the first robot sees the second go.
    pub fn step(
        &mut self,
        sighted_mps: impl Fn(RobotId, RobotId) -> Option<f64>,
        now: &Now<'_>,
        log: &mut EventLog,
    ) {
        let Some(rules) = &now.model.telemetry else { return };
        let presences: Vec<Presence> = now.team.iter().map(now.presence).collect();
        self.note_trips(&presences, now, rules);
        self.look(sighted_mps, &presences, now, rules);
        if now.model.is_due(now.step, rules.every_steps) {
            self.report_all(now.team.iter().filter(|robot| robot.is_able()), now, log);
        }
        self.deliver(now.time_s(), log);
    }

    /// The base asks the robots at home how they are, before a round.
    pub(crate) fn ask_at_home(&mut self, now: &Now<'_>, log: &mut EventLog) {
        let is_home = |robot: &&KnownRobot| robot.is_able() && (now.presence)(robot).is_home;
        for robot in now.team.iter().filter(is_home) {
            if std::mem::take(&mut self.takes_new_name[robot.id.index()]) {
                self.hearers().for_each(|heard| {
                    heard.known_since.insert(robot.id.0, now.round);
                });
            }
        }
        self.report_all(now.team.iter().filter(is_home), now, log);
        self.deliver(now.time_s(), log);
    }

    /// A question is asked: what it has of the evidence. One that is not the first of its negotiation stands
    /// for the one before.
    pub(crate) fn note_question(&mut self, round: u32, is_first: bool) {
        for heard in self.hearers() {
            if !is_first {
                heard.extents.pop();
            }
            let extent = heard.log.extent(round, heard.known_since.clone());
            heard.extents.push(extent);
        }
    }

    /// The evidence of the last question, of the base or of a robot.
    pub fn evidence(&self, asker: Option<RobotId>, model: &Model) -> Option<Evidence> {
        let heard = self.heard_by(asker);
        Some(known(model, heard.log.evidence().as_of(heard.extents.last()?)))
    }

    /// The levels of a robot as the base heard them last, in percent.
    pub fn levels(&self, rules: &TelemetryModel, robot: RobotId) -> [f64; 2] {
        self.heard.levels(robot, rules.mean_levels())
    }

    /// A robot as a member of a team that is to be grouped, as the base heard of it last, or another robot.
    /// What the base hands out and what a robot carries is known to all.
    pub(crate) fn member(&self, asker: Option<RobotId>, robot: &KnownRobot, model: &Model) -> Option<Member> {
        let (rules, heard) = (model.telemetry.as_ref()?, self.heard_by(asker));
        let robot_heard = robot.with_levels(heard.levels(robot.id, rules.mean_levels()));
        let member = robot_heard.member(&model.needs)?;
        let Some(said) = heard.said_needs(robot.id).filter(|said| !said.is_empty()) else {
            return Some(member);
        };
        let mut needs = member.needs.values().to_vec();
        said.iter().for_each(|(place, said)| needs[*place] = *said);
        Some(Member { needs: NeedVector::new(needs).ok()?, ..member })
    }

    /// A round begins with these groups.
    pub(crate) fn begin_round(&mut self, groups: &[Vec<RobotId>]) {
        self.hearers().for_each(Heard::begin_round);
        self.witnesses.begin_round(groups);
        self.trips.fill(Trip::default());
    }

    /// A round is over: robots say what they saw of their mates.
    pub(crate) fn rate(&mut self, now: &Now<'_>, log: &mut EventLog) {
        let Some(rules) = &now.model.telemetry else { return };
        for robot in in_turn(now.team.iter().filter(|robot| robot.is_able()), now) {
            for rating in self.witnesses.ratings(rules, robot.id, now.round) {
                let top_mps = now.team[rating.of as usize].spec.speed_mps;
                self.know(robot.id, Statement::MateGoes(rating), now);
                let said = self.tells(rules, robot.id, now.time_s(), Lie::is_about_mates);
                let said = said.map_or(Some(rating), |lie| said_of_mate(&lie.lie, rating, top_mps, rules));
                if let Some(rating) = said {
                    self.send(Statement::MateGoes(rating), robot, now, log);
                }
            }
        }
        self.deliver(now.time_s(), log);
    }

    /// The base closes its books of a round, once the robots at home have reported.
    pub(crate) fn close_round(&mut self, rounds: &[RoundOutcome], model: &Model, step: u64) {
        let time_s = step as f64 * model.dt_s();
        let Self { heard, trips, .. } = self;
        for round in rounds.iter().skip(heard.history.len()) {
            let known = |member: &MemberOutcome| Some(trips[member.id as usize].ended(member, round, time_s));
            heard.end_round(round, known, model);
        }
    }

    /// The rounds as the base heard of them, or a robot, as far as their robots still have their names.
    pub fn history(&self, asker: Option<RobotId>) -> Vec<RoundOutcome> {
        let heard = self.heard_by(asker);
        named(&heard.history, &heard.known_since)
    }

    /// The base sees who rests and who is back.
    fn note_trips(&mut self, presences: &[Presence], now: &Now<'_>, rules: &TelemetryModel) {
        for ((robot, presence), trip) in now.team.iter().zip(presences).zip(&mut self.trips) {
            if presence.is_resting {
                trip.rested = true;
                let whitewashes = |told: &Told| {
                    let lie = &rules.lies[told.lie as usize];
                    matches!(lie.lie, Lie::Whitewash { .. }) && lie.is_told_at(now.time_s())
                };
                self.takes_new_name[robot.id.index()] |= self.told[robot.id.index()].iter().any(whitewashes);
            }
            if presence.is_home && trip.back_s.is_none() {
                trip.back_s = Some(now.time_s());
            }
        }
    }

    /// Robots in the field look at their mates there.
    fn look(
        &mut self,
        sighted_mps: impl Fn(RobotId, RobotId) -> Option<f64>,
        presences: &[Presence],
        now: &Now<'_>,
        rules: &TelemetryModel,
    ) {
        let mean = rules.mean_levels();
        let speed_need = now.model.needs.iter().position(|need| need.measures == Measure::Speed);
        for (robot, presence) in now.team.iter().zip(presences) {
            if !presence.is_in_field || !robot.is_able() {
                continue;
            }
            let heard = self.peers.get(robot.id.index()).map_or(&self.heard, |peer| &peer.heard);
            self.witnesses.look(robot.id, |mate| {
                let there = presences[mate.index()];
                let mps = sighted_mps(robot.id, mate).filter(|_| there.is_in_field)?;
                let said = heard.said_needs(mate).and_then(|needs| needs.get(&speed_need?).copied());
                let said =
                    said.unwrap_or_else(|| now.team[mate.index()].speed_at(heard.levels(mate, mean)[1]));
                Some([mps / there.known_loss, said])
            });
        }
    }
}
