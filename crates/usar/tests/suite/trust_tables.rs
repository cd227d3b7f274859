//! `usar trust` with a table of a user's own: all pairs, groups, and every problem with its place.

use serde_json::{Value, json as value};

use crate::commands::refused;
use crate::support::{json, read, succeeds, usar};

/// With the worst damage 100, the needs are (10, 80), (20, 40) and (10, 40); divided by the largest values,
/// (1/2, 1), (1, 1/2) and (1/2, 1/2). The shares are (1/3, 2/3), (2/3, 1/3) and (1/2, 1/2).
const SPOTS: &str = "id,hp,damage\nspot-1,10,20\nspot-2,20,60\nspot-3,10,60\n";

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

fn matrix(text: &str, arguments: &[&str]) -> Value {
    let (_folder, path) = table(text);
    json(&[&["trust", path.as_str(), "--json"], arguments].concat())["tables"].clone()
}

#[track_caller]
fn close(found: &Value, expected: f64) {
    let found = found.as_f64().unwrap();
    assert!((found - expected).abs() < 1e-12, "{found} {expected}");
}

const LESS: [&str; 2] = ["--less-is-better", "damage=100"];

#[test]
fn a_table_gives_the_trust_of_all_pairs() {
    let all = matrix(SPOTS, &LESS);
    let rne = &all["distrust"];
    let robots = [0, 1, 2].map(|place: usize| rne[place]["from \\ to"].clone());
    assert_eq!(robots, ["spot-1", "spot-2", "spot-3"].map(|name| value!(name)));
    assert_eq!(all["needs"][1], value!({"need": "damage", "weight": 1.0 / 80.0}));
    // 1/3 ln((1/3) / (2/3)) + 2/3 ln((2/3) / (1/3)), and so on.
    close(&rne[0]["spot-2"], 2_f64.ln() / 3.0);
    close(&rne[1]["spot-1"], 2_f64.ln() / 3.0);
    close(&rne[0]["spot-3"], (2.0_f64 / 3.0).ln() / 3.0 + (4.0_f64 / 3.0).ln() * 2.0 / 3.0);
    close(&rne[2]["spot-1"], (9.0_f64 / 8.0).ln() / 2.0);
    close(&rne[2]["spot-3"], 0.0);
    close(&all["trust"][0]["spot-2"], 2_f64.powf(-1.0 / 3.0));
    // With the weights 2 and 1 the shares of the first two are (1/2, 1/2) and (4/5, 1/5).
    let weighted = matrix(SPOTS, &[&LESS[..], &["--weights", "2,1"]].concat());
    close(&weighted["distrust"][0]["spot-2"], (25.0_f64 / 16.0).ln() / 2.0);
    // As they are, the needs of the first two are (10, 80) and (20, 40).
    let as_is = matrix(SPOTS, &[&LESS[..], &["--measure", "RNE(scale: false)"]].concat());
    close(&as_is["distrust"][0]["spot-2"], (1.0_f64 / 3.0).ln() / 9.0 + (4.0_f64 / 3.0).ln() * 8.0 / 9.0);
}

#[test]
fn no_trust_at_all_is_null_and_a_word() {
    // The second robot is at the worst.
    let text = "id,hp,damage\na,10,50\nb,10,100\n";
    let all = matrix(text, &LESS);
    assert_eq!((&all["distrust"][0]["b"], &all["trust"][0]["b"]), (&Value::Null, &value!(0.0)));
    close(&all["distrust"][1]["a"], 2_f64.ln());
    let (folder, path) = table(text);
    let csv = succeeds(&usar(folder.path(), &[&["trust", &path, "--format", "csv"], &LESS[..]].concat()));
    assert_eq!(csv.lines().take(2).collect::<Vec<_>>(), ["from \\ to,a,b", "a,0,infinite"]);
    let drawn = usar(folder.path(), &[&["trust", &path, "--out", "m.svg"], &LESS[..]].concat());
    assert!(succeeds(&drawn).contains("damage (weight 1, counts as 100 - damage)"));
    let svg = read(&folder.path().join("m.svg"));
    assert!(svg.contains("darkest: infinite") && !svg.contains("NaN") && !svg.contains("inf<"), "{svg}");
}

