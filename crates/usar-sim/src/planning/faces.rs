//! The free plane among obstacles whose outlines may touch or overlap: joined, and as the faces that remain.
//! No way leads from one face to another.

use geo::{BooleanOps, Contains, LineString, Point, Polygon, unary_union};
use parry2d::math::Vector;
use polyanya::{Mesh, Triangulation};

/// A point this far outside a mesh counts as inside, in metres.
pub(super) const SEARCH_DELTA_M: f32 = 0.01;

/// A face smaller than this has no room for the centre of a robot, in square metres.
const LEAST_FACE_M2: f64 = 1e-3;

/// A face, and the mesh of its inside.
struct Face {
    area: Polygon,
    mesh: Mesh,
}

/// The faces of a free plane.
pub(super) struct Faces(Vec<Face>);

impl Faces {
    /// The faces within a border, among the outlines of obstacles; all corners are anticlockwise.
    ///
    /// # Panics
    /// The library cannot triangulate a face.
    pub(super) fn among(border: &[Vector], outlines: &[Vec<Vector>]) -> Self {
        let outlines: Vec<Polygon> = outlines.iter().map(|outline| polygon(outline)).collect();
        let free = polygon(border).difference(&unary_union(&outlines));
        let is_wide = |face: &Polygon| geo::Area::unsigned_area(face) >= LEAST_FACE_M2;
        Self(free.into_iter().filter(is_wide).map(Face::new).collect())
    }

    /// The shortest path from one point to another, without its start; `None` if they are in different faces.
    pub(super) fn path(&self, from: Vector, to: Vector) -> Option<Vec<Vector>> {
        let at = Point::new(f64::from(from.x), f64::from(from.y));
        let face = self.0.iter().find(|face| face.area.contains(&at))?;
        Some(face.mesh.path(from, to)?.path)
    }
}

impl Face {
    fn new(area: Polygon) -> Self {
        let mut triangulation = Triangulation::from_outer_edges(&corners(area.exterior()));
        triangulation.add_obstacles(area.interiors().iter().map(corners));
        let mut mesh = triangulation.as_navmesh();
        mesh.set_search_delta(SEARCH_DELTA_M);
        Self { area, mesh }
    }
}

fn polygon(corners: &[Vector]) -> Polygon {
    let ring = corners.iter().map(|at| (f64::from(at.x), f64::from(at.y))).collect();
    Polygon::new(ring, Vec::new())
}

/// The corners of a closed ring, each once.
fn corners(ring: &LineString) -> Vec<Vector> {
    ring.coords().skip(1).map(|at| Vector::new(at.x as f32, at.y as f32)).collect()
}
