//! Each robot takes routes that are wide enough for it.

use usar_sim::model::Layout;
use usar_sim::record::Status;
use usar_sim::simulation::Simulation;

use crate::{scenario, trial};

/// A wall with a gap of 1 m and, if `detour` is true, a wide gap far away. The first robot is small, the
/// second one large.
fn doorway(detour: bool) -> String {
    let [middle, height] = if detour { [9.75, 8.5] } else { [12.75, 14.5] };
    format!(
        r#"duration_s: 120.0, arena_m: (20.0, 20.0),
        roles: [(name: "small", radius_m: 0.2), (name: "large", radius_m: 0.6)],
        team: [
            (role: "small", count: 1, center: (5.0, 5.0), width_m: 0.0),
            (role: "large", count: 1, center: (5.0, 7.0), width_m: 0.0),
        ],
        errands: [(robot: 0, to: [(15.0, 5.0)]), (robot: 1, to: [(15.0, 7.0)])],
        debris: [(shape: Box(0.4, 4.5), at: (10.0, 2.25)),
                 (shape: Box(0.4, {height:?}), at: (10.0, {middle:?}))]"#
    )
}

#[test]
fn a_small_robot_passes_the_small_gap_and_a_large_one_takes_the_detour() {
    let record = trial(&scenario(&doorway(true)), |_, _, _| {});
    assert_eq!((record.status, record.counts.errands_done), (Status::Finished, 2));
    let [small, large] = [0, 1].map(|robot: usize| record.robots[robot].distance_m);
    assert!(small < 12.0 && large > 18.0, "{small} m, {large} m");
}

#[test]
fn a_small_robot_passes_the_small_gap_and_a_large_one_gives_up() {
    let record = trial(&scenario(&doorway(false)), |_, _, _| {});
    assert_eq!((record.status, record.counts.errands_done), (Status::Finished, 1));
    assert_eq!(record.counts.unreachable, 1);
    assert!(record.robots[0].distance_m < 12.0 && record.robots[1].distance_m < 12.0);
}

/// What robots cannot reach, each by its field.
fn out_of_reach(fields: &str) -> Vec<String> {
    let scenario = scenario(fields);
    let problems = Layout::sample(&scenario, 1).unwrap().out_of_reach(&scenario);
    problems.into_iter().map(|problem| problem.field).collect()
}

#[test]
fn places_of_errands_without_a_way_that_is_wide_enough_are_told() {
    assert!(out_of_reach(&doorway(true)).is_empty());
    assert_eq!(out_of_reach(&doorway(false)), ["errands[1].to[0]"]);
    let lane = |y: f64| {
        format!(
            r#"duration_s: 100.0, arena_m: (12.0, 4.0), roles: [(name: "robot", radius_m: 0.25)],
            team: [(role: "robot", count: 1, center: (2.0, 2.0), width_m: 0.0)],
            errands: [(robot: 0, to: [(4.0, 2.0), (9.0, 2.0)])],
            walls: [(from: (6.0, 1.5), to: (12.0, 1.5), thickness_m: 0.2),
                    (from: (6.0, {y:?}), to: (12.0, {y:?}), thickness_m: 0.2)]"#
        )
    };
    assert_eq!(out_of_reach(&lane(2.4)), ["errands[0].to[1]"], "0.7 m; with clearance the robot takes 0.8 m");
    assert!(out_of_reach(&lane(2.6)).is_empty());
}

#[test]
fn rescuees_that_are_all_inside_debris_are_told() {
    let under = |size_m: f64| {
        format!(
            r#"duration_s: 100.0, arena_m: (30.0, 20.0), roles: [(name: "robot", capacity: 2, resources: 5)],
            team: [(role: "robot", count: 2, center: (4.0, 4.0), width_m: 3.0)],
            tasks: [(name: "far", difficulty: 1, center: (20.0, 10.0), size_m: (2.0, 2.0), grid: (2, 2),
                     rest: (5.0, 15.0))],
            debris: [(shape: Box({size_m:?}, 7.0), at: (20.0, 10.0),
                      movable: (mass_kg: 500.0, friction: 0.5))]"#
        )
    };
    assert_eq!(out_of_reach(&under(7.0)), ["tasks[0].grid"]);
    assert!(out_of_reach(&under(2.0)).is_empty(), "robots reach them from the sides");
}

#[test]
fn a_snapshot_goes_on_with_the_same_ways_for_each_radius() {
    let scenario = scenario(&doorway(true));
    let mut policy = policies::standard().open("RNE").unwrap();
    let mut whole = Simulation::new(&scenario, 1).unwrap();
    (0..150).for_each(|_| assert_eq!(whole.step(&mut *policy), None));
    let restored = Simulation::restore(&scenario, &whole.snapshot("RNE")).unwrap();
    let mut rest = |trial: Simulation| trial.run(&mut *policy, |_, _, _| {}).state_hash;
    assert_eq!(rest(restored), rest(whole));
}

#[test]
fn a_mission_whose_small_robots_live_behind_a_small_gap_is_no_layout_without_passage() {
    let mission = |small: &str, large: &str| {
        let text = format!(
            r#"duration_s: 10.0, arena_m: (40.0, 20.0),
            roles: [(name: "small", radius_m: 0.2), (name: "large", radius_m: 0.6)],
            team: [
                (role: "small", count: 1, center: {small}, width_m: 0.0),
                (role: "large", count: 1, center: {large}, width_m: 0.0),
            ],
            tasks: [(name: "task", difficulty: 1, center: (30.0, 10.0), size_m: (1.0, 1.0), grid: (1, 1),
                     rest: (30.0, 5.0))],
            debris: [(shape: Box(0.4, 4.5), at: (10.0, 2.25)), (shape: Box(0.4, 14.5), at: (10.0, 12.75))]"#
        );
        Simulation::new(&scenario(&text), 1).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(mission("(5.0, 5.0)", "(20.0, 5.0)"), Ok(()));
    let error = mission("(20.0, 5.0)", "(5.0, 5.0)").unwrap_err();
    assert!(error.contains("radius 0.6 m"), "{error}");
}
