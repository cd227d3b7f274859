//! The mission: rounds of grouping, searching, rescuing and returning. Robots decide here, from what they
//! heard; what they want done becomes an [`Intent`](crate::intent::Intent), and the world has the last word.

mod agent;
mod claims;
mod crew;
mod errands;
mod heard_claims;
mod progress;
mod question;
mod regroup;
mod round;
mod scene;
mod settle;
mod talks;
mod told;
mod work;

use scenario::ClaimRule;
use serde::{Deserialize, Serialize};
use teaming::{Question, TaskId};

pub use agent::{Activity, Agent};
pub use claims::Claims;
pub use crew::{Crew, Group};
pub use progress::Progress;
pub use round::{FieldState, Fitness, return_cause, turn_back_cause, unfit_cause};
pub use scene::Scene;
pub use settle::Sharing;
pub use talks::{Deed, Endless, Join};

use crate::belief::Holder;
use crate::event::{Event, TurnBackCause};
use crate::ids::RobotId;
use crate::model::Model;
use talks::Talks;

/// How near a robot comes to its place at home or at a rest place, in metres.
const SLOT_M: f32 = 0.15;

/// How near a robot passes the places of its sweep, in metres.
const SWEEP_M: f32 = 0.8;

/// A robot that has known no route to its goal for this long, in seconds, gives up on the goal.
const GIVE_UP_S: f64 = 2.0;

/// A round that waits for its assignment.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Pending {
    question: Question,
    /// What each robot asks itself whose turn it is, where robots decide.
    turns: Vec<Question>,
    /// Robots that must rest during the round, and why.
    unfit: Vec<(RobotId, TurnBackCause)>,
}

/// The robots at home when a round opens. Who comes home later takes part in the next one.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
struct Gathered {
    home: Vec<RobotId>,
    /// Those of them that take part.
    fit: Vec<RobotId>,
    /// Those that must rest, and why.
    unfit: Vec<(RobotId, TurnBackCause)>,
}

/// The state of the mission of one trial.
#[derive(Serialize, Deserialize)]
pub struct Mission {
    /// What each robot is doing, and in which group.
    pub crew: Crew,
    /// Which robots claim which rescuees.
    pub claims: Claims,
    /// Number of the round, from 1; 0 before the first.
    pub round: u32,
    /// Why the mission is over, once it is.
    pub ending: Option<Ending>,
    pending: Option<Pending>,
    talks: Option<Talks>,
    /// No round opens before this step.
    waits_until: u64,
}

/// Why a mission ends before the duration of the trial.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ending {
    /// No robot that can carry is left.
    NobodyCanCarry,
    /// Nobody is left to bring home; or all errands are done or given up.
    Finished,
    /// No round can begin, and no robot gets anywhere.
    Standstill,
}

impl Mission {
    /// A mission in which all robots are at home, or on their errands.
    pub fn new(model: &Model) -> Self {
        let (crew, claims) = (Crew::new(model), Claims::nothing(model));
        Self { crew, claims, round: 0, ending: None, pending: None, talks: None, waits_until: 0 }
    }

    /// The question that waits for an assignment, if there is one.
    pub fn question(&self) -> Option<&Question> {
        self.pending.as_ref().map(|pending| &pending.question)
    }

