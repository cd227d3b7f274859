//! Negotiations: robots at home take turns, say things and hear things, until each has joined a group.

use std::collections::BTreeMap;

use scenario::Decider;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use teaming::{Act, Assignment, Question, Say, Told, Turn, Undecided};

use super::{Gathered, Mission, Pending, Scene};
use crate::ids::RobotId;
use crate::model::Model;
use crate::report::Statement;
use crate::telemetry::Mail;

/// So often a robot may wake up in one step.
const MOST_TURNS: u32 = 200;

/// A negotiation before a round.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Talks {
    who: Gathered,
    since_step: u64,
    seats: Vec<Seat>,
}

/// A robot in a negotiation.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Seat {
    robot: RobotId,
    /// What it keeps in mind, in JSON.
    state: String,
    /// What it was told since its last turn.
    told: Vec<Mail>,
    wakes_at: Option<u64>,
    is_due: bool,
    /// Its turns in this step.
    turns: u32,
    joined: Option<Join>,
}

/// How a robot decided.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Join {
    /// The robot.
    pub robot: u32,
    /// The groups as it sees them. It joins its own.
    pub sees: Assignment,
    /// How old what it last heard of each other member was, in seconds; none for whom it never heard.
    pub ages_s: BTreeMap<u32, Option<f64>>,
    /// How long after the negotiation began, in seconds.
    pub after_s: f64,
    /// Whether it was out of time.
    pub is_late: bool,
}

impl Join {
    /// Those whom the robot holds for its group, itself among them.
    pub(super) fn mates(&self) -> Vec<RobotId> {
        let own = self.sees.task_of(self.robot).map(|task| self.sees.of(task)).unwrap_or_default();
        own.iter().map(|robot| RobotId(*robot)).collect()
    }

    /// Whether it sees the place of any robot but itself.
    pub(super) fn names_others(&self) -> bool {
        self.sees.groups.iter().chain([&self.sees.idle]).map(Vec::len).sum::<usize>() > 1
    }

    /// Whether two robots saw each robot that both saw in the same place; `None` if both saw none, as where
    /// each names only its own task.
    #[must_use]
    pub fn agrees_with(&self, other: &Self) -> Option<bool> {
        let places = |sees: &Assignment| {
            let groups = sees.groups.iter().zip(1_usize..).chain([(&sees.idle, 0)]);
            let places = groups.flat_map(|(group, place)| group.iter().map(move |robot| (*robot, place)));
            places.collect::<BTreeMap<u32, usize>>()
        };
        let theirs = places(&other.sees);
        let both =
            places(&self.sees).into_iter().filter_map(|(robot, place)| Some((place, *theirs.get(&robot)?)));
        both.map(|(place, other)| place == other).reduce(|all, same| all && same)
    }
}

/// A robot that got no further in a negotiation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Endless(pub RobotId);

impl Talks {
    /// A negotiation that begins: the first turn is everybody's.
    pub(super) fn begin(who: Gathered, step: u64) -> Self {
        let seat = |robot: &RobotId| Seat {
            robot: *robot,
            state: Value::Null.to_string(),
            told: Vec::new(),
            wakes_at: Some(step),
            is_due: false,
            turns: 0,
            joined: None,
        };
        let seats = who.fit.iter().map(seat).collect();
        Self { who, since_step: step, seats }
    }

    fn due(&self) -> impl Iterator<Item = &Seat> {
        self.seats.iter().filter(|seat| seat.is_due)
    }

    /// Robots that were lost take part no longer.
    fn lose(&mut self, is_able: impl Fn(RobotId) -> bool) {
        let Gathered { home, fit, unfit } = &mut self.who;
        home.retain(|id| is_able(*id));
        fit.retain(|id| is_able(*id));
        unfit.retain(|(id, _)| is_able(*id));
        self.seats.retain(|seat| is_able(seat.robot));
    }
}

