//! Schedules by a policy, which is asked whenever a robot becomes free.
//!
//! The question has the tasks that are not covered yet, and the robots whose skills some of them lack.
//! Roles are robots with the same skills, and needs are skills: 1 for a robot that has one. For each task
//! whose predecessors are covered, the group with which it starts the earliest says how many robots of
//! which role it gets; the policy says which. Robots are often fewer than such slots. Then a robot stands
//! in the question once for each turn that it could take, all at the place where it is: what its first turn
//! gets is what it does now, and the other turns are thrown away. If robots are more than slots, the rest
//! goes to the task `end`, and waits where it is. `end` is at the centre of the locations where robots end.
//! The longer a task and all after it take, the harder it is.
//!
//! Robots that go to a task are bound to it until it is over. A robot is not bound if this could end with
//! robots that wait for each other at different tasks. As long as an answer binds robots, the policy is
//! asked about those that are left.

use rne_core::{NeedVector, NeedsError};
use teaming::question::{Member, Need, RandomSeed, Task as Asked};
use teaming::session::TrialStart;
use teaming::{Assignment, AssignmentError, GroupSizes, PolicyError, Question};
use teaming::{QuestionError, Quota, RoleId, Session, TaskId};
use xxhash_rust::xxh3::xxh3_64;

use crate::problem::{Problem, Skills};
use crate::schedule::Schedule;

/// Most tasks in a question, without `end`.
const MOST: usize = teaming::question::MAX_TASKS - 1;

