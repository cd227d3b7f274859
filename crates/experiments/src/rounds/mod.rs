//! Rounds as question and answer: what a split amounts to, and how another policy would have split the same
//! team.

mod levels;
mod sizes;
mod sorting;

use store::Failure;
use teaming::{Asked, Assignment, Decision, MadePolicy, Member, Question, RoleId, TaskId};
use usar_sim::robot::{ENERGY, HP};

pub use levels::{GroupLevels, levels, mean_levels};
pub use sizes::{OddSizes, odd_sizes};
pub use sorting::{KEYS, Key, Share, SortingAgreement, agreement};

use crate::run::Trial;
use crate::sweep::folder::Folder;

/// One round of one trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Round {
    /// Number of the trial, from 1.
    pub trial: u32,
    /// Seed of the trial.
    pub seed: u64,
    /// The question.
    pub question: Question,
    /// The answer.
    pub decision: Decision,
    /// The members as they really were, by id.
    pub team: Vec<Member>,
}

/// The rounds of a trial.
pub fn rounds_of(number: u32, trial: &Trial) -> impl Iterator<Item = Round> + '_ {
    trial.record.decisions.iter().map(move |asked| Round {
        trial: number,
        seed: trial.record.seed,
        question: trial.record.question(asked),
        decision: asked.decision.clone(),
        team: asked.team().to_vec(),
    })
}

/// All rounds of one policy of a sweep.
///
/// # Errors
/// The journal cannot be read.
pub fn rounds_in(folder: &mut Folder, case: usize, policy: usize) -> Result<Vec<Round>, Failure> {
    let mut rounds = Vec::new();
    for place in folder.places(case, policy) {
        if let Ok(trial) = folder.outcome(place)?.result {
            rounds.extend(rounds_of(place.2, &trial));
        }
    }
    Ok(rounds)
}

impl Round {
    /// How another policy would have grouped this team.
    ///
    /// # Errors
    /// The policy cannot group this team.
    pub fn grouped_by(&self, policy: &MadePolicy) -> Result<Assignment, Failure> {
        let asked = Asked::of(&self.question).knowing(&self.team);
        Ok(policy.open().and_then(|mut it| it.decide(&asked)).map_err(Failure::run)?.assignment)
    }

    /// The question as it would have been if all members had been reported as they were.
    pub fn true_question(&self) -> Question {
        Question { members: self.team.clone(), ..self.question.clone() }
    }

    /// The members of a role, by id.
    pub fn of_role(&self, role: RoleId) -> impl Iterator<Item = &Member> {
        self.team.iter().filter(move |member| member.role == role)
    }

    /// The members of a task's group, by id.
    pub fn group(&self, task: TaskId) -> impl Iterator<Item = &Member> {
        let group = self.decision.assignment.of(task);
        self.team.iter().filter(move |member| group.contains(&member.id))
    }

    /// The tasks whose groups have members, from the hardest to the easiest.
    pub fn tasks(&self) -> Vec<TaskId> {
        let has_members = |task: &TaskId| !self.decision.assignment.of(*task).is_empty();
        self.question.hardest_first().into_iter().filter(has_members).collect()
    }

    /// Whether an assignment equals this round's: first with the same tasks, second as a split, regardless
    /// of which group takes which task.
    pub fn is_as(&self, assignment: &Assignment) -> [bool; 2] {
        let sorted = |assignment: &Assignment| {
            let mut groups = assignment.groups.clone();
            groups.sort();
            groups
        };
        let own = &self.decision.assignment;
        [own == assignment, sorted(own) == sorted(assignment)]
    }
}

/// Battery level of a member, in percent.
pub fn energy(member: &Member) -> f64 {
    member.level(ENERGY).unwrap_or(0.0)
}

/// Health level of a member, in percent.
pub fn hp(member: &Member) -> f64 {
    member.level(HP).unwrap_or(0.0)
}

#[cfg(test)]
pub(crate) mod testing {
    use rne_core::NeedVector;
    use teaming::question::hardest_first;
    use teaming::{Decision, Level, Member, Need, Question, Quota, RandomSeed, RoleId, Task};

    use super::Round;

    /// Robots of one role, each with its levels (energy, HP) and the number of its task; the first task is
    /// the harder one.
    pub(crate) fn round(robots: &[(f64, f64, usize)]) -> Round {
        let member = |(id, (energy, hp, _)): (u32, &(f64, f64, usize))| Member {
            id,
            role: RoleId(0),
            home: [0.0, 0.0],
            needs: NeedVector::new(vec![*hp, *energy]).unwrap(),
            levels: vec![Some(*energy), Some(*hp)],
        };
        let ids = |task: usize| {
            let of_task = (0..).zip(robots).filter(|(_, robot)| robot.2 == task);
            of_task.map(|(id, _)| id).collect::<Vec<u32>>()
        };
        let tasks = vec![Task::new("far", 2), Task::new("near", 1)];
        let order = hardest_first(tasks.iter().map(|task| task.difficulty));
        let question = Question {
            roles: vec!["walker".into()],
            needs: ["hp", "eng"].map(|name| Need { name: name.into(), weight: 1.0 }).to_vec(),
            tasks,
            quotas: Quota::equal(&[robots.len()], &order),
            members: (0..).zip(robots).map(member).collect(),
            levels: Level::energy_and_hp(),
            random_seed: RandomSeed::from(1),
            ..Question::default()
        };
        let (decision, team) = (Decision::unscored(vec![ids(0), ids(1)]), question.members.clone());
        Round { trial: 3, seed: 7, question, decision, team }
    }
}
