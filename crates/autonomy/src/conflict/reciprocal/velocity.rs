//! Reciprocal avoidance (ORCA): the velocity nearest to the preferred velocity that keeps a robot clear of
//! all others for a while, provided that each robot does its share.
//!
//! After van den Berg, Guy, Lin & Manocha, "Reciprocal n-Body Collision Avoidance", 2011. Three things
//! differ. Shares need not be equal. Walls and debris are one half-plane each, because outlines are convex.
//! Robots look no farther ahead than their route goes straight.

use parry2d::math::Vector;
use serde::{Deserialize, Serialize};

use super::encounter::Encounter;
use super::half_planes::{HalfPlane, best_velocity};
use crate::report::Track;

/// The least horizon, in seconds, just before a bend of the route.
const LEAST_HORIZON_S: f32 = 0.3;

/// Robots that are too close part within this time, in seconds.
const PART_WITHIN_S: f32 = 0.05;

/// Distance that robots keep from one another, in metres.
pub(super) const MARGIN_M: f32 = 0.015;

/// A robot heeds this many others at most: the nearest.
pub(super) const HEEDED: usize = 12;

/// Share of the avoidance that the robot with the right of way at a passage takes; the other robot takes the
/// rest.
pub(super) const SHARE_OF_THE_FIRST: f32 = 0.3;

/// Share of the avoidance in the open that the robot with the better claim takes, and share of a robot in
/// the avoidance of one that makes room for it.
pub(super) const SHARE_OF_PRIORITY: f32 = 0.2;

/// The least share that a robot may have in the avoidance of another.
pub(super) const LEAST_SHARE: f32 = SHARE_OF_PRIORITY.min(SHARE_OF_THE_FIRST);

/// In the open, a preferred velocity that another robot obstructs is turned to the right by this much
/// (tangent) if any robot nearby heads the other way or stands. This breaks symmetry and keeps traffic to one
/// side. Robots that only cross pass between one another, and would lose by turning.
const KEEP_RIGHT: f32 = 0.35;

/// Another robot, as seen by the robot that avoids it.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Neighbour {
    /// Its index.
    pub(super) robot: usize,
    /// Distance that the two keep between their centres, in metres.
    pub(super) apart: f32,
    /// The avoiding robot's share in the avoidance: 0.5 if both robots do the same, 1 if the other does
    /// nothing.
    pub(super) share: f32,
    /// How its way relates to the avoiding robot's.
    pub(super) encounter: Encounter,
}

/// How a robot avoids others, from one control step to the next.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct Avoidance {
    /// The preferred velocity, in metres per second.
    pub(super) preferred: Vector,
    /// Top speed, in metres per second.
    pub(super) speed: f32,
    /// Time for which its route goes straight, in seconds.
    pub(super) straight_for_s: f32,
    /// Whether it is not at a narrow passage.
    pub(super) is_open: bool,
    /// The velocities that keep clear of walls and debris.
    pub(super) walls: Vec<HalfPlane>,
    /// The robots that it heeds.
    pub(super) neighbours: Vec<Neighbour>,
}

impl Avoidance {
    /// The velocity that a robot with this track takes among its neighbours. `planes` is only memory.
    pub(super) fn velocity(
        &self,
        me: Track,
        track_of: impl Fn(usize) -> Track,
        planes: &mut Vec<HalfPlane>,
    ) -> Vector {
        let looks_ahead_s = self.straight_for_s.max(LEAST_HORIZON_S);
        let plane = |other: &Neighbour| {
            let horizon = other.encounter.horizon_s().min(looks_ahead_s);
            robot_plane(me, track_of(other.robot), other, horizon)
        };
        planes.clone_from(&self.walls);
        planes.extend(self.neighbours.iter().map(plane));
        let (walls, preferred) = (self.walls.len(), self.preferred);
        let keeps_right = self.is_open
            && planes[walls..].iter().any(|plane| !plane.holds(preferred))
            && self.neighbours.iter().any(|other| other.encounter.needs_a_side());
        let turned = if keeps_right { preferred - preferred.perp() * KEEP_RIGHT } else { preferred };
        best_velocity(planes, walls, turned, self.speed)
    }
}

/// The velocities by which a robot does its share in keeping clear of another.
fn robot_plane(me: Track, its: Track, other: &Neighbour, horizon: f32) -> HalfPlane {
    let Neighbour { apart, share, .. } = *other;
    let (offset, velocity) = (its.position - me.position, me.velocity);
    let relative = velocity - its.velocity;
    let distance_squared = offset.length_squared();
    let (direction, change) = if distance_squared <= apart * apart {
        out_of_disc(relative - offset / PART_WITHIN_S, apart / PART_WITHIN_S)
    } else {
        let from_center = relative - offset / horizon;
        let ahead = from_center.dot(offset);
        if ahead < 0.0 && ahead * ahead > apart * apart * from_center.length_squared() {
            out_of_disc(from_center, apart / horizon)
        } else {
            let leg = (distance_squared - apart * apart).sqrt();
            let along = if offset.perp_dot(from_center) > 0.0 { leg } else { -leg };
            let direction = (offset * along + offset.perp() * apart) / distance_squared;
            (direction, direction * relative.dot(direction) - relative)
        }
    };
    HalfPlane { point: velocity + change * share, direction }
}

