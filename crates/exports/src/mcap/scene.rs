//! The world, the robots and the rescuees as objects in space. Lengths are in metres.

use foxglove::messages::{
    Color, Point3, PointCloud, SceneEntity, SceneUpdate, Timestamp, TriangleListPrimitive,
};
use recording::{Frame, MovedDebris, World};
use scenario::{DebrisShape, RoleKind};

use super::messages::{WORLD, cube, disc, entity, grey, points, pose, text};

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

/// Debris with less than this coordinate is not there: an event has not brought it yet, or took it away.
const AWAY_MM: i32 = -10_000_000;

fn group_color(task: Option<u32>) -> Color {
    task.map_or(UNGROUPED, |task| GROUPS[task as usize % GROUPS.len()])
}

/// Floor, walls, and the names of the places.
pub(super) fn world_scene(world: &World, time: Timestamp) -> SceneUpdate {
    let [width, height] = world.arena_m;
    let mut ground = entity(time, WORLD, "ground");
    let mut slab = |place, size, color| ground.cubes.push(cube(pose(place, 0.0), size, color));
    slab([width / 2.0, height / 2.0, -0.05], [width, height, 0.08], FLOOR);
    for x in [-WALL_M / 2.0, width + WALL_M / 2.0] {
        slab([x, height / 2.0, 0.5], [WALL_M, height + 2.0 * WALL_M, 1.0], WALL);
    }
    for y in [-WALL_M / 2.0, height + WALL_M / 2.0] {
        slab([width / 2.0, y, 0.5], [width, WALL_M, 1.0], WALL);
    }
    for (number, task) in (0..).zip(&world.tasks) {
        let ([x, y], [width, height]) = (task.center, task.size_m);
        let color = Color { a: 0.15, ..group_color(Some(number)) };
        slab([x, y, 0.0], [width + 3.0, height + 3.0, 0.02], color);
    }
    for task in &world.tasks {
        let ([x, y], [rest_x, rest_y]) = (task.center, task.rest);
        let above = [x, y + task.size_m[1] / 2.0 + 2.0, 0.5];
        ground
            .texts
            .extend([text(above, &task.name, 1.5, INK), text([rest_x, rest_y, 0.5], "rest", 1.0, INK)]);
    }
    SceneUpdate { entities: vec![ground], ..SceneUpdate::default() }
}

/// The radiation zones whose state changed; all of them where nothing is known of them. A zone that is off
/// is an empty entity.
pub(super) fn radiation_scene(
    world: &World,
    on: &[bool],
    before: Option<&[bool]>,
    time: Timestamp,
) -> Option<SceneUpdate> {
    let changed = |number: &usize| before.is_none_or(|before| before[*number] != on[*number]);
    let zone = |number: usize| {
        let mut entity = entity(time, WORLD, format!("radiation/{number}"));
        let zone = &world.zones[number];
        let foot = [zone.at[0], zone.at[1], 0.0];
        entity.cylinders.extend(on[number].then(|| disc(foot, zone.radius_m, 0.05, RADIATION)));
        entity
    };
    update((0..on.len()).filter(changed).map(zone))
}

/// The pieces of debris whose pose changed since the frame before; all of them in the first frame. A piece
/// that is not there is an empty entity.
pub(super) fn debris_scene(
    world: &World,
    frame: &Frame,
    before: Option<&Frame>,
    time: Timestamp,
) -> Option<SceneUpdate> {
    let moved = |number: &usize| before.is_none_or(|before| before.debris[*number] != frame.debris[*number]);
    let piece = |number: usize| {
        let (file, lies) = (&world.debris[number], &frame.debris[number]);
        let mut entity = entity(time, WORLD, format!("debris/{number}"));
        if lies.position_mm[0] > AWAY_MM {
            let color = if file.movable.is_some() { MOVABLE } else { DEBRIS };
            draw_debris(&mut entity, &file.shape, lies, color);
        }
        entity
    };
    update((0..frame.debris.len()).filter(moved).map(piece))
}

fn update(entities: impl Iterator<Item = SceneEntity>) -> Option<SceneUpdate> {
    let entities: Vec<SceneEntity> = entities.collect();
    (!entities.is_empty()).then_some(SceneUpdate { entities, ..SceneUpdate::default() })
}

/// Adds a piece of debris in its pose to its entity.
fn draw_debris(entity: &mut SceneEntity, shape: &DebrisShape, lies: &MovedDebris, color: Color) {
    let [x, y] = lies.position_mm.map(|mm| f64::from(mm) / 1000.0);
    let at = |z: f64| pose([x, y, z], f64::from(lies.angle) / 10_000.0);
    match shape {
        DebrisShape::Disc(radius) => {
            entity.cylinders.push(disc([x, y, 0.0], *radius, DEBRIS_HEIGHT_M, color));
        }
        DebrisShape::Box(width, height) => {
            entity.cubes.push(cube(at(DEBRIS_HEIGHT_M / 2.0), [*width, *height, DEBRIS_HEIGHT_M], color));
        }
        DebrisShape::Polygon(corners) => entity.triangles.push(TriangleListPrimitive {
            pose: Some(at(DEBRIS_HEIGHT_M)),
            points: corners.iter().map(|[x, y]| Point3 { x: *x, y: *y, z: 0.0 }).collect(),
            color: Some(color),
            colors: Vec::new(),
            indices: (2..corners.len() as u32).flat_map(|corner| [0, corner - 1, corner]).collect(),
        }),
    }
}

/// Height of the lower end of a robot.
fn low(world: &World, id: usize) -> f64 {
    if world.body_of(id).kind == RoleKind::Aerial { FLIGHT_M } else { 0.0 }
}

/// The robots as cylinders in the colours of their groups; flying robots are drawn above the ground.
pub(super) fn robots_scene(world: &World, frame: &Frame, time: Timestamp) -> SceneUpdate {
    let robot = |id: usize| {
        let (body, low) = (world.body_of(id), low(world, id));
        let name = format!("robot/{id}");
        let mut entity = entity(time, &name, &*name);
        let color = group_color(frame.robots[id].state.task);
        entity.cylinders.push(disc([0.0, 0.0, low], body.radius_m, ROBOT_HEIGHT_M, color));
        let above = [0.0, 0.0, low + 2.0 * ROBOT_HEIGHT_M];
        entity.texts.push(text(above, &format!("{} {id}", body.name), 0.6, INK));
        entity
    };
    SceneUpdate { entities: (0..world.robots.len()).map(robot).collect(), ..SceneUpdate::default() }
}

/// The robots as points in the colours of their groups, for programs that draw no scenes.
pub(super) fn positions(world: &World, frame: &Frame, time: Timestamp) -> PointCloud {
    let robots = frame.robots.iter().enumerate().map(|(id, robot)| {
        let [x, y] = robot.motion.position_mm.map(|mm| f64::from(mm) / 1000.0);
        let Color { r, g, b, a } = group_color(robot.state.task);
        let bytes = [r, g, b, a].map(|share| (share * 255.0).round() as u8).to_vec();
        ([x, y, low(world, id) + ROBOT_HEIGHT_M], bytes)
    });
    points(time, &["red", "green", "blue", "alpha"], robots)
}

/// The rescuees as points with their states.
pub(super) fn rescuees(world: &World, frame: &Frame, time: Timestamp) -> PointCloud {
    let rescuees = world.rescuees.iter().zip(&frame.rescuees);
    points(time, &["state"], rescuees.map(|([x, y], rescuee)| ([*x, *y, 0.2], vec![rescuee.state])))
}
