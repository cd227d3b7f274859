//! Files with distributions and timelines on the command line: `fmt`, `resolve`, `draw`, `run`, snapshots and
//! recordings.

use crate::support::{read, succeeds, usar};

const WORLD: &str = r#"(format: 2, name: "w", duration_s: 20, dt_s: 0.02, arena_m: (30, 30),
    team: [(role: "robot", count: Uniform(2, 3), center: (15, 3), width_m: 4, body: (observing_m: 4))],
    tasks: [(name: "a", difficulty: 1, center: (15, 24), size_m: (4, 2), grid: (2, 2), rest: (6, 8))],
    radiation: [(at: (Uniform(8, 22), 14), radius_m: 2, name: "core")], // a comment
    walls: [(from: (8, 18), to: (30, 18), doors: [(at_m: 7, width_m: 3, name: "gate")])],
    timeline: [(at_s: 5, event: Closes("gate")), (at_s: Uniform(8, 9), event: SourceDies("core")),
        (at_s: 12, event: RobotFails(0))],
)
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("w.ron"), WORLD).unwrap();
    folder
}

#[test]
fn what_a_timeline_asks_for_is_told_and_goes_on_from_a_snapshot() {
    let folder = folder();
    let run = |arguments: &[&str]| succeeds(&usar(folder.path(), arguments));
    run(&["run", "w.ron", "--check", "--quiet", "--events", "e.jsonl", "--record", "w.usrec"]);
    run(&["run", "w.ron", "--quiet", "--save", "w.snapshot", "--save-at", "7"]);
    let events = std::fs::read_to_string(folder.path().join("e.jsonl")).unwrap();
    for kind in ["way_closed", "source_died", "damaged", "disabled"] {
        assert!(events.contains(&format!("\"event\":\"{kind}\"")), "{kind} is missing");
    }
    let hash = |text: &str| serde_json::from_str::<serde_json::Value>(text).unwrap()["state_hash"].clone();
    let whole = run(&["run", "w.ron", "--quiet", "--json"]);
    let rest = run(&["run", "w.ron", "--quiet", "--json", "--resume", "w.snapshot"]);
    assert_eq!(hash(&whole), hash(&rest));
    assert_ne!(hash(&whole), serde_json::Value::Null);
    run(&["export", "w.usrec", "--at", "10", "--to", "frame.svg"]);
    run(&["scenario", "draw", "w.ron", "--seed", "4", "--out", "map.svg"]);
    let map = std::fs::read_to_string(folder.path().join("map.svg")).unwrap();
    assert!(map.contains("w, seed 4"));
}

#[test]
fn resolve_prints_a_distribution_as_one_value_with_its_line() {
    let folder = folder();
    let told = succeeds(&usar(
        folder.path(),
        &["scenario", "resolve", "w.ron", "--set", "radiation[0].radius_m=Uniform(1, 2)"],
    ));
    for says in ["= Uniform(2, 3)  # w.ron:2", "= Uniform(1, 2)  # --set", "= Uniform(8, 22)  # w.ron:4"] {
        assert!(told.contains(says), "{says} is not in\n{told}");
    }
}

#[test]
fn fmt_keeps_values_and_comments_and_writes_only_what_differs() {
    let folder = folder();
    let here = folder.path();
    let wild = WORLD.replace(": ", ":").replace("\n    timeline", "\ntimeline");
    std::fs::write(here.join("wild.ron"), &wild).unwrap();
    assert_eq!(usar(here, "scenario fmt --dry-run wild.ron").status.code(), Some(1));
    assert_eq!(read(&here.join("wild.ron")), wild);
    assert_eq!(succeeds(&usar(here, "scenario fmt w.ron wild.ron")), "wild.ron: written\n");
    assert_eq!(read(&here.join("wild.ron")), WORLD);
    assert_eq!(succeeds(&usar(here, "scenario fmt wild.ron")), "");
    std::fs::write(here.join("wild.ron"), &wild).unwrap();
    std::fs::write(here.join("bad.ron"), "(name: \"o\" conflicts: ())").unwrap();
    assert_eq!(usar(here, "scenario fmt wild.ron bad.ron").status.code(), Some(2));
    assert_eq!(read(&here.join("wild.ron")), wild, "nothing is written if a file cannot be read");
}
