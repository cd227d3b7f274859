//! The question that a policy answers: the robots to be grouped, the tasks, and the outcomes of earlier
//! rounds.
//!
//! A question is complete: a policy is a function of its question, and random draws come from the question
//! too. Its JSON form is documented in `docs/decisions.md`.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use schemars::JsonSchema;
use serde::de::Error;
use serde::ser::SerializeStruct;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub use crate::schema::{MAX_TASKS, SCHEMA_VERSION};

use crate::error::QuestionError;
use crate::evidence::Evidence;
use crate::history::RoundOutcome;
use crate::ids::{LevelId, RoleId, TaskId, rows};
use crate::levels::{Level, Rest};
use rne_core::needs::{NeedVector, check_length};

/// A team to be grouped.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Question {
    /// Version of the JSON form: [`SCHEMA_VERSION`].
    #[serde(deserialize_with = "this_version")]
    pub schema_version: u32,
    /// Number of the round, from 1.
    pub round: u32,
    /// The robot that asks, one of the members, where robots decide among themselves; absent where the base
    /// asks. Nobody leaves it out of its team.
    #[serde(default)]
    pub asker: Option<u32>,
    /// Names of the roles, in the order of their table.
    pub roles: Vec<String>,
    /// The needs that members report, in the order of their table.
    pub needs: Vec<Need>,
    /// The levels that members have, in the order of their table.
    #[serde(default)]
    pub levels: Vec<Level>,
    /// What a rest fills.
    #[serde(default)]
    pub rest: Rest,
    /// The tasks, in the order of their table.
    pub tasks: Vec<Task>,
    /// For each role, how many members each task gets.
    pub quotas: Vec<Quota>,
    /// The members as reported, by id.
    pub members: Vec<Member>,
    /// Whether an answer may leave robots idle.
    #[serde(default)]
    pub may_idle: bool,
    /// The rounds that are over, the first one first.
    pub history: Vec<RoundOutcome>,
    /// Seed of the policy's own draws in this round.
    pub random_seed: RandomSeed,
    /// What the base heard of the robots, where reports may be late, lost, wrong or lies; absent where
    /// everybody knows how every robot is. The state of a trial has it elsewhere: it is in texts only.
    #[serde(default, deserialize_with = "evidence_of_text")]
    pub evidence: Option<Evidence>,
}

impl Question {
    /// The level of this name, if robots have it.
    #[must_use]
    pub fn level(&self, name: &str) -> Option<LevelId> {
        let place = self.levels.iter().position(|level| level.name == name)?;
        u16::try_from(place).ok().map(LevelId)
    }

    /// The level of this name of a member, if it is known.
    #[must_use]
    pub fn level_of(&self, member: &Member, name: &str) -> Option<f64> {
        member.level(self.level(name)?)
    }
}

impl Member {
    /// A level, if it is known.
    #[must_use]
    pub fn level(&self, level: LevelId) -> Option<f64> {
        *self.levels.get(level.index())?
    }
}

/// Reads the version, which stands before what differs between versions.
pub(crate) fn this_version<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    let found = u32::deserialize(deserializer)?;
    if found == SCHEMA_VERSION { Ok(found) } else { Err(D::Error::custom(QuestionError::Version { found })) }
}

/// Reads evidence from a text; in bytes it is never written.
fn evidence_of_text<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Evidence>, D::Error> {
    if deserializer.is_human_readable() { Option::deserialize(deserializer) } else { Ok(None) }
}

impl Default for Question {
    /// A question about nobody, to be filled in.
    fn default() -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            round: 1,
            asker: None,
            roles: Vec::new(),
            needs: Vec::new(),
            levels: Vec::new(),
            rest: Rest::All,
            tasks: Vec::new(),
            quotas: Vec::new(),
            members: Vec::new(),
            may_idle: false,
            history: Vec::new(),
            random_seed: RandomSeed::default(),
            evidence: None,
        }
    }
}

