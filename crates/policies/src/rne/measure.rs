//! RNE as a trust measure: between robots, between groups, and need by need.

use std::collections::BTreeMap;

use super::scorer::{Scorer, add};
use super::{NAME, Rne, as_score, weighted_needs};
use rne_core::divergence::{relative_entropy, relative_entropy_by_need};
use rne_core::needs::{NeedDistribution, NeedVector, NeedWeights};
use rne_core::trust::RelativeNeedsEntropy;
use teaming::decision::Assignment;
use teaming::error::PolicyError;
use teaming::measure::{NeedPart, TeamTrust, TrustMeasure};
use teaming::question::Question;
use teaming::registry::MeasureKind;

/// The registry's line for the trust measure. It has the name and the options of the policy that groups by
/// it.
#[must_use]
pub fn measure_kind() -> MeasureKind {
    let about = "Relative Needs Entropy, in nats: how unlike two sides share out their needs";
    MeasureKind::with_options(NAME, about, Rne::new).from_sources(env!("SOURCES_RNE"))
}

impl TrustMeasure for Rne {
    fn unit(&self) -> &'static str {
        "nats"
    }

    fn of_team<'q>(&'q self, question: &'q Question) -> Result<Box<dyn TeamTrust + 'q>, PolicyError> {
        let weights = NeedWeights::new(self.weights(question)?).map_err(PolicyError::Options)?;
        let needs = question.members.iter().map(|member| (member.id, &member.needs)).collect();
        Ok(Box::new(InTeam { rne: self, question, weights, needs }))
    }
}

/// RNE in one team.
struct InTeam<'q> {
    rne: &'q Rne,
    question: &'q Question,
    weights: NeedWeights,
    needs: BTreeMap<u32, &'q NeedVector>,
}

impl InTeam<'_> {
    /// The distribution of a group, its members in the order of the question.
    fn distribution(&self, group: &[u32]) -> Result<NeedDistribution, PolicyError> {
        let needs = |id: &u32| self.needs.get(id).map(|needs| (*needs).clone());
        if let [one] = group
            && let Some(needs) = needs(one)
        {
            return NeedDistribution::of_agent(&needs, &self.weights)
                .map_err(|source| PolicyError::Needs { id: *one, source });
        }
        let members = self.question.members.iter().map(|member| member.id).filter(|id| group.contains(id));
        let needs: Vec<NeedVector> = members.filter_map(|id| needs(&id)).collect();
        NeedDistribution::of_group(&needs, &self.weights).map_err(PolicyError::Options)
    }
}

impl TeamTrust for InTeam<'_> {
    fn towards(&self, from: &[u32], to: &[u32]) -> Result<f64, PolicyError> {
        let rne = relative_entropy(&self.distribution(from)?, &self.distribution(to)?);
        Ok(rne.map_err(PolicyError::Options)?.nats().unwrap_or(f64::INFINITY))
    }

    /// The score as the policy with these options computes it.
    fn between(&self, assignment: &Assignment) -> Result<Option<f64>, PolicyError> {
        let score = self.rne.score(self.question, assignment)?;
        Ok(score.map(|rne| rne.nats().unwrap_or(f64::INFINITY)))
    }

    /// With the option `sort` shares are sorted before they are compared, so that they belong to no need.
    fn by_need(&self, from: &[u32], to: &[u32]) -> Result<Option<Vec<NeedPart>>, PolicyError> {
        if self.rne.options.sort {
            return Ok(None);
        }
        let (p, q) = (self.distribution(from)?, self.distribution(to)?);
        let adds = relative_entropy_by_need(&p, &q).map_err(PolicyError::Options)?;
        let shares = p.shares().iter().zip(q.shares());
        let part = |((p, q), adds): ((&f64, &f64), Option<f64>)| NeedPart {
            shares: [*p, *q],
            adds: adds.unwrap_or(f64::INFINITY),
        };
        Ok(Some(shares.zip(adds).map(part).collect()))
    }

    fn weights(&self) -> &[f64] {
        self.weights.values()
    }
}

impl Rne {
    /// The score of an assignment as this policy computes it: the sum over all pairs of groups, in nats.
    /// `None` where fewer than two groups have members.
    ///
    /// # Errors
    /// Those of [`teaming::Policy::decide`].
    pub fn score(
        &self,
        question: &Question,
        assignment: &Assignment,
    ) -> Result<Option<RelativeNeedsEntropy>, PolicyError> {
        let rows = weighted_needs(question, &self.weights(question)?)?;
        // The order of the groups matters if the score has a direction. They are sorted by their smallest ids
        // of the first role, as the policy forms them.
        let first_role = question.role_ids().find(|role| question.of_role(*role).next().is_some());
        let of_task = |group: &Vec<u32>| {
            let (mut sum, mut smallest) = (vec![0.0; question.needs.len()], u32::MAX);
            let members = question.members.iter().zip(&rows).filter(|(member, _)| group.contains(&member.id));
            for (member, row) in members {
                add(&mut sum, row);
                if Some(member.role) == first_role {
                    smallest = smallest.min(member.id);
                }
            }
            (smallest, sum)
        };
        let groups = assignment.groups.iter().filter(|group| !group.is_empty());
        let mut sums: Vec<(u32, Vec<f64>)> = groups.map(of_task).collect();
        sums.sort_by_key(|(smallest, _)| *smallest);
        let sums: Vec<Vec<f64>> = sums.into_iter().map(|(_, sum)| sum).collect();
        Ok(as_score(Scorer::new(self.options.score, self.options.sort).total(&sums, 0)))
    }
}
