//! Debris: convex pieces, fixed or movable.

use parry2d::bounding_volume::Aabb;
use parry2d::math::{Pose, Rotation, Vector};
use parry2d::shape::SharedShape;
use parry2d::transformation::convex_hull;
use serde::{Deserialize, Serialize};

use crate::scenario::{DebrisFile, DebrisShape};

/// A pushed piece is noticed once it lies this far, in metres, from where it was last seen.
const NOTICED_MOVE_M: f32 = 0.2;

/// A convex shape in its place.
#[derive(Clone, Serialize, Deserialize)]
pub struct Outline {
    /// The shape.
    pub shape: SharedShape,
    /// Its place.
    pub pose: Pose,
}

impl Outline {
    /// A disc.
    #[must_use]
    pub fn disc(center: Vector, radius: f32) -> Self {
        Self { shape: SharedShape::ball(radius), pose: Pose::from_translation(center) }
    }

    /// Distance from a point to the outline, in metres; 0 inside.
    #[must_use]
    pub fn distance_to(&self, point: Vector) -> f32 {
        self.shape.distance_to_point(&self.pose, point, true)
    }

    /// Distance from a point to the outline, in metres; negative inside.
    #[must_use]
    pub fn signed_distance(&self, point: Vector) -> f32 {
        self.shape.distance_to_point(&self.pose, point, false)
    }

    /// Corners, anticlockwise, of a convex polygon that holds every point within `by` metres of the outline and little more.
    #[must_use]
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

/// Corners of the regular polygon around a circle of this radius.
fn ring(corners: u32, radius: f32) -> impl Iterator<Item = Vector> {
    let half = std::f32::consts::PI / corners as f32;
    let outer = radius / libm::cosf(half);
    (0..corners).map(move |i| {
        let angle = (2 * i + 1) as f32 * half;
        Vector::new(libm::cosf(angle), libm::sinf(angle)) * outer
    })
}

/// A piece of debris in the world.
#[derive(Clone, Serialize, Deserialize)]
pub struct Debris {
    /// Where it is.
    pub outline: Outline,
    /// Whether nothing can push it.
    pub is_fixed: bool,
    /// No point of it is farther from its centre than this, in metres.
    pub reach: f32,
    /// The outlines that robots may have seen: the initial one, and one more each time it was pushed noticeably.
    pub sightings: Vec<Outline>,
}

impl Debris {
    /// At its initial place.
    #[must_use]
    pub fn new(file: &DebrisFile) -> Self {
        let outline = debris_outline(file);
        let bounds = outline.shape.compute_local_bounding_sphere();
        let reach = bounds.center.length() + bounds.radius;
        Self { is_fixed: file.movable.is_none(), sightings: vec![outline.clone()], reach, outline }
    }

    /// The box that holds it.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.outline.shape.compute_aabb(&self.outline.pose)
    }

    /// Takes a new pose from the physics.
    pub(super) fn moved_to(&mut self, pose: Pose) {
        self.outline.pose = pose;
        let seen = &self.sightings[self.sightings.len() - 1].pose;
        let arm = self.outline.shape.compute_local_bounding_sphere().radius;
        let turned =
            Vector::new(pose.rotation.cos() - seen.rotation.cos(), pose.rotation.sin() - seen.rotation.sin());
        let moved = (seen.translation - pose.translation).length() + arm * turned.length();
        if moved > NOTICED_MOVE_M {
            self.sightings.push(self.outline.clone());
        }
    }
}

/// The outline of a piece of debris as the scenario places it. The shape must have been validated.
#[must_use]
pub fn debris_outline(file: &DebrisFile) -> Outline {
    let shape = match &file.shape {
        DebrisShape::Disc(radius) => SharedShape::ball(*radius as f32),
        DebrisShape::Box(width, height) => SharedShape::cuboid((*width / 2.0) as f32, (*height / 2.0) as f32),
        DebrisShape::Polygon(corners) => {
            let corners: Vec<Vector> =
                corners.iter().map(|[x, y]| Vector::new(*x as f32, *y as f32)).collect();
            SharedShape::convex_hull(&corners).unwrap_or_else(|| SharedShape::ball(0.1))
        }
    };
    let angle = file.rotation_deg.to_radians() as f32;
    let rotation = Rotation::from_cos_sin_unchecked(libm::cosf(angle), libm::sinf(angle));
    let at = Vector::new(file.at[0] as f32, file.at[1] as f32);
    Outline { shape, pose: Pose::from_parts(at, rotation) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn piece(shape: DebrisShape) -> Outline {
        debris_outline(&DebrisFile { shape, at: [10.0, 5.0], rotation_deg: 30.0, movable: None })
    }

    #[test]
    fn an_inflated_outline_keeps_its_distance_and_wastes_little() {
        let triangle = vec![[-1.0, -0.5], [1.0, -0.5], [0.0, 1.0]];
        for shape in [DebrisShape::Disc(0.5), DebrisShape::Box(2.0, 1.0), DebrisShape::Polygon(triangle)] {
            let outline = piece(shape);
            let corners = outline.inflated(0.6);
            for i in 0..corners.len() {
                let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
                for t in [0.0, 0.25, 0.5, 0.75] {
                    let distance = outline.distance_to(a.lerp(b, t));
                    assert!((0.599..0.66).contains(&distance), "{distance}");
                }
            }
        }
    }
}
