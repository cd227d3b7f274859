//! Reads a type from a tree, and finds all values that do not fit.

use serde::de::DeserializeOwned;

use crate::node::Node;
use crate::problem::{MUST_BE_GIVEN, Problem};

/// Most values of wrong types that are reported at once. The tree is read once more to find each.
const MOST_PROBLEMS: usize = 20;

impl Node {
    /// Reads a type. Fields that do not fit are left out and reported. No value is returned if such a field
    /// has no default.
    pub fn read_all<T: DeserializeOwned>(&self) -> (Option<T>, Vec<Problem>) {
        let problem = match self.read_as() {
            Ok(value) => return (Some(value), Vec::new()),
            Err(problem) => problem,
        };
        let (mut rest, mut taken_out) = (self.clone(), Vec::new());
        let mut problems = vec![*problem];
        while problems.len() < MOST_PROBLEMS {
            let last = problems.last().filter(|problem| problem.rule != MUST_BE_GIVEN);
            let Some(path) = last.and_then(|problem| rest.take_out(&problem.field)) else { break };
            taken_out.push(path);
            match rest.read_as() {
                Ok(value) => return (Some(value), problems),
                Err(problem) if taken_out.contains(&problem.field) => break,
                Err(problem) => problems.push(*problem),
            }
        }
        (None, problems)
    }
}
