//! Contacts as the invariants see them.

use scenario::Scenario;
use usar_sim::record::Status;
use usar_sim::simulation::Simulation;

use crate::{scenario, trial};

/// A small robot drives against a large standing robot. A third robot is between the two in x, but far away
/// in y.
const UNEQUAL: &str = r#"duration_s: 20.0, arena_m: (20.0, 14.0),
    roles: [(name: "large", radius_m: 1.0), (name: "small", radius_m: 0.2)],
    mission: (energy_threshold: 30.0, hp_threshold: 30.0, rest_reserve: 1.5, rest_s: 30.0, loading_s: 2.0,
              reach_m: 1.2,
        area_margin_m: 4.0, blind_speed_loss: 0.3, health_floor: 0.5),
    conflicts: (resolver: None),
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

/// A scenario of the repository with these fields set to these values.
fn with(path: &str, fields: &[(&str, &str)]) -> Scenario {
    let path = format!("{}/../../scenarios/{path}", env!("CARGO_MANIFEST_DIR"));
    let mut file = (*Scenario::load(path.as_ref()).unwrap().0).clone();
    fields.iter().for_each(|(field, value)| file.set(field, value).unwrap());
    file.try_into().unwrap()
}

#[test]
fn the_engine_may_brake_robots_just_before_they_touch() {
    let fields = ["roles.carrier.speed_mps", "roles.supplier.speed_mps", "roles.observer.speed_mps"];
    let mut fields = fields.map(|field| (field, "20.0")).to_vec();
    fields.push(("duration_s", "100.0"));
    fields.extend([("debris[4].movable", "None"), ("debris[11].movable", "None")]);
    let scenario = with("paper.ron", &fields);
    let mut rne = policies::standard().open("RNE").unwrap();
    for seed in [1, 2, 3] {
        let record = Simulation::new(&scenario, seed).unwrap().checked().run(&mut *rne, |_, _, _| {});
        assert_eq!(record.status, Status::Completed, "seed {seed}");
    }
}

#[test]
fn a_thin_piece_that_a_fast_robot_pushes_does_not_enter_the_next_robot() {
    for [heavy, light] in [["5.0", "2.25"], ["5.0", "5.0"], ["6.0", "2.25"], ["6.0", "6.0"]] {
        for resolver in ["Rotation", "None"] {
            let fields = [
                ("roles.heavy.speed_mps", heavy),
                ("roles.light.speed_mps", light),
                ("conflicts.resolver", resolver),
                ("duration_s", "20.0"),
            ];
            let record = trial(&with("minimal/pushed.ron", &fields), |_, _, _| {});
            let is_sound = !matches!(record.status, Status::Failed(_));
            assert!(is_sound, "{heavy} m/s, {light} m/s, {resolver}: {:?}", record.status);
            assert!(record.overlaps.unwrap().contacts > 0, "{heavy} m/s, {light} m/s, {resolver}");
        }
    }
}
