//! The shortest way among obstacles, found among the few of them that it has to do with.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use parry2d::math::Vector;
use polyanya::{Mesh, Triangulation};

use super::map::ObstacleMap;
use super::obstacles::{KnownObstacle, ObstacleKey, contains, crosses, push_out, touches};

/// Where a point is too near to an obstacle, a free one is looked for among the obstacles within this range, in metres; where that finds
/// none, within a larger one.
const PUSH_OUT_RANGE_M: f32 = 8.0;

/// A way that is cut once more, after a first round of obstacles, is likely to meet what is this near to the cut leg, in metres, and twice as
/// far in each further round: guessing saves rounds, and with them meshes.
const GUESS_RANGE_M: f32 = 2.0;

/// Meshes kept; when there are more, all are dropped and made anew on demand.
const MAX_MESHES: usize = 64;

/// Times that obstacles are triangulated before they count as impassable. Where outlines run along each other, the library may panic
/// (docs/triangulation.md). Then the outlines are made larger by a little, each by another amount.
const MESH_ATTEMPTS: usize = 6;

/// The most by which the second attempt makes an outline larger, in metres; twice as much in each further one.
const NUDGE_M: f32 = 5.0e-4;

/// Meshes among few obstacles, kept to save time: robots that go the same way ask for the same ones again and again. None where no
/// attempt made one.
#[derive(Default)]
pub(super) struct Meshes(BTreeMap<MeshKey, Option<Mesh>>);

/// What a mesh was made of: the distance from the border as its bits, the obstacles with the sightings in which they are known, and the
/// numbers of the closed zones.
type MeshKey = (u32, Vec<(ObstacleKey, u32)>, Vec<u32>);

/// What a way has to keep clear of.
pub(super) struct Search<'a> {
    /// Width and height of the arena, in metres.
    pub(super) arena: Vector,
    /// Distance to keep from its border, in metres.
    pub(super) offset: f32,
    /// Obstacles that matter as far as a way runs into them; none for a robot that flies over them.
    pub(super) known: Option<&'a ObstacleMap>,
    /// Corners of the few obstacles that count in any case.
    pub(super) always: Vec<&'a [Vector]>,
    /// Numbers that tell these obstacles from others, where their meshes are to be kept.
    pub(super) numbers: Option<&'a [u32]>,
}

impl<'a> Search<'a> {
    /// The free point nearest to a point, or nearly: the point itself where it is free and off the border.
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

    /// The shortest way from one free point to another, without its start; `None` where there is none. `hint` are the waypoints of a way
    /// that may be cut, to begin with what it meets; there may be none.
    pub(super) fn way(
        &self,
        [from, to]: [Vector; 2],
        hint: &[Vector],
        meshes: &mut Meshes,
    ) -> Option<Vec<Vector>> {
        let mut way = if hint.is_empty() { vec![to] } else { hint.to_vec() };
        let mut met = self.bent_round(hint);
        let mut is_clear = hint.is_empty() && !self.always.iter().any(|polygon| crosses(polygon, from, to));
        let mut guess = 0.0;
        loop {
            let news = self.news_along(from, &way, &met, guess);
            if news.is_empty() && is_clear {
                return Some(way);
            }
            met.extend(news);
            met.sort_unstable_by_key(|obstacle| obstacle.key);
            way = self.way_round(&met, [from, to], meshes)?;
            is_clear = true;
            guess = f32::max(GUESS_RANGE_M, 2.0 * guess);
        }
    }

