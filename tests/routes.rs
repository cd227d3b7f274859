//! Routes, proved by a checker of its own: connected, clear of known debris, and as short as an oracle's.
//!
//! The oracle is a visibility graph over the corners of the same inflated outlines, searched by Dijkstra in
//! f64: exact, and too slow for anything but small maps.

use parry2d::math::Vector;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use scenario::shapes::{Outline, RadiationZone};
use scenario::{DebrisFile, DebrisShape, Scenario};
use usar_sim::belief::{Belief, KnownRobot};
use usar_sim::executor::Executor;
use usar_sim::model::{Layout, Model};
use usar_sim::navigation::{Goal, Navigator, Outlook};
use usar_sim::planning::{Inflation, KnownObstacle, ObstacleKey, ObstacleMap, Planner, Query};
use usar_sim::world::World;

use crate::support::{lies, paper, paper_with, trial};

type P = [f64; 2];

const OFFSET_M: f64 = 0.55; // radius and clearance of paper.ron
const ARENA: P = [89.5, 71.5];

fn sub(a: P, b: P) -> P {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: P, b: P) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn distance(a: P, b: P) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Whether more than a touch of the way from `a` to `b` is inside a convex polygon: bisected to the middle of
/// what is left of it.
fn enters(polygon: &[P], a: P, b: P) -> bool {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for i in 0..polygon.len() {
        let (p, q) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let (at_a, at_b) = (cross(sub(q, p), sub(a, p)), cross(sub(q, p), sub(b, p)));
        match (at_a > 0.0, at_b > 0.0) {
            (false, false) => return false,
            (false, true) => from = from.max(at_a / (at_a - at_b)),
            (true, false) => to = to.min(at_a / (at_a - at_b)),
            (true, true) => {}
        }
    }
    (to - from) * distance(a, b) > 2e-3
}

fn holds(polygon: &[P], point: P, depth: f64) -> bool {
    (0..polygon.len()).all(|i| {
        let (p, q) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        cross(sub(q, p), sub(point, p)) > depth * distance(p, q)
    })
}

/// Length of the shortest way, or `None` where there is none.
fn shortest(polygons: &[Vec<P>], from: P, to: P) -> Option<f64> {
    let inside = |p: &P| {
        (0..2).all(|k| p[k] >= OFFSET_M - 1e-4 && p[k] <= ARENA[k] - OFFSET_M + 1e-4)
            && !polygons.iter().any(|polygon| holds(polygon, *p, 1e-3))
    };
    let mut nodes = vec![from, to];
    nodes.extend(polygons.iter().flatten().copied().filter(inside));
    let mut best = vec![f64::INFINITY; nodes.len()];
    let mut done = vec![false; nodes.len()];
    best[0] = 0.0;
    while let Some(i) = (0..nodes.len()).filter(|i| !done[*i]).min_by(|a, b| best[*a].total_cmp(&best[*b])) {
        if !best[i].is_finite() || i == 1 {
            break;
        }
        done[i] = true;
        for j in 0..nodes.len() {
            let length = best[i] + distance(nodes[i], nodes[j]);
            if length < best[j] && !polygons.iter().any(|polygon| enters(polygon, nodes[i], nodes[j])) {
                best[j] = length;
            }
        }
    }
    best[1].is_finite().then_some(best[1])
}

fn random_debris(draws: &mut ChaCha8Rng) -> Vec<Outline> {
    (0..draws.random_range(1..12_u32))
        .map(|_| {
            let size = draws.random_range(0.3..4.0);
            let shape = match draws.random_range(0..3_u32) {
                0 => DebrisShape::Disc(size),
                1 => DebrisShape::Box(size, draws.random_range(0.2..8.0)),
                _ => DebrisShape::Polygon(vec![[-size, -size], [size, -0.5 * size], [0.0, size]]),
            };
            let at = [draws.random_range(25.0..65.0), draws.random_range(20.0..50.0)];
            let rotation_deg = draws.random_range(-180.0..180.0);
            DebrisFile { shape, at, rotation_deg, movable: None, name: None }.outline()
        })
        .collect()
}