impl Serialize for Question {
    /// What is absent is left out of texts, and evidence of bytes.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let is_text = serializer.is_human_readable();
        let mut fields = serializer.serialize_struct("Question", 14)?;
        macro_rules! write {
            ($($field:ident)+) => { $(fields.serialize_field(stringify!($field), &self.$field)?;)+ };
        }
        write!(schema_version round);
        if !is_text || self.asker.is_some() {
            write!(asker);
        }
        write!(roles needs levels rest tasks quotas members may_idle history random_seed);
        if is_text && self.evidence.is_some() {
            write!(evidence);
        }
        fields.end()
    }
}

/// A need that members report.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Need {
    /// Its name.
    pub name: String,
    /// Its weight: finite and >= 0. Only the ratios of weights matter.
    pub weight: f64,
}

/// A task that a group is to be formed for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// Its name.
    pub name: String,
    /// Its rank: the harder the task, the higher. Of two tasks of one rank, the first in the table counts as
    /// harder.
    pub difficulty: u32,
    /// Centre of its area, in metres; absent where it is not known.
    #[serde(default)]
    pub place: Option<[f64; 2]>,
    /// Rescuees that wait there, as far as the team knows; absent where it does not know.
    #[serde(default)]
    pub rescuees: Option<u32>,
    /// What one rescuee of the task is worth, finite and >= 0; absent where the mission does not say.
    #[serde(default)]
    pub value: Option<f64>,
    /// The least that the needs of its group must add up to, by the names of needs. A wish of the mission: no
    /// answer is refused for it.
    #[serde(default)]
    pub requires: BTreeMap<String, f64>,
    /// How long its work is expected to take, in seconds, finite and >= 0; absent where nobody says.
    #[serde(default)]
    pub duration_s: Option<f64>,
    /// The tasks after which it should be done.
    #[serde(default)]
    pub after: Vec<TaskId>,
}

impl Task {
    /// A task of which no more is known than its name and its rank.
    #[must_use]
    pub fn new(name: &str, difficulty: u32) -> Self {
        Self {
            name: name.to_owned(),
            difficulty,
            place: None,
            rescuees: None,
            value: None,
            requires: BTreeMap::new(),
            duration_s: None,
            after: Vec::new(),
        }
    }
}

/// How many members of one role each task gets.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Quota {
    /// Members for each task, in the order of the table. They add up to the members of the role.
    pub members: Vec<usize>,
    /// How far an answer must keep these numbers.
    pub sizes: GroupSizes,
}

/// How far an answer must keep the numbers of the question's quotas. If robots are left idle, numbers may be
/// smaller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub enum GroupSizes {
    /// Task by task.
    Binding,
    /// As sizes of parts: the policy decides which task gets which part. The default.
    #[default]
    Parts,
    /// Not at all: they are a suggestion.
    Free,
}

/// What a robot reports of itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Member {
    /// Unique in the team.
    pub id: u32,
    /// Its role.
    pub role: RoleId,
    /// Initial position in the plane, in metres.
    pub home: [f64; 2],
    /// Its needs, in the order of the table of needs.
    pub needs: NeedVector,
    /// Its levels, in the order of the table of levels; null where one is not known. That of the battery is
    /// below 0 where robots go on with an empty one; their needs of energy are 0 then.
    #[serde(default)]
    pub levels: Vec<Option<f64>>,
}

/// Seed of a policy's draws: 32 bytes, in JSON 64 hexadecimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "String", into = "String")]
pub struct RandomSeed(#[schemars(with = "String")] pub [u8; 32]);

impl From<RandomSeed> for String {
    fn from(seed: RandomSeed) -> Self {
        let digit = |half: u8| char::from_digit(u32::from(half), 16).unwrap_or_default();
        seed.0.iter().flat_map(|byte| [digit(byte >> 4), digit(byte & 15)]).collect()
    }
}

impl TryFrom<String> for RandomSeed {
    type Error = BadSeed;

    fn try_from(text: String) -> Result<Self, BadSeed> {
        let mut seed = [0; 32];
        let is_hex = text.len() == 64 && text.bytes().all(|digit| digit.is_ascii_hexdigit());
        for (i, byte) in seed.iter_mut().enumerate().filter(|_| is_hex) {
            *byte = u8::from_str_radix(&text[2 * i..2 * i + 2], 16).unwrap_or_default();
        }
        if is_hex { Ok(Self(seed)) } else { Err(BadSeed) }
    }
}

/// A text that is no [`RandomSeed`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("random_seed must be 64 hexadecimal digits")]
pub struct BadSeed;

impl From<u64> for RandomSeed {
    fn from(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed).get_seed())
    }
}

