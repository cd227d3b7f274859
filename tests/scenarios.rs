//! Every scenario of the repository loads; every broken one gives its exact message.

use std::path::Path;

use experiments::experiment::{Experiment, Overrides};
use usar_sim::layout::Layout;
use usar_sim::scenario::Scenario;

use crate::support::{paper, paper_text, paper_with, root};

#[test]
fn every_scenario_loads() {
    let mut found = 0;
    let files = |folder| std::fs::read_dir(root().join(folder)).unwrap();
    for entry in files("scenarios").chain(files("scenarios/minimal")) {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "ron") {
            let (scenario, _) = Scenario::load(&path).unwrap_or_else(|error| panic!("{error}"));
            Layout::sample(&scenario, scenario.sweep.first_seed).unwrap();
            found += 1;
        }
    }
    assert!(found > 0);
}

#[test]
fn every_sweep_file_loads() {
    let mut found = 0;
    for entry in std::fs::read_dir(root().join("scenarios/sweeps")).unwrap() {
        let path = entry.unwrap().path();
        let sweep = Experiment::load(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
        assert!(sweep.keys(None).count() > 0);
        found += 1;
    }
    assert!(found > 0);
}

#[test]
fn the_defaults_are_those_of_the_paper_s_scenario() {
    use usar_sim::scenario::{
        ConflictRules, Costs, InitialLevels, MissionRules, PlanningRules, Roles, Sampled,
    };
    let paper = paper();
    assert_eq!(paper.roles, Roles::default());
    assert_eq!(paper.initial_levels, InitialLevels::default());
    assert_eq!(paper.costs, Costs::default());
    assert_eq!(paper.mission, MissionRules::default());
    assert_eq!(paper.planning, PlanningRules::default());
    assert_eq!(paper.conflicts, ConflictRules::default());
    assert_eq!(paper.sampled, Sampled::default());
}

#[test]
fn a_scenario_needs_tasks_or_errands_and_errands_need_robots_and_places() {
    let small = "(name: \"s\", duration_s: 10.0, dt_s: 0.02, arena_m: (10.0, 10.0), team: [(role: Carrier, count: 1, center: (5.0, 5.0), width_m: 0.0)],";
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
    assert!(errors.contains("errands[2].to must name at least one place"), "{errors}");
}

#[test]
fn a_resolved_scenario_reads_back_as_itself() {
    let scenario = paper();
    let text = ron::to_string(&scenario);
    assert_eq!(Scenario::parse(&text, Path::new("resolved.ron")).unwrap(), scenario);
}

mod ron {
    pub fn to_string(scenario: &usar_sim::scenario::Scenario) -> String {
        ::ron::ser::to_string_pretty(&**scenario, ::ron::ser::PrettyConfig::new()).unwrap()
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
            "s.ron:{line}: radiation[8].at must lie in the arena, at least 0 m from its walls, found (179.4, 25.9)"
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
    assert!(unknown.contains("rest_secs") && unknown.contains("`rest_s`"), "{unknown}");

    let wrong_type = error_of("rest_s: 30.0", "rest_s: \"thirty\"");
    assert!(wrong_type.starts_with(&format!("s.ron:{line}:")), "{wrong_type}");
    assert!(wrong_type.contains("mission.rest_s"), "{wrong_type}");

    let missing = error_of("rest_s: 30.0,", "");
    assert!(missing.contains("rest_s"), "{missing}");

    let variant = error_of("hard_rule: IntraGroupTrust", "hard_rule: Best");
    assert!(variant.contains("Best") && variant.contains("Capability"), "{variant}");
}

#[test]
fn an_unknown_policy_in_a_scenario_lists_the_known_ones() {
    let line = line_of("policies: [");
    assert_eq!(
        error_of("\"DIS\"", "\"NEAREST\""),
        format!(
            "s.ron:{line}: sweep.policies[1] must be a known policy, found unknown policy \"NEAREST\"; known policies: RNE, DIS, ENG, HP_DIS, RANDOM"
        )
    );
}

#[test]
fn extensions_that_change_what_a_file_means_are_refused() {
    let error = error_of("// The experiment", "#![enable(unwrap_newtypes)]\n// The experiment");
    assert!(error.contains("not allowed"), "{error}");
}

#[test]
fn debris_on_a_home_and_a_concave_polygon_are_refused() {
    let error = error_of("at: (17.1, 49.4)", "at: (40.1, 13.8)");
    assert!(error.contains("debris[0].at must leave every robot's home free"), "{error}");
    let error = error_of("(1.2, 1.5), ", "(0.0, 0.0), ");
    assert!(error.contains("must be convex"), "{error}");
}

#[test]
fn debris_that_closes_every_way_is_refused() {
    let wall = "debris: [ (shape: Box(89.0, 1.0), at: (44.75, 40.0)),";
    let scenario = paper_with(&[("debris: [", wall)]);
    let error = Layout::sample(&scenario, 1).unwrap_err().to_string();
    assert!(error.contains("no way from home to the hard task"), "{error}");
}

#[test]
fn sampled_layouts_keep_clear_and_differ_by_seed_alone() {
    let sampled = "sampled: (hard: (debris: 10, radiation: 4), easy: (debris: 4, radiation: 1)),";
    let scenario = paper_with(&[(&format!("// {sampled}"), sampled)]);
    let (one, again) = (Layout::sample(&scenario, 3).unwrap(), Layout::sample(&scenario, 3).unwrap());
    let other = Layout::sample(&scenario, 4).unwrap();
    assert_eq!(one, again);
    assert_ne!(one.debris, other.debris);
    assert_eq!(one.debris.len(), scenario.debris.len() + 14);
    assert_eq!(one.zones.len(), scenario.radiation.len() + 5);
}

#[test]
fn a_layout_without_room_says_so() {
    let crowded = "sampled: (hard: (debris: 5000)),";
    let scenario = paper_with(&[("// For random debris", &format!("{crowded}\n// For random debris"))]);
    let error = Layout::sample(&scenario, 1).unwrap_err().to_string();
    assert!(error.starts_with("sampled.hard: no room for debris "), "{error}");
}