impl Seat {
    fn wakes_by(&self, step: u64) -> bool {
        self.wakes_at.is_some_and(|at| at <= step)
    }

    /// Tells it something that it hears now.
    fn hear(&mut self, mail: impl Iterator<Item = Mail>) {
        self.told.extend(mail);
    }
}

impl Mission {
    /// Goes on with a negotiation in a new step: robots that have heard something, that wake up, or whose
    /// time is over get a turn.
    pub(super) fn talk(&mut self, scene: &mut Scene) {
        let Some(mut talks) = self.talks.take() else { return };
        talks.lose(|id| scene.beliefs.team[id.index()].is_able());
        let is_late = late(scene.model, scene.step, talks.since_step).is_some();
        for seat in &mut talks.seats {
            if let Some(telemetry) = scene.telemetry.as_deref_mut() {
                seat.hear(telemetry.take_mail(seat.robot, self.round));
            }
            seat.turns = 0;
            let has_turn = is_late || !seat.told.is_empty() || seat.wakes_by(scene.step);
            seat.is_due = has_turn && !(is_late && seat.joined.is_some());
        }
        self.hear_turns(talks, scene);
    }

    /// Asks those whose turn it is, or notes that all have decided.
    fn hear_turns(&mut self, talks: Talks, scene: &mut Scene) {
        let is_over = talks.seats.iter().all(|seat| seat.joined.is_some());
        if is_over || talks.due().next().is_some() {
            let is_first = talks.since_step == scene.step && talks.seats.iter().all(|seat| seat.turns == 0);
            self.note_question(is_first, scene);
            let question = self.question_of(None, &talks.who, scene);
            let of_seat = |seat: &Seat| self.question_of(Some(seat.robot), &talks.who, scene);
            let turns = talks.due().map(of_seat).collect();
            self.pending = Some(Pending { question, turns, unfit: talks.who.unfit.clone() });
        }
        self.talks = Some(talks);
    }

    /// The turns of robots that wait for an answer. `whole` adds to a question what its robot remembers.
    pub fn turns(&self, whole: impl Fn(&Question) -> Question, model: &Model, step: u64) -> Vec<Turn> {
        let (Some(talks), Some(pending)) = (&self.talks, &self.pending) else { return Vec::new() };
        let dt_s = model.dt_s();
        let now_s = step as f64 * dt_s;
        let told =
            |mail: &Mail| Told { from: mail.from.0, what: value(&mail.what), age_s: now_s - mail.sent_s };
        let late = late(model, step, talks.since_step);
        let turn = |(seat, question): (&Seat, &Question)| Turn {
            robot: seat.robot.0,
            since_s: (step - talks.since_step) as f64 * dt_s,
            told: seat.told.iter().map(told).collect(),
            state: value(&seat.state),
            rule: None,
            question: whole(question),
            late,
        };
        talks.due().zip(&pending.turns).map(turn).collect()
    }

    /// Whether all robots have decided, and where they go.
    pub fn agreed(&self) -> Option<Vec<Join>> {
        let seats = &self.talks.as_ref().filter(|_| self.pending.is_some())?.seats;
        seats.iter().map(|seat| seat.joined.clone()).collect()
    }

