//! `GREEDY(protocol, graph, quality, distance)`: the largest [utility](crate::utility) among free robots and
//! open slots, again and again.
//!
//! The protocol says who does it. `Central` sorts all pairs. `Ssi` is a sequential single-item auction
//! (Koenig et al. 2006, *The Power of Sequential Single-Item Auctions for Agent Coordination*). `Cbba` is the
//! consensus-based bundle algorithm with bundles of one (Choi, Brunet, How 2009, *Consensus-Based
//! Decentralized Auctions for Robust Task Allocation*, IEEE T-RO 25). All three settle the pairs in one
//! order (utility, lower id, harder task), so that they have one answer; they differ in what is sent.
//!
//! Time for n members of a role and m tasks: `Central` n m log(n m), `Ssi` n^2 m, `Cbba` up to n^2 for each
//! round and link.
//!
//! Example: utilities (1, 0.99) and (1, 0) at two tasks of one slot each. Both robots have 1 at the first
//! task; the lower id gets it. The other one is left with 0: 1.00 in all, of 1.99 that are possible.

mod auction;
mod consensus;
mod graph;
mod market;

pub use graph::Graph;

use serde::{Deserialize, Serialize};
use teaming::decision::{Account, Decision, Protocol as Sent};
use teaming::error::PolicyError;
use teaming::policy::Policy;
use teaming::question::Question;
use teaming::registry::PolicyKind;

use crate::assigning::of_role;
use crate::utility::{Utility, UtilityOptions};
use market::Market;

const NAME: &str = "GREEDY";

/// Who finds the largest utility.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Protocol {
    /// The base, without messages. The default.
    #[default]
    Central,
    /// An auction of one robot after the other: in each round the largest bid wins.
    Ssi,
    /// All robots bid at once and compare with their neighbours, until none is outbid.
    Cbba,
}

teaming::options! {
    /// Options of `GREEDY`.
    #[derive(Copy)]
    pub struct Options {
        /// Who finds the largest utility.
        pub protocol: Protocol = Protocol::default(),
        /// Which robots of a role hear one another.
        pub graph: Graph = Graph::default(),
        /// How much strength at worthy tasks counts, from 0 to 100.
        pub quality: f64 = 1.0,
        /// How much the way to the task counts, from 0 to 100.
        pub distance: f64 = 1.0,
    }
}

/// Per role, the largest utility first.
#[derive(Debug, Clone, Copy)]
pub struct Greedy {
    options: Options,
    utility: Utility,
}

/// The registry's line.
#[must_use]
pub fn kind() -> PolicyKind {
    PolicyKind::with_options(NAME, "the largest utility first, centrally or by auction", Greedy::new)
        .from_sources(env!("SOURCES_GREEDY"))
}

impl Greedy {
    fn new(options: Options) -> Result<Self, &'static str> {
        let Options { quality, distance, .. } = options;
        Ok(Self { options, utility: Utility::new(NAME, UtilityOptions { quality, distance })? })
    }
}

impl Policy for Greedy {
    fn decide(&self, question: &Question) -> Result<Decision, PolicyError> {
        let table = self.utility.table(question)?;
        let hardest_first = question.hardest_first();
        let mut groups = vec![Vec::new(); question.tasks.len()];
        let mut sent = Sent::default();
        for role in question.role_ids() {
            let members = of_role(question, role);
            let market = Market::of(&question.quotas[role.index()].members, &hardest_first, &members, &table);
            let (won, of_role) = match self.options.protocol {
                Protocol::Central => (auction::central(&market), Sent::default()),
                Protocol::Ssi => auction::one_by_one(&market, self.options.graph),
                Protocol::Cbba => consensus::agree(&market, self.options.graph),
            };
            sent = sent.beside(of_role);
            let pairs = members.iter().zip(won);
            pairs.for_each(|(i, rank)| groups[hardest_first[rank].index()].push(question.members[*i].id));
        }
        let decision = Decision { proven_optimal: false, ..Decision::unscored(groups) };
        Ok(match self.options.protocol {
            Protocol::Central => decision,
            Protocol::Ssi | Protocol::Cbba => Decision { account: Account::Protocol(sent), ..decision },
        })
    }
}
