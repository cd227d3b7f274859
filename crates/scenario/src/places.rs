//! Places and outlines of the things of a scenario.

use parry2d::math::{Pose, Rotation, Vector};
use parry2d::shape::SharedShape;

use super::debris::ROUNDING_M;
use super::file::{
    ConflictRules, DebrisFile, DebrisShape, Door, ResolverRule, RightOfWay, RoleFile, Row, ScenarioFile,
    WallFile, ZoneFile,
};
use crate::shapes::{Outline, RadiationZone, vector};

impl DebrisFile {
    /// The outline of a piece of debris as the scenario places it. The shape must have been validated.
    pub fn outline(&self) -> Outline {
        let shape = match &self.shape {
            DebrisShape::Disc(radius) => SharedShape::ball(*radius as f32),
            DebrisShape::Box(width, height) => {
                SharedShape::cuboid((*width / 2.0) as f32, (*height / 2.0) as f32)
            }
            DebrisShape::Polygon(corners) => {
                let corners: Vec<Vector> = corners.iter().copied().map(vector).collect();
                SharedShape::convex_hull(&corners).unwrap_or_else(|| SharedShape::ball(0.1))
            }
        };
        let angle = self.rotation_deg.to_radians() as f32;
        let rotation = Rotation::from_cos_sin_unchecked(libm::cosf(angle), libm::sinf(angle));
        Outline { shape, pose: Pose::from_parts(vector(self.at), rotation) }
    }
}

impl WallFile {
    /// Length of its middle line, in metres.
    pub fn length_m(&self) -> f64 {
        libm::hypot(self.to[0] - self.from[0], self.to[1] - self.from[1])
    }

    /// The parts of the wall between its doors, as fixed debris. Parts shorter than the wall's thickness are
    /// left out.
    pub fn pieces(&self) -> impl Iterator<Item = DebrisFile> + use<> {
        let mut doors = self.doors.clone();
        doors.sort_by(|a, b| a.at_m.total_cmp(&b.at_m));
        let begins = doors.clone().into_iter().map(|door| door.at_m + door.width_m / 2.0);
        let ends = doors.into_iter().map(|door| door.at_m - door.width_m / 2.0).chain([self.length_m()]);
        let (wall, least) = (self.clone(), self.thickness_m - ROUNDING_M);
        let parts = std::iter::once(0.0).chain(begins).zip(ends);
        parts
            .filter(move |(begin, end)| end - begin >= least)
            .map(move |(begin, end)| wall.part(f64::midpoint(begin, end), end - begin))
    }

    /// The panel that closes a door.
    pub fn panel(&self, door: &Door) -> DebrisFile {
        DebrisFile { name: door.name.clone(), ..self.part(door.at_m, door.width_m) }
    }

    /// A piece of the wall of this length, whose middle is at this distance from its begin, in metres.
    fn part(&self, middle_m: f64, part_m: f64) -> DebrisFile {
        let (from, length) = (self.from, self.length_m());
        let along = [(self.to[0] - from[0]) / length, (self.to[1] - from[1]) / length];
        let at = [from[0] + along[0] * middle_m, from[1] + along[1] * middle_m];
        let rotation_deg = libm::atan2(along[1], along[0]).to_degrees();
        DebrisFile { rotation_deg, ..DebrisFile::fixed(DebrisShape::Box(part_m, self.thickness_m), at) }
    }
}

impl ScenarioFile {
    /// Debris at known places, followed by the parts of the walls.
    pub fn obstacles(&self) -> Vec<DebrisFile> {
        let mut all = self.debris.clone();
        all.extend(self.walls.iter().flat_map(WallFile::pieces));
        all
    }

