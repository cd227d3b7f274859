//! No robot holds up the mission.

use parry2d::math::Vector;
use usar_sim::event::{CutOffCause, Event};
use usar_sim::record::Status;

use crate::{scenario, trial};

/// Robot 0 senses no debris. On its way home it meets a wall that no robot knows, and pushes against it for
/// good.
const WALL: &str = r#"duration_s: 300.0, arena_m: (40.0, 40.0),
    roles: [(name: "blind", sensing_m: 0.0, observing_m: 1.0, resources: 10),
            (name: "seer", observing_m: 3.0)],
    team: [
        (role: "blind", count: 1, center: (6.0, 5.0), width_m: 0.0),
        (role: "seer", count: 1, center: (30.0, 5.0), width_m: 0.0),
    ],
    tasks: [
        (name: "far", difficulty: 2, center: (15.0, 30.0), size_m: (20.0, 0.0), grid: (3, 1),
         rest: (36.0, 36.0),
         quota: {"blind": 1, "seer": 0}),
        (name: "near", difficulty: 1, center: (32.0, 20.0), size_m: (2.0, 1.0), grid: (5, 2),
         rest: (36.0, 10.0),
         quota: {"blind": 0, "seer": 1}),
    ],
    debris: [(shape: Box(6.0, 0.5), at: (6.0, 17.0))]"#;

#[test]
fn a_robot_that_comes_no_nearer_to_its_home_is_cut_off_and_the_others_go_on() {
    let record = trial(&scenario(WALL), |_, _, _| {});
    assert_eq!(record.status, Status::Completed);
    let [cut_off] = record.cut_off[..] else { panic!("{:?}", record.cut_off) };
    assert_eq!((cut_off.robot, cut_off.times, cut_off.place), (0, 1, [6.0, 5.0]));
    assert_eq!(cut_off.cause, CutOffCause::NoProgress);
    let stall = record.robots[0].longest_stall_s;
    assert!((70.0..160.0).contains(&cut_off.first_s) && stall > 150.0, "{} s, {stall} s", cut_off.first_s);
    assert!(record.completed_rounds >= 3, "{} rounds", record.completed_rounds);
    assert_eq!(record.counts.unreachable, 0);
}

#[test]
fn the_time_until_a_robot_is_cut_off_is_a_field_of_the_scenario() {
    let with = |seconds: f64| {
        let mut file = (*scenario(WALL)).clone();
        file.set("mission.cut_off_s", &format!("{seconds:?}")).unwrap();
        trial(&file.try_into().unwrap(), |_, _, _| {})
    };
    let first_s = |seconds| with(seconds).cut_off[0].first_s;
    assert!((first_s(60.0) - first_s(20.0) - 40.0).abs() < 0.1);
    let never = with(10_000.0);
    assert_eq!((never.cut_off.len(), never.completed_rounds), (0, 0), "the first round never ends");
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
    assert_eq!(record.status, Status::Completed);
    assert_eq!(record.counts.unreachable, 2, "each rest place once");
    assert_eq!(record.rounds.iter().map(|round| round.round).max(), Some(1));
    assert!(record.robots[0].final_energy > 10.0);
}