    /// Robots act in their turns, all at once: what they say is heard after all have acted.
    ///
    /// # Errors
    /// A robot wakes up again and again in one step.
    pub fn act_in_turn(&mut self, acts: Vec<Deed>, scene: &mut Scene) -> Result<(), Endless> {
        let Some(mut talks) = self.talks.take() else { return Ok(()) };
        self.pending = None;
        let (mut said, mut sharing) = (Vec::new(), Vec::new());
        let is_late = late(scene.model, scene.step, talks.since_step).is_some();
        let after_s = (scene.step - talks.since_step) as f64 * scene.model.dt_s();
        for (seat, deed) in talks.seats.iter_mut().filter(|seat| seat.is_due).zip(acts) {
            let Deed { act, sees, ages_s } = deed;
            let robot = seat.robot;
            seat.state = act.state.to_string();
            seat.told.clear();
            seat.turns += 1;
            // Who sleeps at all sleeps for a step.
            let sleep = |seconds: f64| scene.model.steps_in(seconds).max(u64::from(seconds > 0.0));
            seat.wakes_at = act.wake_in_s.map(|seconds| scene.step + sleep(seconds));
            said.extend(act.says.into_iter().map(|say| (robot, say)));
            sharing.extend(act.shares.then_some(robot));
            let stays = || Assignment {
                idle: vec![robot.0],
                ..Assignment::new(vec![Vec::new(); self.crew.groups.len()])
            };
            let sees = sees.or_else(|| (is_late && seat.joined.is_none()).then(stays));
            if let Some(sees) = sees {
                seat.joined = Some(Join { robot: robot.0, sees, ages_s, after_s, is_late });
            }
        }
        for speaker in self.in_turn(scene) {
            for (robot, say) in said.iter().filter(|(robot, _)| *robot == speaker) {
                self.say(*robot, say, &mut talks, scene);
            }
        }
        self.with_telemetry(scene, |telemetry, now, log| telemetry.end_turn(&sharing, now, log));
        for seat in &mut talks.seats {
            if let Some(telemetry) = scene.telemetry.as_deref_mut() {
                seat.hear(telemetry.take_mail(seat.robot, self.round));
            }
            seat.is_due = seat.wakes_by(scene.step) && !(is_late && seat.joined.is_some());
            if seat.is_due && seat.turns >= MOST_TURNS {
                return Err(Endless(seat.robot));
            }
        }
        self.hear_turns(talks, scene);
        Ok(())
    }

    /// A robot says something to all, or to one. Where all know all, it is heard at once.
    fn say(&self, from: RobotId, say: &Say, talks: &mut Talks, scene: &mut Scene) {
        let (what, to) = (say.what.to_string(), say.to.map(RobotId));
        if scene.telemetry.is_some() {
            let says = Statement::Protocol { round: self.round, what };
            self.with_telemetry(scene, |telemetry, now, log| {
                telemetry.say_in_turn(&now.report(from, says), to, now, log);
            });
            return;
        }
        let sent_s = scene.step as f64 * scene.model.dt_s();
        let hears = |seat: &&mut Seat| seat.robot != from && to.is_none_or(|to| to == seat.robot);
        for seat in talks.seats.iter_mut().filter(hears) {
            seat.hear([Mail { from, round: self.round, what: what.clone(), sent_s }].into_iter());
        }
    }

    /// Notes what is known at a question, instead of what was known at the last of the same negotiation.
    pub(super) fn note_question(&self, is_first: bool, scene: &mut Scene) {
        if let Some(telemetry) = scene.telemetry.as_deref_mut() {
            telemetry.close_rounds_of_peers(scene.beliefs.ledger.rounds(), is_first, scene.model);
            telemetry.note_question(self.round, is_first);
        }
    }
}

/// What a robot does in its turn, with what it knows of the others then.
#[derive(Debug, Clone)]
pub struct Deed {
    /// What it does.
    pub act: Act,
    /// The groups as it sees them, if it has decided.
    pub sees: Option<Assignment>,
    /// See [`Join::ages_s`].
    pub ages_s: BTreeMap<u32, Option<f64>>,
}

/// What becomes of undecided robots, once the time of the negotiation is over.
fn late(model: &Model, step: u64, since_step: u64) -> Option<Undecided> {
    match model.mission.decides {
        Decider::Robots { deadline_s, undecided, .. } => {
            // At the deadline itself robots may still decide.
            let is_over = step > since_step + model.steps_in(deadline_s) || deadline_s == 0.0;
            is_over.then_some(undecided)
        }
        Decider::Base => None,
    }
}

fn value(json: &str) -> Value {
    serde_json::from_str(json).unwrap_or_default() // it was written from a value
}