#[test]
fn a_spreadsheets_table_gives_the_same_numbers() {
    let points = "id,role,hp,damage\nspot 1,träger,10.5,20.25\n\"spot, 2\",späher,20,60\n";
    let expected = matrix(points, &LESS);
    let semicolons =
        "\u{feff}id;role;hp;damage\r\nspot 1;träger;10,5;20,25\r\n\"spot, 2\";späher;20;60\r\n;;;\r\n";
    assert_eq!(matrix(semicolons, &LESS), expected);
    assert_eq!(matrix(&semicolons.replace(';', "\t"), &LESS), expected);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "needs --features full")]
fn the_picture_is_of_the_named_kind_and_replaces_nothing() {
    let (folder, path) = table(SPOTS);
    for (file, begin) in [("m.svg", &b"<svg"[..]), ("m.png", b"\x89PNG"), ("m.pdf", b"%PDF")] {
        let arguments = ["trust", &path, "--out", file];
        succeeds(&usar(folder.path(), &arguments));
        assert!(std::fs::read(folder.path().join(file)).unwrap().starts_with(begin), "{file}");
        crate::place::refused(folder.path(), 2, &arguments, &["exists; nothing was overwritten"]);
    }
    let svg = read(&folder.path().join("m.svg"));
    assert!(svg.contains("spot-3") && svg.contains("RNE in thousandths of nats"), "{svg}");
    refused(&["trust", &path, "--out", "m.gif"], "--out: must end with .svg or .png or .pdf, found m.gif");
}

#[test]
fn one_robot_and_two_hundred_are_a_team() {
    let one = matrix("id,hp\nonly,3\n", &[]);
    assert_eq!(one["distrust"], value!([{"from \\ to": "only", "only": 0.0}]));
    let row = |i: usize| format!("robot-{i};{};{},5\n", i % 7 + 1, i % 11);
    let many = format!("id;hp;v\n{}", (0..200).map(row).collect::<String>());
    let (folder, path) = table(&many);
    let told = succeeds(&usar(folder.path(), &["trust", &path, "--out", "many.svg"]));
    assert!(told.contains("trusts most") && told.lines().all(|line| line.chars().count() < 110), "{told}");
    let groups = matrix(&many, &["--policy", "RNE"]);
    let size = |task: usize| groups["groups"][task]["robot"].as_array().unwrap().len();
    assert_eq!((size(0), size(1)), (100, 100));
    let decision: teaming::Decision = serde_json::from_value(groups["decision"][0].clone()).unwrap();
    assert!(!decision.proven_optimal);
    let told = succeeds(&usar(folder.path(), &["trust", &path, "--policy", "RNE"]));
    assert!(told.contains("not proven optimal"), "{told}");
    let crowd: Vec<String> = (0..501).map(|i| format!("{i},1\n")).collect();
    let crowd = format!("id,hp\n{}", crowd.concat());
    let (_folder, path) = table(&crowd);
    refused(&["trust", &path], "must have 1 to 500 robots, found 501");
}

