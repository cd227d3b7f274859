//! The world, the robots and the rescuees as objects in space. Lengths are in metres.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use recording::{Frame, World};
use usar_sim::scenario::{DebrisShape, RoleKind};

use super::messages::{
    Color, CubePrimitive, CylinderPrimitive, PackedElementField, PointCloud, Pose, Quaternion, SceneEntity,
    SceneUpdate, TextPrimitive, Time, TriangleListPrimitive, Vector3,
};

const FLOOR: Color = grey(0.97, 1.0);
const WALL: Color = grey(0.3, 1.0);
const DEBRIS: Color = grey(0.54, 1.0);
const MOVABLE: Color = Color { r: 0.76, g: 0.72, b: 0.61, a: 1.0 };
const RADIATION: Color = Color { r: 0.84, g: 0.66, b: 0.0, a: 0.3 };
const INK: Color = grey(0.1, 1.0);
const UNGROUPED: Color = grey(0.52, 1.0);

/// The colours of the groups, as in pictures and on the viewer's page: Okabe and Ito's.
const GROUPS: [Color; 7] = [
    Color { r: 0.0, g: 0.447, b: 0.698, a: 1.0 },
    Color { r: 0.851, g: 0.51, b: 0.0, a: 1.0 },
    Color { r: 0.0, g: 0.62, b: 0.451, a: 1.0 },
    Color { r: 0.8, g: 0.475, b: 0.655, a: 1.0 },
    Color { r: 0.835, g: 0.369, b: 0.0, a: 1.0 },
    Color { r: 0.337, g: 0.706, b: 0.914, a: 1.0 },
    Color { r: 0.541, g: 0.49, b: 0.0, a: 1.0 },
];

/// Thickness of walls, and heights of things.
const WALL_M: f64 = 0.3;
const DEBRIS_HEIGHT_M: f64 = 0.6;
const ROBOT_HEIGHT_M: f64 = 0.4;
const FLIGHT_M: f64 = 2.0;

const fn grey(value: f64, a: f64) -> Color {
    Color { r: value, g: value, b: value, a }
}

fn vector(x: f64, y: f64, z: f64) -> Vector3 {
    Vector3 { x, y, z }
}

fn cube(place: [f64; 3], size: [f64; 3], color: Color) -> CubePrimitive {
    CubePrimitive { pose: Pose::at(place), size: size.into(), color }
}

fn disc([x, y]: [f64; 2], radius: f64, [low, height]: [f64; 2], color: Color) -> CylinderPrimitive {
    let (pose, size) = (Pose::at([x, y, low + height / 2.0]), vector(2.0 * radius, 2.0 * radius, height));
    CylinderPrimitive { pose, size, bottom_scale: 1.0, top_scale: 1.0, color }
}

fn text([x, y, z]: [f64; 3], text: &str, font_size: f64) -> TextPrimitive {
    let pose = Pose::at([x, y, z]);
    TextPrimitive {
        pose,
        billboard: true,
        font_size,
        scale_invariant: false,
        color: INK,
        text: text.to_owned(),
    }
}

/// Floor, walls, radiation, fixed debris, and the names of the places.
pub(super) fn world_scene(world: &World, time: Time) -> SceneUpdate {
    let [width, height] = world.arena_m;
    let mut ground = SceneEntity::new(time, "world", "ground");
    ground.cubes.push(cube([width / 2.0, height / 2.0, -0.05], [width, height, 0.08], FLOOR));
    for x in [-WALL_M / 2.0, width + WALL_M / 2.0] {
        ground.cubes.push(cube([x, height / 2.0, 0.5], [WALL_M, height + 2.0 * WALL_M, 1.0], WALL));
    }
    for y in [-WALL_M / 2.0, height + WALL_M / 2.0] {
        ground.cubes.push(cube([width / 2.0, y, 0.5], [width, WALL_M, 1.0], WALL));
    }
    let from_start = |(number, _): &(usize, _)| !world.zones_later.contains(number);
    for (_, zone) in world.zones.iter().enumerate().filter(from_start) {
        ground.cylinders.push(disc(zone.at, zone.radius_m, [0.0, 0.05], RADIATION));
    }
    for (number, task) in world.tasks.iter().enumerate() {
        let Color { r, g, b, .. } = GROUPS[number % GROUPS.len()];
        let ([x, y], [width, height]) = (task.center, task.size_m);
        ground.cubes.push(cube([x, y, 0.0], [width + 3.0, height + 3.0, 0.02], Color { r, g, b, a: 0.15 }));
        ground.texts.push(text([x, y + height / 2.0 + 2.0, 0.5], &task.name, 1.5));
        ground.texts.push(text([task.rest[0], task.rest[1], 0.5], "rest", 1.0));
    }
    let fixed = world.debris.iter().enumerate().filter(|(_, piece)| piece.movable.is_none());
    let debris = fixed.map(|(number, piece)| {
        debris_entity((number, &piece.shape, DEBRIS), (piece.at, piece.rotation_deg.to_radians()), time)
    });
    SceneUpdate { entities: std::iter::once(ground).chain(debris).collect() }
}

