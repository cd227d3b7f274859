//! The answer to a question: which robots go to which task, the policy's own score of it, and its account of
//! the decision.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::de::IgnoredAny;
use serde::{Deserialize, Serialize};

use crate::error::AssignmentError;
use crate::estimate::Estimate;
use crate::ids::{RoleId, TaskId};
use crate::question::{GroupSizes, Question, SCHEMA_VERSION};
use rne_core::trust::RelativeNeedsEntropy;

/// Who goes to which task.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Assignment {
    /// For each task, in the order of the table, the ids of its group, ascending.
    pub groups: Vec<Vec<u32>>,
    /// The ids of the members that stay at home, where the question allows it.
    #[serde(default)]
    pub idle: Vec<u32>,
}

impl Assignment {
    /// Groups with their ids in any order; nobody is idle.
    #[must_use]
    pub fn new(groups: Vec<Vec<u32>>) -> Self {
        Self { groups, idle: Vec::new() }.sorted()
    }

    /// The same assignment with all ids in ascending order.
    #[must_use]
    pub fn sorted(mut self) -> Self {
        self.groups.iter_mut().chain([&mut self.idle]).for_each(|group| group.sort_unstable());
        self
    }

    /// The ids of one task's group.
    #[must_use]
    pub fn of(&self, task: TaskId) -> &[u32] {
        self.groups.get(task.index()).map_or(&[], Vec::as_slice)
    }

    /// The task of a robot, if it is in a group.
    #[must_use]
    pub fn task_of(&self, robot: u32) -> Option<TaskId> {
        let place = self.groups.iter().position(|group| group.contains(&robot))?;
        u16::try_from(place).ok().map(TaskId)
    }

    /// Checks that this answers a question: a group for each task, each member in exactly one or, where the
    /// question allows it, idle, and the quotas kept as far as they ask for it.
    ///
    /// # Errors
    /// What does not fit, with the robot or the task.
    pub fn check(&self, question: &Question) -> Result<(), AssignmentError> {
        let (found, tasks) = (self.groups.len(), question.tasks.len());
        if found != tasks {
            return Err(AssignmentError::Groups { found, tasks });
        }
        if let Some(robot) = self.idle.first().filter(|_| !question.may_idle) {
            return Err(AssignmentError::Idle { robot: *robot });
        }
        if !self.idle.is_empty() && self.groups.iter().all(Vec::is_empty) {
            return Err(AssignmentError::AllIdle);
        }
        let mut grouped: Vec<u32> = self.groups.iter().chain([&self.idle]).flatten().copied().collect();
        grouped.sort_unstable();
        if let Some(pair) = grouped.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(AssignmentError::Twice { robot: pair[0] });
        }
        let is_member = |id: u32| question.members.binary_search_by_key(&id, |member| member.id).is_ok();
        if let Some(robot) = grouped.iter().find(|id| !is_member(**id)) {
            return Err(AssignmentError::Stranger { robot: *robot });
        }
        if let Some(member) = question.members.iter().find(|m| grouped.binary_search(&m.id).is_err()) {
            return Err(AssignmentError::Missing { robot: member.id });
        }
        self.check_quotas(question)
    }

    fn check_quotas(&self, question: &Question) -> Result<(), AssignmentError> {
        for (role, quota) in question.role_ids().zip(&question.quotas) {
            let count =
                |group: &Vec<u32>| question.of_role(role).filter(|member| group.contains(&member.id)).count();
            let found: Vec<usize> = self.groups.iter().map(count).collect();
            let misses =
                |found: usize, wanted: usize| found > wanted || self.idle.is_empty() && found < wanted;
            let name = || question.roles[role.index()].clone();
            match quota.sizes {
                GroupSizes::Free => {}
                GroupSizes::Binding => {
                    let mut pairs = question.tasks.iter().zip(&found).zip(&quota.members);
                    if let Some(((task, found), quota)) =
                        pairs.find(|((_, found), quota)| misses(**found, **quota))
                    {
                        let (task, role) = (task.name.clone(), name());
                        return Err(AssignmentError::Quota { task, role, quota: *quota, found: *found });
                    }
                }
                GroupSizes::Parts => {
                    let [mut found, mut parts] = [found, quota.members.clone()];
                    found.sort_unstable();
                    parts.sort_unstable();
                    if found.iter().zip(&parts).any(|(found, part)| misses(*found, *part)) {
                        return Err(AssignmentError::Parts { role: name(), parts, found });
                    }
                }
            }
        }
        Ok(())
    }
}

/// A policy's answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Decision {
    /// Version of the JSON form: [`SCHEMA_VERSION`].
    #[serde(deserialize_with = "crate::question::this_version")]
    pub schema_version: u32,
    /// Who goes to which task.
    pub assignment: Assignment,
    /// What the policy maximised, by its own score: for RNE the sum over the pairs of groups, in nats. Absent
    /// for a policy that computes none, or where fewer than two groups have members.
    #[serde(default)]
    pub score: Option<RelativeNeedsEntropy>,
    /// False where the policy aims at the best by some measure, and has not proven that it found it.
    #[serde(default = "yes")]
    pub proven_optimal: bool,
    /// The next best assignments that the policy knows of, the best first.
    #[serde(default)]
    pub alternatives: Vec<Alternative>,
    /// How the policy came to its answer.
    #[serde(default)]
    pub account: Account,
    /// What was thought of each member, in the order of the members, where an estimator judged what robots
    /// said.
    #[serde(default)]
    pub believed: Option<Vec<Estimate>>,
}

/// The fields of a decision in JSON.
const FIELDS: [&str; 7] =
    ["schema_version", "assignment", "score", "proven_optimal", "alternatives", "account", "believed"];

