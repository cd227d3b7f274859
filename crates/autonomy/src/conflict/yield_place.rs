//! Where a robot can make room: the nearest place that leaves another robot's route free, and the path to it.
//!
//! In the open, the place is a step aside. In a passage too narrow for two robots, the path leads back to the
//! nearest bay or out of the passage. The search is Dijkstra's algorithm on a local grid with cells of half
//! the robot's radius; O(cells log cells), at most 201 x 201 cells.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use parry2d::math::Vector;

use super::Mover;
use crate::planning::{KnownObstacle, nearest_border_point, polygon_contains};

/// Cells from the middle of the grid to its border.
const HALF_CELLS: i32 = 100;

/// Cells in a row.
const ROW: i32 = 2 * HALF_CELLS + 1;

/// Cost of a step along a row or column, and of a diagonal one.
const STEP_COST: [u32; 2] = [10, 14];

/// Extra cost of a cell where another robot stands: that robot has to make room in turn.
const CROWD_COST: u32 = 150;

/// Length of the other robot's route ahead, and of its trail behind, that is to be left free, in metres.
const CLEARED_WAY_M: f32 = 30.0;

/// Under the paper's rule, an obstacle is left out if the robot is inside its inflated outline and within
/// this distance of one of its corners in both x and y, in metres.
const LEAVE_M: f32 = 0.8;

/// A robot that is too close to an obstacle may come this much closer on its way along it, in metres.
const SLIDE_M: f32 = 0.01;

/// A request for room.
pub(super) struct Ask<'a> {
    /// The robot that is to make room.
    pub(super) me: &'a Mover<'a>,
    /// The robot for which it makes room.
    pub(super) head: &'a Mover<'a>,
    /// The path of `head` that is to be left free.
    pub(super) way: Vec<Vector>,
    /// Whether `me` may pass through the position of `head`, which then has to make room for `me` first.
    pub(super) through_head: bool,
    /// Other robots: their centres, and the distances at which they touch `me`.
    pub(super) crowd: Vec<(Vector, f32)>,
    /// Places to which other robots are going to make room there.
    pub(super) reserved: Vec<(Vector, f32)>,
    /// Distance to keep from robots, in metres.
    pub(super) margin: f32,
    /// Whether obstacles near whose corners `me` is too close are left out.
    pub(super) leaves_out_corners: bool,
    /// Width and height of the arena, in metres.
    pub(super) arena: Vector,
}

/// The paths of a robot: its route ahead, and its trail behind.
pub(super) fn ways(robot: &Mover) -> [Vec<Vector>; 2] {
    let ahead = std::iter::once(robot.position).chain(robot.route.iter().copied());
    let behind = std::iter::once(robot.position).chain(robot.trail.iter().rev().copied());
    [cut(ahead), cut(behind)]
}

fn cut(points: impl Iterator<Item = Vector>) -> Vec<Vector> {
    let mut length = 0.0;
    let mut way: Vec<Vector> = Vec::new();
    for point in points {
        length += way.last().map_or(0.0, |last| (point - *last).length());
        way.push(point);
        if length > CLEARED_WAY_M {
            break;
        }
    }
    way
}

