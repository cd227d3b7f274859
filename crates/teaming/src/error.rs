//! Errors of questions and of policies: one sentence each, for the person who can fix the input.

use rne_core::NeedsError;
use thiserror::Error;

use crate::levels::Level;
use crate::schema::{SCHEMA_VERSION, since};

/// A question that cannot be asked.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum QuestionError {
    /// Another version of the JSON form.
    #[error("schema_version must be {SCHEMA_VERSION}, found {found}{}", since(&found.to_string()))]
    Version {
        /// The version that was found.
        found: u32,
    },
    /// Text that is not the JSON of what is expected.
    #[error("not the JSON of a {what}: {reason}")]
    Json {
        /// What was expected.
        what: &'static str,
        /// Why it is not.
        reason: String,
    },
    /// No task, or too many.
    #[error("a question must have 1 to {} tasks, found {found}", crate::schema::MAX_TASKS)]
    Tasks {
        /// Number of tasks.
        found: usize,
    },
    /// A place that is NaN or infinite.
    #[error(
        "the place of task {task:?} must be two finite numbers of at most 1e100 in size, found {found:?}"
    )]
    Place {
        /// The task.
        task: String,
        /// Its place.
        found: [f64; 2],
    },
    /// A fact of a task that cannot be.
    #[error("{what} of task {task:?} must be finite and >= 0, found {found}")]
    Fact {
        /// The task.
        task: String,
        /// The field, or the need that the task requires.
        what: String,
        /// The value.
        found: f64,
    },
    /// A task requires a need that members do not report.
    #[error("task {task:?} requires {need:?}, which is not in the table of needs")]
    Requires {
        /// The task.
        task: String,
        /// The need.
        need: String,
    },
    /// A task comes after one that is not there.
    #[error("task {task:?} comes after task {found}, which is not in the table of tasks")]
    After {
        /// The task.
        task: String,
        /// The row that was named.
        found: u16,
    },
    /// A weight that is NaN, infinite or negative.
    #[error("the weight of need {need:?} must be a finite number >= 0, found {found}")]
    Weight {
        /// The need.
        need: String,
        /// The weight.
        found: f64,
    },
    /// The same id twice.
    #[error("robot id {id} stands twice in the team; ids must be unique")]
    DuplicateId {
        /// The id.
        id: u32,
    },
    /// A role that is not in the table.
    #[error("robot {id}: its role must be a row of the table of {roles} roles (from 0), found {found}")]
    Role {
        /// The robot.
        id: u32,
        /// Its role.
        found: u16,
        /// Rows of the table.
        roles: usize,
    },
    /// A robot's needs cannot be used.
    #[error("robot {id}: {source}")]
    Needs {
        /// The robot.
        id: u32,
        /// What is wrong with its needs.
        source: NeedsError,
    },
    /// A level that cannot be used.
    #[error("a level must have the unit \"%\" and finite numbers, found {0:?}")]
    Level(Level),
    /// The robot that asks is none of the members.
    #[error("asker must be one of the members, found robot {id}")]
    Asker {
        /// The robot.
        id: u32,
    },
    /// The body of a robot, or a report, in the evidence, cannot be used.
    #[error("evidence: {what} of robot {robot}: {reason}")]
    Evidence {
        /// What cannot be used.
        what: &'static str,
        /// The robot.
        robot: u32,
        /// The rule, and what was found.
        reason: String,
    },
    /// A fact that must be a finite number is not.
    #[error("{what} of robot {id} must be a finite number of at most 1e100 in size, found {found}")]
    NotFinite {
        /// The fact.
        what: String,
        /// The robot.
        id: u32,
        /// The value.
        found: f64,
    },
    /// There must be a quota for each role.
    #[error("there must be a quota for each of the {roles} roles, found {found}")]
    Quotas {
        /// Number of quotas.
        found: usize,
        /// Number of roles.
        roles: usize,
    },
    /// A quota does not share out the members of its role.
    #[error(
        "the quota of role {role:?} must share its {members} members out over all tasks, found {found:?}"
    )]
    Quota {
        /// The role.
        role: String,
        /// The quota.
        found: Vec<usize>,
        /// Members of the role.
        members: usize,
    },
}

