//! Robots that decide take turns.

use std::collections::BTreeMap;

use teaming::protocol::MOST_STATE;
use teaming::{Act, Assignment, AssignmentError, Choice, Decision, Question, Turn};

use super::{AssignError, Simulation};
use crate::ids::RobotId;
use crate::mission::Deed;
use crate::record::Join;

/// Longest time for which a robot may sleep, in seconds.
const MOST_SLEEP_S: f64 = 86_400.0;

impl Simulation {
    /// Answers the [turns](super::Ask::Turns) of robots, in their order. Once all have decided, each goes to
    /// the group in which it saw itself. Groups may so have other sizes than the question says.
    ///
    /// # Errors
    /// It is nobody's turn, or an act cannot be done; nothing changes then. A robot that wakes up again and
    /// again in one step ends the trial as failed.
    pub fn act(&mut self, acts: Vec<Act>) -> Result<(), AssignError> {
        if self.turns.is_empty() || acts.len() != self.turns.len() {
            return Err(AssignError::NotAsked);
        }
        let deeds = self.turns.iter().zip(acts).map(|(turn, act)| self.deed(turn, act));
        let deeds = deeds.collect::<Result<_, _>>()?;
        let (mission, mut scene) = self.state.scene(&self.setup.model);
        if let Err(endless) = mission.act_in_turn(deeds, &mut scene) {
            let (field, rule) = ("wake_in_s", "not be 0 again and again".to_owned());
            let error = AssignError::Act { robot: endless.0.0, field, rule };
            self.failure = Some(error.to_string());
            return Err(error);
        }
        self.take_question();
        Ok(())
    }

    /// The turns of robots that wait for an answer.
    pub(super) fn due(&self) -> Vec<Turn> {
        self.state.mission.turns(|question| self.whole(question), self.model(), self.state.step)
    }

    /// What a robot does, once it is checked.
    fn deed(&self, turn: &Turn, mut act: Act) -> Result<Deed, AssignError> {
        let refused = |field, rule: String| Err(AssignError::Act { robot: turn.robot, field, rule });
        let is_long = |value: &serde_json::Value| value.to_string().len() > MOST_STATE;
        if is_long(&act.state) {
            return refused("state", "have at most 16 KiB of JSON".to_owned());
        }
        if act.says.iter().any(|say| is_long(&say.what)) {
            return refused("says", "have at most 16 KiB of JSON each".to_owned());
        }
        let robots = self.model().robots.len() as u32;
        let mut named = act.says.iter().filter_map(|say| say.to);
        if let Some(to) = named.find(|to| *to >= robots || *to == turn.robot) {
            return refused("says", format!("be to the number of another robot, found {to}"));
        }
        if let Some(found) = act.wake_in_s.filter(|seconds| !(0.0..=MOST_SLEEP_S).contains(seconds)) {
            return refused("wake_in_s", format!("be 0 to 86400, found {found}"));
        }
        if act.asks {
            return refused("asks", "be false: there is no rule before `by`".to_owned());
        }
        let tasks = self.model().tasks.len();
        if let Some(Choice::Group(task)) = &act.joins
            && task.index() >= tasks
        {
            let rule = format!("be the number of a task, 0 to {}, found {}", tasks - 1, task.0);
            return refused("joins", rule);
        }
        let sees = act.joins.take().and_then(|choice| choice.seen_by(turn.robot, tasks));
        if let Some(sees) = &sees {
            check(sees, turn.robot, tasks, robots)?;
        }
        let ages_s = if sees.is_some() { self.ages_s(&turn.question, turn.robot) } else { BTreeMap::new() };
        Ok(Deed { act, sees, ages_s })
    }

    /// How old what a robot last heard of the others is, in seconds; none for whom it never heard.
    fn ages_s(&self, question: &Question, robot: u32) -> BTreeMap<u32, Option<f64>> {
        let others = question.members.iter().map(|member| member.id).filter(|id| *id != robot);
        let age = |of: u32| match &self.state.telemetry {
            Some(telemetry) => telemetry.age_s(RobotId(robot), RobotId(of), self.time_s()),
            None => Some(0.0),
        };
        others.map(|of| (of, age(of))).collect()
    }

    /// Robots that have decided go.
    pub(super) fn depart(&mut self, joined: Vec<Join>) {
        let mut assignment = Assignment::new(vec![Vec::new(); self.model().tasks.len()]);
        for Join { robot, sees, .. } in &joined {
            match sees.task_of(*robot) {
                Some(task) => assignment.groups[task.index()].push(*robot),
                None => assignment.idle.push(*robot),
            }
        }
        self.group(Decision::of(assignment), joined);
    }
}

/// Whether a robot may see the groups so: each robot at most once, none that there is not, and itself. It may
/// see some that it would not have grouped itself, because it knows that they stay out.
fn check(sees: &Assignment, robot: u32, tasks: usize, robots: u32) -> Result<(), AssignmentError> {
    let found = sees.groups.len();
    if found != tasks {
        return Err(AssignmentError::Groups { found, tasks });
    }
    let mut named: Vec<u32> = sees.groups.iter().chain([&sees.idle]).flatten().copied().collect();
    named.sort_unstable();
    if let Some(pair) = named.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(AssignmentError::Twice { robot: pair[0] });
    }
    if let Some(stranger) = named.iter().find(|id| **id >= robots) {
        return Err(AssignmentError::Stranger { robot: *stranger });
    }
    if named.binary_search(&robot).is_err() { Err(AssignmentError::Missing { robot }) } else { Ok(()) }
}
