//! Robots in order along x: who is near a point, by sweep and prune.

use parry2d::math::Vector;

/// A robot where it is.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// Its place, in metres.
    pub at: Vector,
    /// Whether it flies.
    pub is_aerial: bool,
}

/// Robots in order along x. The order is kept from step to step, so that sorting takes linear time.
#[derive(Debug, Clone, Default)]
pub struct ByX {
    order: Vec<usize>,
    /// The same robots, in this order.
    spots: Vec<Spot>,
}

impl ByX {
    /// Puts the robots in order along x, those of one x by number.
    pub fn sort(&mut self, count: usize, spot: impl Fn(usize) -> Spot) {
        if self.order.len() != count {
            self.order = (0..count).collect();
        }
        self.order.sort_by(|a, b| spot(*a).at.x.total_cmp(&spot(*b).at.x).then(a.cmp(b)));
        self.spots.clear();
        self.spots.extend(self.order.iter().map(|i| spot(*i)));
    }

    /// The robots in order along x, each with its place.
    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = (usize, Spot)> + Clone {
        self.order.iter().copied().zip(self.spots.iter().copied())
    }

    /// The robots within `range` metres of a point, in order along x.
    pub fn within(&self, point: Vector, range: f32) -> impl Iterator<Item = (usize, Spot)> {
        let first = self.spots.partition_point(|spot| spot.at.x < point.x - range);
        let strip = self.iter().skip(first).take_while(move |(_, spot)| spot.at.x <= point.x + range);
        strip.filter(move |(_, spot)| (spot.at - point).length_squared() < range * range)
    }
}
