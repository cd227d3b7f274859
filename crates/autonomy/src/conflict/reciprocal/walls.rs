//! Walls and known debris: the velocities by which a robot brakes in time for them.
//!
//! Outlines are convex, so each is one half-plane. Obstacles near a robot are looked up once for a stretch of
//! its way.

use parry2d::math::Vector;
use smallvec::SmallVec;

use super::half_planes::HalfPlane;
use crate::conflict::Mover;
use crate::planning::{KnownObstacle, ObstacleMap, nearest_border_point, outward_normal, polygon_contains};

/// Robots brake for walls and debris that they would reach within this time, in seconds.
const WALL_HORIZON_S: f32 = 0.5;

/// Robots under pressure may come this much nearer to walls and debris than their routes do, in metres.
const WALL_SLACK_M: f32 = 0.04;

/// What was looked up near a robot holds until it is this far away, in metres, separately in x and in y.
const STRETCH_M: f32 = 1.0;

/// The obstacles near a robot, from step to step. They only save time.
#[derive(Default)]
pub(super) struct NearWalls {
    /// The digest of the map in which they were looked up; none before the first time.
    map: Option<u64>,
    /// Where.
    at: Vector,
    /// How far from there, in metres.
    range: f32,
    /// Numbers of the obstacles in the map, in order of their keys.
    numbers: SmallVec<[usize; 8]>,
}

impl NearWalls {
    /// Whether no wall or debris cuts the preferred velocity of the robot.
    pub(super) fn are_clear(&mut self, me: &Mover, arena: Vector) -> bool {
        let wished = me.preferred.clamp_length_max(me.speed);
        border_planes(me, arena).all(|plane| plane.holds(wished))
            && self.debris_planes(me).all(|plane| plane.holds(wished))
    }

    /// The velocities by which the robot keeps clear of walls and debris.
    pub(super) fn planes(&mut self, me: &Mover, arena: Vector, planes: &mut Vec<HalfPlane>) {
        planes.extend(border_planes(me, arena));
        planes.extend(self.debris_planes(me));
    }

    /// The velocities that keep clear of the debris that the robot knows.
    fn debris_planes(&mut self, me: &Mover) -> impl Iterator<Item = HalfPlane> {
        if let Some(known) = me.known {
            self.look_round(me, known);
        }
        let near = me.known.into_iter().flat_map(|known| {
            let obstacle = |number: &usize| known.number(*number);
            self.numbers.iter().map(obstacle)
        });
        near.filter_map(move |obstacle| debris_plane(me, obstacle))
    }

    /// Looks the obstacles up anew, if the robot has left the stretch for which they hold, or knows others.
    fn look_round(&mut self, me: &Mover, known: &ObstacleMap) {
        let reach = me.speed * WALL_HORIZON_S;
        let way = (me.position - self.at).abs().max_element();
        if self.map == Some(known.digest()) && way + reach <= self.range {
            return;
        }
        (self.map, self.at, self.range) = (Some(known.digest()), me.position, reach + STRETCH_M);
        self.numbers.clear();
        self.numbers.extend(known.numbers_near(self.at, self.range));
        self.numbers.sort_unstable_by_key(|number| known.number(*number).key);
    }
}

/// The velocities that keep a robot within the arena.
fn border_planes(me: &Mover, arena: Vector) -> impl Iterator<Item = HalfPlane> {
    let gaps = [
        (me.position.x - me.radius, Vector::X),
        (arena.x - me.position.x - me.radius, -Vector::X),
        (me.position.y - me.radius, Vector::Y),
        (arena.y - me.position.y - me.radius, -Vector::Y),
    ];
    gaps.into_iter().filter_map(|(gap, inward)| wall_plane(me, gap.max(0.0), inward))
}

/// The velocities that keep clear of an obstacle; `None` if it is too far away to matter.
fn debris_plane(me: &Mover, obstacle: &KnownObstacle) -> Option<HalfPlane> {
    if !obstacle.may_reach(me.position, me.speed * WALL_HORIZON_S) {
        return None;
    }
    let to_border = nearest_border_point(&obstacle.tight, me.position) - me.position;
    let (gap, away) = if polygon_contains(&obstacle.tight, me.position) {
        (-to_border.length(), outward_normal(&obstacle.tight, me.position))
    } else {
        (to_border.length(), -to_border.normalize_or(Vector::X))
    };
    wall_plane(me, gap + WALL_SLACK_M, away)
}

/// The velocities that brake in time for a wall at this distance; `None` for a wall that is too far away to
/// matter.
fn wall_plane(me: &Mover, gap: f32, away: Vector) -> Option<HalfPlane> {
    (gap < me.speed * WALL_HORIZON_S).then(|| HalfPlane::at_least(-gap / WALL_HORIZON_S, away))
}