/// Whether sums and squares of such numbers are finite.
fn is_usable(number: f64) -> bool {
    number.abs() <= 1e100
}

impl Question {
    /// Sorts the members and the bodies by their ids and checks that all parts are consistent.
    ///
    /// # Errors
    /// No task or too many; a duplicate id; a role, needs or quotas that do not fit their tables; a number
    /// that is not finite, or above 1e100 in size.
    pub fn checked(mut self) -> Result<Self, QuestionError> {
        self.members.sort_by_key(|member| member.id);
        if self.schema_version != SCHEMA_VERSION {
            return Err(QuestionError::Version { found: self.schema_version });
        }
        if self.tasks.is_empty() || self.tasks.len() > MAX_TASKS {
            return Err(QuestionError::Tasks { found: self.tasks.len() });
        }
        for task in &self.tasks {
            self.check_task(task)?;
        }
        if let Some(need) = self.needs.iter().find(|need| !need.weight.is_finite() || need.weight < 0.0) {
            return Err(QuestionError::Weight { need: need.name.clone(), found: need.weight });
        }
        if let Some(level) = self.levels.iter().find(|level| !level.is_usable()) {
            return Err(QuestionError::Level(level.clone()));
        }
        let mut ids = BTreeSet::new();
        for member in &self.members {
            if !ids.insert(member.id) {
                return Err(QuestionError::DuplicateId { id: member.id });
            }
            self.check_member(member)?;
        }
        if let Some(id) = self.asker.filter(|asker| !ids.contains(asker)) {
            return Err(QuestionError::Asker { id });
        }
        self.check_quotas()?;
        if let Some(evidence) = &mut self.evidence {
            evidence.check(self.needs.len(), self.levels.len())?;
        }
        Ok(self)
    }

    fn check_task(&self, task: &Task) -> Result<(), QuestionError> {
        if let Some(place) = task.place.filter(|place| !place.iter().copied().all(is_usable)) {
            return Err(QuestionError::Place { task: task.name.clone(), found: place });
        }
        let required = task.requires.iter().map(|(need, least)| (need.as_str(), *least));
        let facts = [("value", task.value), ("duration_s", task.duration_s)].into_iter();
        let mut facts = facts.filter_map(|(what, value)| Some((what, value?))).chain(required);
        if let Some((what, found)) = facts.find(|(_, value)| !value.is_finite() || *value < 0.0) {
            return Err(QuestionError::Fact { task: task.name.clone(), what: what.to_owned(), found });
        }
        let is_known = |name: &&String| self.needs.iter().any(|need| need.name == **name);
        if let Some(need) = task.requires.keys().find(|name| !is_known(name)) {
            return Err(QuestionError::Requires { task: task.name.clone(), need: need.clone() });
        }
        match task.after.iter().find(|other| other.index() >= self.tasks.len()) {
            Some(other) => Err(QuestionError::After { task: task.name.clone(), found: other.0 }),
            None => Ok(()),
        }
    }

    fn check_member(&self, member: &Member) -> Result<(), QuestionError> {
        let id = member.id;
        if member.role.index() >= self.roles.len() {
            return Err(QuestionError::Role { id, found: member.role.0, roles: self.roles.len() });
        }
        check_length("needs", self.needs.len(), member.needs.values().len())
            .and_then(|()| check_length("levels", self.levels.len(), member.levels.len()))
            .map_err(|source| QuestionError::Needs { id, source })?;
        let levels = self.levels.iter().map(|level| level.name.as_str()).zip(member.levels.iter().copied());
        let mut facts = ["x", "y"].into_iter().zip(member.home.map(Some)).chain(levels);
        match facts.find_map(|(what, value)| Some((what, value.filter(|v| !is_usable(*v))?))) {
            Some((what, found)) => Err(QuestionError::NotFinite { what: what.to_owned(), id, found }),
            None => Ok(()),
        }
    }

