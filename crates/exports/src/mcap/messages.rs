//! What Foxglove's messages are made of: times, places, colours, primitives and points.

use foxglove::messages::packed_element_field::NumericType;
use foxglove::messages::{
    Color, CubePrimitive, CylinderPrimitive, PackedElementField, PointCloud, Pose, Quaternion, SceneEntity,
    TextPrimitive, Timestamp, Vector3,
};

/// The frame of the arena, in which everything but robots has its place.
pub(super) const WORLD: &str = "world";

/// Nanoseconds of a time in seconds, rounded to microseconds.
pub(super) fn nanoseconds(time_s: f64) -> u64 {
    (time_s * 1e6).round() as u64 * 1000
}

/// A moment of simulated time.
pub(super) fn timestamp(time_s: f64) -> Timestamp {
    let nanoseconds = nanoseconds(time_s);
    Timestamp::new((nanoseconds / 1_000_000_000) as u32, (nanoseconds % 1_000_000_000) as u32)
}

pub(super) const fn grey(value: f64, a: f64) -> Color {
    Color { r: value, g: value, b: value, a }
}

pub(super) fn vector([x, y, z]: [f64; 3]) -> Vector3 {
    Vector3 { x, y, z }
}

/// A rotation by an angle in radians around the vertical axis.
pub(super) fn turned(angle: f64) -> Quaternion {
    Quaternion { x: 0.0, y: 0.0, z: (angle / 2.0).sin(), w: (angle / 2.0).cos() }
}

pub(super) fn pose(place: [f64; 3], angle: f64) -> Pose {
    Pose { position: Some(vector(place)), orientation: Some(turned(angle)) }
}

pub(super) fn cube(pose: Pose, size: [f64; 3], color: Color) -> CubePrimitive {
    CubePrimitive { pose: Some(pose), size: Some(vector(size)), color: Some(color) }
}

/// An upright cylinder that stands on a place.
pub(super) fn disc(foot: [f64; 3], radius: f64, height: f64, color: Color) -> CylinderPrimitive {
    let [x, y, low] = foot;
    CylinderPrimitive {
        pose: Some(pose([x, y, low + height / 2.0], 0.0)),
        size: Some(vector([2.0 * radius, 2.0 * radius, height])),
        bottom_scale: 1.0,
        top_scale: 1.0,
        color: Some(color),
    }
}

/// A text that always faces the viewer.
pub(super) fn text(place: [f64; 3], text: &str, font_size: f64, color: Color) -> TextPrimitive {
    TextPrimitive {
        pose: Some(pose(place, 0.0)),
        billboard: true,
        font_size,
        scale_invariant: false,
        color: Some(color),
        text: text.to_owned(),
    }
}

/// Things that belong together; empty. An entity of a later message replaces the one with its name.
pub(super) fn entity(time: Timestamp, frame_id: &str, id: impl Into<String>) -> SceneEntity {
    SceneEntity {
        timestamp: Some(time),
        frame_id: frame_id.to_owned(),
        id: id.into(),
        frame_locked: true,
        ..SceneEntity::default()
    }
}

/// Points of the arena, in metres, each with four bytes whose names are given.
pub(super) fn points(
    time: Timestamp,
    bytes: &[&str],
    points: impl Iterator<Item = ([f64; 3], Vec<u8>)>,
) -> PointCloud {
    let coordinates = ["x", "y", "z"].iter().map(|name| (*name, NumericType::Float32, 4));
    let fields = coordinates.chain(bytes.iter().map(|name| (*name, NumericType::Uint8, 1)));
    let mut stride = 0;
    let fields = fields
        .map(|(name, kind, size)| {
            let offset = stride;
            stride += size;
            PackedElementField { name: name.to_owned(), offset, r#type: kind.into() }
        })
        .collect();
    let mut data = Vec::new();
    for (place, bytes) in points {
        place.iter().for_each(|value| data.extend((*value as f32).to_le_bytes()));
        data.extend(bytes);
    }
    PointCloud {
        timestamp: Some(time),
        frame_id: WORLD.to_owned(),
        pose: Some(pose([0.0; 3], 0.0)),
        point_stride: stride,
        fields,
        data: data.into(),
    }
}