    /// The state of the mission without the claims and the talks: a part of the hash chain.
    pub fn course(&self) -> impl Serialize + '_ {
        let Self { crew: Crew { agents, groups, .. }, claims, round, ending, pending, .. } = self;
        let pending = pending.as_ref().map(|pending| (&pending.question, &pending.unfit));
        (agents, groups, &claims.given_up, round, ending, pending)
    }

    /// How far the robots are in their talks before a round, until when they wait, and what they know of
    /// claims by radio: a part of the hash chain; `None` where they neither talk, nor have waited, nor know.
    pub fn talks(&self) -> Option<impl Serialize + '_> {
        let heard = self.claims.heard();
        let is_any = self.talks.is_some() || self.waits_until > 0 || heard.is_some();
        is_any.then_some((&self.talks, self.waits_until, heard))
    }

    /// Begins the decisions of a step: notes which robots are cut off, and ends and begins rounds. A new
    /// round waits for its assignment: see [`Mission::question`]. With `is_done`, nobody is left to bring
    /// home and no event is to come. Returns the robots that the base restocks.
    pub fn prepare(&mut self, is_done: bool, scene: &mut Scene) -> Vec<RobotId> {
        self.crew.look_for_guides(&scene.model.mission, &scene.beliefs.team);
        if !scene.model.errands.is_empty() {
            if self.crew.follow_errands(scene) {
                self.end(Ending::Finished, scene);
            }
        } else if self.round > 0 && is_done {
            self.come_home(scene);
        } else if scene.beliefs.team.iter().any(|robot| robot.is_able() && robot.can_carry()) {
            let crew = &mut self.crew;
            crew.note_progress(scene);
            if self.talks.is_some() {
                self.talk(scene);
                return Vec::new();
            }
            let is_due = scene.step >= self.waits_until;
            if is_due
                && crew.everybody_is_home(scene)
                && crew.can_begin_round(scene)
                && !crew.rest_first(scene)
            {
                self.end_round(scene);
                return self.open_round(scene);
            }
            if crew.is_at_a_standstill(scene) {
                self.end(Ending::Standstill, scene);
            }
        } else {
            self.end(Ending::NobodyCanCarry, scene);
        }
        Vec::new()
    }

    fn end(&mut self, ending: Ending, scene: &mut Scene) {
        self.ending = Some(ending);
        scene.log.push(match ending {
            Ending::NobodyCanCarry => Event::MissionOver,
            Ending::Finished => Event::Finished,
            Ending::Standstill => Event::Standstill,
        });
    }

    /// Ends the last round, and the mission once the robots that are still out have come home.
    fn come_home(&mut self, scene: &mut Scene) {
        self.crew.note_progress(scene);
        if scene.beliefs.ledger.is_open() && self.crew.everybody_is_home(scene) {
            self.end_round(scene);
        }
        if self.crew.all_stay(scene) {
            self.end(Ending::Finished, scene);
        }
    }

    /// Decides what every robot does next, and sets its goal.
    pub fn act(&mut self, scene: &mut Scene) {
        if self.ending.is_none() && scene.model.errands.is_empty() {
            self.turn_back(scene);
            for task in scene.model.task_ids() {
                self.call_back(task, scene);
            }
            let claims = match scene.model.mission.claims {
                ClaimRule::Known => self.claims.new_claims(&self.crew, scene),
                ClaimRule::ByRadio { .. } => self.claim_by_radio(scene),
            };
            let mut claims = claims.into_iter().peekable();
            for robot in (0..scene.beliefs.team.len() as u32).map(RobotId) {
                let claim = claims.next_if(|(by, _)| *by == robot).map(|(_, rescuee)| rescuee);
                self.choose_activity(robot, claim, scene);
            }
            self.tell_claims(scene);
        }
        for robot in &scene.beliefs.team {
            let goal = self.crew.goal_of(robot, scene.model, scene.beliefs);
            scene.navigator.set_goal(robot.id, goal);
        }
    }

    /// Sends robots that must leave the field to rest.
    fn turn_back(&mut self, scene: &mut Scene) {
        for id in 0..self.crew.agents.len() {
            let (robot, agent) = (&scene.beliefs.team[id], &self.crew.agents[id]);
            let underway = agent.activity.is_in_field()
                || agent.activity == Activity::Returning && agent.levels_at_start.is_some();
            if !robot.is_able() || !underway {
                continue;
            }
            let way = f64::from((robot.rest_slot(agent.rest_at) - robot.position).length());
            let way_cost = scene.way_cost(robot, way, self.crew.speed_of(scene.model, robot));
            let rules = &scene.model.mission;
            if let Some(cause) = turn_back_cause(rules, robot.energy, robot.hp, way_cost) {
                self.release_claim(RobotId(id as u32));
                self.crew.agents[id].go_to_rest();
                scene.log.push(Event::TurnedBack { robot: RobotId(id as u32), cause });
            }
        }
    }

    /// Calls a group home if it can do no more.
    fn call_back(&mut self, task: TaskId, scene: &mut Scene) {
        if !self.crew.groups[task.index()].at_work {
            return;
        }
        let Some(cause) = return_cause(&self.field_state(task, scene)) else { return };
        scene.log.push(Event::GroupReturned { task, cause });
        self.crew.groups[task.index()].at_work = false;
        for id in self.crew.in_field(task, &scene.beliefs.team).collect::<Vec<_>>() {
            self.release_claim(id);
            self.crew.agent(id).activity = Activity::Returning;
        }
    }

    /// Gives up the claim of a robot, if it has one.
    fn release_claim(&mut self, id: RobotId) {
        if let Some(rescuee) = self.crew.agents[id.index()].activity.claim() {
            self.claims.free(rescuee, id);
        }
    }

    fn field_state(&self, task: TaskId, scene: &Scene) -> FieldState {
        let mut field = FieldState::default();
        for id in self.crew.in_field(task, &scene.beliefs.team) {
            let (robot, agent) = (&scene.beliefs.team[id.index()], &self.crew.agents[id.index()]);
            field.carrying_members += u32::from(robot.can_carry());
            field.free_capacity += robot.free_capacity();
            field.resources += robot.resources;
            field.known_rescuees += u32::from(agent.activity.claim().is_some());
            field.still_searching += u32::from(!agent.sweep.is_empty());
        }
        if field.still_searching == 0 && field.known_rescuees == 0 {
            let sharing = scene.model.mission.belief_sharing;
            let knows = |id: RobotId| {
                let holder = Holder::of(sharing, id, task);
                let has_room = scene.beliefs.team[id.index()].free_capacity() > 0;
                has_room && self.claims.on_offer(task, holder, id, scene).next().is_some()
            };
            field.known_rescuees = u32::from(self.crew.in_field(task, &scene.beliefs.team).any(knows));
        }
        field
    }
}