fn known(outlines: &[Outline]) -> ObstacleMap {
    let key = |i: usize| ObstacleKey::Debris(i as u32);
    outlines.iter().enumerate().map(|(i, o)| KnownObstacle::new(key(i), o, 0.4, 0.15)).collect()
}

fn vector(p: P) -> Vector {
    Vector::new(p[0] as f32, p[1] as f32)
}

/// A ground robot's query at its usual speed.
fn query(obstacles: &ObstacleMap, from: P, to: P) -> Query<'_> {
    let (from, to) = (vector(from), vector(to));
    Query { from, to, aerial: false, radius: 0.4, speed: 2.25, obstacles, in_the_way: &[], zones: &[] }
}

#[test]
fn routes_are_connected_clear_of_known_debris_and_as_short_as_the_oracle_s() {
    let planner = Planner::new(&paper());
    let mut compared = 0;
    for seed in 0..150 {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let outlines = random_debris(&mut draws);
        let obstacles = known(&outlines);
        let polygons: Vec<Vec<P>> = obstacles
            .iter()
            .map(|obstacle| obstacle.planned.iter().map(|p| [f64::from(p.x), f64::from(p.y)]).collect())
            .collect();
        let mut place = |x: f64| [x + draws.random_range(-5.0..5.0), draws.random_range(10.0..60.0)];
        let (from, to) = (place(15.0), place(75.0));
        if polygons.iter().any(|polygon| holds(polygon, from, 0.0) || holds(polygon, to, 0.0)) {
            continue;
        }
        let route = planner.route(&query(&obstacles, from, to));
        let oracle = shortest(&polygons, from, to);
        assert_eq!(route.is_some(), oracle.is_some(), "seed {seed}");
        let (Some(route), Some(oracle)) = (route, oracle) else { continue };
        let start = vector(from);
        let length = f64::from(route.length(start));
        assert!((length - oracle).abs() <= 1e-4 * oracle, "seed {seed}: {length} m, oracle {oracle} m");
        assert!(distance([f64::from(route.end().x), f64::from(route.end().y)], to) < 1e-3, "seed {seed}");
        for (a, b) in route.legs(start) {
            for step in 0..=200 {
                let point = a.lerp(b, step as f32 / 200.0);
                let gap = outlines.iter().map(|o| o.distance_to(point)).fold(f32::INFINITY, f32::min);
                assert!(f64::from(gap) >= OFFSET_M - 2e-3, "seed {seed}: {gap} m from debris at {point}");
            }
        }
        compared += 1;
    }
    assert!(compared > 100, "{compared} routes compared");
}

/// Walls along the lines of a lattice, as people draw floor plans: the ends stick out by half the thickness,
/// so that walls meet flush.
struct FloorPlan {
    /// Columns and rows of cells.
    cells: [usize; 2],
    cell_m: f64,
    thickness_m: f64,
    /// For each cell: whether there is a wall to its left, and below it. One more column and row than cells.
    walls: Vec<[bool; 2]>,
}

impl FloorPlan {
    /// Lower left corner of the plan.
    const AT: P = [20.0, 20.0];

    fn draw(seed: u64) -> Self {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let cells = [draws.random_range(2..=6_usize), draws.random_range(2..=5_usize)];
        let share = draws.random_range(0.3..0.8);
        let walls = (0..(cells[0] + 1) * (cells[1] + 1)).map(|_| [0; 2].map(|_| draws.random_bool(share)));
        let walls = walls.collect();
        let cell_m = f64::from(draws.random_range(4..=8_u32)) / 2.0;
        Self { cells, cell_m, thickness_m: [0.2, 0.3, 0.5][draws.random_range(0..3_usize)], walls }
    }

