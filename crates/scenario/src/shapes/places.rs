//! Spatial search for numbered things.

use parry2d::bounding_volume::{Aabb, BoundingVolume};
use parry2d::math::Vector;
use parry2d::partitioning::{Bvh, BvhNode, TraversalAction};
use parry2d::query::{Ray, RayCast};
use smallvec::SmallVec;

/// Bounds are enlarged by this much, in metres, so that rounding hides no thing.
const BOUNDS_MARGIN_M: f32 = 0.01;

/// Numbers of things, in no particular order. Callers that depend on an order sort them.
pub type Found = SmallVec<[usize; 32]>;

/// A tree of the bounding boxes of numbered things. The cost of a search depends mainly on how much it finds.
#[derive(Debug, Clone, Default)]
pub struct Places {
    tree: Bvh,
}

impl Places {
    /// Sets the bounding box of a thing.
    pub fn put(&mut self, number: usize, bounds: Aabb) {
        self.tree.insert(bounds.loosened(BOUNDS_MARGIN_M), number as u32);
    }

    /// The things whose boxes reach within this range of a point, in metres, separately in x and in y.
    pub fn near(&self, point: Vector, range: f32) -> Found {
        let area = Aabb::from_half_extents(point, Vector::splat(range));
        self.find(|node| node.aabb().intersects(&area))
    }

    /// The things whose boxes the line from `a` to `b` touches.
    pub fn along(&self, a: Vector, b: Vector) -> Found {
        let way = Ray::new(a, b - a);
        self.find(|node| node.cast_ray(&way, 1.0) <= 1.0)
    }

    /// The things whose boxes reach within this range of the line from `a` to `b`, in metres, separately in x
    /// and in y.
    pub fn beside(&self, a: Vector, b: Vector, range: f32) -> Found {
        let way = Ray::new(a, b - a);
        self.find(|node| node.aabb().loosened(range).cast_local_ray(&way, 1.0, true).is_some())
    }

    fn find(&self, reaches: impl Fn(&BvhNode) -> bool) -> Found {
        let mut found = Found::new();
        self.tree.traverse(|node| {
            if !reaches(node) {
                return TraversalAction::Prune;
            }
            found.extend(node.leaf_data().map(|number| number as usize));
            TraversalAction::Continue
        });
        found
    }
}

impl FromIterator<Aabb> for Places {
    fn from_iter<T: IntoIterator<Item = Aabb>>(bounds: T) -> Self {
        let mut places = Self::default();
        bounds.into_iter().enumerate().for_each(|(number, bounds)| places.put(number, bounds));
        places
    }
}
