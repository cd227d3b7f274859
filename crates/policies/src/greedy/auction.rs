//! Greedy by the base, and as an auction of one robot after the other.

use teaming::decision::Protocol;

use super::graph::Graph;
use super::market::{Bid, Market};

/// The best bid so far: its value, its robot and its task, 8 bytes each.
const BYTES: usize = 24;

/// Takes all pairs in their order. Returns the task of each robot.
pub(super) fn central(market: &Market) -> Vec<usize> {
    let mut open = market.open.clone();
    let mut won = vec![None; market.bids.len()];
    let of_robot = |(robot, bids): (usize, &Vec<f64>)| {
        bids.iter()
            .enumerate()
            .map(move |(task, value)| (Bid { value: *value, robot }, task))
            .collect::<Vec<_>>()
    };
    let mut pairs: Vec<(Bid, usize)> = market.bids.iter().enumerate().flat_map(of_robot).collect();
    pairs.sort_by(|(a, task), (b, other)| a.winner_first(b).then(task.cmp(other)));
    for (bid, task) in pairs {
        if won[bid.robot].is_none() && open[task] > 0 {
            won[bid.robot] = Some(task);
            open[task] -= 1;
        }
    }
    won.into_iter().flatten().collect()
}

/// In each round, each free robot bids for its best open task, and the best bid wins. The robots pass on the
/// best bid that they know until all know it, which takes the diameter of their graph.
pub(super) fn one_by_one(market: &Market, graph: Graph) -> (Vec<usize>, Protocol) {
    let robots = market.bids.len();
    let mut open = market.open.clone();
    let mut won = vec![None; robots];
    for _ in 0..robots {
        let mut best: Option<(Bid, usize)> = None;
        for robot in (0..robots).filter(|robot| won[*robot].is_none()) {
            let of_task = |task: usize| Bid { value: market.bids[robot][task], robot };
            let tasks = (0..open.len()).filter(|task| open[*task] > 0);
            let own = tasks.min_by(|a, b| of_task(*a).winner_first(&of_task(*b)).then(a.cmp(b)));
            let Some(task) = own else { continue };
            if of_task(task).beats(best.map(|(bid, _)| bid)) {
                best = Some((of_task(task), task));
            }
        }
        if let Some((bid, task)) = best {
            won[bid.robot] = Some(task);
            open[task] -= 1;
        }
    }
    let rounds = robots * graph.diameter(robots);
    let messages = rounds * graph.links(robots);
    let sent =
        Protocol { rounds: rounds as u64, messages: messages as u64, bytes: (messages * BYTES) as u64 };
    (won.into_iter().flatten().collect(), sent)
}

#[cfg(test)]
mod tests {
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    use super::*;
    use crate::assigning::matching;
    use crate::greedy::consensus::agree;

    fn sum(bids: &[Vec<f64>], won: &[usize]) -> f64 {
        bids.iter().zip(won).map(|(row, task)| row[*task]).sum()
    }

    #[test]
    fn the_example_by_hand_gets_half_and_no_free_matrix_less() {
        let example = [vec![1.0, 0.99], vec![1.0, 0.0]];
        let mut draws = ChaCha8Rng::seed_from_u64(7);
        let mut matrix = |n: usize| (0..n).map(|_| (0..n).map(|_| draws.random::<f64>()).collect()).collect();
        let matrices: Vec<Vec<Vec<f64>>> = (0..1_000).map(|turn| matrix(2 + turn % 7)).collect();
        for bids in matrices.iter().chain([&example.to_vec()]) {
            let market = Market { bids: bids.clone(), open: vec![1; bids.len()] };
            let won = central(&market);
            assert!(sum(bids, &won) >= sum(bids, &matching(bids)) / 2.0);
            for graph in [Graph::Full, Graph::Ring, Graph::Line] {
                let most = bids.len() * graph.diameter(bids.len()) + 1;
                for (found, sent) in [one_by_one(&market, graph), agree(&market, graph)] {
                    assert_eq!(found, won, "{graph:?} {bids:?}");
                    assert!(sent.rounds <= most as u64, "{sent:?} {most}");
                }
            }
        }
        let market = Market { bids: example.to_vec(), open: vec![1, 1] };
        let (found, best) = (sum(&example, &central(&market)), sum(&example, &matching(&example)));
        assert_eq!((found.to_bits(), best.to_bits()), (1.0_f64.to_bits(), 1.99_f64.to_bits()));
    }
}