    /// Properties and abilities of the robots of each row, and their number.
    pub fn bodies(&self) -> impl Iterator<Item = (RoleFile, u32)> + '_ {
        self.team.iter().map(|row| (self.body_of(row).unwrap_or_default(), row.count))
    }

    /// Whether a robot may push debris.
    pub(super) fn can_be_pushed(&self) -> bool {
        self.debris.iter().any(|piece| piece.movable.is_some())
            || self.scatter.iter().any(|entry| entry.movable.is_some())
    }

    /// Properties and abilities of the robots of a row: their role's, with the changes of the row. `None` if
    /// the scenario has no such role.
    pub fn body_of(&self, row: &Row) -> Option<RoleFile> {
        let mut body = self.roles.iter().find(|role| role.name == row.role)?.clone();
        if let Some(other) = row.body {
            body.radius_m = other.radius_m.unwrap_or(body.radius_m);
            body.mass_kg = other.mass_kg.unwrap_or(body.mass_kg);
            body.hp = other.hp.unwrap_or(body.hp);
            body.energy = other.energy.unwrap_or(body.energy);
            body.speed_mps = other.speed_mps.unwrap_or(body.speed_mps);
            body.acceleration_mps2 = other.acceleration_mps2.unwrap_or(body.acceleration_mps2);
            body.sensing_m = other.sensing_m.unwrap_or(body.sensing_m);
            body.observing_m = other.observing_m.unwrap_or(body.observing_m);
            body.capacity = other.capacity.unwrap_or(body.capacity);
            body.resources = other.resources.unwrap_or(body.resources);
            body.guides = other.guides.unwrap_or(body.guides);
        }
        Some(body)
    }
}

impl ConflictRules {
    /// The values of the paper's rule; the defaults under another resolver.
    pub fn right_of_way(&self) -> RightOfWay {
        match self.resolver {
            ResolverRule::Rotation(rule) | ResolverRule::Swap(rule) => rule,
            ResolverRule::Reciprocal | ResolverRule::None => RightOfWay::default(),
        }
    }
}

impl ZoneFile {
    /// The radiation zone at its place.
    pub fn zone(&self) -> RadiationZone {
        RadiationZone { center: vector(self.at), radius: self.radius_m as f32 }
    }
}

impl Row {
    /// One robot of a role at a place.
    pub fn of_one(role: &str, center: [f64; 2]) -> Self {
        Self { role: role.to_owned(), count: 1, center, width_m: 0.0, levels: None, body: None }
    }

    /// Places of the robots of a row, side by side.
    pub fn places(&self) -> impl Iterator<Item = [f64; 2]> + use<> {
        let Self { count, center, width_m, .. } = *self;
        let gaps = f64::from(count.saturating_sub(1).max(1));
        let left = if count > 1 { center[0] - width_m / 2.0 } else { center[0] };
        (0..count).map(move |i| [left + width_m * f64::from(i) / gaps, center[1]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DebrisShape;

    fn piece(shape: DebrisShape) -> Outline {
        DebrisFile { shape, at: [10.0, 5.0], rotation_deg: 30.0, movable: None, name: None }.outline()
    }

    #[test]
    fn the_parts_of_a_wall_leave_its_doors_free() {
        let door = |at_m| crate::Door { at_m, width_m: 1.0, name: None, is_closed: false };
        let doors = vec![door(7.0), door(3.0), door(9.55)];
        let wall = WallFile { from: [2.0, 0.0], to: [2.0, 10.0], thickness_m: 0.2, doors };
        let pieces: Vec<(f64, f64)> = wall
            .pieces()
            .map(|piece| match piece.shape {
                DebrisShape::Box(length, 0.2) => (piece.at[1], length),
                shape => panic!("{shape:?}"),
            })
            .collect();
        assert_eq!(pieces.len(), 3, "{pieces:?}");
        for ((middle, length), (begin, end)) in pieces.iter().zip([(0.0, 2.5), (3.5, 6.5), (7.5, 9.05)]) {
            assert!(
                (middle - f64::midpoint(begin, end)).abs() < 1e-9 && (length - (end - begin)).abs() < 1e-9
            );
        }
        assert!(wall.pieces().all(|piece| (piece.rotation_deg - 90.0).abs() < 1e-9));
    }

    #[test]
    fn an_inflated_outline_keeps_its_distance_and_wastes_little() {
        let triangle = vec![[-1.0, -0.5], [1.0, -0.5], [0.0, 1.0]];
        for shape in [DebrisShape::Disc(0.5), DebrisShape::Box(2.0, 1.0), DebrisShape::Polygon(triangle)] {
            let outline = piece(shape);
            let corners = outline.inflated(0.6);
            for i in 0..corners.len() {
                let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
                for t in [0.0, 0.25, 0.5, 0.75] {
                    let distance = outline.distance_to(a.lerp(b, t));
                    assert!((0.599..0.66).contains(&distance), "{distance}");
                }
            }
        }
    }
}
