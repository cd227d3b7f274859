//! The way of a robot out of a place from which no route leads.
//!
//! A robot keeps on a route that leads between pieces of debris which it saw too late, as long as no piece is
//! nearer to the route than a third of the clearance. Behind them it knows no way: a new route would have to
//! keep the whole clearance. So it goes back the way it came.

use parry2d::math::Vector;

use crate::planning::{ObstacleMap, Planner, Query, Route, polygon_contains, polygon_crossed};

/// The way back along a trail (the latest place last) to the first place from which a route leads to the
/// goal, and on along this route. Only places beyond a stretch through which no route would lead are tried:
/// from all others, no more places are reached than from here. `None` if there is no such place, or if the
/// way back to it is shut.
pub(super) fn way_out(planner: &Planner, query: &Query, trail: &[Vector]) -> Option<Route> {
    let known = query.obstacles;
    let (mut way, mut at, mut has_left) = (Vec::new(), query.from, false);
    for before in trail.iter().rev().copied() {
        if is_shut(known, before) {
            return None;
        }
        has_left |= is_too_narrow(known, at, before);
        way.push(before);
        at = before;
        if !has_left || known.covers(at) {
            continue;
        }
        if let Some(route) = planner.route(&Query { from: at, in_the_way: &[], ..*query }) {
            way.extend(route.ahead());
            return Some(Route::new(way));
        }
        has_left = false;
    }
    None
}

/// Whether no route would lead along the line from `a` to `b`.
fn is_too_narrow(known: &ObstacleMap, a: Vector, b: Vector) -> bool {
    known.along(a, b).any(|obstacle| polygon_crossed(&obstacle.planned, a, b))
}

/// Whether something stands now where the robot was. The lines between the places of a trail say less: they
/// cut the corners that the robot went round.
fn is_shut(known: &ObstacleMap, place: Vector) -> bool {
    known.near(place, 0.0).any(|obstacle| polygon_contains(&obstacle.tight, place))
}