/// Fields of older programs, which are not looked at.
const FORMER_FIELDS: [&str; 2] = ["upper_bound", "gap_percent"];

fn yes() -> bool {
    true
}

/// An assignment that was not chosen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Alternative {
    /// Who would have gone to which task.
    pub assignment: Assignment,
    /// Its score, as in [`Decision::score`].
    #[serde(default)]
    pub score: Option<RelativeNeedsEntropy>,
}

/// A policy's own account of its decision.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub enum Account {
    /// It gives none.
    #[default]
    None,
    /// It sorted the members of each role by one key.
    Ranking(Ranking),
    /// It searched for the largest Relative Needs Entropy, level by level.
    Rne(RneAccount),
    /// The robots would have come to it among themselves.
    Protocol(Protocol),
    /// In words.
    Text(String),
}

/// What robots send one another until they agree, on links that lose and delay nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Protocol {
    /// Rounds of messages, in each of which every link may carry one message in each direction.
    pub rounds: u64,
    /// Messages over one link each.
    pub messages: u64,
    /// Bytes of these messages, without headers.
    pub bytes: u64,
}

impl Protocol {
    /// Both exchanges, side by side: the longer one says when they are over.
    #[must_use]
    pub fn beside(self, other: Self) -> Self {
        Self {
            rounds: self.rounds.max(other.rounds),
            messages: self.messages + other.messages,
            bytes: self.bytes + other.bytes,
        }
    }
}

/// Members sorted by one key; the first go to the hardest task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Ranking {
    /// What they were sorted by.
    pub key: String,
    /// For each role, its members with the key's value, in their order.
    pub roles: Vec<Vec<Ranked>>,
}

/// A member in a ranking.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Ranked {
    /// The robot.
    pub id: u32,
    /// The key's value.
    pub value: f64,
}

/// How the RNE policy came to its groups.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RneAccount {
    /// The weight of each need after scaling.
    pub weights: Vec<f64>,
    /// The split of each role that has members.
    pub splits: Vec<RoleSplit>,
    /// The merge of each role after the first with the groups so far.
    pub merges: Vec<RoleMerge>,
    /// How well each group is suited for a hard task, by the hard rule.
    pub suitability: Vec<Suitability>,
}

/// How the members of one role were split into parts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RoleSplit {
    /// The role.
    pub role: RoleId,
    /// Ids of the parts, in the order of their smallest ids; empty parts last.
    pub parts: Vec<Vec<u32>>,
    /// Sum of the scores of all pairs of parts, in nats; absent where fewer than two have members.
    pub score: Option<RelativeNeedsEntropy>,
    /// The next best split that was looked at.
    pub runner_up: Option<SplitCandidate>,
    /// Splits that were looked at.
    pub searched: u64,
    /// Whether all were.
    pub proven_optimal: bool,
}

/// A split that was not chosen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SplitCandidate {
    /// Ids of the parts.
    pub parts: Vec<Vec<u32>>,
    /// Its score, in nats.
    pub score: Option<RelativeNeedsEntropy>,
}

/// How the parts of one role were matched with the groups so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RoleMerge {
    /// The role.
    pub role: RoleId,
    /// For each group so far, which part of the role joined it.
    pub matching: Vec<usize>,
    /// The score of the matching, in nats.
    pub score: Option<RelativeNeedsEntropy>,
    /// The next best matching and its score.
    pub runner_up: Option<MatchingCandidate>,
    /// Whether all matchings were looked at.
    pub proven_optimal: bool,
}

/// A matching that was not chosen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MatchingCandidate {
    /// For each group so far, which part of the role would have joined it.
    pub matching: Vec<usize>,
    /// Its score, in nats.
    pub score: Option<RelativeNeedsEntropy>,
}

/// How well one group is suited for a hard task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Suitability {
    /// The task that the group got.
    pub task: TaskId,
    /// The value: higher is better suited. Absent for an empty group, and where it is not finite.
    pub value: Option<f64>,
}

impl Decision {
    /// Groups without a score; nobody is idle.
    #[must_use]
    pub fn unscored(groups: Vec<Vec<u32>>) -> Self {
        Self::of(Assignment::new(groups))
    }

    /// An assignment without a score.
    #[must_use]
    pub fn of(assignment: Assignment) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            assignment,
            score: None,
            proven_optimal: true,
            alternatives: Vec::new(),
            account: Account::None,
            believed: None,
        }
    }

    /// Reads the JSON form; ids of a group may stand in any order.
    ///
    /// # Errors
    /// Text that is not the JSON of a decision, or another version.
    #[expect(clippy::zero_sized_map_values, reason = "only the names are looked at")]
    pub fn from_json(text: &str) -> Result<Self, crate::error::QuestionError> {
        use crate::error::QuestionError;
        let bad = |reason| QuestionError::Json { what: "decision", reason };
        let wrong = |error| bad(ron_tree::without_types(&error));
        let names: BTreeMap<String, IgnoredAny> = serde_json::from_str(text).map_err(wrong)?;
        let is_known = |name: &&String| FIELDS.iter().chain(&FORMER_FIELDS).any(|known| known == name);
        if let Some(name) = names.keys().find(|name| !is_known(name)) {
            return Err(bad(format!("unknown field `{name}`, expected one of `{}`", FIELDS.join("`, `"))));
        }
        let mut decision: Self = serde_json::from_str(text).map_err(wrong)?;
        let others = decision.alternatives.iter_mut().map(|other| &mut other.assignment);
        let all = std::iter::once(&mut decision.assignment).chain(others);
        all.for_each(|assignment| *assignment = std::mem::take(assignment).sorted());
        Ok(decision)
    }
}
