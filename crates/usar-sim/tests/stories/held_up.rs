//! No robot holds up the mission.

use parry2d::math::Vector;
use usar_sim::event::{CutOffCause, Event};
use usar_sim::record::{Status, TrialRecord};

use crate::{scenario, trial};

/// The gate through which robot 0 went out closes behind it. In the other door stands a keeper that has
/// nothing to do and, without a rule of right of way, makes no room: robot 0 pushes against it for good.
const KEEPER: &str = r#"duration_s: 300.0, arena_m: (40.0, 40.0), conflicts: (resolver: None),
    mission: (ends: AtDuration),
    roles: [(name: "runner", observing_m: 1.0, resources: 10), (name: "seer", observing_m: 3.0),
            (name: "keeper", mass_kg: 500.0)],
    team: [
        (role: "runner", count: 1, center: (6.0, 5.0), width_m: 0.0),
        (role: "seer", count: 1, center: (30.0, 20.0), width_m: 0.0),
        (role: "keeper", count: 1, center: (20.0, 12.0), width_m: 0.0),
    ],
    tasks: [
        (name: "far", difficulty: 2, center: (15.0, 30.0), size_m: (20.0, 0.0), grid: (3, 1),
         rest: (36.0, 36.0),
         quota: {"runner": 1, "seer": 0, "keeper": 0}),
        (name: "near", difficulty: 1, center: (32.0, 30.0), size_m: (2.0, 1.0), grid: (5, 2),
         rest: (36.0, 20.0),
         quota: {"runner": 0, "seer": 1, "keeper": 0}),
    ],
    walls: [(from: (0.0, 12.0), to: (40.0, 12.0), thickness_m: 0.3, doors: [
        (at_m: 6.0, width_m: 3.0, name: "gate"), (at_m: 20.0, width_m: 1.3)])],
    timeline: [(at_s: 25, event: Closes("gate"))]"#;

#[test]
fn a_robot_that_comes_no_nearer_to_its_home_is_cut_off_and_the_others_go_on() {
    let record = trial(&scenario(KEEPER), |_, _, _| {});
    assert_eq!(record.status, Status::Completed);
    let [cut_off] = record.cut_off[..] else { panic!("{:?}", record.cut_off) };
    assert_eq!((cut_off.robot, cut_off.place), (0, [6.0, 5.0]));
    assert_eq!(cut_off.cause, CutOffCause::NoProgress);
    assert!((70.0..160.0).contains(&cut_off.first_s), "{} s", cut_off.first_s);
    assert!(record.completed_rounds >= 3, "{} rounds", record.completed_rounds);
    assert_eq!(record.counts.unreachable, 0);
}

#[test]
fn the_time_until_a_robot_is_cut_off_is_a_field_of_the_scenario() {
    let with = |seconds: f64| {
        let mut file = (*scenario(KEEPER)).clone();
        file.set("mission.cut_off_s", &format!("{seconds:?}")).unwrap();
        trial(&file.try_into().unwrap(), |_, _, _| {})
    };
    let first_s = |seconds| with(seconds).cut_off[0].first_s;
    assert!((first_s(60.0) - first_s(20.0) - 40.0).abs() < 0.1);
    let never = with(10_000.0);
    assert_eq!((never.cut_off.len(), never.completed_rounds), (0, 0), "the first round never ends");
}

/// Robot 0 cannot get to its place: a robot that rests stands in the only door.
#[test]
fn an_errand_is_given_up_by_a_robot_that_comes_no_nearer() {
    let keeper = r#"duration_s: 300.0, arena_m: (20.0, 10.0), conflicts: (resolver: None),
        roles: [(name: "runner"), (name: "keeper", mass_kg: 500.0)],
        team: [
            (role: "runner", count: 1, center: (3.0, 5.0), width_m: 0.0),
            (role: "keeper", count: 1, center: (10.0, 5.0), width_m: 0.0),
        ],
        errands: [(robot: 0, to: [(17.0, 5.0), (3.0, 5.0)])],
        walls: [(from: (10.0, 0.0), to: (10.0, 10.0), thickness_m: 0.3,
            doors: [(at_m: 5.0, width_m: 1.3)])]"#;
    let record = trial(&scenario(keeper), |_, _, _| {});
    let counts = record.counts;
    assert_eq!((record.status, record.stalled), (Status::Finished, 0), "it went on to its second place");
    assert_eq!((counts.errands_done, counts.unreachable), (1, 0), "there is a way, but it was not free");
    let [cut_off] = record.cut_off[..] else { panic!("{:?}", record.cut_off) };
    assert_eq!((cut_off.place, cut_off.cause), ([17.0, 5.0], CutOffCause::NoProgress));
    assert!((60.0..80.0).contains(&cut_off.first_s), "{} s", cut_off.first_s);
}

