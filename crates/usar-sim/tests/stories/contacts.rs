//! Contacts as the invariants see them.

use usar_sim::record::{Status, TrialRecord};
use usar_sim::scenario::Scenario;

use crate::{scenario, trial};

/// A small robot drives against a large one that stands. A third one stands between their places in x, far off in y.
const UNEQUAL: &str = r#"duration_s: 20.0, arena_m: (20.0, 14.0),
    roles: [(name: "large", radius_m: 1.0), (name: "small", radius_m: 0.2)],
    mission: (energy_threshold: 30.0, hp_threshold: 30.0, rest_reserve: 1.5, rest_s: 30.0, loading_s: 2.0, reach_m: 1.2,
        area_margin_m: 4.0, blind_speed_loss: 0.3, health_floor: 0.5),
    conflicts: (margin_m: 0.15, horizon_s: 0.8, deadlock_steps: 10, resolver: None),
    team: [
        (role: "small", count: 1, center: (4.0, 10.0), width_m: 0.0),
        (role: "small", count: 1, center: (9.9, 3.0), width_m: 0.0),
        (role: "large", count: 1, center: (10.0, 10.0), width_m: 0.0),
    ],
    errands: [(robot: 0, to: [(16.0, 10.0)])]"#;

#[test]
fn a_contact_of_unequal_radii_is_seen_with_a_robot_between_them() {
    let record = trial(&scenario(UNEQUAL), |_, _, _| {});
    assert!(!matches!(record.status, Status::Failed(_)), "{:?}", record.status);
    let overlaps = record.overlaps.unwrap();
    assert!(overlaps.contacts > 100 && overlaps.deepest_m < 0.05, "{overlaps}");
}

/// Two robots head-on at this speed, without right of way.
fn head_on(speed: f64, acceleration: f64, dt: f64) -> TrialRecord {
    let text = format!(
        r#"(name: "head_on", duration_s: 20.0, dt_s: {dt:?}, arena_m: (60.0, 10.0),
        roles: [(name: "fast", radius_m: 1.0, speed_mps: {speed:?}, acceleration_mps2: {acceleration:?})],
        conflicts: (margin_m: 0.0, horizon_s: 0.0, deadlock_steps: 10, resolver: None),
        team: [
            (role: "fast", count: 1, center: (5.0, 5.0), width_m: 0.0),
            (role: "fast", count: 1, center: (55.0, 5.3), width_m: 0.0),
        ],
        errands: [(robot: 0, to: [(55.0, 5.0)]), (robot: 1, to: [(5.0, 5.0)])])"#
    );
    trial(&Scenario::parse(&text, "head_on.ron".as_ref()).unwrap(), |_, _, _| {})
}

#[test]
fn the_engine_may_brake_robots_just_before_they_touch() {
    for (speed, acceleration, dt) in
        [(2.0, 4.0, 0.05), (20.0, 10.0, 0.05), (20.0, 20.0, 0.02), (10.0, 4.0, 0.01)]
    {
        let record = head_on(speed, acceleration, dt);
        assert!(!matches!(record.status, Status::Failed(_)), "{speed} m/s, {dt} s: {:?}", record.status);
        assert!(record.overlaps.unwrap().contacts > 0, "{speed} m/s, {dt} s: they meet");
    }
}

/// `scenarios/minimal/pushed.ron` at these speeds.
fn pushed([heavy, light]: [f64; 2]) -> TrialRecord {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/minimal/pushed.ron");
    let mut file = (*Scenario::load(path.as_ref()).unwrap().0).clone();
    file.set("roles.heavy.speed_mps", &format!("{heavy:?}")).unwrap();
    file.set("roles.light.speed_mps", &format!("{light:?}")).unwrap();
    trial(&file.try_into().unwrap(), |_, _, _| {})
}

#[test]
fn a_thin_piece_that_a_fast_robot_pushes_does_not_enter_the_next_robot() {
    for speeds in [[5.0, 2.25], [5.0, 5.0], [10.0, 2.25], [20.0, 20.0]] {
        let record = pushed(speeds);
        let overlaps = record.overlaps.unwrap();
        assert_eq!(record.status, Status::ErrandsOver, "{speeds:?} m/s: {overlaps}");
    }
}