    fn wall(&self, x: usize, y: usize, side: usize) -> bool {
        let [columns, rows] = self.cells;
        let exists = if side == 0 { x <= columns && y < rows } else { x < columns && y <= rows };
        exists && self.walls[y * (columns + 1) + x][side]
    }

    fn outlines(&self) -> Vec<Outline> {
        let (long, thin) = (self.cell_m + self.thickness_m, self.thickness_m);
        let places = (0..=self.cells[1]).flat_map(|y| (0..=self.cells[0]).map(move |x| (x, y)));
        let sides = places.flat_map(|(x, y)| [(x, y, 0), (x, y, 1)]);
        sides
            .filter(|(x, y, side)| self.wall(*x, *y, *side))
            .map(|(x, y, side)| {
                let half = if side == 0 { [0.0, 0.5] } else { [0.5, 0.0] };
                let shape =
                    if side == 0 { DebrisShape::Box(thin, long) } else { DebrisShape::Box(long, thin) };
                let at = [(x, 0), (y, 1)].map(|(i, k)| Self::AT[k] + (i as f64 + half[k]) * self.cell_m);
                DebrisFile { shape, at, rotation_deg: 0.0, movable: None, name: None }.outline()
            })
            .collect()
    }

    /// Whether one cell can be reached from another, by a flood fill of the cells; all around is one more.
    fn is_reachable(&self, from: usize, to: usize) -> bool {
        let [columns, rows] = self.cells;
        let outside = columns * rows;
        let cell = |x: usize, y: usize| if x < columns && y < rows { y * columns + x } else { outside };
        let (mut flooded, mut queue) = (vec![false; outside + 1], vec![from]);
        while let Some(here) = queue.pop() {
            if std::mem::replace(&mut flooded[here], true) {
                continue;
            }
            for y in 0..=rows {
                for x in 0..=columns {
                    let left = (0, cell(x.wrapping_sub(1), y), y < rows);
                    let below = (1, cell(x, y.wrapping_sub(1)), x < columns);
                    for (side, beside, is_in) in [left, below] {
                        let ends = [cell(x, y), beside];
                        if is_in && ends.contains(&here) && !self.wall(x, y, side) {
                            queue.extend(ends);
                        }
                    }
                }
            }
        }
        flooded[to]
    }

    fn middle(&self, cell: usize) -> P {
        let at = [cell % self.cells[0], cell / self.cells[0]];
        [0, 1].map(|k| Self::AT[k] + (at[k] as f64 + 0.5) * self.cell_m)
    }
}

#[test]
fn no_route_leads_through_walls_that_meet_flush_and_every_open_room_is_reached() {
    let planner = Planner::new(&paper());
    let (mut open, mut closed) = (0, 0);
    for seed in 0..640 {
        let plan = FloorPlan::draw(seed);
        let outlines = plan.outlines();
        let obstacles = known(&outlines);
        let last = plan.cells[0] * plan.cells[1] - 1;
        for (from, to) in [(0, last), (last, 0), (0, last / 2)] {
            let start = plan.middle(from);
            let route = planner.route(&query(&obstacles, start, plan.middle(to)));
            assert_eq!(route.is_some(), plan.is_reachable(from, to), "plan {seed}, from {from} to {to}");
            let Some(route) = route else {
                closed += 1;
                continue;
            };
            open += 1;
            for (a, b) in route.legs(vector(start)) {
                let points = (0..=200).map(|step| a.lerp(b, step as f32 / 200.0));
                let gap = |point| outlines.iter().map(move |outline| outline.distance_to(point));
                let nearest = points.flat_map(gap).fold(f32::INFINITY, f32::min);
                assert!(f64::from(nearest) >= OFFSET_M - 5e-3, "plan {seed}: {nearest} m from a wall");
            }
        }
    }
    assert!(open > 400 && closed > 400, "{open} open, {closed} closed");
}

