//! The history of a robot up to a moment.

use experiments::why::Exchange;
use serde::Serialize;
use teaming::{Decision, Question, TaskId};
use usar_sim::conflict::{Delay, DelayCause};
use usar_sim::event::{Event, TurnBackCause};
use usar_sim::ids::{RescueeId, RobotId};
use usar_sim::simulation::Simulation;
use usar_sim::world::RescueeState;

/// A robot that is observed while its trial is played.
pub(super) struct Watched {
    robot: RobotId,
    delay: Delay,
    since_s: f64,
    turned_back: Option<TurnedBack>,
}

/// A robot that turned back.
#[derive(Debug, Clone, Serialize)]
pub(super) struct TurnedBack {
    pub at_s: f64,
    pub cause: &'static str,
    /// Levels at that time, in percent.
    pub energy: f64,
    pub hp: f64,
}

/// The account of a robot.
#[derive(Serialize)]
pub(super) struct RobotStory {
    pub robot: u32,
    pub role: String,
    /// The task of its group.
    pub task: Option<String>,
    pub at_s: f64,
    /// Levels at this moment, in percent.
    pub energy: f64,
    pub hp: f64,
    pub speed_mps: f64,
    pub activity: &'static str,
    /// Its delay cause; `under_way` if nothing holds it up.
    pub delay: &'static str,
    pub waits_for: Option<u32>,
    /// Rescuees of its task that wait and that its group gave up on in this round.
    pub given_up: usize,
    /// Time when this delay began, in seconds.
    pub since_s: f64,
    /// The last time it turned back, if any.
    pub turned_back: Option<TurnedBack>,
    /// The scores after exchanges of places, the best first; empty for a policy that is not RNE.
    pub exchanges: Vec<Exchange>,
}

impl Watched {
    pub(super) fn new(robot: u32) -> Self {
        Self { robot: RobotId(robot), delay: Delay::default(), since_s: 0.0, turned_back: None }
    }

    pub(super) fn robot(&self) -> u32 {
        self.robot.0
    }

    /// Records a step.
    pub(super) fn listen(&mut self, simulation: &Simulation) {
        let delay = simulation.delay(self.robot);
        if (delay.cause, delay.waits_for) != (self.delay.cause, self.delay.waits_for) {
            (self.delay, self.since_s) = (delay, simulation.time_s());
        }
        for event in simulation.events() {
            if let Event::TurnedBack { robot, cause } = event
                && *robot == self.robot
            {
                let body = &simulation.world().robots[self.robot.index()];
                let cause = match cause {
                    TurnBackCause::Energy => "energy",
                    TurnBackCause::Hp => "hp",
                };
                let (energy, hp) = (body.energy, body.hp);
                self.turned_back = Some(TurnedBack { at_s: simulation.time_s(), cause, energy, hp });
            }
        }
    }

    pub(super) fn story(
        self,
        simulation: &Simulation,
        question: &Question,
        decision: &Decision,
        exchanges: Vec<Exchange>,
    ) -> RobotStory {
        let body = &simulation.world().robots[self.robot.index()];
        let member = question.members.iter().find(|member| member.id == self.robot.0);
        let role = member.map_or(String::new(), |member| question.roles[member.role.index()].clone());
        let task = decision.assignment.task_of(self.robot.0);
        RobotStory {
            robot: self.robot.0,
            role,
            task: task.map(|task| question.tasks[task.index()].name.clone()),
            at_s: simulation.time_s(),
            energy: body.energy,
            hp: body.hp,
            speed_mps: f64::from(body.velocity.length()),
            activity: simulation.mission().crew.agents[self.robot.index()].activity.name(),
            delay: self.delay.cause.name(),
            waits_for: self.delay.waits_for.map(|other| other.0),
            given_up: task.map_or(0, |task| given_up(simulation, task)),
            since_s: self.since_s,
            turned_back: self.turned_back,
            exchanges,
        }
    }
}

/// Rescuees of a task that wait and that its group gave up on in this round.
fn given_up(simulation: &Simulation, task: TaskId) -> usize {
    let of_task = simulation.model().tasks[task.index()].rescuees.clone();
    let is_waiting = |i: &usize| simulation.world().rescuees[*i].state == RescueeState::Waiting;
    let waiting = of_task.filter(is_waiting).map(|i| RescueeId(i as u32));
    waiting.filter(|rescuee| simulation.mission().claims.has_given_up(*rescuee)).count()
}

/// The explanation of a delay, as the continuation of "robot 3 ...".
pub(super) fn in_words(delay: &str, waits_for: Option<u32>) -> String {
    let other = waits_for.map_or("another robot".to_owned(), |id| format!("robot {id}"));
    let cause = DelayCause::ALL.into_iter().find(|cause| cause.name() == delay).unwrap_or_default();
    match cause {
        DelayCause::UnderWay => "is under way; nothing holds it up".to_owned(),
        DelayCause::NothingToDo => "is where it should be and has nothing to do".to_owned(),
        DelayCause::Loading => "takes a rescuee on board".to_owned(),
        DelayCause::Resting => "rests".to_owned(),
        DelayCause::RightOfWay => format!("yields to {other}, which has the right of way"),
        DelayCause::Blocked if waits_for.is_some() => format!("is blocked by {other}"),
        DelayCause::Blocked => "is blocked".to_owned(),
        DelayCause::MakingRoom => format!("makes room for {other}"),
        DelayCause::BackingOff => "backs off: its whole conflict set was deadlocked".to_owned(),
        DelayCause::NoRoute => "knows no way to where it should be".to_owned(),
        DelayCause::Stranded => "is stranded: its energy is 0".to_owned(),
        DelayCause::Disabled => "is disabled: its HP is 0".to_owned(),
    }
}
