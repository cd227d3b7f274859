//! All assignments of a question, or a sample of them with a local search, each with its outcome.

use std::collections::BTreeSet;

use teaming::{Assignment, Question, assignments};

use super::branch::{BranchError, Outcome};
use super::objective::Objective;

/// An assignment and its outcome.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// The assignment.
    pub assignment: Assignment,
    /// The outcome of the assignment.
    pub outcome: Outcome,
}

/// Which of the assignments were played.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coverage {
    /// All of them: the best one in the survey is the best there is.
    All,
    /// A random sample, and the assignments that a local search from the best of them played. A better
    /// assignment may exist, so that a regret is a lower bound.
    Sample {
        /// Number of assignments that exist; `u64::MAX` stands for that many or more.
        of: u64,
        /// Number of assignments that were drawn or named by a policy.
        drawn: usize,
        /// Number of assignments that the local search added.
        searched: usize,
    },
}

/// Assignments of one question and their outcomes.
#[derive(Debug, Clone, PartialEq)]
pub struct Survey {
    /// Each assignment once.
    pub evaluations: Vec<Evaluation>,
    /// Whether these are all assignments.
    pub coverage: Coverage,
}

/// Rank, regret and value of an assignment among the played assignments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// 1 for the best; assignments with equal values share a rank.
    pub rank: usize,
    /// Regret: distance of its value to the best value, never negative.
    pub regret: f64,
    /// Its value.
    pub value: f64,
}

impl Survey {
    /// The outcome of an assignment, if it was played.
    pub fn of(&self, assignment: &Assignment) -> Option<&Outcome> {
        let found = self.evaluations.iter().find(|evaluation| evaluation.assignment == *assignment);
        found.map(|evaluation| &evaluation.outcome)
    }

    /// The evaluations for which an objective is defined, the best first. Equal ones are in the order in
    /// which they were played.
    pub fn ranked(&self, objective: &Objective) -> Vec<&Evaluation> {
        let mut scored: Vec<(f64, &Evaluation)> = self
            .evaluations
            .iter()
            .filter_map(|evaluation| Some((objective.score(&evaluation.outcome)?, evaluation)))
            .collect();
        scored.sort_by(|a, b| b.0.total_cmp(&a.0));
        scored.into_iter().map(|(_, evaluation)| evaluation).collect()
    }

    /// The standing of an assignment; `None` if it was not played or has no value.
    pub fn standing(&self, objective: &Objective, assignment: &Assignment) -> Option<Standing> {
        let outcome = self.of(assignment)?;
        let score = objective.score(outcome)?;
        let scores = self.evaluations.iter().filter_map(|evaluation| objective.score(&evaluation.outcome));
        let (mut better, mut best) = (0, score);
        for other in scores {
            better += usize::from(other > score);
            best = best.max(other);
        }
        Some(Standing { rank: better + 1, regret: best - score, value: objective.value(outcome)? })
    }

    /// Values of the best and of the worst assignment; `None` if no assignment has a value.
    pub fn range(&self, objective: &Objective) -> Option<[f64; 2]> {
        let ranked = self.ranked(objective);
        let value = |evaluation: &&Evaluation| objective.value(&evaluation.outcome);
        Some([ranked.first().and_then(value)?, ranked.last().and_then(value)?])
    }

    /// Mean value over all played assignments that have one: the expected value of a fair draw.
    pub fn mean(&self, objective: &Objective) -> Option<f64> {
        let values: Vec<f64> =
            self.evaluations.iter().filter_map(|evaluation| objective.value(&evaluation.outcome)).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    }
}

/// Plays all assignments of a question if there are at most `limit`. If there are more, plays the `named`
/// assignments and a uniform sample that fills half of the limit. A local search then moves from the best
/// assignment to its best neighbour (see [`assignments::neighbours`]), until no neighbour is better or
/// the limit is reached.
///
/// `play` returns the outcomes of a batch of assignments, in their order.
///
/// # Errors
/// Those of `play`.
pub fn survey<E: From<BranchError>>(
    question: &Question,
    objective: &Objective,
    limit: u64,
    named: &[Assignment],
    mut play: impl FnMut(&[Assignment]) -> Result<Vec<Outcome>, E>,
) -> Result<Survey, E> {
    let count = assignments::count(question);
    if count <= limit {
        let all = assignments::all(question);
        let outcomes = play(&all)?;
        return Ok(Survey { evaluations: evaluations(all, outcomes), coverage: Coverage::All });
    }
    let limit = usize::try_from(limit).unwrap_or(usize::MAX);
    let sample = sample(question, named, limit / 2);
    let mut known: BTreeSet<Vec<Vec<u32>>> =
        sample.iter().map(|assignment| assignment.groups.clone()).collect();
    let outcomes = play(&sample)?;
    let drawn = sample.len();
    let mut survey = Survey {
        evaluations: evaluations(sample, outcomes),
        coverage: Coverage::Sample { of: count, drawn, searched: 0 },
    };
    while let Some(best) = survey.ranked(objective).first().map(|best| best.assignment.clone()) {
        let mut near = assignments::neighbours(question, &best);
        near.retain(|assignment| !known.contains(&assignment.groups));
        near.truncate(limit.saturating_sub(survey.evaluations.len()));
        if near.is_empty() {
            break;
        }
        known.extend(near.iter().map(|assignment| assignment.groups.clone()));
        let outcomes = play(&near)?;
        survey.evaluations.extend(evaluations(near, outcomes));
        if survey.ranked(objective).first().is_some_and(|found| found.assignment == best) {
            break;
        }
    }
    let searched = survey.evaluations.len() - drawn;
    survey.coverage = Coverage::Sample { of: count, drawn, searched };
    Ok(survey)
}

