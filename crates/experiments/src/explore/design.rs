//! The points at which a scenario's parameters are evaluated. They come in blocks, each drawn
//! independently, so that more blocks can follow. A place is a value's share of its range, from 0 to 1.

use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use serde::{Deserialize, Serialize};

/// Method of a sensitivity study.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Elementary effects: one parameter moves at a time, along trajectories. Needs few points and gives a
    /// ranking.
    Morris,
    /// Shares of the variance. Needs many points.
    Sobol,
}

/// Levels on which trajectories move: 0, 1/3, 2/3, 1.
const LEVELS: f64 = 4.0;
/// How far a parameter moves, as a share of its range: p / (2 (p - 1)).
pub(super) const MOVE: f64 = LEVELS / (2.0 * (LEVELS - 1.0));

/// The points of a block, as places. Morris: a trajectory; `moved` is the parameter that moves at each
/// point after the first. Sobol: the points A and B, then A with each parameter in turn taken from B.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Block {
    pub places: Vec<Vec<f64>>,
    pub moved: Vec<usize>,
}

impl Block {
    /// Draws the block with this number. It does not depend on the number of blocks.
    pub fn draw(method: Method, parameters: usize, seed: u64, number: u32) -> Self {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        draws.set_stream(u64::from(number));
        match method {
            Method::Morris => trajectory(parameters, &mut draws),
            Method::Sobol => mixed(parameters, &mut draws),
        }
    }
}

fn trajectory(parameters: usize, draws: &mut ChaCha8Rng) -> Block {
    let mut moved: Vec<usize> = (0..parameters).collect();
    moved.shuffle(draws);
    let step = 1.0 / (LEVELS - 1.0);
    let mut draw = || {
        let low = if draws.random::<bool>() { step } else { 0.0 };
        if draws.random::<bool>() { (low, low + MOVE) } else { (low + MOVE, low) }
    };
    let ends: Vec<(f64, f64)> = (0..parameters).map(|_| draw()).collect();
    let mut places = vec![ends.iter().map(|(from, _)| *from).collect::<Vec<f64>>()];
    for parameter in &moved {
        let mut next = places[places.len() - 1].clone();
        next[*parameter] = ends[*parameter].1;
        places.push(next);
    }
    Block { places, moved }
}

fn mixed(parameters: usize, draws: &mut ChaCha8Rng) -> Block {
    let mut point = || (0..parameters).map(|_| draws.random::<f64>()).collect::<Vec<f64>>();
    let (a, b) = (point(), point());
    let with = |i: usize| a.iter().enumerate().map(|(k, place)| if k == i { b[k] } else { *place }).collect();
    let mixed: Vec<Vec<f64>> = (0..parameters).map(with).collect();
    Block { places: [vec![a, b], mixed].concat(), moved: (0..parameters).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn along_a_trajectory_each_parameter_moves_once_and_alone() {
        for number in 0..50 {
            let block = Block::draw(Method::Morris, 4, 7, number);
            assert_eq!(block.places.len(), 5);
            let mut moved = block.moved.clone();
            moved.sort_unstable();
            assert_eq!(moved, [0, 1, 2, 3]);
            for (pair, parameter) in block.places.windows(2).zip(&block.moved) {
                for (k, (from, to)) in pair[0].iter().zip(&pair[1]).enumerate() {
                    let by = (to - from).abs();
                    assert!((by - if k == *parameter { MOVE } else { 0.0 }).abs() < 1e-12);
                    assert!((0.0..=1.0 + 1e-12).contains(to));
                }
            }
        }
        assert_eq!(Block::draw(Method::Morris, 4, 7, 3), Block::draw(Method::Morris, 4, 7, 3));
        assert_ne!(Block::draw(Method::Morris, 4, 7, 3), Block::draw(Method::Morris, 4, 7, 4));
    }

    #[test]
    fn mixed_points_take_one_parameter_from_the_second() {
        let block = Block::draw(Method::Sobol, 3, 1, 0);
        let [a, b] = [&block.places[0], &block.places[1]];
        for (i, mixed) in block.places[2..].iter().enumerate() {
            (0..3).for_each(|k| assert!((mixed[k] - if k == i { b[k] } else { a[k] }).abs() < 1e-15));
        }
    }
}
