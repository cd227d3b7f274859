//! The shortest path among obstacles, found among the few obstacles that matter.

use parry2d::math::Vector;

use super::map::ObstacleMap;
use super::obstacles::{KnownObstacle, contains, crosses, push_out};
use super::tangents::{Plane, Wanted};

/// Range around a point within an obstacle in which the obstacles are considered when a free point is
/// searched for, in metres. If the search finds none, the range grows.
const PUSH_OUT_RANGE_M: f32 = 8.0;

/// When a path is cut again after a first round, obstacles within this distance of the cut leg are added too,
/// in metres; twice as far in each further round. The path is likely to meet them, and guessing saves rounds.
const GUESS_RANGE_M: f32 = 2.0;

/// The obstacles from which a path has to keep clear.
pub(super) struct Search<'a> {
    /// Width and height of the arena, in metres.
    pub(super) arena: Vector,
    /// Distance to keep from its border, in metres.
    pub(super) offset: f32,
    /// Obstacles that matter if a path runs into them; none for a robot that flies over them.
    pub(super) known: Option<&'a ObstacleMap>,
    /// Corners of the few obstacles that always count.
    pub(super) always: Vec<&'a [Vector]>,
}

impl<'a> Search<'a> {
    /// The free point nearest to a point, or nearly so; the point itself if it is free and off the border.
    pub(super) fn free_point(&self, point: Vector) -> Vector {
        let mut free = push_out::<&[Vector]>(point, &[], self.arena, self.offset);
        let mut range = PUSH_OUT_RANGE_M;
        while self.covers(free) && range < 4.0 * self.arena.max_element() {
            free = push_out(point, &self.near(point, range), self.arena, self.offset);
            range *= 4.0;
        }
        free
    }

    /// Corners of the obstacles near a point.
    fn near(&self, point: Vector, range: f32) -> Vec<&'a [Vector]> {
        let near = self.known.into_iter().flat_map(|known| known.near(point, range));
        let mut near: Vec<&KnownObstacle> = near.collect();
        near.sort_unstable_by_key(|obstacle| obstacle.key);
        near.into_iter()
            .map(|obstacle| obstacle.planned.as_slice())
            .chain(self.always.iter().copied())
            .collect()
    }

    fn covers(&self, point: Vector) -> bool {
        self.known.is_some_and(|known| known.covers(point))
            || self.always.iter().any(|polygon| contains(polygon, point))
    }

    /// The shortest path from one free point to another, or any, without its start; `None` if there is none.
    pub(super) fn way(&self, [from, to]: [Vector; 2], wanted: Wanted) -> Option<Vec<Vector>> {
        let (mut way, mut met, mut guess) = (vec![to], Vec::new(), 0.0);
        let mut is_clear = !self.always.iter().any(|polygon| crosses(polygon, from, to));
        loop {
            let news = self.news_along(from, &way, &met, guess);
            if news.is_empty() && is_clear {
                return Some(way);
            }
            met.extend(news);
            met.sort_unstable_by_key(|obstacle| obstacle.key);
            let outlines = met.iter().map(|obstacle| obstacle.planned.as_slice());
            let border = [Vector::splat(self.offset), self.arena - self.offset];
            way = Plane::new(border, outlines.chain(self.always.iter().copied())).way([from, to], wanted)?;
            is_clear = true;
            guess = f32::max(GUESS_RANGE_M, 2.0 * guess);
        }
    }

    /// The obstacles near the cut legs of a path that the path was not made to avoid. Empty if it runs into
    /// none.
    fn news_along(
        &self,
        from: Vector,
        way: &[Vector],
        met: &[&KnownObstacle],
        guess: f32,
    ) -> Vec<&'a KnownObstacle> {
        let Some(known) = self.known else { return Vec::new() };
        let is_new =
            |obstacle: &&KnownObstacle| met.binary_search_by_key(&obstacle.key, |met| met.key).is_err();
        let is_cut = |a, b| known.along(a, b).filter(is_new).any(|obstacle| crosses(&obstacle.planned, a, b));
        let legs = std::iter::once(&from).chain(way).zip(way);
        let cut = legs.filter(|(a, b)| is_cut(**a, **b));
        let mut news: Vec<&KnownObstacle> =
            cut.flat_map(|(a, b)| known.beside(*a, *b, guess)).filter(is_new).collect();
        news.sort_unstable_by_key(|obstacle| obstacle.key);
        news.dedup_by_key(|obstacle| obstacle.key);
        news
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planning::ObstacleKey;
    use scenario::shapes::Outline;

    #[test]
    fn points_in_the_strip_along_the_border_find_a_free_point_beside_what_stands_there() {
        let disc = Outline::disc(Vector::new(10.0, 1.4), 0.3);
        let known: ObstacleMap =
            std::iter::once(KnownObstacle::new(ObstacleKey::Debris(0), &disc, 0.4, 0.15)).collect();
        let search =
            Search { arena: Vector::splat(20.0), offset: 0.55, known: Some(&known), always: Vec::new() };
        let point = Vector::new(10.0, 0.45); // free itself, but nearer to the border than routes go
        assert!(!search.covers(point) && search.covers(Vector::new(10.0, 0.57)));
        let free = search.free_point(point);
        assert!(!search.covers(free) && free.y >= 0.55 && (free - point).length() < 1.2, "{free}");
        assert!(search.way([free, Vector::new(10.0, 15.0)], Wanted::Shortest).is_some());
        assert_eq!(search.free_point(Vector::new(5.0, 5.0)), Vector::new(5.0, 5.0));
    }
}