    fn check_quotas(&self) -> Result<(), QuestionError> {
        if self.quotas.len() != self.roles.len() {
            return Err(QuestionError::Quotas { found: self.quotas.len(), roles: self.roles.len() });
        }
        for (role, quota) in self.role_ids().zip(&self.quotas) {
            let members = self.of_role(role).count();
            let shared = quota.members.iter().try_fold(0, |sum: usize, share| sum.checked_add(*share));
            if quota.members.len() != self.tasks.len() || shared != Some(members) {
                let role = self.roles[role.index()].clone();
                return Err(QuestionError::Quota { role, found: quota.members.clone(), members });
            }
        }
        Ok(())
    }

    /// Reads the JSON form and checks it.
    ///
    /// # Errors
    /// Text that is not the JSON of a question, or a question that [`Question::checked`] refuses.
    pub fn from_json(text: &str) -> Result<Self, QuestionError> {
        let question: Self = serde_json::from_str(text).map_err(|error| QuestionError::Json {
            what: "question",
            reason: ron_tree::without_types(&error),
        })?;
        question.checked()
    }

    /// The ids of all roles, in the order of their table.
    pub fn role_ids(&self) -> impl Iterator<Item = RoleId> + use<> {
        rows(self.roles.len()).map(RoleId)
    }

    /// The ids of all tasks, in the order of their table.
    pub fn task_ids(&self) -> impl Iterator<Item = TaskId> + use<> {
        rows(self.tasks.len()).map(TaskId)
    }

    /// The tasks from the hardest to the easiest.
    #[must_use]
    pub fn hardest_first(&self) -> Vec<TaskId> {
        hardest_first(self.tasks.iter().map(|task| task.difficulty))
    }

    /// The members of one role, by id.
    pub fn of_role(&self, role: RoleId) -> impl Iterator<Item = &Member> {
        self.members.iter().filter(move |member| member.role == role)
    }

    /// The weight of each need.
    #[must_use]
    pub fn weights(&self) -> Vec<f64> {
        self.needs.iter().map(|need| need.weight).collect()
    }

    /// The same question for a program: its draws have a seed from which that of the trial does not follow.
    /// The same question gets the same one.
    #[must_use]
    pub fn sealed(&self) -> Self {
        let mut seed = [0; 32];
        self.draws().fill(&mut seed);
        Self { random_seed: RandomSeed(seed), ..self.clone() }
    }

    /// The random generator for this question's draws.
    #[must_use]
    pub fn draws(&self) -> ChaCha8Rng {
        ChaCha8Rng::from_seed(self.random_seed.0)
    }
}

/// The tasks with these difficulty ranks, from the hardest to the easiest. Among equal ranks, the first in
/// the table comes first.
#[must_use]
pub fn hardest_first(difficulties: impl Iterator<Item = u32>) -> Vec<TaskId> {
    let mut order: Vec<(Reverse<u32>, TaskId)> =
        difficulties.zip(0..).map(|(difficulty, task)| (Reverse(difficulty), TaskId(task))).collect();
    order.sort_unstable();
    order.into_iter().map(|(_, task)| task).collect()
}

impl Quota {
    /// Whether an answer must keep its numbers task by task.
    #[must_use]
    pub fn binds(&self) -> bool {
        self.sizes == GroupSizes::Binding
    }

    /// Shares `members` out over tasks, which are given from the hardest to the easiest. Some tasks may ask
    /// for a number of members.
    ///
    /// If no task asks for a number, the shares are as equal as possible, and the harder tasks get the extra
    /// members; an answer must keep them as far as `sizes` says. Otherwise the numbers bind: the tasks that
    /// ask are served first, and the rest is shared equally over the other
    /// tasks (over all tasks if every task asks). If there are too few members, each next member goes to the
    /// task with the smallest filled share; among equals, to the harder task.
    #[must_use]
    pub fn share(
        members: usize,
        asked: &[Option<usize>],
        hardest_first: &[TaskId],
        sizes: GroupSizes,
    ) -> Self {
        let sizes = if asked.iter().any(Option::is_some) { GroupSizes::Binding } else { sizes };
        let wanted = asked.iter().flatten().copied().fold(0, usize::saturating_add);
        let mut shares = vec![0; asked.len()];
        if members < wanted {
            fill_by_share(&mut shares, members, asked, hardest_first);
            return Self { members: shares, sizes };
        }
        for (share, asked) in shares.iter_mut().zip(asked) {
            *share = asked.unwrap_or(0);
        }
        let open = |task: &&TaskId| asked[task.index()].is_none() || asked.iter().all(Option::is_some);
        let receivers: Vec<TaskId> = hardest_first.iter().filter(open).copied().collect();
        let rest = members - wanted;
        for (rank, task) in receivers.iter().enumerate() {
            let extra = usize::from(rank < rest % receivers.len());
            shares[task.index()] += rest / receivers.len() + extra;
        }
        Self { members: shares, sizes }
    }

