//! The RNE policy by its definition: an exhaustive search that is not fast. It uses only the distributions
//! and divergences of the crate.

use policies::RneOptions;
use policies::rne::{HardRule, MergeReading, ScoreDirection};
use rne_core::{
    NeedDistribution, NeedVector, NeedWeights, RelativeNeedsEntropy, jeffreys, jensen_shannon,
    relative_entropy,
};
use teaming::{Member, Question, RoleId};

/// Scores that differ by less than this are equal.
const TIE: f64 = 1e-12;

pub type Groups = Vec<Vec<u32>>;

pub struct Oracle<'a> {
    pub question: &'a Question,
    pub options: RneOptions,
    pub weights: NeedWeights,
}

impl<'a> Oracle<'a> {
    pub fn new(question: &'a Question, options: RneOptions) -> Self {
        let needs = 0..question.needs.len();
        let weights = needs.map(|k| if options.scale { scale(question, k) } else { 1.0 });
        let weights = NeedWeights::new(weights.collect()).unwrap();
        Self { question, options, weights }
    }

    fn member(&self, id: u32) -> &Member {
        self.question.members.iter().find(|member| member.id == id).unwrap()
    }

    fn ids(&self, role: RoleId) -> Vec<u32> {
        self.question.of_role(role).map(|member| member.id).collect()
    }

    fn distribution(&self, ids: &[u32]) -> NeedDistribution {
        let needs: Vec<NeedVector> = ids.iter().map(|id| self.member(*id).needs.clone()).collect();
        let distribution = NeedDistribution::of_group(&needs, &self.weights).unwrap();
        if self.options.sort { distribution.sorted() } else { distribution }
    }

    fn pair(&self, one: &[u32], other: &[u32]) -> f64 {
        let (p, q) = (self.distribution(one), self.distribution(other));
        let directed = |p, q| relative_entropy(p, q).unwrap().nats().unwrap_or(f64::INFINITY);
        match self.options.score {
            ScoreDirection::MaxOfBoth => directed(&p, &q).max(directed(&q, &p)),
            ScoreDirection::FirstToSecond => directed(&p, &q),
            ScoreDirection::Sum => jeffreys(&p, &q).unwrap().nats().unwrap_or(f64::INFINITY),
            ScoreDirection::JensenShannon => jensen_shannon(&p, &q).unwrap(),
        }
    }

    /// The sum over all pairs of groups that have members; minus infinity if there is no such pair.
    pub fn total(&self, groups: &[Vec<u32>]) -> f64 {
        let filled: Vec<&Vec<u32>> = groups.iter().filter(|group| !group.is_empty()).collect();
        let pairs = (0..filled.len()).flat_map(|i| (i + 1..filled.len()).map(move |j| (i, j)));
        let scores = pairs.map(|(i, j)| self.pair(filled[i], filled[j]));
        scores.reduce(|sum, score| sum + score).unwrap_or(f64::NEG_INFINITY)
    }

    /// All splits of a role with their scores.
    pub fn splits(&self, role: RoleId) -> Vec<(Groups, f64)> {
        let sizes = &self.question.quotas[role.index()].members;
        let all = partitions(&self.ids(role), sizes).into_iter();
        all.map(|parts| (parts.clone(), self.total(&parts))).collect()
    }

    /// The groups, before they get their tasks.
    pub fn groups(&self) -> Groups {
        let roles = self.question.role_ids().filter(|role| !self.ids(*role).is_empty());
        let mut merged: Option<Groups> = None;
        for role in roles {
            let parts = first_best(self.splits(role));
            merged = Some(match merged {
                None => parts,
                Some(groups) => first_best(self.matchings(&groups, &parts)),
            });
        }
        merged.unwrap_or_else(|| vec![Vec::new(); self.question.tasks.len()])
    }

    /// All merges that keep binding quotas, with their scores.
    pub fn matchings(&self, groups: &[Vec<u32>], parts: &[Vec<u32>]) -> Vec<(Groups, f64)> {
        let orders = permutations(&(0..parts.len()).collect::<Vec<_>>()).into_iter();
        let merged = orders.map(|order| {
            let pairs = || groups.iter().zip(order.iter().map(|part| &parts[*part]));
            let merged: Groups = pairs().map(|(group, part)| [&group[..], part].concat()).collect();
            let score = match self.options.merge {
                MergeReading::Apart => self.total(&merged),
                MergeReading::Together => pairs()
                    .filter(|(group, part)| !group.is_empty() && !part.is_empty())
                    .map(|(group, part)| self.pair(group, part))
                    .fold(f64::NEG_INFINITY, f64::max),
            };
            (merged, score)
        });
        merged.filter(|(merged, _)| self.fits_in_some_order(merged)).collect()
    }

    /// Whether the groups fit some order of tasks whose binding quotas they keep, for the roles merged so
    /// far.
    fn fits_in_some_order(&self, groups: &[Vec<u32>]) -> bool {
        let tasks: Vec<usize> = (0..groups.len()).collect();
        permutations(&tasks)
            .iter()
            .any(|tasks| groups.iter().zip(tasks).all(|(g, t)| self.fits(groups, g, *t)))
    }

    fn fits(&self, all: &[Vec<u32>], group: &[u32], task: usize) -> bool {
        let count = |ids: &[u32], role| ids.iter().filter(|id| self.member(**id).role == role).count();
        let roles = self.question.role_ids().zip(&self.question.quotas);
        let mut binding = roles.filter(|(role, quota)| quota.binds() && count(&all.concat(), *role) > 0);
        binding.all(|(role, quota)| count(group, role) == quota.members[task])
    }