/// Distance of a point from a path, in metres.
pub(super) fn distance_to_way(point: Vector, way: &[Vector]) -> f32 {
    let to_leg = |leg: &[Vector]| {
        let along = leg[1] - leg[0];
        let t = ((point - leg[0]).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
        (leg[0] + along * t - point).length()
    };
    match way {
        [] => f32::INFINITY,
        [only] => (*only - point).length(),
        _ => way.windows(2).map(to_leg).fold(f32::INFINITY, f32::min),
    }
}

impl Ask<'_> {
    /// The path to the nearest place that leaves room, without the robot's own position; `None` if no place
    /// is within reach.
    pub(super) fn find(&self) -> Option<Vec<Vector>> {
        let mut grid = Grid::new(self);
        let place = grid.search()?;
        Some(grid.way_to(place))
    }

    fn touch_head(&self) -> f32 {
        self.me.radius + self.head.radius
    }

    /// Whether `me` leaves room at this point.
    fn leaves_room(&self, point: Vector) -> bool {
        let clear = |(center, touch): &(Vector, f32)| (*center - point).length() >= touch + self.margin;
        distance_to_way(point, &self.way) >= self.touch_head() + self.margin
            && self.crowd.iter().all(clear)
            && self.reserved.iter().all(clear)
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Cell {
    Unknown,
    Blocked,
    Free,
    Crowded,
}

struct Grid<'a> {
    ask: &'a Ask<'a>,
    size: f32,
    /// Obstacles near enough to matter, each with how deep the robot is inside its outline, in metres; 0
    /// outside.
    obstacles: Vec<(&'a KnownObstacle, f32)>,
    cells: Vec<Cell>,
    cost: Vec<u32>,
    from: Vec<u32>,
}

impl<'a> Grid<'a> {
    fn new(ask: &'a Ask<'a>) -> Self {
        let size = 0.5 * ask.me.radius;
        let reach = size * HALF_CELLS as f32;
        let here = ask.me.position;
        let matters = |obstacle: &&KnownObstacle| {
            let distance = |corner: &Vector| (*corner - here).abs().max_element();
            let is_near = || obstacle.tight.iter().map(distance).any(|nearest| nearest < LEAVE_M);
            !(ask.leaves_out_corners && polygon_contains(&obstacle.tight, here) && is_near())
        };
        let near = ask.me.known.into_iter().flat_map(|known| known.near(here, reach)).filter(matters);
        let own_depth =
            |obstacle: &KnownObstacle| if ask.leaves_out_corners { 0.0 } else { depth(obstacle, here) };
        let count = (ROW * ROW) as usize;
        Self {
            ask,
            size,
            obstacles: near.map(|obstacle| (obstacle, own_depth(obstacle))).collect(),
            cells: vec![Cell::Unknown; count],
            cost: vec![u32::MAX; count],
            from: vec![u32::MAX; count],
        }
    }

    fn point(&self, cell: u32) -> Vector {
        let (row, column) = (cell.cast_signed() / ROW, cell.cast_signed() % ROW);
        let offset = Vector::new((column - HALF_CELLS) as f32, (row - HALF_CELLS) as f32);
        self.ask.me.position + offset * self.size
    }

    fn search(&mut self) -> Option<u32> {
        let start = (HALF_CELLS * ROW + HALF_CELLS) as u32;
        let mut open = BinaryHeap::from([Reverse((0, start))]);
        self.cost[start as usize] = 0;
        while let Some(Reverse((cost, cell))) = open.pop() {
            if cost > self.cost[cell as usize] {
                continue;
            }
            if cell != start && self.kind(cell) == Cell::Free && self.ask.leaves_room(self.point(cell)) {
                return Some(cell);
            }
            for (next, step) in neighbours(cell) {
                let crowd = match self.kind(next) {
                    Cell::Blocked | Cell::Unknown => continue,
                    Cell::Free => 0,
                    Cell::Crowded => CROWD_COST,
                };
                let cost = cost + step + crowd;
                if cost < self.cost[next as usize] {
                    self.cost[next as usize] = cost;
                    self.from[next as usize] = cell;
                    open.push(Reverse((cost, next)));
                }
            }
        }
        None
    }

    /// The content of a cell, determined on first use.
    fn kind(&mut self, cell: u32) -> Cell {
        if self.cells[cell as usize] == Cell::Unknown {
            self.cells[cell as usize] = self.look_at(self.point(cell));
        }
        self.cells[cell as usize]
    }

    fn look_at(&self, point: Vector) -> Cell {
        let Ask { me, head, arena, .. } = self.ask;
        let border = Vector::splat(me.radius);
        let outside = point.cmplt(border).any() || point.cmpgt(*arena - border).any();
        // A robot that is too close to an obstacle, or touches another robot, may still move away from it.
        let is_in = |(obstacle, own): &(&KnownObstacle, f32)| {
            polygon_contains(&obstacle.tight, point)
                && (*own <= 0.0 || depth(obstacle, point) > own + SLIDE_M)
        };
        if outside || self.obstacles.iter().any(is_in) {
            return Cell::Blocked;
        }
        let nearer = |center: Vector| (center - point).length() < (center - me.position).length();
        let meets = |center: Vector, touch: f32| (center - point).length() < touch && nearer(center);
        if meets(head.position, self.ask.touch_head()) {
            return if self.ask.through_head { Cell::Crowded } else { Cell::Blocked };
        }
        let crowded = self.ask.crowd.iter().any(|(center, touch)| meets(*center, *touch));
        if crowded { Cell::Crowded } else { Cell::Free }
    }

    /// The path to a cell, reduced to its corners.
    fn way_to(&mut self, place: u32) -> Vec<Vector> {
        let mut way = vec![place];
        let mut last = place;
        while self.from[last as usize] != u32::MAX {
            last = self.from[last as usize];
            way.push(last);
        }
        way.reverse();
        let mut corners = Vec::new();
        let mut at = 0;
        while at + 1 < way.len() {
            let next = (at + 1..way.len()).rev().find(|to| *to == at + 1 || self.is_clear(way[at], way[*to]));
            at = next.unwrap_or(at + 1);
            corners.push(self.point(way[at]));
        }
        corners
    }

    /// Whether the straight line between two cells crosses free cells only.
    fn is_clear(&self, a: u32, b: u32) -> bool {
        let (a, b) = (self.point(a), self.point(b));
        let samples = (2.0 * (b - a).length() / self.size).ceil().max(1.0);
        (0..=samples as u32).all(|i| self.look_at(a.lerp(b, i as f32 / samples)) == Cell::Free)
    }
}

/// How deep a point is inside an obstacle's inflated outline, in metres; 0 outside.
fn depth(obstacle: &KnownObstacle, point: Vector) -> f32 {
    let is_inside = polygon_contains(&obstacle.tight, point);
    if is_inside { (nearest_border_point(&obstacle.tight, point) - point).length() } else { 0.0 }
}

fn neighbours(cell: u32) -> impl Iterator<Item = (u32, u32)> {
    let (row, column) = (cell.cast_signed() / ROW, cell.cast_signed() % ROW);
    (0..9).filter(|k| *k != 4).filter_map(move |k| {
        let (to_row, to_column) = (row + k / 3 - 1, column + k % 3 - 1);
        let inside = (0..ROW).contains(&to_row) && (0..ROW).contains(&to_column);
        let diagonal = usize::from(to_row != row && to_column != column);
        inside.then_some(((to_row * ROW + to_column) as u32, STEP_COST[diagonal]))
    })
}

#[cfg(test)]
mod tests {
    use super::super::testing::mover;
    use super::*;
    use crate::planning::{ObstacleKey, ObstacleMap};
    use scenario::shapes::Outline;

    fn wall(number: u32, center: [f32; 2], size: [f32; 2]) -> KnownObstacle {
        let shape = parry2d::shape::SharedShape::cuboid(size[0] / 2.0, size[1] / 2.0);
        let outline = Outline { shape, ..Outline::disc(center.into(), 1.0) };
        KnownObstacle::new(ObstacleKey::Debris(number), &outline, 0.4, 0.15)
    }

    /// A passage along x at y = 10, 1.2 m wide, from x = 5 to x = 15. Its northern wall has a bay between x =
    /// 11 and x = 13.
    fn passage() -> ObstacleMap {
        let walls = [
            wall(0, [10.0, 9.0], [10.0, 0.8]),
            wall(1, [8.0, 11.0], [6.0, 0.8]),
            wall(2, [14.0, 11.0], [2.0, 0.8]),
            wall(3, [12.0, 12.4], [6.0, 0.8]),
        ];
        walls.into_iter().collect()
    }

    fn ask<'a>(me: &'a Mover, head: &'a Mover) -> Ask<'a> {
        let [way, _] = ways(head);
        Ask {
            me,
            head,
            way,
            through_head: false,
            crowd: Vec::new(),
            reserved: Vec::new(),
            margin: 0.15,
            leaves_out_corners: false,
            arena: Vector::splat(20.0),
        }
    }

    #[test]
    fn in_the_open_a_robot_steps_aside() {
        let head = mover(0, [5.0, 10.0], [1.0, 0.0]);
        let me = mover(1, [6.0, 10.0], [-1.0, 0.0]);
        let way = ask(&me, &head).find().unwrap();
        let place = way[way.len() - 1];
        assert!((place.y - 10.0).abs() >= 0.95 && (place - me.position).length() < 1.3, "{way:?}");
    }

    #[test]
    fn in_a_passage_it_goes_back_to_the_nearest_bay() {
        let obstacles = passage();
        let head = Mover { known: Some(&obstacles), ..mover(0, [7.0, 10.0], [1.0, 0.0]) };
        let me = Mover { known: Some(&obstacles), ..mover(1, [8.0, 10.0], [-1.0, 0.0]) };
        let place = *ask(&me, &head).find().unwrap().last().unwrap();
        assert!((11.0..13.0).contains(&place.x) && place.y > 10.9, "{place}");
        let taken = Ask { reserved: vec![(place, 0.8)], ..ask(&me, &head) };
        let farther = *taken.find().unwrap().last().unwrap();
        assert!(farther.x > 15.0, "the bay is taken: {farther}");
    }

    #[test]
    fn out_of_a_dead_end_there_is_a_way_through_the_other_only() {
        let mut obstacles = passage();
        obstacles.insert(wall(1, [10.0, 11.0], [10.0, 0.8]));
        obstacles.insert(wall(4, [15.0, 10.0], [0.8, 3.0]));
        let head = Mover { known: Some(&obstacles), ..mover(0, [8.0, 10.0], [1.0, 0.0]) };
        let me = Mover { known: Some(&obstacles), ..mover(1, [10.0, 10.0], [0.0, 0.0]) };
        assert_eq!(ask(&me, &head).find(), None);
        let trail = [Vector::new(2.0, 10.0)];
        let head = Mover { trail: &trail, ..head };
        let way = ways(&head).concat();
        let through = Ask { through_head: true, way, ..ask(&me, &head) };
        let place = *through.find().unwrap().last().unwrap();
        assert!(place.x < 5.0 && (place.y - 10.0).abs() > 0.9, "{place}");
    }
}
