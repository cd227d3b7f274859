//! `RNE`: groups by Relative Needs Entropy (the paper's Algorithms 1 to 5), with each ambiguity as a named option.
//!
//! Within each role the split into halves with the largest RNE between them; then carriers are merged with suppliers, and
//! the result with the observers. Which group takes the hard task is the [`HardRule`].

use serde::{Deserialize, Serialize};

use super::split::{Scorer, TIE_TOLERANCE, add, best_split};
use super::{Grouping, GroupingPolicy, Member, Role, Team, missing};
use crate::error::{GroupingError, NeedsError};
use crate::needs::{NeedWeights, check_length};
use crate::trust::{LogBase, RelativeNeedsEntropy};

/// Which RNE between two groups is maximised. RNE is not symmetric and the paper does not say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum ScoreDirection {
    /// The larger of the two directions. The default.
    #[default]
    MaxOfBoth,
    /// From the half with the lowest id to the other: Algorithm 3 called as in Algorithm 1, to the letter.
    FirstToSecond,
    /// The sum of both directions (Jeffreys).
    Sum,
    /// The Jensen-Shannon divergence.
    JensenShannon,
}

/// Which RNE decides how the halves of two roles are merged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum MergeReading {
    /// The RNE between the two merged groups, which stay apart. The default: "maximum trust level difference between each other".
    #[default]
    Apart,
    /// The RNE between two halves that are put together: the literal lines of Algorithm 1, which add `GRC(i, j)` for a pair (i, j) that
    /// becomes one group.
    Together,
}

/// Which of the two groups takes the hard task. Ties go to the group with the lowest id; a group that is empty takes the easy task.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum HardRule {
    /// The group whose members have the lower mean RNE to their own group's distribution (Def. 2), that is, the more trust
    /// within. The default: the text's words.
    #[default]
    IntraGroupTrust,
    /// The group with the larger sum of weighted needs, each need scaled by its maximum over the team.
    Capability,
    /// The group with the higher mean battery level.
    MeanEnergy,
    /// The group with the higher mean health level.
    MeanHp,
}

/// Options of the RNE policy. `docs/readings.md` tells why each default is what it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RneOptions {
    /// Base of the logarithm in which scores are printed.
    pub log_base: LogBase,
    /// Whether distributions are sorted before they are compared: Algorithm 4's last line to the letter, which compares needs of
    /// different kinds.
    pub sort: bool,
    /// Which RNE between two groups is maximised.
    pub score: ScoreDirection,
    /// Weight of each need; `None` means all 1.
    pub weights: Option<Vec<f64>>,
    /// Whether each need is divided by its maximum over the team first, so that no unit dominates.
    pub scale: bool,
    /// Which RNE decides how halves are merged.
    pub merge: MergeReading,
    /// Which group takes the hard task.
    pub hard_rule: HardRule,
}

impl Default for RneOptions {
    fn default() -> Self {
        Self {
            log_base: LogBase::E,
            sort: false,
            score: ScoreDirection::MaxOfBoth,
            weights: None,
            scale: true,
            merge: MergeReading::Apart,
            hard_rule: HardRule::IntraGroupTrust,
        }
    }
}

/// The RNE policy.
pub(super) struct Rne {
    options: RneOptions,
}

/// A group under construction: members as indices into the team, and the sum of their weighted needs.
#[derive(Clone)]
struct Half {
    members: Vec<usize>,
    sum: Vec<f64>,
}

impl Half {
    fn joined(&self, other: &Self) -> Self {
        let mut joined = self.clone();
        joined.members.extend(&other.members);
        add(&mut joined.sum, &other.sum);
        joined
    }
}

impl Rne {
    pub(super) fn new(options: RneOptions) -> Result<Self, GroupingError> {
        if let Some(weights) = &options.weights {
            NeedWeights::new(weights.clone()).map_err(GroupingError::Options)?;
        }
        Ok(Self { options })
    }

    /// The weighted needs of each member, in the team's order.
    fn weighted_needs(&self, team: &Team) -> Result<Vec<Vec<f64>>, GroupingError> {
        let members = team.members();
        let Some(first) = members.first() else { return Ok(Vec::new()) };
        let needs = first.needs.values().len();
        let mut weights = self.options.weights.clone().unwrap_or_else(|| vec![1.0; needs]);
        check_length("weights", needs, weights.len()).map_err(GroupingError::Options)?;
        if self.options.scale {
            scale_by_maximum(&mut weights, members);
        }
        let rows: Vec<Vec<f64>> = members
            .iter()
            .map(|member| member.needs.values().iter().zip(&weights).map(|(n, w)| n * w).collect())
            .collect();
        for (row, member) in rows.iter().zip(members) {
            let sum: f64 = row.iter().sum();
            let source = if sum == 0.0 {
                NeedsError::AllZero { what: "weighted needs" }
            } else if !sum.is_normal() || !(sum * rows.len() as f64).is_finite() {
                NeedsError::Overflow { found: sum }
            } else {
                continue;
            };
            return Err(GroupingError::Needs { id: member.id, source });
        }
        Ok(rows)
    }

