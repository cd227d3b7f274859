//! The shortest path among obstacles, found among the few obstacles that matter.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use parry2d::math::Vector;
use polyanya::{Mesh, Triangulation};

use super::faces::{Faces, SEARCH_DELTA_M};
use super::map::ObstacleMap;
use super::obstacles::{
    KnownObstacle, ObstacleKey, contains, crosses, digest, is_entered, push_out, touches,
};

/// Range around a point within an obstacle in which the obstacles are considered when a free point is
/// searched for, in metres. If the search finds none, the range grows.
const PUSH_OUT_RANGE_M: f32 = 8.0;

/// When a path is cut again after a first round, obstacles within this distance of the cut leg are added too,
/// in metres; twice as far in each further round. The path is likely to meet them, and guessing saves rounds
/// and meshes.
const GUESS_RANGE_M: f32 = 2.0;

/// Number of meshes that a thread keeps. When there are more, all are dropped and made anew on demand.
const MAX_MESHES: usize = 512;

/// Attempts to find a path among obstacles before they count as impassable. The first attempt leaves outlines
/// apart. Where outlines meet, the library may then panic, or take the inside of an obstacle for free
/// (docs/triangulation.md). Further attempts join the outlines; each but the first of them makes the outlines
/// a little larger, each by a different amount.
const ATTEMPTS: usize = 6;

/// The most by which the third attempt makes an outline larger, in metres; twice as much in each further
/// attempt.
const NUDGE_M: f32 = 5.0e-4;

/// The free plane among few obstacles.
enum Plane {
    /// Among outlines that are left apart.
    Apart(Mesh),
    /// Among outlines that are joined.
    Joined(Faces),
}

impl Plane {
    fn path(&self, from: Vector, to: Vector) -> Option<Vec<Vector>> {
        match self {
            Self::Apart(mesh) => Some(mesh.path(from, to)?.path),
            Self::Joined(faces) => faces.path(from, to),
        }
    }
}

/// Planes among few obstacles. `None` if the library failed.
#[derive(Default)]
struct Meshes(BTreeMap<MeshKey, Option<Plane>>);

thread_local! {
    /// The planes that were made on this thread, kept to save time: robots on the same route ask for the same
    /// planes again and again, and so do trials of one scenario. A plane follows from its key alone.
    static MESHES: RefCell<Meshes> = RefCell::default();
}

