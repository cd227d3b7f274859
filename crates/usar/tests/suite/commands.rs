//! The commands as a user meets them: their output, and one clear sentence for bad input.

use serde_json::Value;

use crate::support::{Words, json, root, succeeds, usar};

pub fn paper_text() -> String {
    std::fs::read_to_string(root().join("scenarios/paper.ron")).unwrap()
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
    let told = json("trust --weights 6,4,2 --trustor 86,120,30 --trustee 20,30,10 --json");
    assert_eq!((&told["version"], told["sentences"].as_array().unwrap().len()), (&2.into(), 4));
    let value = &told["tables"]["pair"][0];
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
        "--trustor",
        "82,114,24",
        "--trustor",
        "79,117,23",
        "--trustee",
        "40,56,12",
        "--trustee",
        "56,48,15",
        "--json",
        "--log-base",
        "10",
    ];
    let value = &json(&groups)["tables"]["pair"][0];
    let rne = value["rne"].as_f64().unwrap();
    assert!((rne - 0.009_534_892_308_733_986).abs() < 1e-12);
    assert!((value["bans"].as_f64().unwrap() - rne / std::f64::consts::LN_10).abs() < 1e-15);
}

#[test]
fn infinite_rne_is_said_and_not_printed_as_a_number() {
    let told = json("trust --weights 1,1 --trustor 1,1 --trustee 1,0 --json");
    let value = &told["tables"]["pair"][0];
    assert_eq!(
        (&value["rne"], &told["sentences"][0], value["trust"].as_f64()),
        (&Value::Null, &"RNE    infinite".into(), Some(0.0))
    );
}

#[test]
fn bad_needs_are_refused() {
    let trust = |weights, from, to, message| {
        refused(&["trust", "--weights", weights, "--trustor", from, "--trustee", to], message);
    };
    trust("6,4,2", "86,120", "20,30,10", "--trustor: needs must have 3 entries, found 2");
    trust("6,4,2", "86,-1,30", "20,30,10", "--trustor: needs[1] must be a finite number >= 0, found -1");
    trust("6,4,2", "86,120,30", "20,NaN,10", "--trustee: needs[1] must be a finite number >= 0, found NaN");
    trust("6,4,2", "inf,120,30", "20,30,10", "--trustor: needs[0] must be a finite number >= 0, found inf");
    trust(
        "6,4,2",
        "0,0,0",
        "20,30,10",
        "--trustor: weighted needs must have at least one entry above 0, found only zeros",
    );
    trust(
        "0,0,0",
        "1,2,3",
        "20,30,10",
        "--weights: weights must have at least one entry above 0, found only zeros",
    );
    trust("6,x,2", "1,2,3", "20,30,10", "--weights: entry 2 must be a number, found \"x\"");
    trust("", "1", "1", "--weights: entry 1 must be a number, found \"\"");
    refused("trust --trustor 1,2 --trustee 2", "--trustee: needs must have 2 entries, found 1");
    refused("trust --trustor 1,2", "--trustee <TRUSTEE>");
    for more in ["--policy RNE", "--out x.svg", "--less-is-better a=1", "--format csv", "--measure RNE"] {
        refused(&*format!("trust --trustor 1,2 --trustee 2,1 {more}"), "cannot be used with");
    }
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
fn what_is_no_command_or_no_file_is_told_with_what_is_meant() {
    let folder = crate::place::place();
    let refused = |arguments: &str, says: &str| crate::place::refused(folder.path(), 2, arguments, &[says]);
    refused("short.ron", "short.ron is no command; did you mean `usar run short.ron`?");
    refused("run shrot.ron", "shrot.ron: cannot be read: there is no such file; did you mean short.ron?");
    refused("run short.ron --seed 1.5", "must be a whole number from 0 on, found \"1.5\"");
    refused("compare short.ron", "it is a file; `usar sweep` makes a folder of results from a scenario");
}