/// So many robots, in rows of eight, change rooms through one door of a single lane.
fn crowd(robots: u32, fields: &str) -> TrialRecord {
    let place = |robot: u32, x: f64| {
        let [column, row] = [robot % 8, robot / 8].map(f64::from);
        format!("({:.1}, {:.1})", x + 0.8 * column, 1.0 + 0.8 * row)
    };
    let all = |one: &dyn Fn(u32) -> String| (0..robots).map(one).collect::<Vec<_>>().join(", ");
    let stand = |robot| format!(r#"(role: "robot", count: 1, center: {}, width_m: 0.0)"#, place(robot, 1.0));
    let go = |robot| format!("(robot: {robot}, to: [{}])", place(robot, 9.4));
    trial(
        &scenario(&format!(
            "arena_m: (16.0, 12.0), team: [{}], errands: [{}], {fields},
            walls: [(from: (8.0, 0.0), to: (8.0, 12.0), thickness_m: 0.2,
                     doors: [(at_m: 6.0, width_m: 1.0)])]",
            all(&stand),
            all(&go)
        )),
        |_, _, _| {},
    )
}

#[test]
fn a_robot_in_a_queue_that_gets_on_gives_up_nothing() {
    let record = crowd(
        64,
        r#"duration_s: 400.0, mission: (cut_off_s: 15.0),
        roles: [(name: "robot", radius_m: 0.25, speed_mps: 1.0, sensing_m: 100.0)]"#,
    );
    let longest = record.robots.iter().map(|robot| robot.longest_stall_s).fold(0.0, f64::max);
    assert!(longest > 20.0, "robots wait for longer than `cut_off_s`: {longest} s");
    assert_eq!((record.status, record.counts.errands_done), (Status::Finished, 64));
    assert_eq!((record.counts.unreachable, record.cut_off.len()), (0, 0));
}

#[test]
fn slow_robots_have_in_proportion_longer() {
    let record = crowd(
        8,
        r#"duration_s: 1500.0, mission: (cut_off_s: 10.0),
        roles: [(name: "robot", radius_m: 0.25, speed_mps: 0.05, sensing_m: 100.0)]"#,
    );
    assert_eq!((record.status, record.counts.errands_done), (Status::Finished, 8));
}

/// The door to all places opens late.
#[test]
fn errands_wait_for_a_way_that_an_event_may_open() {
    let gate = |opens_s: u32| {
        let fields = format!(
            r#"duration_s: 200.0, arena_m: (20.0, 10.0), roles: [(name: "robot", sensing_m: 3.0)],
            team: [(role: "robot", count: 1, center: (3.0, 5.0), width_m: 0.0)],
            errands: [(robot: 0, to: [(17.0, 5.0)])],
            walls: [(from: (10.0, 0.0), to: (10.0, 10.0), thickness_m: 0.4,
                     doors: [(at_m: 5.0, width_m: 1.4, name: "gate", closed: true)])],
            timeline: [(at_s: {opens_s}, event: Opens("gate"))]"#
        );
        trial(&scenario(&fields), |_, _, _| {})
    };
    let opened = gate(100);
    assert_eq!((opened.status, opened.counts.errands_done), (Status::Finished, 1));
    assert!((104.0..115.0).contains(&opened.time_s), "{} s", opened.time_s);
    let never = gate(500);
    assert_eq!((never.status, never.counts.unreachable), (Status::Finished, 1));
    assert!(never.time_s < 20.0, "an event after the end is not waited for: {} s", never.time_s);
}

/// A robot senses nothing from afar. A box is on its way.
#[test]
fn a_robot_notices_what_it_touches() {
    let fields = r#"duration_s: 120.0, arena_m: (20.0, 10.0), roles: [(name: "blind", sensing_m: 0.0)],
        team: [(role: "blind", count: 1, center: (2.0, 5.0), width_m: 0.0)],
        errands: [(robot: 0, to: [(18.0, 5.0)])],
        debris: [(shape: Box(1.0, 3.0), at: (10.0, 5.0))]"#;
    let record = trial(&scenario(fields), |_, _, _| {});
    assert_eq!((record.status, record.counts.errands_done), (Status::Finished, 1));
}

/// A robot needs rest soon. Debris covers the rest places of the tasks with a mark.
fn tired(covered: [bool; 2]) -> String {
    let disc = |at: &str| format!("(shape: Disc(1.5), at: {at})");
    let places = ["(10.0, 20.0)", "(30.0, 20.0)"].into_iter().zip(covered);
    let debris: Vec<String> = places.filter(|(_, covered)| *covered).map(|(at, _)| disc(at)).collect();
    format!(
        r#"duration_s: 400.0, arena_m: (40.0, 40.0), roles: [(name: "carrier", observing_m: 3.0)],
        team: [(role: "carrier", count: 1, center: (20.0, 5.0), width_m: 0.0,
                levels: (energy: 33.0, hp: 100.0))],
        tasks: [
            (name: "left", difficulty: 2, center: (10.0, 32.0), size_m: (2.0, 1.0), grid: (5, 2),
             rest: (10.0, 20.0)),
            (name: "right", difficulty: 1, center: (30.0, 32.0), size_m: (2.0, 1.0), grid: (5, 2),
             rest: (30.0, 20.0)),
        ],
        debris: [{}]"#,
        debris.join(", ")
    )
}

#[test]
fn a_robot_rests_at_its_own_slot_or_at_another_rest_place() {
    for (covered, rests_at) in [([false, false], [10.0, 20.0]), ([true, false], [30.0, 20.0])] {
        let mut places: Vec<Vector> = Vec::new();
        let record = trial(&scenario(&tired(covered)), |_, events, world| {
            let starts = |event: &&Event| matches!(event, Event::RestStarted { .. });
            places.extend(events.iter().filter(starts).map(|_| world.robots[0].position));
        });
        assert_eq!(record.status, Status::Completed);
        assert!(!places.is_empty());
        assert!(places.iter().all(|place| (*place - Vector::from(rests_at)).length() <= 0.4), "{places:?}");
        assert_eq!(record.counts.unreachable > 0, covered[0]);
    }
}

#[test]
fn a_robot_that_can_rest_nowhere_goes_home_and_does_not_give_up_again_and_again() {
    let record = trial(&scenario(&tired([true, true])), |_, _, _| {});
    assert_eq!(
        (record.status, record.stalled),
        (Status::Stalled, 0),
        "it is at home, where it can do nothing"
    );
    assert!(record.time_s < 200.0, "{} s", record.time_s);
    assert_eq!(record.counts.unreachable, 2, "each rest place once");
    assert_eq!(record.rounds.iter().map(|round| round.round).max(), Some(1));
    assert!(record.robots[0].final_energy > 10.0);
}

/// A robot plans its way east from `first`, through a gap of 1 m between two pieces of debris at x = 10, and
/// back.
/// The gap has room for its body, but not for a route planned by one that sees the debris.
fn through_a_gap(first: f64) -> TrialRecord {
    let gap = format!(
        r#"duration_s: 120.0, arena_m: (20.0, 10.0),
        roles: [(name: "runner")],
        team: [(role: "runner", count: 1, center: (3.0, 5.0), width_m: 0.0)],
        errands: [(robot: 0, to: [({first:?}, 5.0), (16.0, 5.0), (3.0, 5.0)])],
        debris: [(shape: Box(0.3, 4.5), at: (10.0, 2.25)), (shape: Box(0.3, 4.5), at: (10.0, 7.75))]"#
    );
    trial(&scenario(&gap), |_, _, _| {})
}

#[test]
fn a_robot_comes_back_out_of_where_it_came_in_although_no_route_leads_there() {
    let seen_late = through_a_gap(4.0).counts;
    assert_eq!((seen_late.errands_done, seen_late.unreachable), (3, 0));
    let seen_in_time = through_a_gap(8.0).counts;
    assert_eq!((seen_in_time.errands_done, seen_in_time.unreachable), (2, 1), "it never went in");
}
