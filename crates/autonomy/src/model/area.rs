//! A task's area: its block of rescuees with a margin, the lanes of its sweep, and the waiting places of
//! robots.

use parry2d::math::Vector;
use scenario::shapes::vector;
use scenario::{RoleKind, Scenario, TaskFile};

/// Least distance between the lanes of a sweep, in metres: a robot that sees only a few millimetres cannot
/// comb an area.
const LEAST_LANE_SPACING_M: f32 = 2.0;

/// Distance between waiting places beyond the diameter of the largest robot on the ground or in the air, in
/// metres.
const MUSTER_GAP_M: f32 = 0.8;

/// A task's area.
#[derive(Debug, Clone, Copy)]
pub struct TaskArea {
    /// Lower left corner of the block of rescuees.
    block_min: Vector,
    /// Upper right corner of the block of rescuees.
    block_max: Vector,
    margin: f32,
    /// Distance of the first row of waiting places from the block.
    muster_margin: f32,
    spacing: f32,
    /// Distance between the waiting places of robots that fly.
    air_spacing: f32,
    /// Waiting places in a row are at least so many.
    least_in_row: usize,
    home: Vector,
}

impl TaskArea {
    /// The area of one task. Waiting places are on the side that faces `home`. The area contains the waiting
    /// places of all `robots`, so that waiting robots share its resources.
    pub fn new(scenario: &Scenario, file: &TaskFile, home: Vector, robots: usize) -> Self {
        let (center, half) = (vector(file.center), vector(file.size_m) / 2.0);
        let spacing = |kind| 2.0 * scenario.largest_radius_m(kind) as f32 + MUSTER_GAP_M;
        let mut area = Self {
            block_min: center - half,
            block_max: center + half,
            margin: scenario.mission.area_margin_m as f32,
            muster_margin: 0.6 * scenario.mission.area_margin_m as f32,
            spacing: spacing(RoleKind::Ground),
            air_spacing: spacing(RoleKind::Aerial),
            least_in_row: 1,
            home,
        };
        let is_outside =
            |place: Vector| place.cmplt(Vector::ZERO).any() || place.cmpgt(vector(scenario.arena_m)).any();
        let last = |area: &Self| area.muster(robots.saturating_sub(1));
        if is_outside(last(&area)) {
            // As many as there are rows: before a small block, they lead far.
            area.least_in_row = robots.isqrt();
        }
        let last = last(&area);
        let beyond = (last - last.clamp(area.block_min, area.block_max)).abs().max_element();
        area.margin = area.margin.max(beyond + area.spacing);
        area
    }

    /// Whether a point lies in the area.
    pub fn contains(&self, point: Vector) -> bool {
        let margin = Vector::splat(self.margin);
        point.cmpge(self.block_min - margin).all() && point.cmple(self.block_max + margin).all()
    }

    /// Centre of the block.
    pub fn center(&self) -> Vector {
        (self.block_min + self.block_max) / 2.0
    }

    /// The waypoints of a sweep by which a robot that sees `range` metres sees the whole block. The lanes run
    /// along the longer side and begin at the end nearer to home. The `rank`-th of `ranks` robots begins with
    /// a lane of its own, as far as there are enough lanes.
    pub fn sweep(&self, range: f32, rank: usize, ranks: usize) -> Vec<Vector> {
        let size = self.block_max - self.block_min;
        let along_x = size.x >= size.y;
        let (length, width) = if along_x { (size.x, size.y) } else { (size.y, size.x) };
        let spacing = (std::f32::consts::SQRT_2 * range).max(LEAST_LANE_SPACING_M);
        let lanes = (width / spacing).ceil().max(1.0);
        // With this inset, the corners of a lane's strip are within range from the lane's end.
        let inset = (spacing / 2.0).min(length / 2.0);
        let place = |along: f32, across: f32| {
            self.block_min + if along_x { Vector::new(along, across) } else { Vector::new(across, along) }
        };
        let mut ends: Vec<[Vector; 2]> = (0..lanes as usize)
            .map(|lane| (lane as f32 + 0.5) * width / lanes)
            .map(|across| [place(inset, across), place(length - inset, across)])
            .collect();
        let distance = |ends: &[Vector; 2]| ends.map(|end| (end - self.home).length());
        if distance(&ends[0])[0].min(distance(&ends[0])[1])
            > distance(&ends[ends.len() - 1])[0].min(distance(&ends[ends.len() - 1])[1])
        {
            ends.reverse();
        }
        let shift = rank * ends.len() / ranks.max(1);
        ends.rotate_left(shift);
        let mut turn = distance(&ends[0])[0] > distance(&ends[0])[1];
        let mut path = Vec::with_capacity(2 * ends.len());
        for [a, b] in ends {
            path.extend(if turn { [b, a] } else { [a, b] });
            turn = !turn;
        }
        path
    }