/// The shortest exit from a disc of relative velocities that lead to a collision: the direction of the disc's
/// border there, and the change of velocity that leads to it.
fn out_of_disc(from_center: Vector, radius: f32) -> (Vector, Vector) {
    let length = from_center.length();
    let outward = if length > 1e-6 { from_center / length } else { Vector::X };
    (-outward.perp(), outward * (radius - length))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A place and a velocity.
    type Moving = ([f32; 2], [f32; 2]);

    /// The velocity that a robot of at most this speed takes in the origin, driving at `velocity`, among
    /// these others, each with its share, in the open or at a passage.
    fn taken(
        [velocity, preferred]: [[f32; 2]; 2],
        speed: f32,
        is_open: bool,
        others: &[(Moving, f32)],
    ) -> Vector {
        let neighbour = |(robot, (_, share)): (usize, &(Moving, f32))| Neighbour {
            robot,
            apart: 0.8,
            share: *share,
            encounter: Encounter::Other,
        };
        let avoidance = Avoidance {
            preferred: Vector::from(preferred),
            speed,
            straight_for_s: 10.0,
            is_open,
            walls: Vec::new(),
            neighbours: others.iter().enumerate().map(neighbour).collect(),
        };
        let track = |(position, velocity): Moving| Track {
            position: Vector::from(position),
            velocity: Vector::from(velocity),
        };
        avoidance.velocity(track(([0.0; 2], velocity)), |j| track(others[j].0), &mut Vec::new())
    }

    /// The velocity that a robot driving east with 1 m/s takes beside one other robot.
    fn among(offset: [f32; 2], velocity: [f32; 2], share: f32) -> Vector {
        taken([[1.0, 0.0]; 2], 1.0, true, &[((offset, velocity), share)])
    }

    /// How near two robots come within the horizon if both keep their velocities.
    fn nearest(offset: [f32; 2], mine: Vector, other: Vector) -> f32 {
        let gaps =
            (0..=150_u8).map(|i| (Vector::from(offset) + (other - mine) * (f32::from(i) * 0.01)).length());
        gaps.fold(f32::INFINITY, f32::min)
    }

    #[test]
    fn a_robot_that_meets_nobody_keeps_its_velocity() {
        assert_eq!(among([-1.0, 0.0], [0.0, 0.0], 1.0), Vector::X, "behind");
        assert_eq!(among([1.0, 2.0], [1.0, 0.0], 0.5), Vector::X, "abreast");
        assert_eq!(among([5.0, 0.0], [0.0, 0.0], 1.0), Vector::X, "beyond the horizon");
    }

    #[test]
    fn two_robots_that_do_their_halves_keep_apart_and_so_does_one_that_does_all() {
        for aside in [-0.5, -0.1, 0.1, 0.5] {
            let mine = among([2.0, aside], [-1.0, 0.0], 0.5);
            // The other one sees the same, turned by half a turn.
            assert!(nearest([2.0, aside], mine, -mine) > 0.79, "halves, {aside}: {mine}");
            let all = among([1.4, aside], [0.0, 0.0], 1.0);
            assert!(nearest([1.4, aside], all, Vector::ZERO) > 0.79, "all, {aside}: {all}");
        }
    }

    #[test]
    fn robots_within_the_margin_part_at_once() {
        for missing in [0.001, MARGIN_M, 0.05] {
            let other = ([0.8 - missing, 0.0], [0.0; 2]);
            let velocity = taken([[0.0; 2]; 2], 2.0, true, &[(other, 0.5)]);
            // Each takes half of the missing distance upon itself.
            let expected = Vector::new(-0.5 * missing / PART_WITHIN_S, 0.0);
            assert!((velocity - expected).length() < 1e-4, "{missing}: {velocity} instead of {expected}");
        }
    }

    #[test]
    fn head_on_both_keep_to_the_right() {
        assert!(among([2.0, 0.0], [-1.0, 0.0], 0.5).y < -0.05);
    }

    /// Velocity and preferred velocity of a robot, places and velocities of the others, and the velocity that
    /// it takes.
    type Case = ([f32; 2], [f32; 2], &'static [Moving], [f32; 2]);

    /// Robots of 0.4 m, at most 2 m/s, horizon 1.5 s, time step 0.5 s. The expected velocities come from
    /// RVO2, the code that the authors of ORCA published (`pyrvo` 0.4.3).
    #[rustfmt::skip]
    const RVO2: [Case; 14] = [
        ([-0.53, -1.05], [0.42, -1.2], &[([-2.21, 0.04], [-1.39, -0.2])], [0.4200, -1.2000]),
        ([-1.29, -1.23], [-0.21, 0.92], &[([-1.88, -1.38], [0.38, 1.34])], [0.0193, 0.7673]),
        ([0.23, -0.31], [1.33, -1.27], &[([1.79, -1.05], [-1.07, -1.15])], [1.3560, -0.8944]),
        ([-0.57, 0.95], [-0.89, 0.23], &[([0.69, -0.64], [0.14, -1.31]),
            ([-2.2, -1.47], [0.54, -0.22])], [-0.8900, 0.2300]),
        ([-0.56, 0.26], [-0.13, -0.56], &[([1.47, 0.99], [-0.77, 0.22]),
            ([0.13, 1.88], [0.69, -0.64])], [-0.1300, -0.5600]),
        ([1.44, -1.15], [-0.23, 0.72], &[([0.98, 0.47], [0.24, -0.13]), ([1.32, 0.37], [1.13, -0.56]),
            ([-1.74, -0.06], [-1.38, 0.5])], [-0.2117, -0.2199]),
        ([1.02, 1.33], [-0.07, 0.46], &[([1.61, -1.08], [-0.34, 0.51]), ([-2.39, -0.19], [-1.0, -1.15]),
            ([-2.2, 1.01], [0.44, 1.48])], [0.0159, 0.9741]),
        ([-1.32, 0.8], [-1.04, -0.71], &[([-1.11, -0.42], [-0.42, 1.15]), ([0.25, 1.92], [0.96, 1.09]),
            ([-0.55, 1.86], [-1.26, -0.15]), ([2.29, -1.75], [-0.97, -0.8])], [-1.0411, -0.7084]),
        ([-0.8, -0.05], [0.25, -0.66], &[([1.87, 1.49], [-0.32, -0.3]), ([0.88, -2.23], [1.2, 0.84]),
            ([2.27, 0.95], [0.05, 0.35]), ([-2.48, -0.41], [-0.39, 0.2])], [0.1529, -0.6376]),
        ([-1.19, 0.4], [-1.23, -1.21], &[([-1.24, -0.76], [-0.41, -1.13]), ([-1.46, -1.69], [-0.48, -1.34]),
            ([-2.37, 1.87], [0.34, -1.05]), ([1.74, 2.47], [-0.1, -0.05]),
            ([-2.5, -1.74], [-1.2, -0.41])], [-0.3856, -0.3785]),
        ([-1.24, -1.19], [-0.44, -0.66], &[([-1.19, -0.67], [-1.0, 0.82]), ([0.16, 1.4], [-0.51, -0.83]),
            ([0.14, -1.77], [0.13, -1.42]), ([1.64, -1.69], [-1.43, 1.35]),
            ([0.14, 2.39], [1.09, 0.59])], [-0.9063, -0.8703]),
        ([0.93, 1.45], [0.99, 0.86], &[([-1.2, 0.96], [1.37, -0.16]), ([-1.4, -1.37], [-0.91, -0.89]),
            ([1.59, 1.2], [-0.82, 0.05]), ([0.62, 2.0], [1.02, -0.06]), ([-0.72, -2.36], [-1.42, -0.66]),
            ([2.19, 2.44], [1.37, -0.41])], [0.6948, 1.8754]),
        ([0.46, 0.9], [-1.16, 0.45], &[([1.12, -1.65], [-1.12, -1.05]), ([-1.61, 1.45], [-0.5, 0.9]),
            ([2.36, -0.52], [-0.3, 1.34]), ([2.05, 1.41], [0.75, -0.07]), ([2.4, 0.79], [-0.45, 0.15]),
            ([2.02, 1.53], [-1.06, 0.98])], [-0.7890, 0.2736]),
        ([-1.11, -1.46], [1.32, 0.42], &[([-1.3, 0.43], [-0.72, -0.24]), ([0.42, 2.02], [-0.24, 1.25]),
            ([0.13, 2.17], [-0.2, 1.12]), ([1.63, -1.44], [-0.74, -0.62]), ([0.12, -2.41], [-0.18, -0.95]),
            ([-1.84, 2.05], [-0.44, -0.13])], [-0.5854, -0.7450]),
    ];

    #[test]
    fn velocities_are_those_of_the_published_code() {
        for (velocity, preferred, others, expected) in RVO2 {
            let others: Vec<(Moving, f32)> = others.iter().map(|other| (*other, 0.5)).collect();
            let found = taken([velocity, preferred], 2.0, false, &others);
            assert!((found - Vector::from(expected)).length() < 1e-3, "{found} instead of {expected:?}");
        }
    }
}
