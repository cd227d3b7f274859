//! Outlines: convex shapes in their places.

use parry2d::math::{Pose, Vector};
use parry2d::shape::SharedShape;
use parry2d::transformation::convex_hull;

/// A convex shape in its place.
#[derive(Clone)]
pub struct Outline {
    /// The shape.
    pub shape: SharedShape,
    /// Its place.
    pub pose: Pose,
}

impl Outline {
    /// A disc.
    pub fn disc(center: Vector, radius: f32) -> Self {
        Self { shape: SharedShape::ball(radius), pose: Pose::from_translation(center) }
    }

    /// Distance from a point to the outline, in metres; 0 inside.
    pub fn distance_to(&self, point: Vector) -> f32 {
        self.shape.distance_to_point(&self.pose, point, true)
    }

    /// Distance from a point to the outline, in metres; negative inside.
    pub fn signed_distance(&self, point: Vector) -> f32 {
        self.shape.distance_to_point(&self.pose, point, false)
    }

    /// Corners, anticlockwise, of a convex polygon that contains every point within `by` metres of the
    /// outline, and little more.
    pub fn inflated(&self, by: f32) -> Vec<Vector> {
        if let Some(ball) = self.shape.as_ball() {
            return ring(16, ball.radius + by).map(|offset| self.pose.translation + offset).collect();
        }
        let corners: Vec<Vector> = if let Some(cuboid) = self.shape.as_cuboid() {
            let [w, h] = [cuboid.half_extents.x, cuboid.half_extents.y];
            [[-w, -h], [w, -h], [w, h], [-w, h]].map(Vector::from).to_vec()
        } else {
            self.shape.as_convex_polygon().map(|polygon| polygon.points().to_vec()).unwrap_or_default()
        };
        let points: Vec<Vector> = corners
            .into_iter()
            .flat_map(|corner| {
                let corner = self.pose.transform_point(corner);
                ring(12, by).map(move |offset| corner + offset)
            })
            .collect();
        convex_hull(&points)
    }
}

impl std::fmt::Debug for Outline {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "outline at {:?}", self.pose.translation)
    }
}

/// Corners of the regular polygon circumscribed about a circle of this radius.
fn ring(corners: u32, radius: f32) -> impl Iterator<Item = Vector> {
    let half = std::f32::consts::PI / corners as f32;
    let outer = radius / libm::cosf(half);
    (0..corners).map(move |i| {
        let angle = (2 * i + 1) as f32 * half;
        Vector::new(libm::cosf(angle), libm::sinf(angle)) * outer
    })
}
