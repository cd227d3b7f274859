//! The parts of Foxglove's messages that are used here, with the names of Foxglove's schemas
//! (<https://docs.foxglove.dev/docs/sdk/schemas>).

use schemars::JsonSchema;
use serde::Serialize;

/// A moment of simulated time.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[schemars(rename = "time")]
pub(super) struct Time {
    pub(super) sec: u32,
    pub(super) nsec: u32,
}

/// Nanoseconds of a time in seconds, rounded to microseconds.
pub(super) fn nanoseconds(time_s: f64) -> u64 {
    (time_s * 1e6).round() as u64 * 1000
}

impl Time {
    pub(super) fn of(time_s: f64) -> Self {
        let nanoseconds = nanoseconds(time_s);
        Self { sec: (nanoseconds / 1_000_000_000) as u32, nsec: (nanoseconds % 1_000_000_000) as u32 }
    }
}

/// A length of time: none is for ever.
#[derive(Debug, Clone, Copy, Default, Serialize, JsonSchema)]
#[schemars(rename = "duration")]
pub(super) struct Duration {
    sec: i32,
    nsec: u32,
}

#[derive(Debug, Clone, Copy, Default, Serialize, JsonSchema)]
pub(super) struct Vector3 {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) z: f64,
}

impl From<[f64; 3]> for Vector3 {
    fn from([x, y, z]: [f64; 3]) -> Self {
        Self { x, y, z }
    }
}

#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub(super) struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

impl Quaternion {
    /// A rotation by an angle in radians around the vertical axis.
    pub(super) fn turned(angle: f64) -> Self {
        Self { x: 0.0, y: 0.0, z: (angle / 2.0).sin(), w: (angle / 2.0).cos() }
    }
}

#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub(super) struct Pose {
    pub(super) position: Vector3,
    pub(super) orientation: Quaternion,
}

impl Pose {
    pub(super) fn at(place: [f64; 3]) -> Self {
        Self { position: place.into(), orientation: Quaternion::turned(0.0) }
    }
}

#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub(super) struct Color {
    pub(super) r: f64,
    pub(super) g: f64,
    pub(super) b: f64,
    pub(super) a: f64,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct CubePrimitive {
    pub(super) pose: Pose,
    pub(super) size: Vector3,
    pub(super) color: Color,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct CylinderPrimitive {
    pub(super) pose: Pose,
    pub(super) size: Vector3,
    pub(super) bottom_scale: f64,
    pub(super) top_scale: f64,
    pub(super) color: Color,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct TriangleListPrimitive {
    pub(super) pose: Pose,
    pub(super) points: Vec<Vector3>,
    pub(super) color: Color,
    pub(super) colors: Vec<Color>,
    pub(super) indices: Vec<u32>,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct TextPrimitive {
    pub(super) pose: Pose,
    pub(super) billboard: bool,
    pub(super) font_size: f64,
    pub(super) scale_invariant: bool,
    pub(super) color: Color,
    pub(super) text: String,
}

/// Things that belong together. An entity of a later message replaces the one with its name.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct SceneEntity {
    pub(super) timestamp: Time,
    pub(super) frame_id: String,
    pub(super) id: String,
    pub(super) lifetime: Duration,
    pub(super) frame_locked: bool,
    pub(super) cubes: Vec<CubePrimitive>,
    pub(super) cylinders: Vec<CylinderPrimitive>,
    pub(super) triangles: Vec<TriangleListPrimitive>,
    pub(super) texts: Vec<TextPrimitive>,
}

impl SceneEntity {
    /// An empty entity.
    pub(super) fn new(timestamp: Time, frame_id: &str, id: impl Into<String>) -> Self {
        Self {
            timestamp,
            frame_id: frame_id.to_owned(),
            id: id.into(),
            lifetime: Duration::default(),
            frame_locked: true,
            cubes: Vec::new(),
            cylinders: Vec::new(),
            triangles: Vec::new(),
            texts: Vec::new(),
        }
    }
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct SceneUpdate {
    pub(super) entities: Vec<SceneEntity>,
}

/// Where a frame is in another one.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct FrameTransform {
    pub(super) timestamp: Time,
    pub(super) parent_frame_id: String,
    pub(super) child_frame_id: String,
    pub(super) translation: Vector3,
    pub(super) rotation: Quaternion,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct FrameTransforms {
    pub(super) transforms: Vec<FrameTransform>,
}

/// A number of each point: its name, where it begins, and Foxglove's number of its type.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct PackedElementField {
    pub(super) name: String,
    pub(super) offset: u32,
    #[serde(rename = "type")]
    pub(super) kind: u8,
}

#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct PointCloud {
    pub(super) timestamp: Time,
    pub(super) frame_id: String,
    pub(super) pose: Pose,
    pub(super) point_stride: u32,
    pub(super) fields: Vec<PackedElementField>,
    #[schemars(extend("contentEncoding" = "base64"))]
    pub(super) data: String,
}

/// A line of a log.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub(super) struct Log {
    pub(super) timestamp: Time,
    pub(super) level: u8,
    pub(super) message: String,
    pub(super) name: String,
    pub(super) file: String,
    pub(super) line: u32,
}
