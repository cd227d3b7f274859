//! Predicted conflicts: pairs of robots whose preferred velocities would bring them into each other's safety
//! distance, and the sets that these pairs connect.

use super::Mover;
use super::passing::PASSING_RANGE_M;
use crate::by_x::{ByX, Spot};

/// Robots near one another.
#[derive(Default)]
pub(super) struct Neighbours {
    by_x: ByX,
    /// For each robot, those near it: found by [`Self::pair`].
    lists: Vec<Vec<usize>>,
}

impl Neighbours {
    /// Puts the robots in order along x.
    pub(super) fn sort(&mut self, movers: &[Mover]) {
        self.by_x.sort(movers.len(), |i| Spot { at: movers[i].position, is_aerial: movers[i].aerial });
    }

    /// The robots in order along x. Needs [`Self::sort`] first.
    pub(super) fn by_x(&self) -> &ByX {
        &self.by_x
    }

    /// Adds the robots of its layer within `range` metres of robot `i` to a list, in no particular order.
    /// Needs [`Self::sort`] first.
    pub(super) fn find(&self, i: usize, me: &Mover, range: f32, list: &mut Vec<usize>) {
        let near = self.by_x.within(me.position, range);
        list.extend(near.filter(|(j, spot)| *j != i && spot.is_aerial == me.aerial).map(|(j, _)| j));
    }

    /// Finds, for each robot that wishes to move, those of its layer that it could meet within the horizon or
    /// that could be in its way.
    /// Needs [`Self::sort`] first.
    pub(super) fn pair(&mut self, movers: &[Mover], margin: f32, horizon: f32) {
        let range = range(movers, margin, horizon);
        clear(&mut self.lists, movers.len());
        let lists = &mut self.lists;
        let mut rest = self.by_x.iter();
        while let Some((a, from)) = rest.next() {
            let a_wishes = movers[a].wishes_to_move();
            for (b, to) in rest.clone() {
                let apart = to.at - from.at;
                if apart.x > range {
                    break;
                }
                if from.is_aerial == to.is_aerial && apart.length_squared() <= range * range {
                    if a_wishes {
                        lists[a].push(b);
                    }
                    if movers[b].wishes_to_move() {
                        lists[b].push(a);
                    }
                }
            }
        }
        self.lists.iter_mut().for_each(|list| list.sort_unstable());
    }

    /// The pairs, each once with the lower number first, in order.
    fn pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let lists = self.lists.iter().enumerate();
        lists.flat_map(|(a, list)| list.iter().filter(move |b| **b > a).map(move |b| (a, *b)))
    }

    /// The robots near robot `i`, in order. Needs [`Self::pair`] first.
    pub(super) fn of(&self, i: usize) -> &[usize] {
        &self.lists[i]
    }
}

/// The distance within which robots could meet within the horizon or be in each other's way, in metres.
pub(super) fn range(movers: &[Mover], margin: f32, horizon: f32) -> f32 {
    let fastest = movers.iter().map(|mover| mover.preferred.length()).fold(0.0, f32::max);
    (2.0 * fastest * horizon).max(PASSING_RANGE_M) + 2.0 * largest(movers) + margin
}

/// The largest radius, in metres.
pub(super) fn largest(movers: &[Mover]) -> f32 {
    movers.iter().map(|mover| mover.radius).fold(0.0, f32::max)
}

/// Whether two robots that both want to move would come closer than their safety distance within the horizon
/// if both moved at their preferred velocities. Robots that are too close already but move apart are not in
/// conflict.
fn will_conflict(a: &Mover, b: &Mover, margin: f32, horizon: f32) -> bool {
    if !a.wishes_to_move() || !b.wishes_to_move() {
        return false;
    }
    let apart = b.position - a.position;
    let closing = b.preferred - a.preferred;
    let approach = -apart.dot(closing);
    if approach <= 0.0 {
        return false;
    }
    let nearest_at = (approach / closing.length_squared()).min(horizon);
    let safety = a.radius + b.radius + margin;
    (apart + closing * nearest_at).length_squared() < safety * safety
}

