//! Greedy without an auctioneer: the consensus-based bundle algorithm with bundles of one.
//!
//! Each robot keeps, for each slot, the best bid that it knows of. In each round, a robot without a slot
//! bids for its best task at which it beats a bid, there for the slot with the weakest one. Then all send
//! their bids and winners to their neighbours at once, and keep the better bid of each slot. A robot that
//! learns of a better bid for its slot is free again. Bids of a slot only rise, so that no time stamps are
//! needed. The round in which nothing changes is the last one.

use teaming::decision::Protocol;

use super::graph::Graph;
use super::market::{Bid, Market};

/// Bytes of a slot in a message: its bid and its winner, 8 each.
const BYTES: usize = 16;

/// What the robots of a role know.
struct Robots<'m> {
    market: &'m Market,
    /// The task of each slot.
    slots: Vec<usize>,
    /// For each robot, the best bid that it knows for each slot.
    known: Vec<Vec<Option<Bid>>>,
    /// For each robot, the slots of which it knows more than its neighbours were told.
    fresh: Vec<Vec<usize>>,
}

/// Returns the task of each robot.
pub(super) fn agree(market: &Market, graph: Graph) -> (Vec<usize>, Protocol) {
    let count = market.bids.len();
    let tasks = market.open.iter().enumerate();
    let slots: Vec<usize> = tasks.flat_map(|(task, open)| std::iter::repeat_n(task, *open)).collect();
    let known = vec![vec![None; slots.len()]; count];
    let mut robots = Robots { market, slots, known, fresh: vec![Vec::new(); count] };
    let neighbours: Vec<Vec<usize>> = (0..count).map(|robot| graph.neighbours(robot, count)).collect();
    let mut rounds = 0;
    let mut changes = count > 0;
    while changes {
        let bids = (0..count).filter(|robot| robots.bid(*robot)).count();
        changes = robots.exchange(&neighbours) || bids > 0;
        rounds += u64::from(count > 1); // a robot alone has nobody to talk to
    }
    let messages = rounds * graph.links(count) as u64;
    let sent = Protocol { rounds, messages, bytes: messages * (BYTES * count) as u64 };
    (robots.tasks(), sent)
}

impl Robots<'_> {
    /// Bids for a slot, if the robot has none and beats a bid. Returns whether it did.
    fn bid(&mut self, robot: usize) -> bool {
        let known = &self.known[robot];
        if known.iter().flatten().any(|bid| bid.robot == robot) {
            return false;
        }
        let own = |slot: usize| Bid { value: self.market.bids[robot][self.slots[slot]], robot };
        let weaker_first = |a: &usize, b: &usize| match (known[*a], known[*b]) {
            (Some(one), Some(other)) => one.value.total_cmp(&other.value),
            (one, other) => one.is_some().cmp(&other.is_some()),
        };
        let by_rank = |a: &usize, b: &usize| {
            let task = self.slots[*a].cmp(&self.slots[*b]);
            own(*a).winner_first(&own(*b)).then(task).then_with(|| weaker_first(a, b)).then(a.cmp(b))
        };
        let beaten = (0..self.slots.len()).filter(|slot| own(*slot).beats(known[*slot]));
        let Some(slot) = beaten.min_by(by_rank) else { return false };
        self.known[robot][slot] = Some(own(slot));
        self.fresh[robot].push(slot);
        true
    }

    /// All robots send what they know. Returns whether anybody learnt something.
    fn exchange(&mut self, neighbours: &[Vec<usize>]) -> bool {
        let fresh: Vec<Vec<usize>> = self.fresh.iter_mut().map(std::mem::take).collect();
        let sent: Vec<Vec<(usize, Option<Bid>)>> = fresh
            .iter()
            .zip(&self.known)
            .map(|(slots, known)| slots.iter().map(|slot| (*slot, known[*slot])).collect())
            .collect();
        for (robot, near) in neighbours.iter().enumerate() {
            for (slot, bid) in near.iter().flat_map(|other| &sent[*other]) {
                if bid.is_some_and(|bid| bid.beats(self.known[robot][*slot])) {
                    self.known[robot][*slot] = *bid;
                    self.fresh[robot].push(*slot);
                }
            }
        }
        self.fresh.iter().any(|slots| !slots.is_empty())
    }

    /// The task of each robot.
    fn tasks(&self) -> Vec<usize> {
        let mut tasks = vec![0; self.known.len()];
        let agreed = self.known.first().into_iter().flatten().zip(&self.slots);
        agreed
            .filter_map(|(bid, task)| Some((bid.as_ref()?.robot, task)))
            .for_each(|(robot, task)| tasks[robot] = *task);
        tasks
    }
}