/// Why a policy makes no schedule.
#[derive(Debug, thiserror::Error)]
pub enum DispatchError {
    /// The policy does not answer.
    #[error(transparent)]
    Policy(#[from] PolicyError),
    /// It answers something else than it was asked.
    #[error("decision {decision}: {source}")]
    Assignment {
        /// Which decision, from 1.
        decision: u32,
        /// What does not fit.
        source: AssignmentError,
    },
    /// No question can be asked.
    #[error("no question can be made: {0}")]
    Question(#[from] QuestionError),
    /// A skill is no need.
    #[error("no question can be made: {0}")]
    Needs(#[from] NeedsError),
    /// All robots are idle, and tasks are left.
    #[error("decision {decision}: the policy leaves all robots idle, and tasks are left")]
    AllIdle {
        /// Which decision, from 1.
        decision: u32,
    },
}

/// The makespan of the schedule that a policy makes.
///
/// # Errors
/// The policy does not answer, or not so that all tasks are done.
pub fn dispatch(problem: &Problem, session: &mut dyn Session) -> Result<f64, DispatchError> {
    session.reset(&TrialStart { scenario: &problem.name, number: 0 })?;
    let mut schedule = Schedule::new(problem);
    let (mut now, mut decision) = (0.0, 0);
    while schedule.ends.iter().any(Option::is_none) {
        while let Some(turn) = Turn::of(&schedule, now, decision + 1)? {
            decision += 1;
            let answer = session.decide(&teaming::Asked::of(&turn.question))?.assignment;
            let refused = |source| DispatchError::Assignment { decision, source };
            answer.check(&turn.question).map_err(refused)?;
            if turn.carry_out(&answer, &mut schedule, now) == 0 {
                break;
            }
        }
        let later = (0..schedule.ready.len()).filter(|robot| !schedule.is_bound[*robot]);
        let later = later.map(|robot| schedule.ready[robot]).filter(|ready| *ready > now);
        let next = later.fold(f64::INFINITY, f64::min);
        if next == f64::INFINITY && schedule.ends.iter().any(Option::is_none) {
            return Err(DispatchError::AllIdle { decision });
        }
        now = next;
    }
    Ok(schedule.makespan())
}

/// A question, and what its rows stand for.
struct Turn {
    question: Question,
    /// The task of each row of tasks, without `end`.
    tasks: Vec<usize>,
    /// The robots that are free now; their ids in the question are their numbers here.
    free: Vec<usize>,
}

impl Turn {
    /// The question at a time; `None` if no free robot can do anything.
    fn of(schedule: &Schedule, now: f64, round: u32) -> Result<Option<Self>, DispatchError> {
        let problem = schedule.problem;
        let unbound = (0..problem.robots.len()).filter(|robot| !schedule.is_bound[*robot]);
        let (mut free, busy): (Vec<usize>, Vec<usize>) =
            unbound.partition(|robot| schedule.ready[*robot] <= now);
        let slots = slots(schedule, now);
        let is_asked = |skills: Skills| slots.iter().any(|slot| slot.skills == skills);
        free.retain(|robot| is_asked(problem.robots[*robot].skills));
        if free.is_empty() {
            return Ok(None);
        }
        let tasks = listed(schedule, &slots);
        let mut roles: Vec<Skills> = free.iter().map(|robot| problem.robots[*robot].skills).collect();
        roles.sort_unstable();
        roles.dedup();
        // For each role its robots, those that are free first.
        let mut rows: Vec<(usize, RoleId)> = Vec::new();
        let mut quotas = Vec::new();
        let of_role = |skills: Skills, robots: &[usize]| -> Vec<usize> {
            robots.iter().copied().filter(|robot| problem.robots[*robot].skills == skills).collect()
        };
        for robot in &free {
            let role = roles.iter().position(|skills| *skills == problem.robots[*robot].skills).unwrap_or(0);
            rows.push((*robot, RoleId(role as u16)));
        }
        for (role, skills) in (0..).map(RoleId).zip(&roles) {
            let count = |task: &usize| {
                slots.iter().filter(|slot| slot.task == *task && slot.skills == *skills).count()
            };
            let mut members: Vec<usize> = tasks.iter().map(count).collect();
            let wanted: usize = members.iter().sum();
            let there = [of_role(*skills, &free), of_role(*skills, &busy)].concat();
            let free_there = of_role(*skills, &free).len();
            let more = there.iter().cycle().take(wanted.max(there.len())).skip(free_there);
            rows.extend(more.map(|robot| (*robot, role)));
            members.push(there.len().saturating_sub(wanted));
            quotas.push(Quota { members, sizes: GroupSizes::Binding });
        }
        let mut asked = asked(problem, &tasks);
        if quotas.iter().all(|quota| quota.members.last() == Some(&0)) {
            asked.pop();
            quotas.iter_mut().for_each(|quota| quota.members.truncate(tasks.len()));
        }
        let question = Question {
            round,
            roles: roles.iter().map(|skills| format!("skills {}", names(problem, *skills))).collect(),
            needs: (0..problem.skills).map(|skill| Need { name: need(skill), weight: 1.0 }).collect(),
            tasks: asked,
            quotas,
            members: members(schedule, &rows)?,
            may_idle: true,
            random_seed: RandomSeed::from(xxh3_64(format!("{} {round}", problem.name).as_bytes())),
            ..Question::default()
        };
        Ok(Some(Self { question: question.checked()?, tasks, free }))
    }

    /// Binds free robots to their tasks. Returns how many are bound.
    fn carry_out(&self, answer: &Assignment, schedule: &mut Schedule, now: f64) -> usize {
        let mut count = 0;
        for (id, robot) in (0..).zip(&self.free) {
            let task = answer.task_of(id).and_then(|row| self.tasks.get(row.index()));
            let Some(task) = task.filter(|task| is_useful(schedule, *robot, **task)) else { continue };
            let mut bound = schedule.clone();
            bound.commit(*robot, *task, now);
            if bound.is_safe() {
                *schedule = bound;
                count += 1;
            }
        }
        count
    }
}

fn is_useful(schedule: &Schedule, robot: usize, task: usize) -> bool {
    let is_open = schedule.open().any(|open| open == task);
    is_open && schedule.missing(task) & schedule.problem.robots[robot].skills != 0
}

/// An open position in the group of a task, for a robot with these skills.
struct Slot {
    task: usize,
    start: f64,
    skills: Skills,
}

/// The positions in the groups with which open tasks start the earliest, if they can be taken now.
fn slots(schedule: &Schedule, now: f64) -> Vec<Slot> {
    let teams = schedule.open().filter_map(|task| schedule.team(task, now));
    let of_team = |team: crate::schedule::Team| {
        let can_join = |robot: &usize| {
            let mut bound = schedule.clone();
            bound.commit(*robot, team.task, now);
            bound.is_safe()
        };
        let joining = team.joining.into_iter().filter(can_join);
        let slot = |robot: usize| Slot {
            task: team.task,
            start: team.start,
            skills: schedule.problem.robots[robot].skills,
        };
        joining.map(slot).collect::<Vec<Slot>>()
    };
    let mut slots: Vec<Vec<Slot>> = teams.map(of_team).filter(|slots| !slots.is_empty()).collect();
    slots.sort_by(|a, b| a[0].start.total_cmp(&b[0].start));
    slots.into_iter().take(MOST).flatten().collect()
}

/// The tasks of a question: those with slots, and others that are not covered, in the order of the table.
fn listed(schedule: &Schedule, slots: &[Slot]) -> Vec<usize> {
    let mut tasks: Vec<usize> = slots.iter().map(|slot| slot.task).collect();
    tasks.dedup();
    let others = (0..schedule.ends.len()).filter(|task| schedule.ends[*task].is_none());
    let others: Vec<usize> = others.filter(|task| !tasks.contains(task)).take(MOST - tasks.len()).collect();
    tasks.extend(others);
    tasks.sort_unstable();
    tasks
}

/// The tasks as a policy sees them, and `end`.
fn asked(problem: &Problem, tasks: &[usize]) -> Vec<Asked> {
    let tails = problem.tails();
    let rank = |task: &usize| 1 + tasks.iter().filter(|other| tails[**other] < tails[*task]).count() as u32;
    let row = |task: &usize| tasks.iter().position(|other| other == task).map(|row| TaskId(row as u16));
    let of_task = |task: &usize| {
        let of = &problem.tasks[*task];
        let skills = (0..problem.skills).filter(|skill| of.requires >> skill & 1 == 1);
        Asked {
            place: Some(problem.places[task + 1]),
            requires: skills.map(|skill| (need(skill), 1.0)).collect(),
            duration_s: Some(of.duration),
            after: of.after.iter().filter_map(row).collect(),
            ..Asked::new(&format!("task {}", task + 1), rank(task))
        }
    };
    let end = Asked { place: Some(centre_of_ends(problem)), ..Asked::new("end", 0) };
    tasks.iter().map(of_task).chain([end]).collect()
}

/// The mean place of the locations where robots end.
fn centre_of_ends(problem: &Problem) -> [f64; 2] {
    let mut ends: Vec<usize> = problem.robots.iter().map(|robot| robot.end).collect();
    ends.sort_unstable();
    ends.dedup();
    let mean =
        |axis: usize| ends.iter().map(|end| problem.places[*end][axis]).sum::<f64>() / ends.len() as f64;
    [mean(0), mean(1)]
}

/// The rows of robots as members, numbered in this order.
fn members(schedule: &Schedule, rows: &[(usize, RoleId)]) -> Result<Vec<Member>, NeedsError> {
    let problem = schedule.problem;
    let member = |(id, (robot, role)): (u32, &(usize, RoleId))| {
        let has = |skill: usize| (problem.robots[*robot].skills >> skill & 1) as f64;
        Ok(Member {
            id,
            role: *role,
            home: problem.places[schedule.place[*robot]],
            needs: NeedVector::new((0..problem.skills).map(has).collect())?,
            levels: Vec::new(),
        })
    };
    (0..).zip(rows).map(member).collect()
}

fn need(skill: usize) -> String {
    format!("skill {}", skill + 1)
}

fn names(problem: &Problem, skills: Skills) -> String {
    let has = (0..problem.skills).filter(|skill| skills >> skill & 1 == 1);
    has.map(|skill| (skill + 1).to_string()).collect::<Vec<String>>().join(" and ")
}