    /// The waiting place of the `rank`-th of `ranks` aerial members. The places are side by side over the
    /// middle of the block, in as many rows as needed to stay in the area, so that the robots share its
    /// resources.
    pub(crate) fn hover(&self, rank: usize, ranks: usize) -> Vector {
        let width = self.block_max.x - self.block_min.x + 2.0 * self.margin;
        let per_row = ((width / self.air_spacing).floor() as usize).max(1);
        let (row, place) = (rank / per_row, rank % per_row);
        let rows = ranks.div_ceil(per_row).max(1);
        let in_row = ranks.saturating_sub(row * per_row).clamp(1, per_row);
        let off_middle = |i: usize, count: usize| (i as f32 - (count - 1) as f32 / 2.0) * self.air_spacing;
        self.center() + Vector::new(off_middle(place, in_row), off_middle(row, rows))
    }

    /// The waiting place of the `rank`-th member. The places form rows in the margin, on the side that faces
    /// home.
    pub fn muster(&self, rank: usize) -> Vector {
        let toward = self.home - self.center();
        let half = (self.block_max - self.block_min) / 2.0;
        let facing_y = toward.y.abs() * half.x >= toward.x.abs() * half.y;
        let (length, depth, sign) =
            if facing_y { (half.x, half.y, toward.y.signum()) } else { (half.y, half.x, toward.x.signum()) };
        let per_row = ((2.0 * length / self.spacing).floor() as usize).max(self.least_in_row);
        let (row, place) = (rank / per_row, rank % per_row);
        let along = (place as f32 - (per_row - 1) as f32 / 2.0) * self.spacing;
        let out = sign * (depth + self.muster_margin + row as f32 * self.spacing);
        self.center() + if facing_y { Vector::new(along, out) } else { Vector::new(out, along) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(size: [f32; 2]) -> TaskArea {
        let (center, half) = (Vector::new(20.0, 60.0), Vector::from(size) / 2.0);
        TaskArea {
            block_min: center - half,
            block_max: center + half,
            margin: 4.0,
            muster_margin: 2.4,
            spacing: 1.6,
            air_spacing: 2.0,
            least_in_row: 1,
            home: Vector::new(40.0, 10.0),
        }
    }

    #[test]
    fn a_sweep_sees_the_whole_block() {
        for size in [[11.0, 5.7], [5.0, 30.0], [1.0, 1.0], [0.0, 0.0]] {
            for range in [3.0, 5.0, 20.0] {
                let area = area(size);
                let path = area.sweep(range, 0, 1);
                for step in 0..=400 {
                    let corner = Vector::new((step % 20) as f32 / 20.0, (step / 20) as f32 / 20.0);
                    let place = area.block_min + corner * Vector::from(size);
                    let seen = path.windows(2).any(|leg| {
                        (0..=100)
                            .any(|t| (leg[0].lerp(leg[1], t as f32 / 100.0) - place).length() <= range + 0.05)
                    });
                    assert!(seen, "{place} is not seen from {path:?} with range {range}");
                }
            }
        }
    }

    #[test]
    fn waiting_places_are_apart_in_the_area_and_face_home() {
        let area = area([11.0, 5.7]);
        let places: Vec<Vector> = (0..6).map(|rank| area.muster(rank)).collect();
        for (i, place) in places.iter().enumerate() {
            assert!(area.contains(*place) && place.y < area.block_min.y, "{place}");
            assert!(places[..i].iter().all(|other| (*other - *place).length() > 1.5));
        }
    }

    #[test]
    fn waiting_places_before_a_small_block_are_in_a_block_themselves_if_a_line_leaves_the_arena() {
        let paper = include_str!("../../../../scenarios/paper.ron");
        let scenario = Scenario::parse(paper, "paper.ron".as_ref()).unwrap();
        let file = TaskFile { size_m: [2.0, 1.0], center: [35.0, 30.0], ..scenario.tasks[0].clone() };
        let depth = |robots: usize| {
            let area = TaskArea::new(&scenario, &file, Vector::new(35.0, 2.0), robots);
            let outside = (0..robots).filter(|rank| area.muster(*rank).y < 0.0).count();
            (outside, (area.muster(0).y - area.muster(robots - 1).y).round())
        };
        assert_eq!([depth(4), depth(49)], [(0, 5.0), (0, 10.0)], "a line of four, seven rows of seven");
    }

    #[test]
    fn waiting_places_in_the_air_are_apart_in_the_area_and_around_its_middle() {
        let area = area([11.0, 5.7]);
        assert_eq!(area.hover(0, 1), area.center());
        assert_eq!(area.hover(1, 2), area.center() + Vector::new(1.0, 0.0));
        for ranks in [3, 9, 10, 25] {
            let places: Vec<Vector> = (0..ranks).map(|rank| area.hover(rank, ranks)).collect();
            for (i, place) in places.iter().enumerate() {
                assert!(area.contains(*place), "{ranks}: {place}");
                assert!(places[..i].iter().all(|other| (*other - *place).length() > 1.9), "{ranks}: {place}");
            }
        }
    }
}
