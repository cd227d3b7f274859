//! Every scenario of the repository loads; every broken one gives its exact message.

use std::path::{Path, PathBuf};

use experiments::experiment::{Experiment, Overrides};
use scenario::{
    Door, EmptyTasks, MissionRules, ResolverRule, RightOfWay, RoleFile, Scenario, ScenarioFile, WallFile,
};
use usar_sim::model::Layout;

use crate::support::{SAMPLED, paper, paper_text, paper_with, root};

#[test]
fn every_scenario_loads() {
    let mut found = 0;
    for path in ["scenarios", "scenarios/minimal", "scenarios/navigation"].into_iter().flat_map(files) {
        if is_scenario(&path) {
            let (scenario, _) = Scenario::load(&path).unwrap_or_else(|error| panic!("{error}"));
            Layout::sample(&scenario, 1).unwrap();
            found += 1;
        }
    }
    assert!(found > 9 + 3 + 30);
}

/// Whether a file is a scenario, and not one's sweep file.
fn is_scenario(path: &Path) -> bool {
    path.is_file() && !path.to_str().unwrap().ends_with(".sweep.ron")
}

/// The files of a folder of the repository.
fn files(folder: &str) -> Vec<PathBuf> {
    std::fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().path()).collect()
}

#[test]
fn every_sweep_file_loads_and_every_mission_has_one() {
    let companions = files("scenarios").into_iter().filter(|path| path.is_file() && !is_scenario(path));
    let mut found = 0;
    for path in files("scenarios/sweeps").into_iter().chain(companions) {
        let sweep = Experiment::load(&path, &Overrides::default(), &policies::standard())
            .unwrap_or_else(|error| panic!("{error}"));
        assert!(sweep.keys(None).count() > 0);
        found += 1;
    }
    assert!(found > 0);
    for path in files("scenarios").into_iter().filter(|path| is_scenario(path)) {
        assert!(path.with_extension("sweep.ron").is_file(), "{}", path.display());
    }
}

/// A scenario that says no more than it must.
const SMALL: &str = r#"(
    name: "s", duration_s: 10.0, dt_s: 0.02, arena_m: (10.0, 10.0),
    team: [(role: "robot", count: 1, center: (5.0, 5.0), width_m: 0.0)],
    tasks: [(name: "t", difficulty: 1, center: (2.0, 2.0), size_m: (1.0, 1.0), grid: (1, 1),
        rest: (8.0, 8.0))],
)"#;

#[test]
fn the_defaults_are_those_of_the_paper_s_scenario() {
    let paper = paper();
    let small = Scenario::parse(SMALL, Path::new("s.ron")).unwrap();
    // The paper's carriers hardly see.
    let carrier = RoleFile { name: "carrier".to_owned(), observing_m: 0.006, ..small.roles[0].clone() };
    assert_eq!(carrier, paper.roles[0]);
    assert_eq!(small.roles.len(), 1);
    assert_eq!(small.needs, paper.needs);
    assert_eq!(small.initial_levels, paper.initial_levels);
    assert_eq!(small.costs, paper.costs);
    // The paper sends a group to each task in every round.
    assert_eq!(MissionRules { empty_tasks: EmptyTasks::GetGroups, ..small.mission }, paper.mission);
    assert_eq!(small.planning, paper.planning);
    assert_eq!(
        (small.conflicts.resolver, paper.conflicts.resolver),
        (ResolverRule::Reciprocal, ResolverRule::Rotation(RightOfWay::default()))
    );
    assert_eq!(small.conflicts.priority, paper.conflicts.priority);
    assert_eq!(small.sampled, paper.sampled);
}

#[test]
fn a_scenario_needs_tasks_or_errands_and_errands_need_robots_and_places() {
    let small = "(name: \"s\", duration_s: 10.0, dt_s: 0.02, arena_m: (10.0, 10.0), team: [(role: \"robot\", \
        count: 1, center: (5.0, 5.0), width_m: 0.0)],";
    let error = |rest: &str| {
        let text = format!("{small}{rest})");
        Scenario::parse(&text, Path::new("s.ron")).unwrap_err().to_string()
    };
    assert!(error("").contains("tasks must be given when there are no errands"));
    let errors =
        error("errands: [(robot: 0, to: [(3.0, 30.0)]), (robot: 7, to: [(1.0, 1.0)]), (robot: 0, to: [])]");
    assert!(errors.contains("errands[0].to[0] must lie in the arena"), "{errors}");
    assert!(errors.contains("errands[1].robot must be the id of one of the 1 robots, found 7"), "{errors}");
    assert!(errors.contains("errands[2].robot must not stand twice"), "{errors}");
    assert!(errors.contains("errands[2].to must have 1 to 10000 entries, found 0"), "{errors}");
}