/// A question that a policy cannot answer.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum PolicyError {
    /// The policy needs a fact that the question does not carry.
    #[error("policy {policy} needs {what}, which is missing{}", for_robot(*robot))]
    MissingFact {
        /// Name of the policy.
        policy: String,
        /// The fact ("the energy level", ...).
        what: &'static str,
        /// The robot that lacks it, if the fact belongs to one robot.
        robot: Option<u32>,
    },
    /// An estimator needs a level that the question does not carry.
    #[error("an estimate needs the level {level} of robot {robot}, which is missing")]
    Unestimated {
        /// The level.
        level: String,
        /// The robot that lacks it.
        robot: u32,
    },
    /// A policy would leave robots idle, and the question does not allow that.
    #[error("{policy} leaves robots idle, which this question does not allow; set mission.may_idle: true")]
    MayNotIdle {
        /// The policy as it was written.
        policy: String,
    },
    /// A robot's needs cannot be used by the policy.
    #[error("robot {id}: {source}")]
    Needs {
        /// The robot.
        id: u32,
        /// What is wrong with its needs.
        source: NeedsError,
    },
    /// The policy's options do not fit the question.
    #[error("options of the policy: {0}")]
    Options(NeedsError),
    /// The policy did not answer before its deadline.
    #[error("the policy did not answer in time")]
    Late,
    /// The policy did not answer within a time of its own, in its own words.
    #[error("{late}: {0}", late = Self::Late)]
    Slow(String),
    /// The policy plays the running trial on, and is asked outside of one.
    #[error("{policy} plays each assignment in the trial that asks; here is no trial")]
    NoTrial {
        /// Name of the policy.
        policy: String,
    },
    /// The policy stands behind the control `Truth`, and is asked where nobody tells it.
    #[error("Truth takes the levels of robots as they really are; here nobody knows them")]
    NoTruth,
    /// A protocol without a rule is asked for groups.
    #[error("a protocol groups nobody by itself: write RULE by PROTOCOL, and let robots decide")]
    NoRule,
    /// The policy is one of another program.
    #[error("this program does not have the policy {policy}: its results can be read, but not run again")]
    Absent {
        /// Name of the policy.
        policy: String,
    },
    /// The policy is a program, and nobody has allowed its command.
    #[error("it is a program that nobody has allowed: {command}; {hint}")]
    NotAllowed {
        /// The command.
        command: String,
        /// How a user allows it.
        hint: &'static str,
    },
    /// The policy gave up, in its own words.
    #[error("{0}")]
    Other(String),
}

/// An assignment that does not answer its question.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum AssignmentError {
    /// There must be a group for each task.
    #[error("an assignment must have a group for each of the {tasks} tasks, found {found}")]
    Groups {
        /// Number of groups.
        found: usize,
        /// Number of tasks.
        tasks: usize,
    },
    /// A robot in two groups, or twice in one.
    #[error("robot {robot} must be in exactly one group, found it twice")]
    Twice {
        /// The robot.
        robot: u32,
    },
    /// A robot that is not a member of the team.
    #[error("robot {robot} is not a member of the team that was to be grouped")]
    Stranger {
        /// The robot.
        robot: u32,
    },
    /// A member without a group.
    #[error("robot {robot} must be in exactly one group, found it in none")]
    Missing {
        /// The robot.
        robot: u32,
    },
    /// A robot is left idle, and the question does not allow that.
    #[error("robot {robot} is left idle, and this question does not allow that")]
    Idle {
        /// The robot.
        robot: u32,
    },
    /// All robots are left idle.
    #[error("an assignment must not leave all robots idle")]
    AllIdle,
    /// Groups of other sizes than the parts of a role.
    #[error("role {role:?} must be split into parts of {parts:?} members, found {found:?}")]
    Parts {
        /// The role.
        role: String,
        /// The sizes of its parts, ascending.
        parts: Vec<usize>,
        /// Its members in each group, ascending.
        found: Vec<usize>,
    },
    /// A group that does not keep a binding quota.
    #[error("task {task:?} must get {quota} members of role {role:?}, found {found}")]
    Quota {
        /// The task.
        task: String,
        /// The role.
        role: String,
        /// Members that it must get.
        quota: usize,
        /// Members that it got.
        found: usize,
    },
}

fn for_robot(robot: Option<u32>) -> String {
    robot.map(|id| format!(" for robot {id}")).unwrap_or_default()
}
