//! `KMEANS(quality, distance)`: robots that are alike work together, by k-means on their needs.
//!
//! Needs are standardised over the team, and clusters keep the sizes of the question: Lloyd's algorithm
//! (1982, *Least Squares Quantization in PCM*) with an optimal assignment in each round (Malinen, Franti
//! 2014, *Balanced K-Means for Clustering*), from 20 fair draws of the question. Clusters of the same sizes
//! are given to tasks by the largest sum of the [utility](crate::utility). Time for each round: that of
//! OPTIMAL.
//!
//! Example: robots with the one need 1, 2, 8, 9 and two tasks of two slots: {1, 2} and {8, 9}; with
//! `distance: 0` the latter go to the harder task.

use teaming::decision::Decision;
use teaming::error::PolicyError;
use teaming::policy::Policy;
use teaming::question::Question;
use teaming::registry::PolicyKind;

use crate::assigning::groups;
use crate::clustering::{clusters, standardised};
use crate::utility::{Utility, UtilityOptions};

const NAME: &str = "KMEANS";

/// Clusters of standardised needs. It is a search from 20 starts, and proves nothing.
#[derive(Debug, Clone, Copy)]
pub struct KMeans {
    utility: Utility,
}

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::with_options(NAME, "robots with like needs work together, by k-means", KMeans::new)
        .from_sources(env!("SOURCES_KMEANS"))
}

impl KMeans {
    fn new(options: UtilityOptions) -> Result<Self, &'static str> {
        Ok(Self { utility: Utility::new(NAME, options)? })
    }
}

impl Policy for KMeans {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let task_of = clusters(question, &standardised(question), &self.utility)?;
        Ok(Decision { proven_optimal: false, ..Decision::unscored(groups(question, &task_of)) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::made_up::with_needs;

    #[test]
    fn the_example_by_hand() {
        let question = with_needs(&[&[1.0], &[8.0], &[2.0], &[9.0]], &[1, 2]);
        let kmeans = KMeans::new(UtilityOptions { distance: 0.0, ..UtilityOptions::default() }).unwrap();
        assert_eq!(kmeans.decide(&question).unwrap().assignment.groups, [[0, 2], [1, 3]]);
        let large = with_needs(&[&[1e307], &[8e307], &[2e307], &[9e307]], &[1, 2]);
        assert_eq!(kmeans.decide(&large).unwrap().assignment.groups, [[0, 2], [1, 3]]);
    }
}
