//! Each limit of a scenario holds at the limit and not one above; the page of limits is made of the
//! constants.

use scenario::limits;
use scenario::{Problem, Scenario, ScenarioFile};

use crate::support::{paper, paper_text};

/// Fields at which single values are checked: a path in paper.ron for each limit of one.
const PLACES: &[(&str, &ron_tree::limits::Limit)] = &[
    ("duration_s", &limits::DURATION_S),
    ("dt_s", &limits::DT_S),
    ("arena_m[0]", &limits::ARENA_M),
    ("arena_m[1]", &limits::ARENA_M),
    ("team[0].width_m", &limits::ROW_WIDTH_M),
    ("team[0].levels.energy", &limits::LEVEL),
    ("team[0].levels.hp", &limits::LEVEL),
    ("roles.carrier.radius_m", &limits::ROBOT_RADIUS_M),
    ("roles.carrier.mass_kg", &limits::ROBOT_MASS_KG),
    ("roles.carrier.hp", &limits::HP),
    ("roles.carrier.energy", &limits::ENERGY),
    ("roles.carrier.speed_mps", &limits::SPEED_MPS),
    ("roles.carrier.acceleration_mps2", &limits::ACCELERATION_MPS2),
    ("roles.carrier.sensing_m", &limits::SENSING_M),
    ("roles.carrier.observing_m", &limits::OBSERVING_M),
    ("roles.carrier.capacity", &limits::CAPACITY),
    ("roles.carrier.resources", &limits::RESOURCES),
    ("needs.hp.weight", &limits::WEIGHT),
    ("initial_levels.energy.mean", &limits::LEVEL_MEAN),
    ("initial_levels.hp.sd", &limits::LEVEL_SD),
    ("tasks.hard.difficulty", &limits::DIFFICULTY),
    ("tasks.hard.size_m[0]", &limits::BLOCK_M),
    ("tasks.hard.size_m[1]", &limits::BLOCK_M),
    ("tasks.hard.grid[0]", &limits::GRID),
    ("tasks.hard.grid[1]", &limits::GRID),
    ("tasks.hard.sampled.debris", &limits::SAMPLED_DEBRIS),
    ("tasks.hard.sampled.radiation", &limits::SAMPLED_ZONES),
    ("debris[0].rotation_deg", &limits::ROTATION_DEG),
    ("debris[4].movable.mass_kg", &limits::PIECE_MASS_KG),
    ("debris[4].movable.friction", &limits::FRICTION),
    ("radiation[0].radius_m", &limits::ZONE_RADIUS_M),
    ("sampled.zone_radius_m[0]", &limits::SAMPLED_RADIUS_M),
    ("sampled.gap_m", &limits::GAP_M),
    ("sampled.strip_m", &limits::STRIP_M),
    ("costs.energy.per_step", &limits::RATE),
    ("costs.hp.per_metre", &limits::RATE),
    ("mission.energy_threshold", &limits::THRESHOLD),
    ("mission.hp_threshold", &limits::THRESHOLD),
    ("mission.rest_reserve", &limits::REST_RESERVE),
    ("mission.rest_s", &limits::REST_S),
    ("mission.loading_s", &limits::LOADING_S),
    ("mission.blind_speed_loss", &limits::BLIND_SPEED_LOSS),
    ("mission.health_floor", &limits::HEALTH_FLOOR),
    ("mission.cut_off_s", &limits::CUT_OFF_S),
    ("planning.clearance_m", &limits::CLEARANCE_M),
    ("planning.exposure_price_m", &limits::EXPOSURE_PRICE_M),
    ("conflicts.resolver.margin_m", &limits::MARGIN_M),
    ("conflicts.resolver.horizon_s", &limits::HORIZON_S),
    ("conflicts.resolver.deadlock_steps", &limits::DEADLOCK_STEPS),
];

fn with(path: &str, value: &str) -> ScenarioFile {
    let mut file: ScenarioFile = (*paper()).clone();
    if path.contains(".levels.") {
        file.set("team[0].levels", "(energy: 50, hp: 50)").unwrap();
    }
    file.set(path, value).unwrap_or_else(|error| panic!("{error}"));
    file
}

/// The problem of a field with its range.
fn out_of_range(path: &str, file: ScenarioFile) -> Option<Problem> {
    let problems = Scenario::try_from(file).err().unwrap_or_default();
    problems.into_iter().find(|problem| problem.field == path && problem.rule.contains(" from "))
}

/// The number that comes next above, or below: a count has none between.
fn next(value: f64, is_count: bool, is_up: bool) -> f64 {
    match (is_count, is_up) {
        (true, true) => value + 1.0,
        (true, false) => value - 1.0,
        (false, true) => value.next_up(),
        (false, false) => value.next_down(),
    }
}

#[test]
fn each_value_may_be_at_its_limit_and_not_beyond() {
    let counts = [
        "capacity",
        "resources",
        "difficulty",
        "grid[0]",
        "grid[1]",
        "debris",
        "radiation",
        "deadlock_steps",
    ];
    for (path, limit) in PLACES {
        let is_count = counts.iter().any(|count| path.ends_with(&format!(".{count}")));
        for (bound, is_up) in [(limit.least, false), (limit.most, true)] {
            assert_eq!(out_of_range(path, with(path, &bound.to_string())), None, "{path}: {bound}");
            let beyond = next(bound, is_count, is_up);
            if is_count && beyond < 0.0 {
                continue; // no count
            }
            let problem = out_of_range(
                path,
                with(path, &format!("{beyond:?}").replace(".0", if is_count { "" } else { ".0" })),
            );
            assert!(problem.is_some(), "{path}: {beyond}");
        }
    }
}

