//! `SPECTRAL(quality, distance)`: robots that are alike work together, by spectral clustering of their needs.
//!
//! After Ng, Jordan, Weiss 2001, *On Spectral Clustering: Analysis and an Algorithm*: the affinity of two
//! robots is `exp(-d^2 / (2 w))`, with the squared distance `d^2` of their standardised needs and its mean
//! over all pairs, `w`. The rows of the eigenvectors of `D^-1/2 A D^-1/2` with the k largest eigenvalues are
//! scaled to length 1 and clustered as by KMEANS, with k groups that get robots. Time: n^3 for n robots.
//!
//! Example: robots with the one need 1, 2, 8, 9 and two tasks of two slots: {1, 2} and {8, 9}, as KMEANS.

use nalgebra::linalg::SymmetricEigen;
use nalgebra::{DMatrix, DVector};
use teaming::decision::Decision;
use teaming::error::PolicyError;
use teaming::policy::Policy;
use teaming::question::Question;
use teaming::registry::PolicyKind;

use crate::assigning::groups;
use crate::clustering::{clusters, squared, standardised};
use crate::utility::{Utility, UtilityOptions};

const NAME: &str = "SPECTRAL";

/// Rounds in which the eigenvalues must be found, for each robot. A few are usual.
const ROUNDS: usize = 100;

/// Clusters of spectral coordinates. It is a search from 20 starts, and proves nothing.
#[derive(Debug, Clone, Copy)]
pub struct Spectral {
    utility: Utility,
}

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::with_options(NAME, "robots with like needs work together, by their spectrum", Spectral::new)
        .from_sources(env!("SOURCES_SPECTRAL"))
}

impl Spectral {
    fn new(options: UtilityOptions) -> Result<Self, &'static str> {
        Ok(Self { utility: Utility::new(NAME, options)? })
    }
}

impl Policy for Spectral {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let gets = |task: usize| question.quotas.iter().any(|quota| quota.members[task] > 0);
        let count = (0..question.tasks.len()).filter(|task| gets(*task)).count();
        let points = coordinates(&standardised(question), count)
            .ok_or_else(|| PolicyError::Other(format!("policy {NAME}: no eigenvectors were found")))?;
        let task_of = clusters(question, &points, &self.utility)?;
        Ok(Decision { proven_optimal: false, ..Decision::unscored(groups(question, &task_of)) })
    }
}

/// The rows of the first eigenvectors, of length 1.
fn coordinates(points: &[Vec<f64>], count: usize) -> Option<Vec<Vec<f64>>> {
    if points.is_empty() {
        return Some(Vec::new());
    }
    let size = points.len();
    let mut matrix = affinities(points);
    let scale: DVector<f64> = matrix.column_sum().map(|sum| if sum > 0.0 { 1.0 / sum.sqrt() } else { 0.0 });
    for (i, j) in (0..size).flat_map(|i| (0..size).map(move |j| (i, j))) {
        matrix[(i, j)] *= scale[i] * scale[j];
    }
    let SymmetricEigen { eigenvectors, eigenvalues } =
        SymmetricEigen::try_new(matrix, f64::EPSILON, ROUNDS * size)?;
    let mut order: Vec<usize> = (0..size).collect();
    order.sort_by(|a, b| eigenvalues[*b].total_cmp(&eigenvalues[*a]).then(a.cmp(b)));
    let row = |i: usize| {
        let mut row: Vec<f64> = order.iter().take(count).map(|column| eigenvectors[(i, *column)]).collect();
        let length = row.iter().map(|value| value * value).sum::<f64>().sqrt();
        if length > 0.0 {
            row.iter_mut().for_each(|value| *value /= length);
        }
        row
    };
    Some((0..size).map(row).collect())
}

/// The affinity of each pair; 0 to itself.
fn affinities(points: &[Vec<f64>]) -> DMatrix<f64> {
    let size = points.len();
    let distances = DMatrix::from_fn(size, size, |i, j| squared(&points[i], &points[j]));
    let pairs = (size * (size - 1)).max(1) as f64;
    let width = 2.0 * distances.sum() / pairs;
    DMatrix::from_fn(size, size, |i, j| match distances[(i, j)] {
        _ if i == j => 0.0,
        distance if distance > 0.0 => libm::exp(-distance / width),
        _ => 1.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clustering::tests::found_and_least;
    use crate::made_up::{drawn, with_needs};

    #[test]
    fn of_1_000_teams_at_least_950_are_clustered_as_brute_force_does() {
        let is_best = |seed: &u64| {
            let question = drawn(*seed);
            let points = coordinates(&standardised(&question), question.tasks.len()).unwrap();
            let [found, least] = found_and_least(&question, &points);
            found < least + 1e-9
        };
        let best = (0..1_000).filter(is_best).count();
        println!("{best} of 1,000");
        assert!(best >= 950, "{best}");
    }

    #[test]
    fn the_example_by_hand() {
        let question = with_needs(&[&[1.0], &[8.0], &[2.0], &[9.0]], &[1, 2]);
        let spectral = Spectral::new(UtilityOptions { distance: 0.0, ..UtilityOptions::default() }).unwrap();
        assert_eq!(spectral.decide(&question).unwrap().assignment.groups, [[0, 2], [1, 3]]);
    }
}
