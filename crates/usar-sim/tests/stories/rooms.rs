//! Rooms whose walls meet.

use usar_sim::simulation::Simulation;

use crate::scenario;

/// A mission in rooms: two long walls, each in two pieces round a door, and three short walls that meet them.
const ROOMS: &str = r#"duration_s: 60.0, arena_m: (53.449, 100.935),
    roles: [(name: "carrier", observing_m: 2.75, resources: 4, sensing_m: 5.28)],
    team: [(role: "carrier", count: 4, center: (25.256, 25.126), width_m: 3.3)],
    tasks: [
        (name: "hard", difficulty: 2, center: (44.197, 44.331), size_m: (3.182, 1.963), grid: (9, 3),
         rest: (13.59, 21.556)),
        (name: "easy", difficulty: 1, center: (45.107, 40.628), size_m: (2.943, 3.495), grid: (10, 8),
         rest: (39.666, 60.826)),
    ],
    debris: [
        (shape: Box(1.423, 0.355), at: (35.871, 73.469), rotation_deg: -138.6,
         movable: (mass_kg: 95.6, friction: 0.86)),
        (shape: Box(0.312, 20.699), at: (17.816, 23.295)), (shape: Box(0.312, 20.008), at: (17.816, 43.649)),
        (shape: Box(0.312, 23.854), at: (35.632, 55.363)), (shape: Box(0.312, 27.757), at: (35.632, 81.168)),
        (shape: Box(6.918, 0.312), at: (14.357, 33.645)), (shape: Box(9.190, 0.312), at: (31.037, 33.645)),
        (shape: Box(1.347, 0.312), at: (34.959, 67.290)),
    ]"#;

#[test]
fn walls_that_meet_do_not_end_a_trial() {
    let scenario = scenario(ROOMS);
    let trial = Simulation::new(&scenario, 777).unwrap_or_else(|error| panic!("{error}"));
    let mut policy = policies::standard().open("RNE").unwrap();
    let record = trial.checked().run(&mut *policy, |_, _, _| {});
    assert_eq!(record.status.name(), "completed", "{:?}", record.status);
    assert!(record.secured() > 0);
}
