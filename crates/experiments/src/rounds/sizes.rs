//! Whether groups have the sizes of their questions, where a scenario leaves sizes free.

use std::fmt;

use store::Failure;
use teaming::{AssignmentError, GroupSizes, Quota};

use super::{Round, rounds_of};
use crate::sweep::folder::Folder;

/// A policy whose groups have other sizes than its questions say.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OddSizes {
    /// The policy.
    policy: String,
    /// Trials with such groups.
    trials: usize,
    /// Trials of scenarios that leave sizes free.
    of: usize,
    /// The first of these groups: trial, round, and what differs.
    first: (u32, u32, AssignmentError),
}

impl fmt::Display for OddSizes {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { policy, trials, of, first: (trial, round, error) } = self;
        write!(
            f,
            "{policy} does not keep the sizes that groups should have in {trials} of {of} trials, which \
             `mission.group_sizes: Free` allows (first in trial {trial}, round {round}: {error}), so that \
             its differences are of group sizes, too."
        )
    }
}

/// The policies of a sweep whose groups have other sizes than the question says. Only scenarios with
/// `group_sizes: Free` allow such groups: elsewhere the trial fails. A folder without records tells of none.
///
/// # Errors
/// The journal cannot be read.
pub fn odd_sizes(folder: &mut Folder) -> Result<Vec<OddSizes>, Failure> {
    let experiment = folder.shared_experiment();
    let is_free = |case: &usize| experiment.cases[*case].scenario.mission.group_sizes == GroupSizes::Free;
    let free: Vec<usize> = (0..experiment.cases.len()).filter(is_free).collect();
    if !experiment.keep.has_records() {
        return Ok(Vec::new());
    }
    let mut odd = Vec::new();
    for (policy, spec) in experiment.policies.iter().enumerate() {
        let (mut of, mut found) = (0, Vec::new());
        for place in free.iter().flat_map(|case| folder.places(*case, policy)).collect::<Vec<_>>() {
            let Ok(trial) = folder.outcome(place)?.result else { continue };
            of += 1;
            found.extend(rounds_of(place.2, &trial).find_map(|round| {
                let error = odd_size(&round)?;
                Some((round.trial, round.question.round, error))
            }));
        }
        let trials = found.len();
        let first = found.into_iter().next();
        odd.extend(first.map(|first| OddSizes { policy: spec.label.clone(), trials, of, first }));
    }
    Ok(odd)
}

/// What would be refused in a round if its sizes were not free.
fn odd_size(round: &Round) -> Option<AssignmentError> {
    let mut question = round.question.clone();
    let free = question.quotas.iter_mut().filter(|quota| quota.sizes == GroupSizes::Free);
    free.for_each(|quota: &mut Quota| quota.sizes = GroupSizes::Parts);
    round.decision.assignment.check(&question).err()
}
