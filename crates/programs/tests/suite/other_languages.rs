//! Policies of the house, written in other languages, answer as those of the house.

use std::path::Path;

use programs::questions::{question, with_evidence};
use programs::templates::Language;
use teaming::MadePolicy;

use crate::support::{ask, exec, is_there};

/// Random teams.
const TEAMS: u64 = 1_000;

#[track_caller]
fn answers_as(policy: &MadePolicy, name: &str, teams: u64) {
    let own = policies::standard().parse(name).unwrap();
    let mut session = policy.open().unwrap();
    let mut groups = 0;
    for seed in 0..teams {
        let question = question(seed);
        let theirs = ask(&mut *session, seed, &question).unwrap_or_else(|error| panic!("{seed}: {error}"));
        assert_eq!(theirs.assignment, own.decide(&question).unwrap().assignment, "seed {seed}");
        groups += theirs.assignment.groups.iter().filter(|group| group.len() > 1).count() as u64;
    }
    assert!(groups > teams / 2, "{groups} groups of two robots or more");
}

/// The program to begin with in a language, which groups by energy.
fn template(language: Language, folder: &Path) -> MadePolicy {
    let name = folder.join("mine").display().to_string();
    for file in language.files(&name) {
        std::fs::create_dir_all(Path::new(&file.path).parent().unwrap()).unwrap();
        std::fs::write(file.path, file.text).unwrap();
    }
    let command = language.command(&name);
    exec(&command.iter().map(String::as_str).collect::<Vec<_>>(), "")
}

#[test]
fn questions_with_evidence_keep_the_rules_of_questions() {
    for seed in 0..TEAMS {
        let question = with_evidence(question(seed)).checked();
        let question = question.unwrap_or_else(|error| panic!("seed {seed}: {error}"));
        let evidence = question.evidence.expect("evidence");
        assert!(evidence.reports.len() > question.members.len() && !evidence.ledger.is_empty());
        assert!(evidence.bodies.iter().all(|body| body.needs.len() == 3), "hp, v and eng follow from levels");
    }
}

#[test]
fn energy_in_python_answers_as_the_built_in_policy() {
    let folder = tempfile::tempdir().unwrap();
    answers_as(&template(Language::Python, folder.path()), "ENG", TEAMS);
}

#[test]
fn distance_in_python_answers_as_the_built_in_policy() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/distance.py");
    answers_as(&exec(&["python3", path], ""), "DIS", TEAMS);
}

#[test]
fn energy_in_javascript_answers_as_the_built_in_policy() {
    if !is_there("node", &["--version"]) {
        return eprintln!("left out: there is no node");
    }
    let folder = tempfile::tempdir().unwrap();
    answers_as(&template(Language::Js, folder.path()), "ENG", TEAMS);
}

#[test]
fn energy_in_r_answers_as_the_built_in_policy() {
    if !is_there("Rscript", &["-e", "library(jsonlite)"]) {
        return eprintln!("left out: there is no R with the package jsonlite");
    }
    let folder = tempfile::tempdir().unwrap();
    answers_as(&template(Language::R, folder.path()), "ENG", TEAMS / 5);
}

#[test]
fn energy_in_julia_answers_as_the_built_in_policy() {
    if !is_there("julia", &["-e", "using JSON"]) {
        return eprintln!("left out: there is no Julia with the package JSON");
    }
    let folder = tempfile::tempdir().unwrap();
    answers_as(&template(Language::Julia, folder.path()), "ENG", TEAMS / 5);
}