/// A piece of debris in its pose.
fn debris_entity(
    (number, shape, color): (usize, &DebrisShape, Color),
    ([x, y], angle): ([f64; 2], f64),
    time: Time,
) -> SceneEntity {
    let mut entity = SceneEntity::new(time, "world", format!("debris/{number}"));
    let pose = |z: f64| Pose { position: vector(x, y, z), orientation: Quaternion::turned(angle) };
    match shape {
        DebrisShape::Disc(radius) => {
            entity.cylinders.push(disc([x, y], *radius, [0.0, DEBRIS_HEIGHT_M], color));
        }
        DebrisShape::Box(width, height) => {
            let size = vector(*width, *height, DEBRIS_HEIGHT_M);
            entity.cubes.push(CubePrimitive { pose: pose(DEBRIS_HEIGHT_M / 2.0), size, color });
        }
        DebrisShape::Polygon(corners) => {
            let points = corners.iter().map(|[x, y]| vector(*x, *y, 0.0)).collect();
            let indices = (2..corners.len() as u32).flat_map(|corner| [0, corner - 1, corner]).collect();
            let pose = pose(DEBRIS_HEIGHT_M);
            entity.triangles.push(TriangleListPrimitive { pose, points, color, colors: Vec::new(), indices });
        }
    }
    entity
}

/// The movable pieces of debris whose pose changed since the frame before; all of them in the first frame.
pub(super) fn debris_scene(
    world: &World,
    frame: &Frame,
    before: Option<&Frame>,
    time: Time,
) -> Option<SceneUpdate> {
    let movable = world.debris.iter().enumerate().filter(|(_, piece)| piece.movable.is_some());
    let moved = movable
        .filter(|(number, _)| before.is_none_or(|before| before.debris[*number] != frame.debris[*number]));
    let entities: Vec<SceneEntity> = moved
        .map(|(number, piece)| {
            let now = &frame.debris[number];
            let at = now.position_mm.map(|mm| f64::from(mm) / 1000.0);
            debris_entity((number, &piece.shape, MOVABLE), (at, f64::from(now.angle) / 10_000.0), time)
        })
        .collect();
    (!entities.is_empty()).then_some(SceneUpdate { entities })
}

/// The robots as cylinders in the colours of their groups; flying robots are drawn above the ground.
pub(super) fn robots_scene(world: &World, frame: &Frame, time: Time) -> SceneUpdate {
    let entity = |id: usize| {
        let role = world.body_of(id);
        let low = if role.kind == RoleKind::Aerial { FLIGHT_M } else { 0.0 };
        let task = frame.robots[id].state.task;
        let color = task.map_or(UNGROUPED, |task| GROUPS[task as usize % GROUPS.len()]);
        let mut entity = SceneEntity::new(time, &format!("robot/{id}"), format!("robot/{id}"));
        entity.cylinders.push(disc([0.0; 2], role.radius_m, [low, ROBOT_HEIGHT_M], color));
        entity.texts.push(text([0.0, 0.0, low + 2.0 * ROBOT_HEIGHT_M], &format!("{} {id}", role.name), 0.6));
        entity
    };
    SceneUpdate { entities: (0..world.robots.len()).map(entity).collect() }
}

/// The rescuees as points with their states.
pub(super) fn rescuees(world: &World, frame: &Frame, time: Time) -> PointCloud {
    /// Foxglove's numbers of types.
    const UINT8: u8 = 1;
    const FLOAT32: u8 = 7;
    let mut data = Vec::new();
    for ([x, y], rescuee) in world.rescuees.iter().zip(&frame.rescuees) {
        [*x as f32, *y as f32, 0.2].iter().for_each(|value| data.extend(value.to_le_bytes()));
        data.push(rescuee.state);
    }
    let field =
        |(name, offset, kind): (&str, u32, u8)| PackedElementField { name: name.to_owned(), offset, kind };
    PointCloud {
        timestamp: time,
        frame_id: "world".to_owned(),
        pose: Pose::at([0.0; 3]),
        point_stride: 13,
        fields: [("x", 0, FLOAT32), ("y", 4, FLOAT32), ("z", 8, FLOAT32), ("state", 12, UINT8)]
            .map(field)
            .to_vec(),
        data: BASE64_STANDARD.encode(data),
    }
}
