//! The commands as a user meets them: their output, and one clear sentence for bad input.

use serde_json::Value;

use crate::support::{Words, root, succeeds, usar};

pub fn paper_text() -> String {
    std::fs::read_to_string(root().join("scenarios/paper.ron")).unwrap()
}

pub fn json(arguments: &(impl Words + ?Sized)) -> Value {
    let output = usar(&root(), arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[track_caller]
pub fn refused(arguments: &(impl Words + ?Sized), message: &str) {
    let folder = tempfile::tempdir().unwrap();
    let output = usar(folder.path(), arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
    assert!(stderr.contains(message), "{arguments:?} must say {message:?}, said {stderr:?}");
    assert!(!stderr.contains("panicked"), "{stderr}");
    assert!(output.stdout.is_empty());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left behind");
}

#[test]
fn trust_prints_the_papers_first_example() {
    let value = json("trust --weights 6,4,2 --from 86,120,30 --to 20,30,10 --json");
    assert_eq!(value["schema_version"], 1);
    assert_eq!(value["infinite"], false);
    let rne = value["rne"].as_f64().unwrap();
    assert!((rne - 0.003_725_460_660_859_402).abs() < 1e-12);
    assert!((value["trust"].as_f64().unwrap() - (-rne).exp()).abs() < 1e-15);
    assert!((value["from"][0].as_f64().unwrap() - 43.0 / 88.0).abs() < 1e-15);
    assert!((value["to"][2].as_f64().unwrap() - 1.0 / 13.0).abs() < 1e-15);
}

#[test]
fn trust_between_groups_and_in_other_bases() {
    let groups = [
        "trust",
        "--weights",
        "6,4,2",
        "--from",
        "82,114,24",
        "--from",
        "79,117,23",
        "--to",
        "40,56,12",
        "--to",
        "56,48,15",
        "--json",
        "--log-base",
        "10",
    ];
    let value = json(&groups);
    let rne = value["rne"].as_f64().unwrap();
    assert!((rne - 0.009_534_892_308_733_986).abs() < 1e-12);
    assert!((value["rne_in_base"].as_f64().unwrap() - rne / std::f64::consts::LN_10).abs() < 1e-15);
}

#[test]
fn infinite_rne_is_said_and_not_printed_as_a_number() {
    let value = json("trust --weights 1,1 --from 1,1 --to 1,0 --json");
    assert_eq!(
        (&value["rne"], &value["infinite"], value["trust"].as_f64()),
        (&Value::Null, &Value::Bool(true), Some(0.0))
    );
}

#[test]
fn bad_needs_are_refused() {
    let trust = |weights, from, to, message| {
        refused(&["trust", "--weights", weights, "--from", from, "--to", to], message);
    };
    trust("6,4,2", "86,120", "20,30,10", "--from: needs must have 3 entries, found 2");
    trust("6,4,2", "86,-1,30", "20,30,10", "--from: needs[1] must be a finite number >= 0, found -1");
    trust("6,4,2", "86,120,30", "20,NaN,10", "--to: needs[1] must be a finite number >= 0, found NaN");
    trust("6,4,2", "inf,120,30", "20,30,10", "--from: needs[0] must be a finite number >= 0, found inf");
    trust(
        "6,4,2",
        "0,0,0",
        "20,30,10",
        "--from: weighted needs must have at least one entry above 0, found only zeros",
    );
    trust(
        "0,0,0",
        "1,2,3",
        "20,30,10",
        "--weights: weights must have at least one entry above 0, found only zeros",
    );
    trust("6,x,2", "1,2,3", "20,30,10", "--weights: entry 2 must be a number, found \"x\"");
    trust("", "1", "1", "--weights: entry 1 must be a number, found \"\"");
}

const TABLE: &str = "id,role,x,y,hp,v,sen,eng,res,cap,obs,energy_level,hp_level
1,carrier,40,14,90,2.1,2.8,120,1,6,0.006,80,90
2,carrier,43,14,60,1.8,2.4,60,1,6,0.006,40,60
3,supplier,45,16,95,2.2,2.9,140,10,1,0.006,93,95
4,supplier,47,16,70,1.9,2.5,75,10,1,0.006,50,70
5,observer,46,18,45,1.4,17,90,0,0,5.7,90,90
6,observer,47,18,30,1.2,14,40,0,0,4.8,40,60
";

fn table(text: &str) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("robots.csv");
    std::fs::write(&path, text).unwrap();
    (folder, path.to_str().unwrap().to_owned())
}

#[test]
fn group_splits_a_table_by_any_policy() {
    let (_folder, path) = table(TABLE);
    for policy in ["RNE", "ENG", "HP_DIS", "DIS", "RANDOM"] {
        let tasks = ["--task", "near,1,73,51", "--task", "far,2,15,64"];
        let value = json(&[&["group", &path, "--policy", policy, "--json"], &tasks[..]].concat());
        assert!(serde_json::from_value::<rne_core::Decision>(value.clone()).is_ok(), "{value}");
        let ids = |task: usize| {
            let group = &value["assignment"]["groups"][task];
            group.as_array().unwrap().iter().map(|id| id.as_u64().unwrap()).collect::<Vec<_>>()
        };
        let mut all = [ids(0), ids(1)].concat();
        all.sort_unstable();
        assert_eq!(all, [1, 2, 3, 4, 5, 6], "{policy}");
        if policy == "ENG" {
            assert_eq!(ids(1), [1, 3, 5]);
        }
        assert_eq!(value["score"].is_null(), policy != "RNE");
    }
}

#[test]
fn bad_tables_are_refused_with_their_lines() {
    let refuse = |text: &str, arguments: &[&str], message: &str| {
        let (_folder, path) = table(text);
        refused(&[&["group", path.as_str()], arguments].concat(), message);
    };
    refuse("", &[], "the header lacks id, role, x, y");
    refuse("id,role,x,y\n1,a,0,0\n", &[], "the header lacks needs");
    refuse(TABLE.lines().next().unwrap(), &[], "has no robots");
    refuse(&TABLE.replace("2,carrier", "2,"), &[], "robots.csv:3: role must be a name, found nothing");
    refuse(
        &TABLE.replace("2,carrier,43", "2,carrier,nan"),
        &[],
        "robots.csv:3: x must be a finite number, found \"nan\"",
    );
    refuse(
        &TABLE.replace("14,90,2.1", "14,-90,2.1"),
        &[],
        "robots.csv:2: hp must be a number >= 0, found -90",
    );
    refuse(&TABLE.replace("\n2,", "\n1,"), &[], "robot id 1 stands twice");
    refuse(TABLE, &["--policy", "DIS"], "policy DIS needs the place of each task, which is missing");
    refuse(
        &TABLE.replace("energy_level", "note"),
        &["--policy", "ENG"],
        "policy ENG needs the energy level, which is missing for robot 1",
    );
    refuse(
        TABLE,
        &["--policy", "NEAREST"],
        "unknown policy \"NEAREST\"; known policies: RNE, DIS, ENG, HP_DIS, RANDOM",
    );
    refuse(TABLE, &["--policy", "RNE(score: Most)"], "--policy: policy RNE: ");
    refuse(
        TABLE,
        &["--weights", "1,2"],
        "--weights: must have one entry for each need (hp, v, sen, eng, res, cap, obs), found 2",
    );
    refuse(
        TABLE,
        &["--task", "far"],
        "--task: must be NAME,DIFFICULTY or NAME,DIFFICULTY,X,Y, found \"far\"",
    );
}

#[test]
fn bad_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).unwrap();
        folder.path().join(name).to_str().unwrap().to_owned()
    };
    let empty = write("empty.ron", "");
    let blank = write("blank.ron", "\n  \n");
    let broken = write("broken.ron", "(name: \"x\",");
    let good = write("good.ron", &paper_text());
    let here = folder.path().to_str().unwrap();
    for verb in ["check", "run", "sweep"] {
        refused(&[verb, "missing.ron"], "missing.ron: cannot be read");
        let words =
            if verb == "run" { "is not the folder of a finished sweep" } else { "is a folder, not a file" };
        refused(&[verb, here], words);
        refused(&[verb, &empty], "empty.ron: is empty");
        refused(&[verb, &blank], "blank.ron: is empty");
        refused(&[verb, &broken], "broken.ron:1:");
    }
    refused(&["run", &good, "--policy", "NEAREST"], "unknown policy \"NEAREST\"; known policies: RNE, DIS");
    refused(
        &["sweep", &good, "--policies", "RNE,NEAREST"],
        "unknown policy \"NEAREST\"; known policies: RNE, DIS",
    );
    refused(&["sweep", &good, "--trials", "0"], "--trials");
    refused(&["sweep", &good, "--out", &good], "is a file, not a folder");
    refused(
        &["sweep", &good, "--out", here],
        "is not empty and not the folder of a sweep; nothing was overwritten",
    );
}

