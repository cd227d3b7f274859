//! Debris and radiation zones, and their rules.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::Checker;
use super::file::{Door, Point, ScenarioFile, WallFile};
use crate::limits;

/// Least width of a polygon in every direction, in metres: less is flat in single precision.
pub const LEAST_POLYGON_WIDTH_M: f64 = 0.01;

/// Lengths that differ by less than this are equal, in metres: what comes of rounding.
pub(super) const ROUNDING_M: f64 = 1e-9;

/// Least sine of the angle by which a polygon turns at a corner; small corners of long edges may turn less.
const LEAST_SINE: f64 = 5e-4;

/// A piece of debris.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DebrisFile {
    /// Its outline.
    pub shape: DebrisShape,
    /// Its centre (for a polygon: the origin of its points).
    pub at: Point,
    /// Rotation, in degrees anticlockwise.
    #[serde(default)]
    pub rotation_deg: f64,
    /// Mass and friction of debris that a robot can push; absent for fixed debris.
    #[serde(default)]
    pub movable: Option<Movable>,
    /// A name, by which an event of the timeline can clear it away.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

impl DebrisFile {
    /// A fixed piece without a name, not rotated.
    pub fn fixed(shape: DebrisShape, at: Point) -> Self {
        Self { shape, at, rotation_deg: 0.0, movable: None, name: None }
    }
}

/// Outline of a piece of debris.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub enum DebrisShape {
    /// A disc of this radius in metres.
    Disc(f64),
    /// A rectangle of this width and height in metres.
    Box(f64, f64),
    /// A convex polygon: its corners in metres, anticlockwise.
    Polygon(Vec<Point>),
}

/// Debris that can be pushed; `movable: ()` has the defaults: 40 kg, friction 0.5.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Movable {
    /// Mass, in kilograms.
    pub mass_kg: f64,
    /// Coefficient of friction with the ground.
    pub friction: f64,
}

/// A radiation zone: a source and the radius of its effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ZoneFile {
    /// The source.
    pub at: Point,
    /// Radius, in metres.
    pub radius_m: f64,
    /// A name, by which an event of the timeline can end it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
}

pub(super) fn debris(check: &mut Checker, file: &ScenarioFile) {
    for (i, file) in file.debris.iter().enumerate() {
        piece(check, &format!("debris[{i}]"), file);
    }
    for (i, moment) in file.timeline.iter().enumerate() {
        if let Some(falling) = moment.event.falling() {
            piece(check, &format!("timeline[{i}].event"), &falling);
        }
    }
    for (i, wall) in file.walls.iter().enumerate() {
        self::wall(check, &format!("walls[{i}]"), wall);
    }
    for (i, zone) in file.radiation.iter().enumerate() {
        check.inside(format!("radiation[{i}].at"), zone.at, 0.0);
    }
}

fn piece(check: &mut Checker, field: &str, piece: &DebrisFile) {
    if let DebrisShape::Polygon(corners) = &piece.shape {
        polygon(check, &format!("{field}.shape"), corners);
    }
    check.inside(format!("{field}.at"), piece.at, 0.0);
}

fn wall(check: &mut Checker, field: &str, wall: &WallFile) {
    check.inside(format!("{field}.from"), wall.from, 0.0);
    check.inside(format!("{field}.to"), wall.to, 0.0);
    let length = wall.length_m();
    if length < wall.thickness_m - ROUNDING_M {
        check.fail(field, "must be at least as long as it is thick", format!("{length} m"));
    }
    let mut doors: Vec<(usize, &Door)> = wall.doors.iter().enumerate().collect();
    doors.sort_by(|a, b| a.1.at_m.total_cmp(&b.1.at_m));
    let mut free_from = 0.0;
    for (i, door) in doors {
        let field = format!("{field}.doors[{i}]");
        let [begin, end] = [door.at_m - door.width_m / 2.0, door.at_m + door.width_m / 2.0];
        if !(begin >= free_from - ROUNDING_M && end <= length + ROUNDING_M) {
            let rule = format!("must lie within the wall of {length:.3} m and clear of other doors");
            check.fail(field, rule, format!("{begin} to {end} m"));
        }
        free_from = end;
    }
}

fn polygon(check: &mut Checker, field: &str, corners: &[Point]) {
    let is_sound = limits::CORNERS.allows(corners.len());
    if !is_sound || !corners.iter().flatten().all(|x| limits::CORNER_M.range().contains(x)) {
        return;
    }
    let edges = || (0..corners.len()).map(|i| [corners[i], corners[(i + 1) % corners.len()]]);
    // How far a corner lies to the left of an edge, in metres.
    let left_of = |[a, b]: [Point; 2], c: &Point| {
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        turn / libm::hypot(b[0] - a[0], b[1] - a[1])
    };
    for i in 0..corners.len() {
        let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % corners.len()]);
        let turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
        let sine = turn / (libm::hypot(b[0] - a[0], b[1] - a[1]) * libm::hypot(c[0] - b[0], c[1] - b[1]));
        if !(turn >= 1e-4 || sine >= LEAST_SINE) {
            let rule = "must be convex, with its corners anticlockwise and none on a straight line";
            return check.fail(
                field,
                rule,
                format!("corner {} at ({}, {})", (i + 1) % corners.len(), b[0], b[1]),
            );
        }
    }
    // Each corner turns left, so a corner to the right of an edge belongs to a second turn round the middle.
    let is_right = |edge| corners.iter().any(|corner| left_of(edge, corner) < -1e-9);
    if let Some([[ax, ay], [bx, by]]) = edges().find(|edge| is_right(*edge)) {
        let rule = "must go round once: no corner may lie to the right of an edge";
        let found = format!("a corner to the right of the edge from ({ax}, {ay}) to ({bx}, {by})");
        return check.fail(field, rule, found);
    }
    let depth = |edge| corners.iter().map(|corner| left_of(edge, corner)).fold(0.0, f64::max);
    let width = edges().map(depth).fold(f64::INFINITY, f64::min);
    if width < LEAST_POLYGON_WIDTH_M {
        let rule = format!("must be at least {LEAST_POLYGON_WIDTH_M} m wide in every direction");
        check.fail(field, rule, format!("{width} m"));
    }
}