/// A list of so many equal entries, in the place of what paper.ron has there.
#[track_caller]
fn entries(path: &str, entry: &str, count: usize) -> Vec<String> {
    let entries = (0..count).map(|i| entry.replace('#', &i.to_string())).collect::<Vec<_>>().join(",");
    let mut file: ScenarioFile = (*paper()).clone();
    file.set(path, &format!("[{entries}]")).unwrap_or_else(|error| panic!("{error}"));
    let problems = Scenario::try_from(file).err().unwrap_or_default();
    problems.into_iter().filter(|problem| problem.field == path).map(|problem| problem.rule).collect()
}

#[test]
fn each_table_may_have_its_most_entries_and_not_one_more() {
    let task = "(name:\"t#\",difficulty:1,center:(20,60),size_m:(1,1),grid:(1,1),rest:(27,14))";
    for (path, entry, limit) in [
        ("roles", "(name:\"r#\")", limits::ROLES),
        ("needs", "(name:\"n#\",level:Basic,measures:Health)", limits::NEEDS),
        ("tasks", task, limits::TASKS),
        ("radiation", "(at:(9,9),radius_m:1)", limits::ZONES),
        ("scatter", "(what:Debris,count:1,radius_m:1)", limits::SCATTERS),
        ("timeline", "(at_s:1,event:RobotFails(1))", limits::MOMENTS),
        ("team", "(role:\"observer\",count:1,center:(9,9),width_m:0)", limits::ROWS),
    ] {
        assert_eq!(entries(path, entry, limit.count()), Vec::<String>::new(), "{path}");
        let rule = entries(path, entry, limit.count() + 1).concat();
        assert!(rule.contains(&format!("{} entries", limit.most)), "{path}: {rule}");
    }
    let with_piece = |count: usize| {
        let mut file: ScenarioFile = (*paper()).clone();
        file.debris = vec![file.debris[0].clone(); count];
        Scenario::try_from(file).err()
    };
    assert_eq!(with_piece(limits::DEBRIS.count()), None);
    assert!(with_piece(limits::DEBRIS.count() + 1).is_some());
}

#[test]
fn values_with_names_have_limits() {
    let with = |values: &str| {
        let text = paper_text().replacen("\n(", &format!("\n(values: ({values}),"), 1);
        Scenario::parse(&text, "t.ron".as_ref()).map(|_| ()).map_err(|error| error.to_string())
    };
    let many = |count: usize| (0..count).map(|i| format!("a{i}: 1")).collect::<Vec<_>>().join(",");
    assert_eq!(with(&many(limits::VALUES.count())), Ok(()));
    assert!(with(&many(limits::VALUES.count() + 1)).unwrap_err().contains("values must be at most 1000"));
    let long = |bytes: usize| format!("a: \"{}\"", "x".repeat(bytes - 2));
    assert_eq!(with(&long(limits::VALUE_BYTES.count())), Ok(()));
    assert!(
        with(&long(limits::VALUE_BYTES.count() + 1))
            .unwrap_err()
            .contains("values.a must be at most 1024 bytes")
    );
}

#[test]
fn distributions_choices_and_scattered_things_have_limits() {
    let problem = |path: &str, value: &str| {
        let mut file: ScenarioFile = (*paper()).clone();
        file.set(path, value).map_err(|error| error.to_string())?;
        Scenario::try_from(file).map(|_| ()).map_err(|problems| problems[0].to_string())
    };
    let zones = |count: usize| vec!["(at:(50,36),radius_m:Uniform(1,2))"; count].join(",");
    assert_eq!(problem("radiation", &format!("[{}]", zones(limits::DRAWS.count()))), Ok(()));
    let many = problem("radiation", &format!("[{}]", zones(limits::DRAWS.count() + 1))).unwrap_err();
    assert!(many.contains("one distribution too many"), "{many}");
    let choice = |count: usize| format!("Choice([{}])", vec!["4.5"; count].join(","));
    assert_eq!(problem("radiation[0].radius_m", &choice(limits::CHOICES.count())), Ok(()));
    assert!(problem("radiation[0].radius_m", &choice(limits::CHOICES.count() + 1)).is_err());
    let scatter = |count: usize| {
        format!("[(what:Debris,count:{count},radius_m:1),(what:Radiation,count:1,radius_m:1)]")
    };
    assert_eq!(problem("scatter", &scatter(limits::SCATTERED.count() - 1)), Ok(()));
    assert!(problem("scatter", &scatter(limits::SCATTERED.count())).unwrap_err().contains("in all"));
    for (event, limit) in [
        ("RobotLoses(robot:1,hp:#)", limits::LOSS),
        ("SourceAppears(at:(9,9),radius_m:#)", limits::ZONE_RADIUS_M),
    ] {
        let event = |value: f64| format!("[(at_s:1,event:{})]", event.replace('#', &format!("{value:?}")));
        assert_eq!(problem("timeline", &event(limit.most)), Ok(()));
        assert!(problem("timeline", &event(limit.most.next_up())).is_err());
    }
    assert_eq!(problem("timeline", "[(at_s:86400,event:RobotFails(1))]"), Ok(()));
    assert!(problem("timeline", "[(at_s:86400.1,event:RobotFails(1))]").is_err());
}

#[test]
fn the_page_of_limits_is_made_of_the_constants() {
    let page = std::fs::read_to_string(xtask::limits::path()).unwrap_or_default();
    assert!(page == xtask::limits::page(), "cargo run --bin xtask -- reference");
}