    /// The quotas of a team whose tasks ask for no number: as equal as possible.
    #[must_use]
    pub fn equal(counts: &[usize], hardest_first: &[TaskId]) -> Vec<Self> {
        counts
            .iter()
            .map(|count| {
                let asked = vec![None; hardest_first.len()];
                Self::share(*count, &asked, hardest_first, GroupSizes::Parts)
            })
            .collect()
    }
}

fn fill_by_share(shares: &mut [usize], members: usize, asked: &[Option<usize>], hardest_first: &[TaskId]) {
    for _ in 0..members {
        let filled = |task: &TaskId| {
            let asked = asked[task.index()].unwrap_or(0);
            if asked == 0 { f64::INFINITY } else { shares[task.index()] as f64 / asked as f64 }
        };
        let next = hardest_first.iter().min_by(|a, b| filled(a).total_cmp(&filled(b)));
        if let Some(task) = next {
            shares[task.index()] += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shares(members: usize, asked: &[Option<usize>]) -> Vec<usize> {
        let order = hardest_first([1, 3, 2][..asked.len()].iter().copied());
        Quota::share(members, asked, &order, GroupSizes::Parts).members
    }

    #[test]
    fn quotas_are_as_equal_as_possible_and_the_harder_tasks_get_the_extra_members() {
        assert_eq!(shares(6, &[None; 3]), [2, 2, 2]);
        assert_eq!(shares(7, &[None; 3]), [2, 3, 2]);
        assert_eq!(shares(8, &[None; 3]), [2, 3, 3]);
        assert_eq!(shares(1, &[None; 2]), [0, 1]);
        assert_eq!(shares(0, &[None; 2]), [0, 0]);
    }

    #[test]
    fn tasks_that_ask_for_a_number_are_served_first() {
        assert_eq!(shares(6, &[Some(1), None, None]), [1, 3, 2]);
        assert_eq!(shares(6, &[Some(1), Some(1), Some(1)]), [2, 2, 2]);
        assert_eq!(shares(3, &[Some(4), Some(2), None]), [2, 1, 0]);
        let order = hardest_first([1, 2].into_iter());
        let sizes = |asked, sizes| Quota::share(3, &[asked, None], &order, sizes).sizes;
        assert_eq!(sizes(Some(1), GroupSizes::Free), GroupSizes::Binding);
        assert_eq!(sizes(None, GroupSizes::Free), GroupSizes::Free);
    }

    #[test]
    fn the_hardest_task_comes_first_and_the_table_settles_ties() {
        assert_eq!(hardest_first([2, 3, 3, 1].into_iter()), [1, 2, 0, 3].map(TaskId));
    }

    #[test]
    fn a_sealed_question_does_not_show_the_seed_of_its_draws() {
        let question = Question { random_seed: RandomSeed([7; 32]), ..Question::default() };
        let sealed = question.sealed();
        assert_eq!((sealed.clone(), sealed.random_seed == question.random_seed), (question.sealed(), false));
        let shown = sealed.random_seed.0.windows(4).any(|part| part == [7; 4]);
        assert!(!shown, "a part of the seed is in the sealed one");
    }

    #[test]
    fn a_seed_has_a_json_form_of_64_digits() {
        let seed = RandomSeed::from(7);
        let text = serde_json::to_string(&seed).unwrap();
        assert_eq!(text.len(), 66);
        assert_eq!(serde_json::from_str::<RandomSeed>(&text).unwrap(), seed);
        assert!(serde_json::from_str::<RandomSeed>("\"abc\"").is_err());
    }
}
