//! Grouping policies: how a mixed team is split over the easy and the hard task.

mod distance;
mod energy;
mod hp_distance;
mod random;
mod registry;
pub mod rne;
mod split;

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use crate::error::GroupingError;
use crate::needs::NeedVector;
use crate::trust::RelativeNeedsEntropy;

pub use registry::{policy_named, policy_names};
pub use rne::RneOptions;
pub use split::EXACT_ROLE_SIZE;

/// What a robot is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Role {
    /// Carries many rescuees, brings few resources.
    Carrier,
    /// Brings many resources, carries few rescuees.
    Supplier,
    /// Flies, sees far, carries nothing.
    Observer,
}

impl Role {
    /// All roles, in the order in which their halves are merged (Algorithm 1).
    pub const ALL: [Self; 3] = [Self::Carrier, Self::Supplier, Self::Observer];

    /// The role's name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Carrier => "Carrier",
            Self::Supplier => "Supplier",
            Self::Observer => "Observer",
        }
    }
}

/// One of the two tasks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Difficulty {
    /// Nearer, with less debris and radiation.
    Easy,
    /// Farther, with more debris and radiation.
    Hard,
}

impl Difficulty {
    /// Both tasks, the hard one first, as in the authors' tables.
    pub const ALL: [Self; 2] = [Self::Hard, Self::Easy];

    /// The task's name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Easy => "easy",
            Self::Hard => "hard",
        }
    }
}

/// What a policy may know of one robot when the team is grouped.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Unique in the team.
    pub id: u32,
    /// What the robot is for.
    pub role: Role,
    /// Initial position in the plane, in metres.
    pub position: [f64; 2],
    /// Needs in the order of [`crate::NEED_NAMES`]; every member of a team has the same number of needs.
    pub needs: NeedVector,
    /// Battery level in percent of the robot's own maximum.
    pub energy_level: Option<f64>,
    /// Health level in percent of the robot's own maximum.
    pub hp_level: Option<f64>,
}

/// Centres of the two task areas, in metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TaskPositions {
    /// Centre of the easy task's area.
    pub easy: [f64; 2],
    /// Centre of the hard task's area.
    pub hard: [f64; 2],
}

/// A team to be grouped: members in order of their ids, so that the order in which they were listed decides nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Team {
    members: Vec<Member>,
    tasks: Option<TaskPositions>,
}

impl Team {
    /// Takes the members, in any order. An empty team is allowed: its groups are empty.
    ///
    /// # Errors
    /// An id that stands twice, a position or level that is not finite, or members with different numbers of needs.
    pub fn new(mut members: Vec<Member>, tasks: Option<TaskPositions>) -> Result<Self, GroupingError> {
        members.sort_by_key(|member| member.id);
        let mut ids = BTreeSet::new();
        for member in &members {
            if !ids.insert(member.id) {
                return Err(GroupingError::DuplicateId { id: member.id });
            }
            check_finite(member)?;
            let expected = members[0].needs.values().len();
            crate::needs::check_length("needs", expected, member.needs.values().len())
                .map_err(|source| GroupingError::Needs { id: member.id, source })?;
        }
        Ok(Self { members, tasks })
    }

    /// The members, in order of their ids.
    #[must_use]
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// Where the tasks are, if it is known.
    #[must_use]
    pub fn tasks(&self) -> Option<TaskPositions> {
        self.tasks
    }

    /// The members of one role, in order of their ids.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = &Member> {
        self.members.iter().filter(move |member| member.role == role)
    }
}

fn check_finite(member: &Member) -> Result<(), GroupingError> {
    let facts = [
        ("x", Some(member.position[0])),
        ("y", Some(member.position[1])),
        ("energy_level", member.energy_level),
        ("hp_level", member.hp_level),
    ];
    match facts.into_iter().find_map(|(what, value)| Some((what, value.filter(|v| !v.is_finite())?))) {
        Some((what, found)) => Err(GroupingError::NotFinite { what, id: member.id, found }),
        None => Ok(()),
    }
}

/// How many robots of one role each task gets: halves, with an extra robot for the hard task where the count is odd.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RoleQuota {
    /// Robots for the easy task.
    pub easy: usize,
    /// Robots for the hard task.
    pub hard: usize,
}

impl RoleQuota {
    /// Halves of `count` robots.
    #[must_use]
    pub fn halves(count: usize) -> Self {
        Self { easy: count / 2, hard: count - count / 2 }
    }
}

/// The two groups that a policy formed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Grouping {
    /// Ids of the group for the easy task, ascending.
    pub easy: Vec<u32>,
    /// Ids of the group for the hard task, ascending.
    pub hard: Vec<u32>,
    /// RNE between the two groups, by the policy's own score; `None` for policies that compute none, or where a group is
    /// empty.
    pub score: Option<RelativeNeedsEntropy>,
    /// Whether every choice was searched exactly. `false` only for the RNE policy with more than [`EXACT_ROLE_SIZE`] robots in
    /// a role, where a local search is used.
    pub proven_optimal: bool,
}

impl Grouping {
    /// Groups without a score, ids in any order.
    #[must_use]
    pub fn unscored(mut easy: Vec<u32>, mut hard: Vec<u32>) -> Self {
        easy.sort_unstable();
        hard.sort_unstable();
        Self { easy, hard, score: None, proven_optimal: true }
    }

    /// The ids of one task's group.
    #[must_use]
    pub fn of(&self, task: Difficulty) -> &[u32] {
        match task {
            Difficulty::Easy => &self.easy,
            Difficulty::Hard => &self.hard,
        }
    }
}

/// A way to split a team over the two tasks.
///
/// A policy must put each member into exactly one group and must not depend on the order in which the members were listed.
/// It decides from the team and its draws alone: the same team and draws give the same groups, whatever it was asked before. Sweeps rely on that.
/// `draws` is a random stream of the policy's own, seeded per trial and round; most policies leave it alone.
pub trait GroupingPolicy: Send + Sync {
    /// Name on the command line, in scenarios and in tables.
    fn name(&self) -> &'static str;

    /// Splits the team.
    ///
    /// # Errors
    /// The team lacks a fact that the policy needs, or its needs cannot be used.
    fn group(&self, team: &Team, draws: &mut dyn rand::Rng) -> Result<Grouping, GroupingError>;
}

/// Per role, sorts by `better_first` and gives the upper half to the hard task.
fn upper_half_to_hard<K: PartialOrd>(
    team: &Team,
    key: impl Fn(&Member) -> Result<K, GroupingError>,
    better_first: impl Fn(&K, &K) -> std::cmp::Ordering,
) -> Result<Grouping, GroupingError> {
    let (mut easy, mut hard) = (Vec::new(), Vec::new());
    for role in Role::ALL {
        let mut ranked =
            team.of_role(role).map(|member| Ok((key(member)?, member.id))).collect::<Result<Vec<_>, _>>()?;
        ranked.sort_by(|a, b| better_first(&a.0, &b.0).then(a.1.cmp(&b.1)));
        let quota = RoleQuota::halves(ranked.len());
        hard.extend(ranked[..quota.hard].iter().map(|(_, id)| *id));
        easy.extend(ranked[quota.hard..].iter().map(|(_, id)| *id));
    }
    Ok(Grouping::unscored(easy, hard))
}

fn squared_distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    dx * dx + dy * dy
}

fn missing(policy: &'static str, what: &'static str, robot: Option<u32>) -> GroupingError {
    GroupingError::MissingFact { policy, what, robot }
}