#[test]
fn a_policy_groups_a_table_by_the_names_of_its_robots() {
    let (folder, path) = table(TABLE);
    for policy in ["RNE", "ENG", "HP_DIS", "DIS", "RANDOM"] {
        let tasks = ["--task", "near,1,73,51", "--task", "far,2,15,64"];
        let answer = json(&[&["trust", &path, "--policy", policy, "--json"], &tasks[..]].concat());
        let (answer, decision) = (&answer["tables"]["groups"], &answer["tables"]["decision"][0]);
        assert!(serde_json::from_value::<teaming::Decision>(decision.clone()).is_ok(), "{answer}");
        let ids = |task: usize| {
            let of = |role: &str| answer[task][role].as_array().unwrap().iter();
            let ids = ["carrier", "supplier", "observer"].into_iter().flat_map(of);
            ids.map(|id| id.as_str().unwrap().to_owned()).collect::<Vec<_>>()
        };
        let mut all = [ids(0), ids(1)].concat();
        all.sort_unstable();
        assert_eq!(all, ["1", "2", "3", "4", "5", "6"], "{policy}");
        if policy == "ENG" {
            assert_eq!(ids(1), ["1", "3", "5"]);
            assert_eq!(decision["assignment"]["groups"][1], value!([1, 3, 5]));
        }
        assert_eq!(decision["score"].is_null(), policy != "RNE", "{policy}");
    }
    // The robots with more energy take the harder task.
    let texts = TABLE.replace("\n1,", "\nspot-2,").replace("\n5,", "\nhusky,");
    let answer = matrix(&texts, &["--policy", "ENG"]);
    let first = value!({"task": "first", "carrier": ["spot-2"], "supplier": ["3"], "observer": ["husky"]});
    assert_eq!(answer["groups"][0], first);
    let told = succeeds(&usar(folder.path(), &["trust", &path, "--policy", "ENG", "--format", "csv"]));
    assert_eq!(told, "task,carrier,supplier,observer\nfirst,1,3,5\nsecond,2,4,6\n");
}

/// The tasks' places are only of use with the robots' places.
#[test]
fn places_and_levels_are_asked_for_by_the_policies_that_need_them() {
    let (_folder, path) = table("id,hp\na,1\nb,2\n");
    let refuse = |more: &str, message: &str| refused(&*format!("trust {path} --policy {more}"), message);
    refuse("DIS", "robots.csv:1: policy DIS needs the place of each task, which is missing; it takes");
    refuse("DIS --task a,1,2,3 --task b,2,3,4", "robots.csv:1: the header lacks x and y: --task has places");
    refuse("ENG", "robots.csv:1: policy ENG needs the energy level, which is missing; it takes levels from");
    refuse("HP_DIS", "columns energy_level and hp_level");
}

#[test]
fn bad_tables_are_refused_with_all_their_problems() {
    let refuse = |text: &str, arguments: &[&str], message: &str| {
        let (_folder, path) = table(text);
        refused(&[&["trust", path.as_str()], arguments].concat(), message);
    };
    refuse("", &[], "robots.csv: is empty\n");
    refuse("name,y\n1,0\n", &[], "lacks id, found name, y\n");
    refuse("id,y\n1,0\n", &[], "robots.csv:1: the header lacks x, but has y\n");
    refuse("id,role,x,y\n1,a,0,0\n", &[], "the header lacks needs");
    refuse(TABLE.lines().next().unwrap(), &[], "robots.csv: must have 1 to 500 robots, found 0");
    let broken = TABLE
        .replace("1,carrier,40,14,90", "1,carrier,,14,-90")
        .replace("2,carrier,43", "2,,nan")
        .replace("4,supplier", "1,supplier")
        .replace("40,60\n", "140,60\n");
    let expected = [
        "robots.csv:2: x: is empty",
        "robots.csv:2: hp: must be a number >= 0, found \"-90\"",
        "robots.csv:3: role: is empty",
        "robots.csv:3: x: must be a finite number, found \"nan\"",
        "robots.csv:3: energy_level: must be a number from 0 to 100, found \"140\"",
        "robots.csv:5: id: must be unique, found \"1\", as in line 2",
        "robots.csv:7: energy_level: must be a number from 0 to 100, found \"140\"",
    ];
    let (folder, path) = table(&broken);
    let output = usar(folder.path(), &["trust", &path, "--out", "m.svg"]);
    let told = String::from_utf8(output.stderr).unwrap();
    let told: Vec<&str> = told.lines().map(|line| &line[line.find("robots").unwrap()..]).collect();
    assert_eq!((output.status.code(), told), (Some(2), expected.to_vec()));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is written");
    refuse("id,hp,v\na,0,0\nb,1,0\n", &[], "robots.csv:2: must have a need above 0, found none");
    refuse(
        "id,hp,v\na,0,1\nb,1,1\n",
        &["--weights", "1,0"],
        "robots.csv:2: robot \"a\": weighted needs must have at least one entry above 0",
    );
    refuse(
        SPOTS,
        &["--less-is-better", "damage=50"],
        ":3: damage: must be a number from 0 to 50, found \"60\"",
    );
    refuse(
        SPOTS,
        &["--less-is-better", "dmg=50"],
        "--less-is-better: must name needs (hp, damage), found \"dmg\"",
    );
    refuse(SPOTS, &["--less-is-better", "hp=50,hp=60"], "\"hp\" is named twice");
    for bad in ["damage", "damage=0", "damage=-1", "damage=inf", "damage=x"] {
        refuse(
            SPOTS,
            &["--less-is-better", bad],
            "must be NEED=WORST with a number above 0, as in damage=100",
        );
    }
}