fn clear(lists: &mut Vec<Vec<usize>>, robots: usize) {
    lists.resize_with(robots, Vec::new);
    lists.iter_mut().for_each(Vec::clear);
}

/// The predicted conflicts of a step.
#[derive(Default)]
pub(super) struct Conflicts {
    pairs: Vec<(usize, usize)>,
    lists: Vec<Vec<usize>>,
}

impl Conflicts {
    /// Finds the pairs of neighbours in conflict, for a margin in metres and a horizon in seconds.
    pub(super) fn find(&mut self, movers: &[Mover], neighbours: &Neighbours, margin: f32, horizon: f32) {
        let in_conflict = |(a, b): &(usize, usize)| will_conflict(&movers[*a], &movers[*b], margin, horizon);
        self.pairs.clear();
        self.pairs.extend(neighbours.pairs().filter(in_conflict));
        clear(&mut self.lists, movers.len());
        for (a, b) in &self.pairs {
            self.lists[*a].push(*b);
            self.lists[*b].push(*a);
        }
    }

    /// Whether no robot is in conflict with another.
    pub(super) fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// The robots in conflict with robot `i`.
    pub(super) fn of(&self, i: usize) -> &[usize] {
        &self.lists[i]
    }

    /// The connected sets of robots in conflict: at least two robots each, in ascending order, sorted by
    /// their first member.
    pub(super) fn components(&self) -> Vec<Vec<usize>> {
        components(self.lists.len(), &self.pairs)
    }
}

fn components(count: usize, pairs: &[(usize, usize)]) -> Vec<Vec<usize>> {
    if pairs.is_empty() {
        return Vec::new();
    }
    let mut root: Vec<usize> = (0..count).collect();
    let find = |root: &mut Vec<usize>, mut i: usize| {
        while root[i] != i {
            root[i] = root[root[i]];
            i = root[i];
        }
        i
    };
    for (a, b) in pairs {
        let (a, b) = (find(&mut root, *a), find(&mut root, *b));
        root[a.max(b)] = a.min(b);
    }
    let mut sets: Vec<Vec<usize>> = Vec::new();
    let mut set_of = vec![usize::MAX; count];
    let mut members: Vec<usize> = pairs.iter().flat_map(|(a, b)| [*a, *b]).collect();
    members.sort_unstable();
    members.dedup();
    for i in members {
        let first = find(&mut root, i);
        if set_of[first] == usize::MAX {
            set_of[first] = sets.len();
            sets.push(Vec::new());
        }
        sets[set_of[first]].push(i);
    }
    sets
}

#[cfg(test)]
mod tests {
    use super::super::testing::mover;
    use super::*;

    #[test]
    fn robots_that_would_meet_conflict_and_robots_that_part_or_keep_abreast_do_not() {
        let conflict = |a: Mover, b: Mover| will_conflict(&a, &b, 0.1, 1.0);
        let east = |x: f32, y: f32| mover(0, [x, y], [1.0, 0.0]);
        let west = |x: f32, y: f32| mover(1, [x, y], [-1.0, 0.0]);
        assert!(conflict(east(0.0, 0.0), west(2.0, 0.0)));
        assert!(!conflict(east(0.0, 0.0), west(2.0, 1.0)), "passes beside");
        assert!(!conflict(east(0.0, 0.0), west(5.0, 0.0)), "beyond the horizon");
        assert!(!conflict(west(0.0, 0.0), east(0.5, 0.0)), "parts");
        assert!(!conflict(east(0.0, 0.0), mover(1, [0.0, 0.95], [1.0, 0.0])), "abreast");
        assert!(!conflict(east(0.0, 0.0), mover(1, [1.0, 0.0], [0.0, 0.0])), "the other stands");
    }

    #[test]
    fn sets_are_connected_components() {
        assert_eq!(components(6, &[(0, 3), (3, 5), (1, 2)]), [vec![0, 3, 5], vec![1, 2]]);
    }
}
