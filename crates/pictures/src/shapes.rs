//! Shapes of roles, and outlines of debris.

use std::f64::consts::PI;

use scenario::{DebrisShape, Point, RoleFile, RoleKind};

use crate::svg::{At, Path};

/// The shape of a role's robots: a disc, or corners on the unit circle and the angle by which they are
/// turned.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shape {
    corners: u32,
    turn: f64,
}

const GROUND: [Shape; 4] = [
    Shape { corners: 0, turn: 0.0 },
    Shape { corners: 4, turn: PI / 4.0 },
    Shape { corners: 6, turn: 0.0 },
    Shape { corners: 4, turn: 0.0 },
];

const AERIAL: [Shape; 3] = [
    Shape { corners: 3, turn: -PI / 2.0 },
    Shape { corners: 5, turn: -PI / 2.0 },
    Shape { corners: 3, turn: PI / 2.0 },
];

/// The shape of each role. Robots on the ground have discs, squares and hexagons; robots that fly have
/// triangles and pentagons.
pub(crate) fn shapes_of(roles: &[RoleFile]) -> Vec<Shape> {
    let (mut ground, mut aerial) = (GROUND.into_iter().cycle(), AERIAL.into_iter().cycle());
    let shape = |role: &RoleFile| match role.kind {
        RoleKind::Ground => ground.next(),
        RoleKind::Aerial => aerial.next(),
    };
    roles.iter().map(shape).map(|shape| shape.unwrap_or(GROUND[0])).collect()
}

impl Shape {
    /// Adds the shape to a path, about as large as a disc with this radius.
    pub(crate) fn add(self, [x, y]: At, radius: f64, path: &mut Path) {
        let size = match self.corners {
            0 => return path.disc([x, y], radius),
            3 => 1.35 * radius,
            4 => 1.18 * radius,
            _ => 1.1 * radius,
        };
        let corner = |number: u32| {
            let angle = 2.0 * PI * f64::from(number) / f64::from(self.corners) + self.turn;
            [x + size * angle.cos(), y + size * angle.sin()]
        };
        path.polygon((0..self.corners).map(corner));
    }
}

/// The corners of a piece of debris at a place, turned by an angle in radians; empty for a disc.
pub(crate) fn corners(shape: &DebrisShape, [x, y]: Point, angle: f64) -> Vec<Point> {
    let (sin, cos) = angle.sin_cos();
    let turned = |[px, py]: Point| [x + px * cos - py * sin, y + px * sin + py * cos];
    match shape {
        DebrisShape::Disc(_) => Vec::new(),
        DebrisShape::Box(width, height) => {
            let (w, h) = (width / 2.0, height / 2.0);
            [[-w, -h], [w, -h], [w, h], [-w, h]].map(turned).to_vec()
        }
        DebrisShape::Polygon(points) => points.iter().copied().map(turned).collect(),
    }
}
