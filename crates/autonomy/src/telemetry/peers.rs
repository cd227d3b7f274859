//! What each robot heard of the others, where robots decide for themselves, and the question that it asks.

use scenario::seed::{Purpose, stream_at};
use scenario::{Coin, Decider};
use serde::{Deserialize, Serialize};
use teaming::{MemberOutcome, RandomSeed, RobotRound, RoundOutcome};

use super::heard::Heard;
use super::radio::Parcel;
use super::{Now, Telemetry, in_turn};
use crate::belief::KnownRobot;
use crate::event::EventLog;
use crate::hash::part;
use crate::ids::RobotId;
use crate::model::Model;
use crate::report::{Digest, Levels, Message, Report, Speaker, Statement};

/// What one robot heard.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Peer {
    pub(super) heard: Heard,
    /// For each robot, the last round of which it said that it stays out; 0 before.
    out_of: Vec<u32>,
    /// What robots said of themselves at the end of rounds.
    trips: Vec<RobotRound>,
    /// How many rounds, and trips of them, were in its books before the negotiation.
    closed: [usize; 2],
    /// What it was told in a negotiation, and has not taken note of yet.
    mail: Vec<Mail>,
    /// The hash of all that was heard.
    digest: u128,
}

/// What a robot is told in a negotiation.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Mail {
    /// Who says it.
    pub from: RobotId,
    /// The round about which they negotiate.
    pub round: u32,
    /// What, in JSON.
    pub what: String,
    /// When it was said, in seconds.
    pub sent_s: f64,
}

impl Peer {
    /// One for each robot where robots decide; none where the base does.
    pub(super) fn all(model: &Model) -> Vec<Self> {
        let (robots, threshold) = (model.robots.len(), model.mission.low_energy.threshold);
        let nothing = || Self {
            heard: Heard::nothing(robots, threshold),
            out_of: vec![0; robots],
            trips: Vec::new(),
            closed: [0; 2],
            mail: Vec::new(),
            digest: 0,
        };
        (0..robots).filter(|_| !model.mission.decides.is_base()).map(|_| nothing()).collect()
    }

    /// What counts in the hash chain.
    pub(super) fn to_hash(&self) -> impl Serialize + '_ {
        (self.digest, self.heard.history.len(), self.mail.len(), self.closed)
    }

    /// Hears a message of another, or what the robot itself knows. Of itself nobody tells it anything.
    pub(super) fn hear(&mut self, message: Message) {
        self.digest = part(&(self.digest, &message));
        let (sender, heard_s) = (message.sender, message.heard_s);
        let own = message.to.map_or(u32::MAX, |robot| robot.0);
        match message.report.says {
            Statement::RoundWas(trip) => self.trips.push(trip),
            Statement::Protocol { round, what } => {
                self.mail.push(Mail { from: sender, round, what, sent_s: message.sent_s });
            }
            Statement::StaysOut { round } => self.note_out(sender, round),
            Statement::HasHeard(Digest { round, levels, out }) => {
                out.iter().for_each(|robot| self.note_out(*robot, round));
                let others = levels.into_iter().filter(|levels| levels.of != own);
                others.for_each(|levels| self.hear_anew(Levels { heard_s, ..levels }));
            }
            Statement::LevelsAre(ref levels)
                if levels.of == own && sender.0 != own || self.heard.has_heard(levels) => {}
            _ => self.heard.hear(message),
        }
    }

    /// Hears at second hand what was said of a robot, if it is newer than what was heard before.
    fn hear_anew(&mut self, levels: Levels) {
        if self.heard.said_at_s(levels.of as usize).is_none_or(|said_s| said_s < levels.sent_s) {
            self.heard.hear_levels(levels);
        }
    }

    /// Notes that a robot stays out of a round, unless it is known to stay out of a later one.
    fn note_out(&mut self, robot: RobotId, round: u32) {
        let known = &mut self.out_of[robot.index()];
        *known = round.max(*known);
    }

    /// Whether a robot is known to stay out of a round.
    fn is_out(&self, robot: RobotId, round: u32) -> bool {
        self.out_of[robot.index()] == round
    }

    /// Notes the rounds that are over: what a robot saw of its own group, and what others said of
    /// themselves. In a negotiation it does so at each question, with what it has heard by then.
    fn close(&mut self, robot: RobotId, base: &Heard, rounds: &[RoundOutcome], model: &Model) {
        let Self { heard, trips, closed, .. } = self;
        heard.reopen(*closed);
        for round in rounds.iter().skip(heard.history.len()) {
            let is_own = |member: &MemberOutcome| {
                let of = |id: u32| round.groups.iter().position(|g| g.members.iter().any(|m| m.id == id));
                of(member.id) == of(robot.0)
            };
            let told = |id: u32| trips.iter().find(|trip| (trip.robot, trip.round) == (id, round.round));
            let known = |member: &MemberOutcome| {
                let saw = is_own(member).then(|| base.log.trip(member.id, round.round));
                saw.unwrap_or_else(|| told(member.id).copied())
            };
            heard.end_round(round, known, model);
        }
    }

    /// A negotiation begins: earlier books stay as they are.
    fn begin(&mut self) {
        self.closed = self.heard.closed();
        let rounds = self.heard.history.len();
        self.trips.retain(|trip| trip.round as usize > rounds);
        self.mail.clear();
    }
}