#[test]
fn costs_per_step_under_another_step_are_told() {
    let told = |dt_s: &str| {
        let mut file = (*paper()).clone();
        file.set("dt_s", dt_s).unwrap();
        let scenario = Scenario::try_from(file).unwrap();
        scenario.warnings(&paper_text()).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(told("0.02"), "");
    let told = told("0.04");
    assert!(
        told.contains(
            "costs.energy.per_step is paid in every step, here of 0.04 s, found 0.0045; in a second this is \
             0.500 times as much"
        ),
        "{told}"
    );
    assert!(told.contains("costs.hp.per_step"), "{told}");
}

#[test]
fn a_control_period_that_is_not_kept_to_is_told() {
    let told = |changes: &[(&str, &str)]| {
        let mut file = (*paper()).clone();
        changes.iter().for_each(|(field, value)| file.set(field, value).unwrap());
        let warnings = Scenario::try_from(file).unwrap().warnings(&paper_text());
        warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(told(&[("control_period_s", "0.02")]), "");
    assert_eq!(told(&[("roles.observer.speed_mps", "5")]), "", "nobody gave a period");
    for (given, kept) in [("0.5", "0.1000"), ("0.05", "0.0400"), ("0.01", "0.0200")] {
        let told = told(&[("control_period_s", given)]);
        let expected =
            format!("control_period_s is not kept to: robots decide every {kept} s, found {given}");
        assert!(told.contains(&expected), "{told}");
    }
    let told = told(&[("fidelity", "AsWritten")]);
    assert!(told.starts_with("fidelity has no effect any more, found AsWritten; all trials"), "{told}");
}

#[test]
fn a_medium_over_which_reports_come_too_late_is_told() {
    let told = |medium: &str| {
        let mut file = (*paper()).clone();
        file.set("reports", "(every_s: 1.0)").unwrap();
        file.set("medium", medium).unwrap();
        let warnings = Scenario::try_from(file).unwrap().warnings(&paper_text());
        warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    assert_eq!((told("(kbps: 6.2)"), told("(delay_s: 10.0)")), (String::new(), String::new()));
    let slow = told("(kbps: 0.01)"); // twelve robots, 64 bytes each, every second: 6.144 kbit/s
    assert!(slow.contains("medium.kbps is 614.4 times too slow for the reports of all robots"), "{slow}");
    let late = told("(delay_s: 3600.0)");
    assert!(late.contains("medium.delay_s is as long as the trial or longer"), "{late}");
}

#[test]
fn a_team_without_a_guide_and_doors_too_narrow_for_all_are_told() {
    let told = |change: &dyn Fn(&mut ScenarioFile)| {
        let mut file = (*paper()).clone();
        change(&mut file);
        let scenario = Scenario::try_from(file).unwrap();
        scenario.warnings(&paper_text()).iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    let blind = told(&|file| file.roles.iter_mut().for_each(|role| role.guides = false));
    assert!(
        blind.contains("].guides leaves the team without a guide: every group loses 0.3 of its speed"),
        "{blind}"
    );
    let door = |width_m| Door { at_m: 5.0, width_m, name: None, is_closed: false };
    let with_door = |width_m| {
        told(&|file: &mut ScenarioFile| {
            file.walls.push(WallFile {
                from: [40.0, 10.0],
                to: [50.0, 10.0],
                thickness_m: 0.2,
                doors: vec![door(width_m)],
            });
        })
    };
    let narrow = with_door(0.5);
    assert!(
        narrow.contains("walls[0].doors[0].width_m is too narrow for every robot, found 0.5; the smallest"),
        "{narrow}"
    );
    assert_eq!(with_door(2.0), "");
}

#[test]
fn values_at_a_limit_pass_whatever_the_rounding() {
    let wall = |from: &str, to: &str| {
        let text = format!(
            "(name: \"s\", duration_s: 10, dt_s: 0.02, arena_m: (10, 10), team: [(role: \"robot\", count: 1, \
             center: (2, 2), width_m: 0)], errands: [(robot: 0, to: [(8, 8)])], walls: [(from: {from}, to: \
             {to}, thickness_m: 0.1)])"
        );
        Scenario::parse(&text, Path::new("s.ron")).map(|scenario| scenario.obstacles().len())
    };
    assert_eq!(wall("(3.05, 5)", "(2.95, 5)").unwrap(), 1, "0.0999999999999996 m long");
    assert!(wall("(3.04, 5)", "(2.95, 5)").is_err());
    // An arc of a milliradian a corner, with edges of 5 cm.
    let corner = |i: u32| [50.0 * (f64::from(i) * 1e-3).cos(), 50.0 * (f64::from(i) * 1e-3).sin()];
    let arc: Vec<String> = (0..60).map(corner).map(|[x, y]| format!("({x:?}, {y:?})")).collect();
    let text = format!(
        "(name: \"s\", duration_s: 10, dt_s: 0.02, arena_m: (90, 20), team: [(role: \"robot\", count: 1, \
         center: (2, 2), width_m: 0)], errands: [(robot: 0, to: [(8, 8)])], debris: [(shape: Polygon([(40.0, \
         1.5), {}]), at: (20, 10))])",
        arc.join(", ")
    );
    Scenario::parse(&text, Path::new("s.ron")).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn errands_lead_where_a_robot_can_stand() {
    let error = |place: &str, rest: &str| {
        let text = format!(
            "(name: \"s\", duration_s: 10, dt_s: 0.02, arena_m: (12, 8), team: [(role: \"robot\", count: 1, \
             center: (2, 4), width_m: 0)], errands: [(robot: 0, to: [{place}])], debris: [(shape: Disc(1), \
             at: (6, 4))], walls: [(from: (9, 0), to: (9, 4), thickness_m: 0.1)]{rest})"
        );
        Scenario::parse(&text, Path::new("s.ron")).map_or_else(|error| error.to_string(), |_| String::new())
    };
    assert_eq!(error("(4, 4)", ""), "");
    assert_eq!(
        error("(9, 2)", ""),
        "s.ron:1: errands[0].to[0] must be at least planning.clearance_m (0.15 m) from walls[0], found a \
         place inside it"
    );
    assert!(error("(12, 4)", "").contains("from the wall of the arena, found a place inside it"));
    assert!(error("(6, 3.5)", "").contains("from debris[0], found a place inside it"));
    let tight = error("(6, 2.9)", "");
    assert!(
        tight.contains("found 0.100 m from it; planning.clearance_m of at most 0.100 would do"),
        "{tight}"
    );
    assert_eq!(error("(6, 2.9)", ", planning: (clearance_m: 0.09)"), "");
    let room = error("(4, 4)", ", planning: (clearance_m: 4.0)");
    assert!(room.contains("planning.clearance_m must leave room in the arena of 8 m"), "{room}");
    let large = error("(4, 4)", ", roles: [(name: \"robot\", radius_m: 1.5)]");
    assert_eq!(large, "", "a mission's reach does not matter to errands");
}

#[test]
fn a_resolved_scenario_reads_back_as_itself() {
    let scenario = paper();
    for text in [scenario.resolved(), scenario.tree().to_string()] {
        assert_eq!(Scenario::parse(&text, Path::new("resolved.ron")).unwrap(), scenario);
    }
}

#[track_caller]
fn error_of(from: &str, to: &str) -> String {
    let text = paper_text();
    assert!(text.contains(from), "{from:?} is not in paper.ron");
    let error = Scenario::parse(&text.replacen(from, to, 1), Path::new("s.ron")).unwrap_err();
    error.to_string()
}

/// Line of paper.ron on which a text stands.
#[track_caller]
fn line_of(what: &str) -> usize {
    let text = paper_text();
    let at = text.find(what).unwrap_or_else(|| panic!("{what:?} is not in paper.ron"));
    1 + text[..at].matches('\n').count()
}

#[test]
fn values_out_of_range_are_named_with_file_line_field_rule_and_value() {
    let line = line_of("rest_s: 30.0");
    assert_eq!(
        error_of("rest_s: 30.0", "rest_s: -1.0"),
        format!("s.ron:{line}: mission.rest_s must be a number from 0 to 86400, found -1")
    );
    let line = line_of("speed_mps: 1.5");
    assert_eq!(
        error_of("speed_mps: 1.5", "speed_mps: NaN"),
        format!("s.ron:{line}: roles.observer.speed_mps must be a number from 0.05 to 20, found NaN")
    );
    let line = line_of("mean: 80.0");
    assert_eq!(
        error_of("mean: 80.0", "mean: inf"),
        format!("s.ron:{line}: initial_levels.energy.mean must be a number from 0 to 100, found inf")
    );
    let line = line_of("(at: (79.4, 25.9)");
    assert_eq!(
        error_of("(at: (79.4, 25.9)", "(at: (179.4, 25.9)"),
        format!(
            "s.ron:{line}: radiation[8].at must lie in the arena, at least 0 m from its walls, found (179.4, \
             25.9)"
        )
    );
}

#[test]
fn all_values_out_of_range_are_named_at_once() {
    let text =
        paper_text().replace("rest_s: 30.0", "rest_s: -1.0").replace("duration_s: 600.0", "duration_s: 0.0");
    let error = Scenario::parse(&text, Path::new("s.ron")).unwrap_err().to_string();
    assert_eq!(error.lines().count(), 2, "{error}");
    assert!(error.contains("duration_s must") && error.contains("mission.rest_s must"), "{error}");
}

#[test]
fn unknown_fields_wrong_types_and_missing_fields_are_named_with_their_place() {
    let line = line_of("rest_s: 30.0");
    let unknown = error_of("rest_s: 30.0", "rest_secs: 30.0");
    assert!(unknown.starts_with(&format!("s.ron:{line}:")), "{unknown}");
    assert!(unknown.contains("rest_secs") && unknown.contains("did you mean rest_s?"), "{unknown}");

    let wrong_type = error_of("rest_s: 30.0", "rest_s: \"thirty\"");
    assert!(wrong_type.starts_with(&format!("s.ron:{line}:")), "{wrong_type}");
    assert!(wrong_type.contains("mission.rest_s"), "{wrong_type}");

    let missing = error_of("size_m: (11.0, 5.7), ", "");
    assert!(missing.contains("size_m"), "{missing}");

    let line = line_of("kind: Aerial");
    let variant = error_of("kind: Aerial", "kind: Flying");
    assert!(variant.starts_with(&format!("s.ron:{line}:")), "{variant}");
    assert!(variant.contains("Flying") && variant.contains("Aerial"), "{variant}");
}

#[test]
fn an_option_of_a_policy_that_is_not_there_is_named_with_the_known_ones() {
    let variant = policies::standard().parse("RNE(hard_rule: Best)").unwrap_err().to_string();
    assert!(variant.contains("Best") && variant.contains("Capability"), "{variant}");
}

#[test]
fn an_unknown_policy_in_a_sweep_file_lists_the_known_ones() {
    let path = root().join("scenarios/paper.sweep.ron");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("\"DIS\""));
    let text = text.replacen("\"DIS\"", "\"NEAREST\"", 1);
    let error = Experiment::parse(text, &path, &Overrides::default(), &policies::standard())
        .err()
        .unwrap()
        .to_string();
    let expected = "unknown policy \"NEAREST\"; known policies: RNE, DIS, ENG, HP_DIS, RANDOM, OPTIMAL, ";
    assert!(error.contains(expected), "{error}");
}

#[test]
fn tables_of_tasks_roles_and_needs_are_checked_and_named_by_their_entries() {
    let refused = |from: &str, to: &str, expected: &str| {
        let error = error_of(from, to);
        assert!(error.ends_with(expected), "{error}");
        assert!(error.starts_with(&format!("s.ron:{}: ", line_of(from))), "{error}");
    };
    refused(
        "size_m: (11.0, 5.7), grid: (20, 10)",
        "size_m: (11.0, 5.7), grid: (1001, 10)",
        "tasks.hard.grid[0] must be a number from 0 to 1000, found 1001",
    );
    refused(
        "rest: (27.0, 14.5)",
        "rest: (27.0, 94.5)",
        "tasks.hard.rest must lie in the arena, at least 0 m from its walls, found (27, 94.5)",
    );
    refused("(name: \"easy\"", "(name: \"hard\"", "tasks[1].name must not be listed twice, found \"hard\"");
    refused(
        "(name: \"easy\"",
        "(name: \"e.s\"",
        "tasks[1].name must be a name of at most 64 letters, digits, `-` and `_` that does not start with \
         `-`, found \"e.s\"",
    );
    refused(
        "rest: (66.0, 14.5)",
        "rest: (66.0, 14.5), quota: {\"walker\": 2}",
        "tasks.easy.quota must name roles of the scenario, found \"walker\"",
    );
    refused(
        "(role: \"supplier\"",
        "(role: \"walker\"",
        "team[1].role must be one of the roles (carrier, supplier, observer), found \"walker\"",
    );
    refused(
        "(name: \"obs\", level: Capability, measures: Observing)",
        "(name: \"obs\", level: Capability, measures: Constant)",
        "needs.obs measures Constant, so that each role must have `constants: {\"obs\": ...}`, found \
         role \"carrier\" without it",
    );
}

#[test]
fn what_is_sampled_depends_on_the_seed_alone() {
    let scenario = paper_with(&SAMPLED);
    let (one, again) = (Layout::sample(&scenario, 3).unwrap(), Layout::sample(&scenario, 3).unwrap());
    let other = Layout::sample(&scenario, 4).unwrap();
    assert_eq!(one, again);
    assert_ne!(one.debris, other.debris);
    assert_eq!(one.debris.len(), scenario.debris.len() + 14);
    assert_eq!(one.zones.len(), scenario.radiation.len() + 5);
}

#[test]
fn a_layout_without_room_says_so() {
    let crowded = "rest: (27.0, 14.5), sampled: (debris: 5000)";
    let scenario = paper_with(&[("rest: (27.0, 14.5)", crowded)]);
    let error = Layout::sample(&scenario, 1).unwrap_err().to_string();
    assert!(error.starts_with("tasks.hard.sampled: no room for debris "), "{error}");
}
