//! `OPTIMAL(quality, distance)`: the largest sum of the [utility](crate::utility), exactly.
//!
//! Each role is a transport problem, solved by successive shortest paths (Ahuja, Magnanti, Orlin 1993,
//! *Network Flows*, section 9.7). The sum of the account is added up again from the utilities as they are.
//! Time: n^2 + n m^3 at most, for n members of a role and m tasks.
//!
//! Example: two robots have utilities (1, 0.99) and (1, 0) at two tasks of one slot each. OPTIMAL sends the
//! first one to the second task, 1.99 in all; GREEDY takes the first 1 and gets 1.00.

use teaming::decision::{Account, Decision};
use teaming::error::PolicyError;
use teaming::policy::Policy;
use teaming::question::Question;
use teaming::registry::PolicyKind;

use crate::assigning::{best, groups};
use crate::utility::{Utility, UtilityOptions};

const NAME: &str = "OPTIMAL";

/// Per role, the assignment with the largest sum of the utility.
#[derive(Debug, Clone, Copy)]
pub struct Optimal {
    utility: Utility,
}

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::with_options(NAME, "the largest sum of the utility, exactly", Optimal::new)
        .from_sources(env!("SOURCES_OPTIMAL"))
}

impl Optimal {
    fn new(options: UtilityOptions) -> Result<Self, &'static str> {
        Ok(Self { utility: Utility::new(NAME, options)? })
    }
}

impl Policy for Optimal {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let table = self.utility.table(question)?;
        let task_of = best(question, &table);
        let sum: f64 = table.iter().zip(&task_of).map(|(row, task)| row[*task]).sum();
        let account = Account::Text(format!("the utility of all members adds up to {sum}"));
        Ok(Decision { account, ..Decision::unscored(groups(question, &task_of)) })
    }
}
