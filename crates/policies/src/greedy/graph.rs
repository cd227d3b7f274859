//! Which robots of a role hear one another.

use serde::{Deserialize, Serialize};

/// A graph of the robots of a role, in the order of their ids.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Graph {
    /// Each robot hears all others. The default.
    #[default]
    Full,
    /// Each robot hears the one before it and the one after it; so do the first and the last.
    Ring,
    /// Each robot hears the one before it and the one after it.
    Line,
}

impl Graph {
    /// The neighbours of one of these robots.
    pub(super) fn neighbours(self, robot: usize, robots: usize) -> Vec<usize> {
        let others = (0..robots).filter(|other| *other != robot);
        others.filter(|other| self.joins(robot.abs_diff(*other), robots)).collect()
    }

    /// Whether two robots that are this far apart in the order hear each other.
    fn joins(self, apart: usize, robots: usize) -> bool {
        match self {
            Self::Full => true,
            Self::Ring => apart == 1 || apart + 1 == robots,
            Self::Line => apart == 1,
        }
    }

    /// Links of so many robots, each way counted.
    pub(super) fn links(self, robots: usize) -> usize {
        match self {
            Self::Full => robots * robots.saturating_sub(1),
            Self::Ring if robots > 2 => 2 * robots,
            Self::Ring | Self::Line => 2 * robots.saturating_sub(1),
        }
    }

    /// The links between the two robots that are farthest apart.
    pub(super) fn diameter(self, robots: usize) -> usize {
        match self {
            Self::Full => robots.saturating_sub(1).min(1),
            Self::Ring => robots / 2,
            Self::Line => robots.saturating_sub(1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_and_diameters_are_those_of_the_neighbours() {
        for graph in [Graph::Full, Graph::Ring, Graph::Line] {
            for robots in 0..9 {
                let near = |robot: &usize| graph.neighbours(*robot, robots);
                let links = (0..robots).map(|robot| near(&robot).len()).sum::<usize>();
                assert_eq!(links, graph.links(robots), "{graph:?} {robots}");
                let farthest = (0..robots).map(|robot| {
                    let mut reached = vec![robot];
                    let mut steps = 0;
                    while reached.len() < robots {
                        reached.extend(reached.clone().iter().flat_map(near));
                        reached.sort_unstable();
                        reached.dedup();
                        steps += 1;
                    }
                    steps
                });
                assert_eq!(farthest.max().unwrap_or(0), graph.diameter(robots), "{graph:?} {robots}");
            }
        }
    }
}