impl Telemetry {
    /// What the base heard, or a robot.
    pub(super) fn heard_by(&self, hearer: Option<RobotId>) -> &Heard {
        hearer.and_then(|robot| self.peers.get(robot.index())).map_or(&self.heard, |peer| &peer.heard)
    }

    /// Everybody who hears.
    pub(super) fn hearers(&mut self) -> impl Iterator<Item = &mut Heard> {
        self.peers.iter_mut().map(|peer| &mut peer.heard).chain([&mut self.heard])
    }

    /// Whether a robot knows that another stays out of a round.
    pub(crate) fn knows_out(&self, by: RobotId, robot: RobotId, round: u32) -> bool {
        self.peers[by.index()].is_out(robot, round)
    }

    /// How old what a robot last heard of another is, in seconds; none if it never heard of it.
    pub fn age_s(&self, by: RobotId, robot: RobotId, time_s: f64) -> Option<f64> {
        Some(time_s - self.heard_by(Some(by)).said_at_s(robot.index())?)
    }

    /// A robot knows what it reads of itself, and what it saw, whatever it says.
    pub(super) fn know(&mut self, robot: RobotId, says: Statement, now: &Now<'_>) {
        if self.peers.is_empty() {
            return;
        }
        let (report, to, sent_s) = (now.report(robot, says), Some(robot), now.time_s());
        self.under_way.push(Message { sender: robot, to, sent_s, heard_s: sent_s, by_radio: false, report });
    }

    /// Robots say what became of them in the round that is over.
    pub(crate) fn tell_rounds(&mut self, round: &RoundOutcome, now: &Now<'_>, log: &mut EventLog) {
        let time_s = now.time_s();
        let is_home = |robot: &&KnownRobot| robot.is_able() && (now.presence)(robot).is_home;
        for robot in in_turn(now.team.iter().filter(is_home), now) {
            let mut members = round.groups.iter().flat_map(|group| &group.members);
            if let Some(member) = members.find(|member| member.id == robot.id.0) {
                let trip = self.trips[robot.id.index()].ended(member, round, time_s);
                self.tell_peers(&now.report(robot.id, Statement::RoundWas(trip)), false, now, log);
            }
        }
        self.deliver(time_s, log);
    }

    /// Robots that must rest say that they stay out of the round.
    pub(crate) fn tell_who_stays(&mut self, who: &[RobotId], now: &Now<'_>, log: &mut EventLog) {
        let is_out = |robot: &&KnownRobot| who.contains(&robot.id);
        for robot in in_turn(now.team.iter().filter(is_out), now) {
            let says = Statement::StaysOut { round: now.round };
            self.tell_peers(&now.report(robot.id, says), false, now, log);
        }
        self.deliver(now.time_s(), log);
    }

