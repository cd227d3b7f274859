//! What is done about trust before a policy is asked: nothing, or a robot that is not believed counts with
//! what others said, or stays at home.

use std::fmt;

use ron_tree::nearest;

use crate::error::PolicyError;
use crate::estimate::Estimate;
use crate::evidence::Body;
use crate::ids::RoleId;
use crate::question::{GroupSizes, Member, Question, Quota};
use crate::registry::{parts, read, written};
use rne_core::needs::NeedVector;

/// A robot with at least this trust is one of the trusted of its role.
pub const TRUSTED_FROM: f64 = 0.5;

/// Names of all uses.
const NAMES: [&str; 3] = ["Ignore", "Discount", "Exclude"];

/// A count that is this close to the next whole number is that number.
const ROUNDING: f64 = 1e-9;

/// What is done about trust.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum TrustUse {
    /// Nothing: the estimated levels and needs count, whoever said what.
    #[default]
    Ignore,
    /// A robot counts with `trust x own estimate + (1 - trust) x mean of the trusted of its role`, in its
    /// levels and in the needs that follow from them. Trusted are all with a trust of [`TRUSTED_FROM`] or
    /// more; in a role without them, the estimates stay.
    Discount,
    /// Robots that are not believed stay at home.
    Exclude(Exclude),
}

crate::options! {
    /// Which robots stay at home: those with the least trust first, in each role, but never the last member
    /// of the team that can carry or that guides, and never the robot that asks.
    #[derive(Copy)]
    pub struct Exclude {
        /// Robots with less trust than this, from 0 to 1.
        pub below: f64 = 0.3,
        /// At most this share of the members of a role, from 0 to 1, rounded down.
        pub most: f64 = 0.34,
    }
}

/// A question as it is asked after the trust was used.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// The question without the excluded robots, with estimates in the place of what was said.
    pub question: Question,
    /// Ids of the robots that stay at home, ascending.
    pub excluded: Vec<u32>,
}

impl TrustUse {
    /// Reads `Ignore`, `Discount` or `Exclude(below: 0.3, most: 0.34)`.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let [name, options] = parts(text);
        let found = match name {
            "Ignore" => Self::Ignore,
            "Discount" => Self::Discount,
            "Exclude" => return Exclude::parse(options).map(Self::Exclude),
            _ => {
                let meant = nearest(name, NAMES).map(|meant| format!("; did you mean {meant}?"));
                let known = NAMES.join(", ");
                return Err(format!(
                    "unknown use {name:?}; known uses: {known}{}",
                    meant.unwrap_or_default()
                ));
            }
        };
        let is_bare = ["", "()"].contains(&options.trim());
        if is_bare { Ok(found) } else { Err(format!("{name} has no options, found {options:?}")) }
    }

    /// Whether it leaves robots idle.
    #[must_use]
    pub fn leaves_idle(&self) -> bool {
        matches!(self, Self::Exclude(_))
    }

    /// The question with these estimates of its members.
    ///
    /// # Errors
    /// Needs that are no needs.
    pub fn judged(&self, question: &Question, estimates: Vec<Estimate>) -> Result<Judged, PolicyError> {
        let mut excluded = Vec::new();
        let estimates = match self {
            Self::Ignore => estimates,
            Self::Discount => discounted(question, estimates)?,
            Self::Exclude(rule) => {
                excluded = rule.excluded(question, &estimates);
                estimates
            }
        };
        let member = |(member, estimate): (&Member, Estimate)| Member {
            levels: estimate.levels.into_iter().map(Some).collect(),
            needs: estimate.needs,
            ..*member
        };
        let mut members: Vec<Member> = question.members.iter().zip(estimates).map(member).collect();
        members.retain(|member| excluded.binary_search(&member.id).is_err());
        let mut judged = Question { members, ..question.clone() };
        if !excluded.is_empty() {
            judged.quotas = quotas_of_fewer(&judged);
        }
        Ok(Judged { question: judged, excluded })
    }
}

impl fmt::Display for TrustUse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ignore => f.write_str("Ignore"),
            Self::Discount => f.write_str("Discount"),
            Self::Exclude(rule) => write!(f, "Exclude{}", written(rule)),
        }
    }
}

impl Exclude {
    fn parse(options: &str) -> Result<Self, String> {
        let rule: Self = match options.trim() {
            "" => Self::default(),
            text => read(text).map_err(|problem| format!("Exclude: {problem}"))?,
        };
        let shares = [("below", rule.below), ("most", rule.most)];
        match shares.into_iter().find(|(_, share)| !(0.0..=1.0).contains(share)) {
            Some((name, found)) => Err(format!("Exclude: {name} must be from 0 to 1, found {found}")),
            None => Ok(rule),
        }
    }