    /// Of the two ways to merge the halves of two roles, the one with the larger RNE; ties go to first with first.
    fn merge(&self, a: &[Half; 2], b: &[Half; 2], scorer: &mut Scorer) -> [Half; 2] {
        let straight = [a[0].joined(&b[0]), a[1].joined(&b[1])];
        let crossed = [a[0].joined(&b[1]), a[1].joined(&b[0])];
        let (score_straight, score_crossed) = match self.options.merge {
            MergeReading::Apart => (
                scorer.score(&straight[0].sum, &straight[1].sum),
                scorer.score(&crossed[0].sum, &crossed[1].sum),
            ),
            MergeReading::Together => (
                scorer.score(&a[0].sum, &b[0].sum).max(scorer.score(&a[1].sum, &b[1].sum)),
                scorer.score(&a[0].sum, &b[1].sum).max(scorer.score(&a[1].sum, &b[0].sum)),
            ),
        };
        if score_crossed > score_straight + TIE_TOLERANCE { crossed } else { straight }
    }

    /// How well a group is suited for the hard task: higher is better, `None` for an empty group.
    fn suitability(
        &self,
        group: &Half,
        team: &Team,
        rows: &[Vec<f64>],
        scorer: &mut Scorer,
    ) -> Result<Option<f64>, GroupingError> {
        let members = || group.members.iter().map(|i| &team.members()[*i]);
        let mean = |sum: f64| sum / group.members.len() as f64;
        if group.members.is_empty() {
            return Ok(None);
        }
        let value = match self.options.hard_rule {
            HardRule::IntraGroupTrust => {
                -mean(group.members.iter().map(|i| scorer.directed(&rows[*i], &group.sum)).sum())
            }
            HardRule::Capability => {
                let mut weights = self.options.weights.clone().unwrap_or_else(|| vec![1.0; group.sum.len()]);
                scale_by_maximum(&mut weights, team.members());
                members()
                    .map(|m| m.needs.values().iter().zip(&weights).map(|(n, w)| n * w).sum::<f64>())
                    .sum()
            }
            HardRule::MeanEnergy => mean(sum_of(members(), "the energy level", |m| m.energy_level)?),
            HardRule::MeanHp => mean(sum_of(members(), "the HP level", |m| m.hp_level)?),
        };
        Ok(Some(value))
    }
}

impl GroupingPolicy for Rne {
    fn name(&self) -> &'static str {
        "RNE"
    }

    fn group(&self, team: &Team, _: &mut dyn rand::Rng) -> Result<Grouping, GroupingError> {
        let rows = self.weighted_needs(team)?;
        let mut scorer = Scorer::new(self.options.score, self.options.sort);
        let mut proven_optimal = true;
        let mut groups: Option<[Half; 2]> = None;
        for role in Role::ALL {
            let of_role: Vec<usize> = (0..rows.len()).filter(|i| team.members()[*i].role == role).collect();
            if of_role.is_empty() {
                continue;
            }
            let role_rows: Vec<Vec<f64>> = of_role.iter().map(|i| rows[*i].clone()).collect();
            let split = best_split(&role_rows, &mut scorer);
            proven_optimal &= split.proven_optimal;
            let halves = [split.first, split.second].map(|side| half_of(&side, &of_role, &rows));
            groups = Some(match groups {
                None => halves,
                Some(merged) => self.merge(&merged, &halves, &mut scorer),
            });
        }
        let Some([first, second]) = groups else { return Ok(Grouping::unscored(Vec::new(), Vec::new())) };
        let score = scorer.score(&first.sum, &second.sum);
        let suited = [
            self.suitability(&first, team, &rows, &mut scorer)?,
            self.suitability(&second, team, &rows, &mut scorer)?,
        ];
        let (hard, easy) =
            if first_takes_hard_task(suited, &first, &second) { (first, second) } else { (second, first) };
        let ids = |group: &Half| group.members.iter().map(|i| team.members()[*i].id).collect();
        let mut grouping = Grouping::unscored(ids(&easy), ids(&hard));
        grouping.score = (score != f64::NEG_INFINITY).then(|| RelativeNeedsEntropy::from_nats(score));
        grouping.proven_optimal = proven_optimal;
        Ok(grouping)
    }
}

/// Divides each weight by the need's maximum over the team; a need that nobody has gets weight 0.
fn scale_by_maximum(weights: &mut [f64], members: &[Member]) {
    for (k, weight) in weights.iter_mut().enumerate() {
        let maximum = members.iter().map(|member| member.needs.values()[k]).fold(0.0, f64::max);
        *weight = if maximum > 0.0 { *weight / maximum } else { 0.0 };
    }
}

fn half_of(side: &[usize], of_role: &[usize], rows: &[Vec<f64>]) -> Half {
    let members: Vec<usize> = side.iter().map(|i| of_role[*i]).collect();
    let mut sum = vec![0.0; rows[0].len()];
    for i in &members {
        add(&mut sum, &rows[*i]);
    }
    Half { members, sum }
}

fn sum_of<'a>(
    members: impl Iterator<Item = &'a Member>,
    what: &'static str,
    level: impl Fn(&Member) -> Option<f64>,
) -> Result<f64, GroupingError> {
    members.map(|member| level(member).ok_or_else(|| missing("RNE", what, Some(member.id)))).sum()
}

fn first_takes_hard_task(suited: [Option<f64>; 2], first: &Half, second: &Half) -> bool {
    match suited {
        [Some(a), Some(b)] if (a - b).abs() > TIE_TOLERANCE => a > b,
        [Some(_), Some(_)] => first.members.iter().min() < second.members.iter().min(),
        [first, _] => first.is_some(),
    }
}