    /// The groups by task. From the hardest task on, each task takes the best-suited group that is left;
    /// among equals, the group with the lowest id.
    pub fn by_task(&self, groups: &[Vec<u32>]) -> Groups {
        let mut left: Groups = groups.to_vec();
        left.iter_mut().for_each(|group| group.sort_unstable());
        let mut by_task = vec![Vec::new(); groups.len()];
        for task in self.question.hardest_first() {
            let may = |group: &&Vec<u32>| self.fits(groups, group, task.index());
            let most = left.iter().filter(may).map(|group| self.suitability(group)).fold(f64::MIN, f64::max);
            let best = left.iter().filter(may).filter(|group| self.suitability(group) >= most - TIE);
            let Some(best) = best.min_by_key(|group| group.first().copied()).cloned() else { continue };
            left.remove(left.iter().position(|group| *group == best).unwrap());
            by_task[task.index()] = best;
        }
        by_task
    }

    pub fn suitability(&self, group: &[u32]) -> f64 {
        let mean = |value: &dyn Fn(&Member) -> f64| {
            group.iter().map(|id| value(self.member(*id))).sum::<f64>() / group.len() as f64
        };
        if group.is_empty() {
            return f64::MIN;
        }
        let capability = |member: &Member| {
            let needs = member.needs.values().iter().enumerate();
            needs.map(|(k, need)| need * scale(self.question, k)).sum::<f64>()
        };
        let own = self.distribution(group);
        let distrust = |m: &Member| {
            relative_entropy(&self.distribution(&[m.id]), &own).unwrap().nats().unwrap_or(f64::INFINITY)
        };
        match self.options.hard_rule {
            HardRule::IntraGroupTrust => -mean(&distrust),
            HardRule::Capability => group.len() as f64 * mean(&capability),
            HardRule::MeanEnergy => mean(&|member| member.levels[0].unwrap()),
            HardRule::MeanHp => mean(&|member| member.levels[1].unwrap()),
        }
    }
}

/// The factor of a need that keeps any unit from dominating.
fn scale(question: &Question, k: usize) -> f64 {
    let maximum = question.members.iter().map(|member| member.needs.values()[k]).fold(0.0, f64::max);
    if maximum > 0.0 { 1.0 / maximum } else { 1.0 }
}

/// Whether two scores are the same up to rounding.
pub fn is_close(found: f64, expected: f64) -> bool {
    found.total_cmp(&expected).is_eq() || (found - expected).abs() < 1e-11
}

/// A score as a number; minus infinity if there is none.
pub fn nats(score: Option<RelativeNeedsEntropy>) -> f64 {
    score.map_or(f64::NEG_INFINITY, |score| score.nats().unwrap_or(f64::INFINITY))
}

/// The first of the best groups.
fn first_best(all: Vec<(Groups, f64)>) -> Groups {
    let best = all.into_iter().reduce(|best, next| if next.1 > best.1 + TIE { next } else { best });
    best.unwrap().0
}

/// All partitions of these ascending ids into sets of these sizes. Sets are in the order of their smallest
/// ids; empty sets come last.
pub fn partitions(ids: &[u32], sizes: &[usize]) -> Vec<Groups> {
    let Some((first, rest)) = ids.split_first() else { return vec![vec![Vec::new(); sizes.len()]] };
    let mut all = Vec::new();
    let mut distinct: Vec<usize> = sizes.iter().copied().filter(|size| *size > 0).collect();
    distinct.sort_unstable();
    distinct.dedup();
    for size in distinct {
        let mut other_sizes = sizes.to_vec();
        other_sizes.remove(sizes.iter().position(|other| *other == size).unwrap());
        for chosen in subsets(rest, size - 1) {
            let others: Vec<u32> = rest.iter().filter(|id| !chosen.contains(id)).copied().collect();
            let set = [&[*first], &chosen[..]].concat();
            let whole = |others: Groups| [vec![set.clone()], others].concat();
            all.extend(partitions(&others, &other_sizes).into_iter().map(whole));
        }
    }
    all
}

fn subsets(ids: &[u32], size: usize) -> Vec<Vec<u32>> {
    match ids.split_first() {
        _ if size == 0 => vec![Vec::new()],
        None => Vec::new(),
        Some((first, rest)) => {
            let with = subsets(rest, size - 1).into_iter().map(|rest| [&[*first], &rest[..]].concat());
            with.chain(subsets(rest, size)).collect()
        }
    }
}

/// All orders, in lexicographic order.
pub fn permutations(items: &[usize]) -> Vec<Vec<usize>> {
    if items.is_empty() {
        return vec![Vec::new()];
    }
    let with_first = |i: usize| {
        let rest = [&items[..i], &items[i + 1..]].concat();
        permutations(&rest).into_iter().map(move |rest| [&[items[i]], &rest[..]].concat())
    };
    (0..items.len()).flat_map(with_first).collect()
}

/// Groups as a set: in the order of their smallest ids, empty ones last.
pub fn as_set(groups: &[Vec<u32>]) -> Groups {
    let mut set = groups.to_vec();
    set.iter_mut().for_each(|group| group.sort_unstable());
    set.sort_by_key(|group| group.first().copied().unwrap_or(u32::MAX));
    set
}