    /// The obstacles at whose corners a way bends.
    fn bent_round(&self, way: &[Vector]) -> Vec<&'a KnownObstacle> {
        let Some(known) = self.known else { return Vec::new() };
        let bends = way
            .iter()
            .flat_map(|bend| known.near(*bend, 0.0).filter(|obstacle| touches(&obstacle.planned, *bend)));
        let mut met: Vec<&KnownObstacle> = bends.collect();
        met.sort_unstable_by_key(|obstacle| obstacle.key);
        met.dedup_by_key(|obstacle| obstacle.key);
        met
    }

    /// The shortest way round these obstacles.
    fn way_round(
        &self,
        met: &[&KnownObstacle],
        [from, to]: [Vector; 2],
        Meshes(meshes): &mut Meshes,
    ) -> Option<Vec<Vector>> {
        let Some(numbers) = self.numbers else { return Some(self.mesh(met)?.path(from, to)?.path) };
        let seen = met.iter().map(|obstacle| (obstacle.key, obstacle.sighting)).collect();
        let key = (self.offset.to_bits(), seen, numbers.to_vec());
        if meshes.len() >= MAX_MESHES && !meshes.contains_key(&key) {
            meshes.clear();
        }
        Some(meshes.entry(key).or_insert_with(|| self.mesh(met)).as_ref()?.path(from, to)?.path)
    }

    /// The obstacles near those legs of a way that run into one, beyond those that it was made to keep clear of; none for a way that runs
    /// into none.
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

    /// The free plane among obstacles, as a navigation mesh; `None` where all attempts fail.
    fn mesh(&self, met: &[&KnownObstacle]) -> Option<Mesh> {
        (0..MESH_ATTEMPTS).find_map(|attempt| {
            // Nothing is shared with a triangulation that is left unfinished.
            catch_unwind(AssertUnwindSafe(|| self.triangulated(met, attempt))).ok()
        })
    }

    /// The mesh among obstacles that are made a little larger in each attempt but the first.
    fn triangulated(&self, met: &[&KnownObstacle], attempt: usize) -> Mesh {
        let (offset, Vector { x, y }) = (self.offset, self.arena - self.offset);
        let border = [[offset, offset], [x, offset], [x, y], [offset, y]].map(Vector::from);
        let mut triangulation = Triangulation::from_outer_edges(&border);
        let met = met.iter().map(|obstacle| obstacle.planned.as_slice());
        let outlines = met.chain(self.always.iter().copied()).enumerate();
        triangulation.add_obstacles(outlines.map(|(number, outline)| nudged(outline, number, attempt)));
        let mut mesh = triangulation.as_navmesh();
        mesh.set_search_delta(0.01);
        mesh
    }
}

/// An outline that is made larger, by another amount for each number. The first attempt leaves it as it is.
fn nudged(outline: &[Vector], number: usize, attempt: usize) -> Vec<Vector> {
    let Some(doublings) = attempt.checked_sub(1) else { return outline.to_vec() };
    let share = (1 + 7 * number % 13) as f32 / 13.0;
    let by = NUDGE_M * share * (1 << doublings) as f32;
    let middle = outline.iter().copied().sum::<Vector>() / outline.len() as f32;
    outline.iter().map(|corner| *corner + (*corner - middle).normalize_or_zero() * by).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Outline;

    /// The smallest case known that panics in the library, from a room whose walls meet (docs/triangulation.md).
    const PANICS: [[[f32; 2]; 3]; 4] = [
        [[34.8173, 73.53], [36.1, 74.6], [35.8847, 74.5]],
        [[35.1, 67.7], [34.926_003, 67.44], [36.3, 43.3]],
        [[34.926_003, 95.193_87], [34.926_003, 67.436_87], [36.3, 67.1]],
        [[35.8, 68.0], [33.74, 67.3], [36.2, 67.0]],
    ];

    #[test]
    fn outlines_that_the_library_cannot_triangulate_are_made_larger_by_a_little() {
        let outlines = PANICS.map(|outline| outline.map(Vector::from).to_vec());
        let search = Search {
            arena: Vector::splat(100.0),
            offset: 0.55,
            known: None,
            always: outlines.iter().map(Vec::as_slice).collect(),
            numbers: None,
        };
        let attempt = |attempt| catch_unwind(AssertUnwindSafe(|| search.triangulated(&[], attempt)));
        assert!(attempt(0).is_err(), "the library is mended: docs/triangulation.md and the attempts can go");
        let ends = [Vector::new(20.0, 70.0), Vector::new(50.0, 70.0)];
        let way = search.way(ends, &[], &mut Meshes::default()).unwrap();
        let legs = || std::iter::once(&ends[0]).chain(&way).zip(&way);
        assert!(legs().all(|(a, b)| !outlines.iter().any(|outline| crosses(outline, *a, *b))));
        let length: f32 = legs().map(|(a, b)| (*b - *a).length()).sum();
        assert!((35.0..60.0).contains(&length), "{length} m");
    }

    #[test]
    fn points_in_the_strip_along_the_border_find_a_free_point_beside_what_stands_there() {
        let disc = Outline::disc(Vector::new(10.0, 1.4), 0.3);
        let known: ObstacleMap =
            std::iter::once(KnownObstacle::new(ObstacleKey::Debris(0), 1, &disc, 0.4, 0.15)).collect();
        let search = Search {
            arena: Vector::splat(20.0),
            offset: 0.55,
            known: Some(&known),
            always: Vec::new(),
            numbers: None,
        };
        let point = Vector::new(10.0, 0.45); // free itself, but nearer to the border than routes go
        assert!(!search.covers(point) && search.covers(Vector::new(10.0, 0.57)));
        let free = search.free_point(point);
        assert!(!search.covers(free) && free.y >= 0.55 && (free - point).length() < 1.2, "{free}");
        assert!(search.way([free, Vector::new(10.0, 15.0)], &[], &mut Meshes::default()).is_some());
        assert_eq!(search.free_point(Vector::new(5.0, 5.0)), Vector::new(5.0, 5.0));
    }
}
