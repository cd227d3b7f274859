//! Where the things of a scenario are, and which outlines they have.

use parry2d::math::{Pose, Rotation, Vector};
use parry2d::shape::SharedShape;

use super::file::{DebrisFile, DebrisShape, Row, ZoneFile};
use crate::geometry::{Outline, RadiationZone};

impl DebrisFile {
    /// The outline of a piece of debris as the scenario places it. The shape must have been validated.
    #[must_use]
    pub fn outline(&self) -> Outline {
        let shape = match &self.shape {
            DebrisShape::Disc(radius) => SharedShape::ball(*radius as f32),
            DebrisShape::Box(width, height) => {
                SharedShape::cuboid((*width / 2.0) as f32, (*height / 2.0) as f32)
            }
            DebrisShape::Polygon(corners) => {
                let corners: Vec<Vector> =
                    corners.iter().map(|[x, y]| Vector::new(*x as f32, *y as f32)).collect();
                SharedShape::convex_hull(&corners).unwrap_or_else(|| SharedShape::ball(0.1))
            }
        };
        let angle = self.rotation_deg.to_radians() as f32;
        let rotation = Rotation::from_cos_sin_unchecked(libm::cosf(angle), libm::sinf(angle));
        let at = Vector::new(self.at[0] as f32, self.at[1] as f32);
        Outline { shape, pose: Pose::from_parts(at, rotation) }
    }
}

impl ZoneFile {
    /// The radiation zone at its place.
    #[must_use]
    pub fn zone(&self) -> RadiationZone {
        RadiationZone {
            center: Vector::new(self.at[0] as f32, self.at[1] as f32),
            radius: self.radius_m as f32,
        }
    }
}

impl Row {
    /// Places of the robots of a row, side by side.
    pub fn places(&self) -> impl Iterator<Item = [f64; 2]> + use<> {
        let Self { count, center, width_m, .. } = *self;
        let gaps = f64::from(count.saturating_sub(1).max(1));
        let left = if count > 1 { center[0] - width_m / 2.0 } else { center[0] };
        (0..count).map(move |i| [left + width_m * f64::from(i) / gaps, center[1]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::DebrisShape;

    fn piece(shape: DebrisShape) -> Outline {
        DebrisFile { shape, at: [10.0, 5.0], rotation_deg: 30.0, movable: None }.outline()
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