/// What a plane is made of.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct MeshKey {
    /// Width and height of the arena, and distance from its border, as bits.
    border: [u32; 3],
    /// The obstacles, with the hashes of their outlines.
    obstacles: Vec<(ObstacleKey, u64)>,
    /// Hashes of the outlines of the closed zones.
    zones: Vec<u64>,
    attempt: usize,
}

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
    /// Whether meshes are kept for later searches: not those round obstacles that will soon be elsewhere.
    pub(super) keeps_meshes: bool,
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

    /// The shortest path from one free point to another, without its start; `None` if there is none. `hint`
    /// holds the waypoints of a path that may be cut; the search begins with the obstacles at its bends. It
    /// may be empty.
    pub(super) fn way(&self, [from, to]: [Vector; 2], hint: &[Vector]) -> Option<Vec<Vector>> {
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
            way = self.way_round(&met, [from, to])?;
            is_clear = true;
            guess = f32::max(GUESS_RANGE_M, 2.0 * guess);
        }
    }

    /// The obstacles at whose corners a path bends.
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

    /// The shortest path round these obstacles.
    fn way_round(&self, met: &[&KnownObstacle], [from, to]: [Vector; 2]) -> Option<Vec<Vector>> {
        for attempt in 0..ATTEMPTS {
            let (make, path) = (|| self.plane(met, attempt), |plane: &Plane| plane.path(from, to));
            let found = if self.keeps_meshes {
                MESHES.with_borrow_mut(|meshes| meshes.get(self.key(met, attempt), make).map(path))
            } else {
                make().as_ref().map(path)
            };
            match found {
                Some(Some(way)) if self.keeps_clear(met, from, &way) => return Some(way),
                Some(None) if attempt > 0 => return None, // the joined outlines leave no way
                Some(_) | None => {}
            }
        }
        None
    }

    /// The key by which a plane is kept.
    fn key(&self, met: &[&KnownObstacle], attempt: usize) -> MeshKey {
        MeshKey {
            border: [self.arena.x, self.arena.y, self.offset].map(f32::to_bits),
            obstacles: met.iter().map(|obstacle| (obstacle.key, obstacle.digest)).collect(),
            zones: self.always.iter().map(|outline| digest(outline)).collect(),
            attempt,
        }
    }

    /// Whether a path enters none of the obstacles that it was made to avoid, except one that its start or
    /// its end is in.
    fn keeps_clear(&self, met: &[&KnownObstacle], from: Vector, way: &[Vector]) -> bool {
        let outlines = met.iter().map(|obstacle| obstacle.planned.as_slice());
        outlines.chain(self.always.iter().copied()).all(|outline| {
            let has_end = |at: Option<&Vector>| at.is_some_and(|at| contains(outline, *at));
            let mut legs = std::iter::once(&from).chain(way).zip(way);
            has_end(Some(&from)) || has_end(way.last()) || !legs.any(|(a, b)| is_entered(outline, *a, *b))
        })
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

    /// The free plane among obstacles; `None` if the library fails.
    fn plane(&self, met: &[&KnownObstacle], attempt: usize) -> Option<Plane> {
        // Nothing is shared with a triangulation that is left unfinished.
        catch_unwind(AssertUnwindSafe(|| match attempt.checked_sub(1) {
            None => Plane::Apart(self.apart(met)),
            Some(nudge) => Plane::Joined(self.joined(met, nudge)),
        }))
        .ok()
    }

    /// Corners of the border of all routes.
    fn border(&self) -> [Vector; 4] {
        let (offset, Vector { x, y }) = (self.offset, self.arena - self.offset);
        [[offset, offset], [x, offset], [x, y], [offset, y]].map(Vector::from)
    }

    /// Corners of all obstacles that count.
    fn outlines(&self, met: &[&'a KnownObstacle]) -> impl Iterator<Item = &'a [Vector]> {
        let met = met.iter().map(|obstacle| obstacle.planned.as_slice());
        met.chain(self.always.iter().copied())
    }

    /// The mesh among outlines that are left apart.
    fn apart(&self, met: &[&KnownObstacle]) -> Mesh {
        let mut triangulation = Triangulation::from_outer_edges(&self.border());
        triangulation.add_obstacles(self.outlines(met).map(<[Vector]>::to_vec));
        let mut mesh = triangulation.as_navmesh();
        mesh.set_search_delta(SEARCH_DELTA_M);
        mesh
    }

    /// The faces among joined outlines.
    fn joined(&self, met: &[&KnownObstacle], nudge: usize) -> Faces {
        let outlines = self.outlines(met).enumerate();
        let outlines: Vec<_> = outlines.map(|(number, outline)| nudged(outline, number, nudge)).collect();
        Faces::among(&self.border(), &outlines)
    }
}

impl Meshes {
    fn get(&mut self, key: MeshKey, make: impl FnOnce() -> Option<Plane>) -> Option<&Plane> {
        if self.0.len() >= MAX_MESHES && !self.0.contains_key(&key) {
            self.0.clear();
        }
        self.0.entry(key).or_insert_with(make).as_ref()
    }
}

/// An enlarged outline, by a different amount for each number. The first attempt leaves it as it is.
fn nudged(outline: &[Vector], number: usize, nudge: usize) -> Vec<Vector> {
    let Some(doublings) = nudge.checked_sub(1) else { return outline.to_vec() };
    let share = (1 + 7 * number % 13) as f32 / 13.0;
    let by = NUDGE_M * share * (1 << doublings) as f32;
    let middle = outline.iter().copied().sum::<Vector>() / outline.len() as f32;
    outline.iter().map(|corner| *corner + (*corner - middle).normalize_or_zero() * by).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Outline;

    /// The smallest known case that panics in the library: a room whose walls meet (docs/triangulation.md).
    const PANICS: [[[f32; 2]; 3]; 4] = [
        [[34.8173, 73.53], [36.1, 74.6], [35.8847, 74.5]],
        [[35.1, 67.7], [34.926_003, 67.44], [36.3, 43.3]],
        [[34.926_003, 95.193_87], [34.926_003, 67.436_87], [36.3, 67.1]],
        [[35.8, 68.0], [33.74, 67.3], [36.2, 67.0]],
    ];

    #[test]
    fn outlines_that_the_library_cannot_triangulate_are_joined() {
        let outlines = PANICS.map(|outline| outline.map(Vector::from).to_vec());
        let search = Search {
            arena: Vector::splat(100.0),
            offset: 0.55,
            known: None,
            always: outlines.iter().map(Vec::as_slice).collect(),
            keeps_meshes: false,
        };
        assert!(search.plane(&[], 0).is_none(), "the library is mended: docs/triangulation.md can go");
        let ends = [Vector::new(20.0, 70.0), Vector::new(50.0, 70.0)];
        let way = search.way(ends, &[]).unwrap();
        let legs = || std::iter::once(&ends[0]).chain(&way).zip(&way);
        assert!(legs().all(|(a, b)| !outlines.iter().any(|outline| crosses(outline, *a, *b))));
        let length: f32 = legs().map(|(a, b)| (*b - *a).length()).sum();
        assert!((35.0..60.0).contains(&length), "{length} m");
    }

    #[test]
    fn points_in_the_strip_along_the_border_find_a_free_point_beside_what_stands_there() {
        let disc = Outline::disc(Vector::new(10.0, 1.4), 0.3);
        let known: ObstacleMap =
            std::iter::once(KnownObstacle::new(ObstacleKey::Debris(0), &disc, 0.4, 0.15)).collect();
        let search = Search {
            arena: Vector::splat(20.0),
            offset: 0.55,
            known: Some(&known),
            always: Vec::new(),
            keeps_meshes: false,
        };
        let point = Vector::new(10.0, 0.45); // free itself, but nearer to the border than routes go
        assert!(!search.covers(point) && search.covers(Vector::new(10.0, 0.57)));
        let free = search.free_point(point);
        assert!(!search.covers(free) && free.y >= 0.55 && (free - point).length() < 1.2, "{free}");
        assert!(search.way([free, Vector::new(10.0, 15.0)], &[]).is_some());
        assert_eq!(search.free_point(Vector::new(5.0, 5.0)), Vector::new(5.0, 5.0));
    }
}