#[test]
fn a_detour_round_radiation_is_made_where_it_is_cheaper_and_no_further() {
    let cost = |price: &str| {
        let scenario = paper_with(&[("exposure_price_m: 2.0", &format!("exposure_price_m: {price}"))]);
        let zone = RadiationZone { center: Vector::new(40.0, 30.0), radius: 4.0 };
        let from = Vector::new(30.0, 30.0);
        let query = Query {
            from,
            to: Vector::new(50.0, 30.0),
            aerial: false,
            radius: 0.4,
            speed: 2.0,
            obstacles: &ObstacleMap::default(),
            in_the_way: &[],
            zones: &[(0, zone)],
        };
        let route = Planner::new(&scenario).route(&query).unwrap();
        (route.length(from), route.length_inside(from, &zone))
    };
    let (straight, inside) = cost("0.0");
    assert!((straight - 20.0).abs() < 1e-3 && (inside - 8.0).abs() < 1e-3);
    // Round the disc: two tangents of sqrt(10^2 - 4^2) m and an arc of 4 (pi - 2 acos(4 / 10)) m, 21.62 m in
    // all.
    let (round, inside) = cost("2.0");
    assert!((21.6..21.95).contains(&round) && inside == 0.0, "{round} m, {inside} m inside");
    let (cheap, inside) = cost("0.3");
    assert!(
        (cheap - 20.0).abs() < 1e-3 && inside > 0.0,
        "4 s inside for 1.2 m are cheaper than 1.6 m round it"
    );
}

/// A thread keeps what it made for a route: another zone of the same number must not be taken for the first.
#[test]
fn what_a_thread_has_planned_before_changes_no_route() {
    let length = |radius: f32| {
        let zone = RadiationZone { center: Vector::new(40.0, 30.0), radius };
        let nothing = ObstacleMap::default();
        let query = query(&nothing, [30.0, 30.0], [50.0, 30.0]);
        let query = Query { zones: &[(0, zone)], speed: 2.0, ..query };
        Planner::new(&paper()).route(&query).unwrap().length(query.from)
    };
    let radii = [4.0, 2.0, 3.0, 4.0];
    let one_after_the_other = radii.map(length);
    let each_by_itself = radii.map(|radius| std::thread::spawn(move || length(radius)).join().unwrap());
    assert_eq!(one_after_the_other.map(f32::to_bits), each_by_itself.map(f32::to_bits));
    assert!(
        one_after_the_other[0] > one_after_the_other[2] && one_after_the_other[2] > one_after_the_other[1]
    );
}

#[test]
fn observers_fly_over_debris() {
    let scenario = paper();
    let wall = DebrisFile {
        shape: DebrisShape::Box(1.0, 60.0),
        at: [45.0, 35.0],
        rotation_deg: 0.0,
        movable: None,
        name: None,
    }
    .outline();
    let obstacles = known(&[wall]);
    let length = |aerial| {
        let query = Query {
            from: Vector::new(30.0, 30.0),
            to: Vector::new(60.0, 30.0),
            aerial,
            radius: 0.4,
            speed: 1.5,
            obstacles: &obstacles,
            in_the_way: &[],
            zones: &[],
        };
        Planner::new(&scenario).route(&query).unwrap().length(query.from)
    };
    assert!((length(true) - 30.0).abs() < 1e-3 && length(false) > 55.0);
}

/// A wall whose only gap, 2 m wide, is closed by a crate; the way round the wall is long.
const CLOSED_GAP: &str = r#"(
    name: "closed-gap", description: "", duration_s: 60.0, dt_s: 0.02, arena_m: (30.0, 30.0),
    team: [(role: "robot", count: 1, center: (10.0, 5.0), width_m: 0.0)],
    errands: [(robot: 0, to: [(20.0, 5.0)])],
    debris: [
        (shape: Box(0.4, 4.0), at: (15.0, 2.0)),
        (shape: Box(0.4, 19.0), at: (15.0, 15.5)),
        (shape: Box(0.8, 2.0), at: (15.0, 5.0), movable: (mass_kg: 30.0, friction: 0.5)),
    ],
)"#;

