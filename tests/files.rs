//! Random valid scenarios, the files of the documents, and the page made of the types' comments.

use std::path::PathBuf;

use scenario::{Scenario, scenario_schema};
use usar_sim::record::Status;
use usar_sim::simulation::Simulation;
use xtask::{random, reference, reference_pages};

use crate::support::root;

#[test]
fn twenty_random_scenarios_of_all_kinds_hold_every_invariant() {
    let (mut events, mut draws, mut tasks) = (0, 0, 0);
    for seed in 1_000..1_020 {
        let ran = random::run(seed);
        assert_eq!(ran.violation, None, "seed {seed}:\n{}", ran.text);
        (events, draws, tasks) = (events + ran.events, draws + ran.draws, tasks + ran.tasks);
    }
    assert!(
        events > 20 && draws > 100 && tasks > 20,
        "{events} events, {draws} distributions, {tasks} tasks"
    );
}

/// The scenario files of a folder of `scenarios/`, in order.
fn files(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join("scenarios").join(folder)).unwrap();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| !path.to_string_lossy().ends_with(".sweep.ron"));
    files.sort();
    files
}

#[test]
fn every_step_of_the_tutorial_and_every_file_of_the_gallery_runs() {
    let mut rne = policies::standard().open("RNE").unwrap();
    let (steps, gallery) = (files("tutorial"), files("gallery"));
    assert_eq!(steps.len(), 10);
    for path in steps.iter().chain(&gallery) {
        let (scenario, text) = Scenario::load(path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(ron_tree::formatted(&text).unwrap(), text, "usar scenario fmt {}", path.display());
        let again = Scenario::parse(&scenario.resolved(), "resolved.ron".as_ref());
        assert_eq!(again.as_ref(), Ok(&scenario), "{}", path.display());
        let mut trial = Simulation::new(&scenario, 1).unwrap().checked();
        let until_s = if trial.world().robots.len() > 100 { 2.0 } else { 45.0 };
        while trial.time_s() < until_s {
            match trial.step(&mut *rne) {
                None => {}
                Some(Status::Failed(reason)) => panic!("{}: {reason}", path.display()),
                Some(_) => break,
            }
        }
    }
}

#[test]
fn the_page_names_each_file_and_each_has_its_picture() {
    let page = std::fs::read_to_string(root().join("docs/scenarios.md")).unwrap();
    for path in files("tutorial").iter().chain(&files("gallery")) {
        let name = path.file_name().unwrap().to_string_lossy();
        assert!(page.contains(&*name), "docs/scenarios.md leaves out {name}");
    }
    let pictures: Vec<&str> =
        page.split("figures/gallery/").skip(1).map(|rest| rest.split(')').next().unwrap()).collect();
    assert!(pictures.len() >= 10, "{pictures:?}");
    for picture in pictures {
        assert!(root().join("docs/figures/gallery").join(picture).is_file(), "{picture} is missing");
    }
}

#[test]
fn the_reference_is_made_of_the_types() {
    let page = std::fs::read_to_string(reference::path()).unwrap();
    assert!(page == reference::page(), "cargo run --bin xtask -- reference makes it anew");
    let schema = scenario_schema();
    let fields = schema["properties"].as_object().unwrap();
    for (name, field) in fields {
        assert!(field.get("description").is_some(), "{name} has no comment");
        assert!(page.contains(&format!("| `{name}` |")), "{name} is missing");
    }
}

#[test]
fn events_and_columns_are_told_by_the_program() {
    for (path, page) in reference_pages::pages() {
        let there = std::fs::read_to_string(&path).unwrap();
        assert!(there == page, "{}: `just reference` makes it anew", path.display());
    }
    let events = &reference_pages::pages()[0].1;
    let rows = events.lines().filter(|line| line.starts_with("| `")).count();
    assert!(rows >= 33, "{events}");
    assert!(events.contains("| `made_room` |") && events.contains("`room_for`: "), "{events}");
}