fn evaluations(assignments: Vec<Assignment>, outcomes: Vec<Outcome>) -> Vec<Evaluation> {
    let pairs = assignments.into_iter().zip(outcomes);
    pairs.map(|(assignment, outcome)| Evaluation { assignment, outcome }).collect()
}

/// The named assignments and random assignments, each once. The draws depend on the question alone, so that
/// every caller gets the same sample.
fn sample(question: &Question, named: &[Assignment], count: usize) -> Vec<Assignment> {
    let mut known = BTreeSet::new();
    let mut sample: Vec<Assignment> =
        named.iter().filter(|assignment| known.insert(assignment.groups.clone())).cloned().collect();
    let mut draws = question.draws();
    // There are more assignments than draws, so that few draws repeat a known assignment.
    for _ in 0..4 * count {
        if sample.len() >= count {
            break;
        }
        let assignment = assignments::draw(question, &mut draws);
        if known.insert(assignment.groups.clone()) {
            sample.push(assignment);
        }
    }
    sample
}

#[cfg(test)]
mod tests {
    use serde_json::json;
    use usar_sim::metrics::TaskTotals;

    use super::*;

    /// Robots of one role for two tasks, by the JSON form of a question.
    fn question(robots: usize) -> Question {
        let member = |id| json!({"id": id, "role": 0, "home": [0, 0], "needs": [1]});
        let task = |name| json!({"name": name, "difficulty": 1});
        let text = json!({
            "schema_version": 3, "round": 1, "roles": ["walker"],
            "needs": [{"name": "constant", "weight": 1}],
            "tasks": [task("far"), task("near")], "members": (0..robots).map(member).collect::<Vec<_>>(),
            "quotas": [{"members": [robots / 2, robots / 2], "sizes": "Parts"}],
            "history": [], "random_seed": "00".repeat(32),
        });
        Question::from_json(&text.to_string()).unwrap()
    }

    /// The first task rescues the sum of its robots' numbers.
    #[expect(clippy::unnecessary_wraps, reason = "playing may fail")]
    fn outcomes(assignments: &[Assignment]) -> Result<Vec<Outcome>, BranchError> {
        let outcome = |assignment: &Assignment| {
            let rescued = assignment.groups[0].iter().sum();
            let tasks = vec![TaskTotals { rescued, ..TaskTotals::default() }; 2];
            Outcome { tasks, ungrouped: [0.0; 2], duration_s: 1.0, is_cut: false }
        };
        Ok(assignments.iter().map(outcome).collect())
    }

    fn objective() -> Objective {
        Objective::parse("rescuees.far", &["far".to_owned(), "near".to_owned()]).unwrap()
    }

    #[test]
    fn few_assignments_are_all_played_and_ranked() {
        let survey = survey(&question(6), &objective(), 100, &[], outcomes).unwrap();
        assert_eq!((survey.coverage, survey.evaluations.len()), (Coverage::All, 20));
        let best = Assignment::new(vec![vec![3, 4, 5], vec![0, 1, 2]]);
        assert_eq!(survey.ranked(&objective())[0].assignment, best);
        assert_eq!(survey.range(&objective()), Some([12.0, 3.0]));
        assert_eq!(survey.mean(&objective()), Some(7.5));
        let second = Assignment::new(vec![vec![2, 4, 5], vec![0, 1, 3]]);
        let standing = Standing { rank: 2, regret: 1.0, value: 11.0 };
        assert_eq!(survey.standing(&objective(), &second), Some(standing));
        let worst =
            survey.standing(&objective(), &Assignment::new(vec![vec![0, 1, 2], vec![3, 4, 5]])).unwrap();
        assert_eq!((worst.rank, worst.regret), (20, 9.0));
    }

    #[test]
    fn of_many_assignments_a_sample_is_played_and_the_best_of_it_is_improved() {
        let question = question(16);
        let named = Assignment::new(vec![(0..8).collect(), (8..16).collect()]);
        let survey = survey(&question, &objective(), 600, std::slice::from_ref(&named), outcomes).unwrap();
        let Coverage::Sample { of, drawn, searched } = survey.coverage else { panic!("a sample") };
        assert_eq!((of, drawn), (12_870, 300));
        assert!(searched > 0 && drawn + searched <= 600, "{searched}");
        assert!(survey.of(&named).is_some());
        let distinct: BTreeSet<_> = survey.evaluations.iter().map(|e| e.assignment.groups.clone()).collect();
        assert_eq!(distinct.len(), survey.evaluations.len());
        let best = survey.range(&objective()).unwrap()[0];
        assert!(best > 85.0, "the largest sum is 92, a good half of draws is below 60; found {best}");
    }
}