#[test]
fn a_way_that_a_pushed_piece_leaves_free_is_taken_once_it_is_noticed_and_others_do_not_count() {
    let scenario = Scenario::parse(CLOSED_GAP, "closed_gap.ron".as_ref()).unwrap();
    let length_after_move = |by: [f32; 2]| {
        let model = Model::compile(&scenario, &Layout::sample(&scenario, 1).unwrap(), 1);
        let world = World::build(&model);
        let mut known = Belief::nothing(&Inflation { radii: vec![0.4], clearance: 0.15 });
        (0..3).for_each(|piece| {
            known.hear(&lies(piece, &world.debris[piece].outline(), 0));
        });
        let mut navigator = Navigator::new(1);
        let robot = world.robots[0].id;
        navigator.set_goal(robot, Some(Goal { point: Vector::new(20.0, 5.0), within: 0.15 }));
        let mut length = |known: &Belief| {
            let (team, step) = (&[KnownRobot::new(&model.robots[0])], 1);
            let outlook =
                Outlook { model: &model, team, step, belief_of: |_| known, speed_of: |_: &KnownRobot| 2.0 };
            navigator.plan(&outlook, Executor::Serial);
            navigator.traveller(robot).route().unwrap().length(world.robots[0].position)
        };
        let before = length(&known);
        let mut moved = world.debris[2].outline();
        moved.pose.translation += Vector::from(by);
        assert!((length(&known) - before).abs() < 1e-6, "nobody has noticed yet");
        known.hear(&lies(2, &moved, 1));
        (before, length(&known))
    };
    let (before, after) = length_after_move([5.0, 8.0]);
    assert!(before > 40.0 && (after - 10.0).abs() < 1e-3, "{before} m, then {after} m");
    let (before, after) = length_after_move([0.1, 0.0]);
    assert!((after - before).abs() < 1e-6, "still closed: {after} m");
}

/// A room of two walls that meet flush in a corner. There is no door.
const SEALED: &str = r#"(
    name: "sealed", duration_s: 100.0, dt_s: 0.02, arena_m: (40.0, 40.0),
    roles: [(name: "carrier", observing_m: 6.0)],
    team: [(role: "carrier", count: 4, center: (10.0, 3.0), width_m: 6.0)],
    tasks: [(name: "north", difficulty: 1, center: (31.0, 33.5), size_m: (1.0, 1.0), grid: (2, 2),
        rest: (5.0, 8.0))],
    walls: [((22.0, 26.9), (22.0, 40.0)), ((21.9, 27.0), (40.0, 27.0))],
)"#;

/// Walls that meet flush, with ways round all of them.
const WITH_CORNERS: &str = r#"(
    name: "with-corners", duration_s: 60.0, dt_s: 0.02, arena_m: (12.0, 12.0),
    roles: [(name: "carrier", radius_m: 0.25, resources: 4, observing_m: 6.0, sensing_m: 100.0)],
    team: [(role: "carrier", count: 2, center: (1.2, 0.8), width_m: 1.2)],
    tasks: [(name: "north", difficulty: 1, center: (10.0, 10.5), size_m: (2.0, 1.0), grid: (3, 2),
        rest: (11.0, 1.0))],
    walls: [((4.0, 1.9), (4.0, 10.1)), ((1.9, 2.0), (4.1, 2.0)), ((0.0, 6.0), (4.1, 6.0))],
)"#;

#[test]
fn a_room_whose_walls_meet_flush_is_sealed_and_ways_round_such_walls_are_found() {
    let sealed = Scenario::parse(SEALED, "sealed.ron".as_ref()).unwrap();
    let error = Layout::sample(&sealed, 1).unwrap_err().to_string();
    assert!(error.contains("no way from home to task \"north\""), "{error}");
    let open = Scenario::parse(WITH_CORNERS, "with-corners.ron".as_ref()).unwrap();
    assert_eq!(trial(&open, "RNE", 1).tasks[0].totals.rescued, 6);
}
