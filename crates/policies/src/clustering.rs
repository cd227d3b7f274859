//! Clusters of robots that are alike, with the sizes of the question: k-means whose assignments keep sizes.
//!
//! Lloyd's algorithm (1982, *Least Squares Quantization in PCM*) with an optimal assignment instead of the
//! nearest centre (Malinen, Franti 2014, *Balanced K-Means for Clustering*). Each of 20 starts is a fair
//! draw; the least inertia wins, and swaps of two members of a role lower it as long as any does (Hartigan,
//! Wong 1979, *A K-Means Clustering Algorithm*: Lloyd's centres do not move before all are assigned, so that
//! he misses swaps that pay). A cluster has the sizes of a task. Among tasks of the same sizes, clusters are
//! labelled by the largest sum of the utility.

use rand::Rng;
use rand::seq::SliceRandom;
use teaming::error::PolicyError;
use teaming::ids::TaskId;
use teaming::question::Question;

use crate::assigning::{best, matching, of_role, slots};
use crate::searching::{Loss, by_swaps};
use crate::utility::Utility;

/// Draws from which the search starts.
const STARTS: usize = 20;

/// A round must lower the inertia by more than this share.
const PROGRESS: f64 = 1e-12;

/// Needs of weight above 0, less their mean over the team, over their standard deviation; without needs that
/// are the same for all.
pub(super) fn standardised(question: &Question) -> Vec<Vec<f64>> {
    let mut points = vec![Vec::new(); question.members.len()];
    for k in (0..question.needs.len()).filter(|k| question.needs[*k].weight > 0.0) {
        let mut values: Vec<f64> = question.members.iter().map(|member| member.needs.values()[k]).collect();
        // By a power of two, so that squares are finite and no bit is lost.
        let (_, power) = libm::frexp(values.iter().copied().fold(0.0, f64::max));
        values.iter_mut().for_each(|value| *value = libm::ldexp(*value, -power));
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let variance =
            values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / values.len() as f64;
        if variance > 0.0 {
            let deviation = variance.sqrt();
            points.iter_mut().zip(&values).for_each(|(point, value)| point.push((value - mean) / deviation));
        }
    }
    points
}

/// The square of the distance between two points.
pub(super) fn squared(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// The task of each member: the clusters of least inertia that were found, labelled.
pub(super) fn clusters(
    question: &Question,
    points: &[Vec<f64>],
    utility: &Utility,
) -> Result<Vec<usize>, PolicyError> {
    let table = utility.table(question)?;
    let mut draws = question.draws();
    let mut least: Option<(f64, Vec<usize>)> = None;
    for _ in 0..STARTS {
        let found = refine(question, points, drawn(question, &mut draws));
        let is_better = |(inertia, _): &(f64, Vec<usize>)| found.0 < inertia * (1.0 - PROGRESS);
        if least.as_ref().is_none_or(is_better) {
            least = Some(found);
        }
    }
    let (_, start) = least.unwrap_or_default();
    let mut inertia = Inertia { points, centres: Vec::new(), sizes: Vec::new(), count: question.tasks.len() };
    let cluster_of = by_swaps(question, &mut inertia, start);
    Ok(labelled(question, &cluster_of, &table))
}

/// A fair draw.
fn drawn(question: &Question, draws: &mut impl Rng) -> Vec<usize> {
    let mut cluster_of = vec![0; question.members.len()];
    for role in question.role_ids() {
        let mut members = of_role(question, role);
        members.shuffle(draws);
        members.into_iter().zip(slots(question, role)).for_each(|(member, task)| cluster_of[member] = task);
    }
    cluster_of
}

/// Rounds of centres and assignments until the inertia does not fall. Returns it with the clusters.
fn refine(question: &Question, points: &[Vec<f64>], mut cluster_of: Vec<usize>) -> (f64, Vec<usize>) {
    let count = question.tasks.len();
    let mut centres = centres(points, &cluster_of, count);
    let mut inertia = inertia_of(points, &cluster_of, &centres);
    loop {
        let next = assigned(question, points, &centres);
        let moved = self::centres(points, &next, count);
        let found = inertia_of(points, &next, &moved);
        if found >= inertia * (1.0 - PROGRESS) {
            return (inertia, cluster_of);
        }
        (inertia, cluster_of, centres) = (found, next, moved);
    }
}

/// The assignment with the least sum of squared distances to the centres.
fn assigned(question: &Question, points: &[Vec<f64>], centres: &[Vec<f64>]) -> Vec<usize> {
    let row = |point: &Vec<f64>| centres.iter().map(|centre| -squared(point, centre)).collect::<Vec<f64>>();
    let mut values: Vec<Vec<f64>> = points.iter().map(row).collect();
    let most = values.iter().flatten().fold(0.0, |most: f64, value| most.max(-value));
    if most > 0.0 {
        values.iter_mut().flatten().for_each(|value| *value /= most);
    }
    best(question, &values)
}

fn centres(points: &[Vec<f64>], cluster_of: &[usize], count: usize) -> Vec<Vec<f64>> {
    let mut centres = vec![vec![0.0; points.first().map_or(0, Vec::len)]; count];
    for (point, cluster) in points.iter().zip(cluster_of) {
        centres[*cluster].iter_mut().zip(point).for_each(|(sum, value)| *sum += value);
    }
    for (cluster, centre) in centres.iter_mut().enumerate() {
        let size = cluster_of.iter().filter(|of| **of == cluster).count().max(1) as f64;
        centre.iter_mut().for_each(|sum| *sum /= size);
    }
    centres
}

/// The sum of squared distances to the centres of the own clusters.
fn inertia_of(points: &[Vec<f64>], cluster_of: &[usize], centres: &[Vec<f64>]) -> f64 {
    points.iter().zip(cluster_of).map(|(point, cluster)| squared(point, &centres[*cluster])).sum()
}

/// The inertia, with what swaps of members change of it.
struct Inertia<'p> {
    points: &'p [Vec<f64>],
    centres: Vec<Vec<f64>>,
    sizes: Vec<f64>,
    count: usize,
}

