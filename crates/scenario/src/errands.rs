//! The rules of errands: a robot goes to each place once, and can stand there.

use std::collections::BTreeSet;

use parry2d::bounding_volume::Aabb;
use parry2d::math::Vector;

use super::checker::{Checker, entry};
use super::file::{DebrisFile, Happening, Point, RoleFile, RoleKind, SampledCounts, ScenarioFile, TaskFile};
use crate::limits;
use crate::shapes::{Places, vector};

/// Checks the values of errands.
pub(super) fn errands(check: &mut Checker, file: &ScenarioFile) {
    let robots: u32 = file.team.iter().map(|row| row.count).sum();
    let mut seen = BTreeSet::new();
    for (i, errand) in file.errands.iter().enumerate() {
        if errand.robot >= robots {
            let rule = format!("must be the id of one of the {robots} robots");
            check.fail(format!("errands[{i}].robot"), rule, errand.robot);
        } else if !seen.insert(errand.robot) {
            check.fail(format!("errands[{i}].robot"), "must not stand twice", errand.robot);
        }
        for (k, place) in errand.to.iter().enumerate() {
            check.inside(format!("errands[{i}].to[{k}]"), *place, 0.0);
        }
    }
    let samples = |task: &&TaskFile| task.sampled != SampledCounts::default();
    if let Some(task) = file.tasks.iter().find(samples) {
        check.fail(
            format!("{}.sampled", entry("tasks", &task.name)),
            "must be absent where there are errands: it fills the ways to tasks",
            "counts above 0",
        );
    }
}

/// A place of an errand.
struct Place {
    field: String,
    at: Point,
    is_on_the_ground: bool,
}

/// Checks that a robot can stand at each place, or so near that it covers it: routes keep `clearance_m` off
/// the walls of the arena and what stands there for good. Values must be sound.
pub(super) fn places_are_free(check: &mut Checker, file: &ScenarioFile) {
    let bodies = file.bodies().flat_map(|(body, count)| std::iter::repeat_n(body, count as usize));
    let bodies: Vec<RoleFile> = bodies.collect();
    let mut places = Vec::new();
    for (i, errand) in file.errands.iter().enumerate() {
        let is_on_the_ground = bodies[errand.robot as usize].kind == RoleKind::Ground;
        let place = |(k, at): (usize, &Point)| Place {
            field: format!("errands[{i}].to[{k}]"),
            at: *at,
            is_on_the_ground,
        };
        places.extend(errand.to.iter().enumerate().map(place));
    }
    for place in &places {
        let depth =
            (0..2).map(|k| place.at[k].min(file.arena_m[k] - place.at[k])).fold(f64::INFINITY, f64::min);
        must_be_clear(check, file, place, depth, "the wall of the arena");
    }
    let boxes = |place: &Place| {
        Aabb::from_half_extents(vector(place.at), Vector::splat(file.planning.clearance_m as f32))
    };
    let tree: Places = places.iter().map(boxes).collect();
    let mut stands = |what: &str, piece: &DebrisFile| {
        let outline = piece.outline();
        let bounds = outline.shape.compute_aabb(&outline.pose);
        let mut near = tree.near(bounds.center(), bounds.half_extents().max_element());
        near.sort_unstable();
        for place in near.into_iter().map(|number| &places[number]).filter(|place| place.is_on_the_ground) {
            let distance = f64::from(outline.signed_distance(vector(place.at)));
            must_be_clear(check, file, place, distance, what);
        }
    };
    for (i, piece) in file.debris.iter().enumerate().filter(|(_, piece)| stays(file, piece)) {
        stands(&format!("debris[{i}]"), piece);
    }
    for (i, wall) in file.walls.iter().enumerate() {
        wall.pieces().for_each(|piece| stands(&format!("walls[{i}]"), &piece));
    }
}

/// Whether nothing moves a piece of debris or clears it away.
fn stays(file: &ScenarioFile, piece: &DebrisFile) -> bool {
    let opens = |name: &String| {
        file.timeline.iter().any(|moment| matches!(&moment.event, Happening::Opens(opened) if opened == name))
    };
    piece.movable.is_none() && !piece.name.as_ref().is_some_and(opens)
}

/// Refuses a place at this distance, in metres, from something that stays; negative inside it.
fn must_be_clear(check: &mut Checker, file: &ScenarioFile, place: &Place, distance: f64, what: &str) {
    const ROUNDING_M: f64 = 1e-4;
    let clearance = file.planning.clearance_m;
    if distance >= clearance - ROUNDING_M {
        return;
    }
    let least = limits::CLEARANCE_M.least;
    let hint = if distance >= least {
        format!("planning.clearance_m of at most {distance:.3} would do")
    } else {
        String::new()
    };
    let found =
        if distance > 0.0 { format!("{distance:.3} m from it") } else { "a place inside it".to_owned() };
    let rule = format!("must be at least planning.clearance_m ({clearance} m) from {what}");
    check.fail_with(&place.field, rule, hint, found);
}