    /// A robot says something in a negotiation, to all or to one.
    pub(crate) fn say_in_turn(
        &mut self,
        report: &Report,
        to: Option<RobotId>,
        now: &Now<'_>,
        log: &mut EventLog,
    ) {
        let Some(one) = to else { return self.tell_peers(report, false, now, log) };
        let hears = |mate: &KnownRobot| report.from != Speaker::Robot(mate.id) && mate.is_able();
        if now.team.get(one.index()).is_some_and(hears) {
            self.carry(Parcel { report, to, is_sent: false }, now, log);
        }
    }

    /// What a robot was told in the negotiation about this round, and has not taken note of yet. What comes
    /// too late is forgotten.
    pub(crate) fn take_mail(&mut self, robot: RobotId, round: u32) -> impl Iterator<Item = Mail> + use<> {
        let mail = self.peers.get_mut(robot.index()).map(|peer| std::mem::take(&mut peer.mail));
        mail.unwrap_or_default().into_iter().filter(move |mail| mail.round == round)
    }

    /// These robots say to all what they have heard of all, and everybody hears what arrives at once.
    pub(crate) fn end_turn(&mut self, sharing: &[RobotId], now: &Now<'_>, log: &mut EventLog) {
        self.deliver(now.time_s(), log);
        let shares = |robot: &&KnownRobot| sharing.contains(&robot.id);
        let digests: Vec<(&KnownRobot, Digest)> = in_turn(now.team.iter().filter(shares), now)
            .into_iter()
            .map(|robot| (robot, self.digest_of(robot, now)))
            .collect();
        for (robot, digest) in digests {
            self.tell_peers(&now.report(robot.id, Statement::HasHeard(digest)), false, now, log);
            // One robot's digest at a time: all at once, those of 200 robots took 720 MB.
            self.deliver(now.time_s(), log);
        }
    }

    fn digest_of(&self, robot: &KnownRobot, now: &Now<'_>) -> Digest {
        let peer = &self.peers[robot.id.index()];
        let others = peer.heard.newest().filter(|report| report.of != robot.id.0).cloned();
        let is_out = |id: &RobotId| peer.is_out(*id, now.round);
        let out = now.team.iter().map(|robot| robot.id).filter(is_out).collect();
        Digest { round: now.round, levels: others.collect(), out }
    }

    /// A robot tells all others, where robots decide. `is_sent` says whether the same sending reaches the
    /// base.
    pub(super) fn tell_peers(
        &mut self,
        report: &Report,
        mut is_sent: bool,
        now: &Now<'_>,
        log: &mut EventLog,
    ) {
        let there = if self.peers.is_empty() { &[][..] } else { now.team };
        let hears = |mate: &&KnownRobot| report.from != Speaker::Robot(mate.id) && mate.is_able();
        for mate in there.iter().filter(hears) {
            is_sent |= self.carry(Parcel { report, to: Some(mate.id), is_sent }, now, log);
        }
    }

    /// Robots close their books of the rounds that are over: for the first time in a negotiation, or anew.
    pub(crate) fn close_rounds_of_peers(&mut self, rounds: &[RoundOutcome], is_first: bool, model: &Model) {
        for (robot, peer) in (0..).map(RobotId).zip(&mut self.peers) {
            if is_first {
                peer.begin();
            }
            peer.close(robot, &self.heard, rounds, model);
        }
    }
}

/// The seed of a robot's draws in a round.
pub(crate) fn seed_of(model: &Model, round: u32, robot: RobotId, base: RandomSeed) -> RandomSeed {
    match model.mission.decides {
        Decider::Robots { coin: Coin::Common, .. } | Decider::Base => base,
        Decider::Robots { coin: Coin::Own, .. } => {
            let draws = stream_at(model.seed, Purpose::Grouping, u64::from(round), 1 + u64::from(robot.0));
            RandomSeed(draws.get_seed())
        }
    }
}
