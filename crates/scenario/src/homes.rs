//! Homes are free: no robot starts where another robot or a piece of debris is.

use parry2d::bounding_volume::Aabb;
use parry2d::math::Vector;

use super::checker::Checker;
use super::file::{DebrisFile, Point, RoleFile, RoleKind, ScenarioFile};
use crate::shapes::{Places, vector};

/// A robot's home.
struct Home<'f> {
    row: usize,
    role: &'f RoleFile,
    at: Point,
}

/// All homes, by number and by place.
struct Homes<'f> {
    list: Vec<Home<'f>>,
    places: Places,
}

/// Checks that no home is on another home of its layer, nor inside debris (aerial robots fly over it). Places
/// and shapes must be sound.
pub(super) fn homes_are_free(check: &mut Checker, file: &ScenarioFile) {
    let bodies: Vec<Option<RoleFile>> = file.team.iter().map(|row| file.body_of(row)).collect();
    let mut homes: Vec<Home> = Vec::new();
    for (row, (line, role)) in file.team.iter().zip(&bodies).enumerate() {
        let Some(role) = role else { continue };
        homes.extend(line.places().map(|at| Home { row, role, at }));
    }
    let boxes =
        |home: &Home| Aabb::from_half_extents(vector(home.at), Vector::splat(home.role.radius_m as f32));
    let homes = Homes { places: homes.iter().map(boxes).collect(), list: homes };
    apart(check, &homes);
    for (i, piece) in file.debris.iter().enumerate() {
        outside(check, &format!("debris[{i}].at"), piece, &homes);
    }
    for (i, wall) in file.walls.iter().enumerate() {
        wall.pieces().for_each(|piece| outside(check, &format!("walls[{i}]"), &piece, &homes));
    }
    for (field, piece) in later_pieces(file) {
        outside(check, &field, &piece, &homes);
    }
}

/// Pieces that events may put into the arena: panels of doors, and debris that falls.
pub(super) fn later_pieces(file: &ScenarioFile) -> impl Iterator<Item = (String, DebrisFile)> + '_ {
    let panels = file.panels().map(|(panel, _)| ("walls".to_owned(), panel));
    let falling = (0..).zip(&file.timeline).filter_map(|(i, moment): (usize, _)| {
        Some((format!("timeline[{i}].event.at"), moment.event.falling()?))
    });
    panels.chain(falling)
}

/// Checks that no ground robot's home is in this piece of debris. Reports the first that is.
fn outside(check: &mut Checker, field: &str, piece: &DebrisFile, homes: &Homes) {
    let outline = piece.outline();
    let bounds = outline.shape.compute_aabb(&outline.pose);
    let mut near = homes.places.near(bounds.center(), bounds.half_extents().max_element());
    near.sort_unstable();
    let is_in_it = |home: &&Home| {
        home.role.kind == RoleKind::Ground && outline.distance_to(vector(home.at)) < home.role.radius_m as f32
    };
    if let Some(Home { at: [x, y], .. }) = near.iter().map(|number| &homes.list[*number]).find(is_in_it) {
        let rule = "must leave every robot's home free";
        check.fail(field, rule, format!("a home at ({x}, {y})"));
    }
}

/// Checks that no home is on another home of its layer. Reports for each home the first that is too near.
fn apart(check: &mut Checker, homes: &Homes) {
    for (i, Home { row, role, at }) in homes.list.iter().enumerate() {
        let mut near = homes.places.near(vector(*at), role.radius_m as f32);
        near.sort_unstable();
        let others = near.into_iter().filter(|other| *other > i).map(|other| &homes.list[other]);
        for other in others.filter(|other| other.role.kind == role.kind) {
            let distance = libm::hypot(at[0] - other.at[0], at[1] - other.at[1]);
            let needed = role.radius_m + other.role.radius_m;
            if distance < needed {
                let rule = format!("must leave at least {needed} m between the centres of two robots");
                check.fail(
                    format!("team[{row}]"),
                    rule,
                    format!("{distance:.3} m at ({}, {})", at[0], at[1]),
                );
                break;
            }
        }
        if check.is_full() {
            return;
        }
    }
}