#[test]
fn bad_options_of_a_table_are_refused() {
    let refuse = |arguments: &[&str], message: &str| {
        let (_folder, path) = table(TABLE);
        refused(&[&["trust", path.as_str()], arguments].concat(), message);
    };
    refuse(
        &["--policy", "NEAREST"],
        "unknown policy \"NEAREST\"; known policies: RNE, DIS, ENG, HP_DIS, RANDOM, OPTIMAL, ",
    );
    refuse(&["--policy", "RNE(score: Most)"], "--policy: policy RNE: ");
    refuse(&["--policy", "RNE", "--out", "x.svg"], "cannot be used with");
    refuse(
        &["--weights", "1,2"],
        "--weights: must have one entry for each need (hp, v, sen, eng, res, cap, obs), found 2",
    );
    refuse(&["--weights", "0,0,0,0,0,0,0"], "--weights: weights must have at least one entry above 0");
    refuse(
        &["--policy", "RNE", "--task", "far"],
        "--task: must be NAME,DIFFICULTY or NAME,DIFFICULTY,X,Y, found \"far\"",
    );
    refuse(&["--task", "far,1"], "--policy <POLICY>");
}

#[test]
fn a_question_in_json_is_answered_in_json() {
    let folder = tempfile::tempdir().unwrap();
    let question = r#"{"schema_version": 3, "round": 1, "roles": ["walker"],
        "needs": [{"name": "hp", "weight": 1.0}], "levels": [{"name": "energy", "unit": "%"}],
        "tasks": [{"name": "a", "difficulty": 1}, {"name": "b", "difficulty": 3},
            {"name": "c", "difficulty": 2}], "quotas": [{"members": [1, 1, 1], "sizes": "Parts"}],
        "history": [], "members": [{"id": 4, "role": 0, "home": [0, 0], "needs": [1.0], "levels": [10.0]},
            {"id": 2, "role": 0, "home": [0, 0], "needs": [2.0], "levels": [90.0]},
            {"id": 7, "role": 0, "home": [0, 0], "needs": [3.0], "levels": [50.0]}],
        "random_seed": "0000000000000000000000000000000000000000000000000000000000000000"}"#;
    let path = folder.path().join("question.json");
    std::fs::write(&path, question).unwrap();
    let path = path.to_str().unwrap();
    let answer = json(&["trust", path, "--policy", "ENG", "--json"]);
    assert_eq!(answer["assignment"]["groups"], serde_json::json!([[4], [2], [7]]));
    assert_eq!(answer["account"]["Ranking"]["roles"][0][0]["id"], 2);
    // Without a policy, its trust: of one need, shares are the same.
    let matrix = json(&["trust", path, "--json"]);
    let row = serde_json::json!({"from \\ to": "7", "2": 0.0, "4": 0.0, "7": 0.0});
    assert_eq!(matrix["tables"]["distrust"][2], row);
    refused(&["trust", path, "--weights", "1"], "--weights and --less-is-better are for tables");
    std::fs::write(path, question.replace("\"round\"", "\"rounds\"")).unwrap();
    refused(&["trust", path], "question.json: not the JSON of a question: unknown field `rounds`");
}