    /// The ids of the robots that stay at home, ascending.
    fn excluded(&self, question: &Question, estimates: &[Estimate]) -> Vec<u32> {
        let mut left = [0_usize; 3];
        for member in &question.members {
            left.iter_mut()
                .zip(abilities(question, member.id))
                .for_each(|(left, can)| *left += usize::from(can));
        }
        let mut excluded = Vec::new();
        for role in question.role_ids() {
            let (doubted, most) = self.doubted(question, estimates, role);
            let mut taken = 0;
            for id in doubted {
                let own = abilities(question, id);
                let is_last = own.iter().zip(left).any(|(can, left)| *can && left == 1);
                if taken < most && !is_last {
                    taken += 1;
                    excluded.push(id);
                    left.iter_mut().zip(own).for_each(|(left, can)| *left -= usize::from(can));
                }
            }
        }
        excluded.sort_unstable();
        excluded
    }

    /// The members of a role with too little trust, the least trusted first (ties: the lower id first), and
    /// how many of them may stay at home.
    fn doubted(&self, question: &Question, estimates: &[Estimate], role: RoleId) -> (Vec<u32>, usize) {
        let all = question.members.iter().zip(estimates).filter(|(member, _)| member.role == role);
        let all: Vec<(f64, u32)> = all.map(|(member, estimate)| (estimate.trust, member.id)).collect();
        let is_doubted = |(trust, id): &(f64, u32)| *trust < self.below && question.asker != Some(*id);
        let most = (self.most * all.len() as f64 + ROUNDING) as usize;
        let mut doubted: Vec<(f64, u32)> = all.into_iter().filter(is_doubted).collect();
        doubted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        (doubted.into_iter().map(|(_, id)| id).collect(), most)
    }
}

/// Whether a robot can carry, whether it guides, and that it is a member: of each the team keeps one.
fn abilities(question: &Question, robot: u32) -> [bool; 3] {
    let body = question.evidence.as_ref().and_then(|evidence| evidence.body(robot));
    let is = |able: fn(&Body) -> bool| body.is_some_and(able);
    [is(|body| body.carries), is(|body| body.guides), true]
}

/// The quotas of a question that has lost members: numbers that bind are shared by the smallest filled share,
/// others as equally as possible.
fn quotas_of_fewer(question: &Question) -> Vec<Quota> {
    let hardest_first = question.hardest_first();
    let fewer = |(role, quota): (RoleId, &Quota)| {
        let count = question.of_role(role).count();
        let asked = quota.members.iter().map(|members| quota.binds().then_some(*members));
        let shared = Quota::share(count, &asked.collect::<Vec<_>>(), &hardest_first, quota.sizes);
        if quota.sizes == GroupSizes::Free { Quota { sizes: quota.sizes, ..shared } } else { shared }
    };
    question.role_ids().zip(&question.quotas).map(fewer).collect()
}

/// The estimates, of which those with little trust are drawn towards the mean of the trusted of their role.
fn discounted(question: &Question, mut estimates: Vec<Estimate>) -> Result<Vec<Estimate>, PolicyError> {
    let means: Vec<Option<Mean>> =
        question.role_ids().map(|role| Mean::of_trusted(question, &estimates, role)).collect();
    for (member, estimate) in question.members.iter().zip(&mut estimates) {
        let Some(mean) = means.get(member.role.index()).and_then(Option::as_ref) else { continue };
        let trust = estimate.trust.clamp(0.0, 1.0);
        let mix = |own: f64, mean: f64| trust * own + (1.0 - trust) * mean;
        for (own, mean) in estimate.levels.iter_mut().zip(&mean.levels) {
            *own = mix(*own, *mean);
        }
        let body = question.evidence.as_ref().and_then(|evidence| evidence.body(member.id));
        let mut needs = estimate.needs.values().to_vec();
        for place in body.iter().flat_map(|body| &body.needs).map(|need| need.need.index()) {
            if let (Some(own), Some(mean)) = (needs.get_mut(place), mean.needs.get(place)) {
                *own = mix(*own, *mean);
            }
        }
        estimate.needs =
            NeedVector::new(needs).map_err(|source| PolicyError::Needs { id: member.id, source })?;
    }
    Ok(estimates)
}

/// The mean of some members.
struct Mean {
    levels: Vec<f64>,
    needs: Vec<f64>,
}

impl Mean {
    fn of_trusted(question: &Question, estimates: &[Estimate], role: RoleId) -> Option<Self> {
        let all = question.members.iter().zip(estimates).filter(|(member, _)| member.role == role);
        let trusted: Vec<&Estimate> =
            all.map(|(_, estimate)| estimate).filter(|estimate| estimate.trust >= TRUSTED_FROM).collect();
        let mean = |value: &dyn Fn(&Estimate) -> f64| {
            trusted.iter().map(|estimate| value(estimate)).sum::<f64>() / trusted.len() as f64
        };
        (!trusted.is_empty()).then(|| Self {
            levels: (0..question.levels.len()).map(|at| mean(&|estimate| estimate.levels[at])).collect(),
            needs: (0..question.needs.len()).map(|k| mean(&|estimate| estimate.needs.values()[k])).collect(),
        })
    }
}