impl Inertia<'_> {
    /// How much the inertia of the cluster of `leaves` falls if `comes` comes instead.
    fn gain_of(&self, cluster: usize, [leaves, comes]: [usize; 2]) -> f64 {
        let [leaves, comes] = [leaves, comes].map(|member| &self.points[member]);
        let centre = &self.centres[cluster];
        squared(leaves, centre) - squared(comes, centre) + squared(leaves, comes) / self.sizes[cluster]
    }
}

impl Loss for Inertia<'_> {
    fn begin(&mut self, task_of: &[usize]) {
        self.centres = centres(self.points, task_of, self.count);
        let size = |cluster: usize| task_of.iter().filter(|of| **of == cluster).count() as f64;
        self.sizes = (0..self.count).map(size).collect();
    }

    fn loss(&self, task_of: &[usize]) -> f64 {
        inertia_of(self.points, task_of, &self.centres)
    }

    fn gain(&self, task_of: &[usize], [a, b]: [usize; 2]) -> f64 {
        self.gain_of(task_of[a], [a, b]) + self.gain_of(task_of[b], [b, a])
    }

    fn swap(&mut self, task_of: &[usize], [a, b]: [usize; 2]) {
        for (cluster, [leaves, comes]) in [(task_of[a], [a, b]), (task_of[b], [b, a])] {
            let values = self.points[comes].iter().zip(&self.points[leaves]);
            for (centre, (comes, leaves)) in self.centres[cluster].iter_mut().zip(values) {
                *centre += (comes - leaves) / self.sizes[cluster];
            }
        }
    }
}

/// Gives clusters of the same sizes to tasks by the largest sum of values.
fn labelled(question: &Question, cluster_of: &[usize], table: &[Vec<f64>]) -> Vec<usize> {
    let sizes = |task: usize| question.quotas.iter().map(|quota| quota.members[task]).collect::<Vec<usize>>();
    let mut task_of: Vec<usize> = (0..question.tasks.len()).collect();
    for task in 0..question.tasks.len() {
        let alike = question.hardest_first().into_iter().map(TaskId::index);
        let alike: Vec<usize> = alike.filter(|other| sizes(*other) == sizes(task)).collect();
        if alike.iter().min() != Some(&task) {
            continue; // done with the first of them
        }
        let value = |cluster: usize, task: usize| {
            let members = cluster_of.iter().zip(table).filter(|(of, _)| **of == cluster);
            members.map(|(_, row)| row[task]).sum::<f64>()
        };
        let row = |cluster: &usize| alike.iter().map(|task| value(*cluster, *task)).collect();
        let values: Vec<Vec<f64>> = alike.iter().map(row).collect();
        matching(&values).into_iter().zip(&alike).for_each(|(to, cluster)| task_of[*cluster] = alike[to]);
    }
    cluster_of.iter().map(|cluster| task_of[*cluster]).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use teaming::{Assignment, GroupSizes, Member, assignments};

    use super::*;
    use crate::made_up::drawn as drawn_question;
    use crate::utility::UtilityOptions;

    fn inertia(points: &[Vec<f64>], cluster_of: &[usize], count: usize) -> f64 {
        inertia_of(points, cluster_of, &centres(points, cluster_of, count))
    }

    /// The inertia that is found, and the least of all assignments.
    pub(crate) fn found_and_least(question: &Question, points: &[Vec<f64>]) -> [f64; 2] {
        let options = UtilityOptions { quality: 1.0, distance: 0.0 };
        let utility = Utility::new("KMEANS", options).unwrap();
        let found = clusters(question, points, &utility).unwrap();
        let mut bound = question.clone();
        bound.quotas.iter_mut().for_each(|quota| quota.sizes = GroupSizes::Binding);
        let of = |assignment: &Assignment| {
            let task_of = |member: &Member| assignment.task_of(member.id).unwrap().index();
            question.members.iter().map(task_of).collect::<Vec<usize>>()
        };
        let all = assignments::all(&bound);
        let count = question.tasks.len();
        let least =
            all.iter().map(|assignment| inertia(points, &of(assignment), count)).fold(f64::MAX, f64::min);
        [inertia(points, &found, count), least]
    }

    #[test]
    fn of_1_000_teams_at_least_950_are_clustered_as_brute_force_does() {
        let is_best = |seed: &u64| {
            let question = drawn_question(*seed);
            let [found, least] = found_and_least(&question, &standardised(&question));
            assert!(found >= least - 1e-9);
            found < least + 1e-9
        };
        let best = (0..1_000).filter(is_best).count();
        println!("{best} of 1,000");
        assert!(best >= 950, "{best}");
    }

    #[test]
    fn inertia_never_rises() {
        for seed in 0..200 {
            let question = drawn_question(seed);
            let points = standardised(&question);
            let count = question.tasks.len();
            let mut cluster_of = drawn(&question, &mut question.draws());
            let (end, _) = refine(&question, &points, cluster_of.clone());
            for _ in 0..10 {
                let before = inertia(&points, &cluster_of, count);
                cluster_of = assigned(&question, &points, &centres(&points, &cluster_of, count));
                assert!(inertia(&points, &cluster_of, count) <= before * (1.0 + PROGRESS), "seed {seed}");
            }
            assert!((inertia(&points, &cluster_of, count) - end).abs() < 1e-9, "seed {seed}");
        }
    }
}