#[test]
fn the_schemas_in_the_documents_are_those_of_the_types() {
    let docs = root().join("docs/schemas");
    for of in ["question", "decision", "scenario", "sweep"] {
        let expected = std::fs::read_to_string(docs.join(format!("{of}.schema.json"))).unwrap();
        assert_eq!(
            succeeds(&usar(&docs, &["scenario", "schema", of])),
            expected,
            "usar scenario schema {of} makes it anew"
        );
    }
}

#[test]
fn a_question_in_json_is_answered_in_json() {
    let folder = tempfile::tempdir().unwrap();
    let question = r#"{"schema_version": 2, "round": 1, "roles": ["walker"], "needs": [{"name": "hp", "weight": 1.0}],
        "tasks": [{"name": "a", "difficulty": 1}, {"name": "b", "difficulty": 3}, {"name": "c", "difficulty": 2}],
        "quotas": [{"members": [1, 1, 1], "sizes": "Parts"}], "history": [],
        "members": [{"id": 4, "role": 0, "home": [0, 0], "needs": [1.0], "energy_level": 10.0},
            {"id": 2, "role": 0, "home": [0, 0], "needs": [2.0], "energy_level": 90.0},
            {"id": 7, "role": 0, "home": [0, 0], "needs": [3.0], "energy_level": 50.0}],
        "random_seed": "0000000000000000000000000000000000000000000000000000000000000000"}"#;
    let path = folder.path().join("question.json");
    std::fs::write(&path, question).unwrap();
    let path = path.to_str().unwrap();
    let answer = json(&["group", path, "--policy", "ENG", "--json"]);
    assert_eq!(answer["assignment"]["groups"], serde_json::json!([[4], [2], [7]]));
    assert_eq!(answer["account"]["Ranking"]["roles"][0][0]["id"], 2);
    std::fs::write(path, question.replace("\"round\"", "\"rounds\"")).unwrap();
    refused(&["group", path], "question.json: not the JSON of a question: unknown field `rounds`");
}

#[test]
fn what_is_no_command_or_no_file_is_told_with_what_is_meant() {
    let folder = crate::place::place();
    let refused = |arguments: &str, says: &str| crate::place::refused(folder.path(), 2, arguments, &[says]);
    refused("short.ron", "short.ron is no command; did you mean `usar run short.ron`?");
    refused("run shrot.ron", "shrot.ron: cannot be read: there is no such file; did you mean short.ron?");
    refused("run short.ron --seed 1.5", "must be a whole number from 0 on, found \"1.5\"");
    refused("compare short.ron", "it is a file; `usar sweep` makes a folder of results from a scenario");
}
