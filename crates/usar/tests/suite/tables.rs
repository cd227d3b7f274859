//! Variants of a scenario, the dictionary of the tables, and the long table.

use crate::place::{column, place, refused, rows};
use crate::support::{succeeds, usar};

/// Six, four and two robots of three roles on full graphs, as an independent program counts their messages.
#[test]
fn rounds_have_what_robots_would_send() {
    let folder = place();
    let here = folder.path();
    let sweep = "sweep short.ron --policies GREEDY(protocol:Cbba),DIS --trials 1 --quiet --out sent";
    succeeds(&usar(here, sweep));
    let sent = |row: csv::StringRecord| [0, 14, 15, 16].map(|column| row[column].to_owned());
    let sent: Vec<[String; 4]> = rows(&here.join("sent"), "rounds.csv").into_iter().map(sent).collect();
    assert_eq!(sent.len(), 4, "a round of two groups under each policy");
    assert!(sent[..2].iter().all(|row| row[1..] == ["7", "276", "24192"]), "{sent:?}");
    assert!(sent[2..].iter().all(|row| row == &["DIS", "", "", ""]), "{sent:?}");
}

#[test]
fn variants_set_several_fields_at_once_and_are_an_axis() {
    let folder = place();
    let here = folder.path();
    let write = |variants: &str| {
        let text = format!(
            "(name: \"varied\", scenario: \"short.ron\", policies: [\"RNE\", \"DIS\"], trials: 2,\n \
             variants: {variants})"
        );
        std::fs::write(here.join("varied.ron"), text).unwrap();
    };
    write(
        "{\"as it is\": {}, \"calm\": {\"radiation\": [], \"debris\": []}, \"faster\": \
         {\"roles.carrier.speed_mps\": 3.0}}",
    );
    succeeds(&usar(here, "sweep varied.ron --quiet"));
    let results = here.join("results/varied");
    let trials = rows(&results, "trials.csv");
    let of = |variant: &str| -> Vec<csv::StringRecord> {
        trials.iter().filter(|row| &row[1] == variant).cloned().collect()
    };
    assert_eq!([of("as it is").len(), of("calm").len(), of("faster").len()], [4; 3]);
    let hash = |row: &csv::StringRecord| row[column(&results, "state_hash")].to_owned();
    assert_ne!(hash(&of("as it is")[0]), hash(&of("calm")[0]));
    // The case equals the scenario changed by --set, and the folder's own file reproduces it.
    let alone = [
        "run",
        "short.ron",
        "--policy",
        "RNE",
        "--seed",
        "1",
        "--json",
        "--set",
        "radiation=[]",
        "--set",
        "debris=[]",
    ];
    let alone: serde_json::Value = serde_json::from_str(&succeeds(&usar(here, &alone))).unwrap();
    assert_eq!(alone["state_hash"], hash(&of("calm")[0]));
    succeeds(&usar(&results, "sweep sweep.ron --quiet --out again"));
    assert_eq!(rows(&results.join("again"), "trials.csv"), trials);
    succeeds(&usar(here, "sweep varied.ron --quiet"));
    let told = succeeds(&usar(here, "compare results/varied --wide"));
    assert!(
        told.contains("By how much these differences change: rescuees.total") && told.contains("│ calm "),
        "{told}"
    );
    refused(
        here,
        2,
        "sweep varied.ron --set radiation=[]",
        &["--set: radiation is on an axis of this sweep"],
    );
    write("{\"as it is\": {}, \"the same\": {}}");
    refused(
        here,
        2,
        "sweep varied.ron",
        &["varied.ron:2: variants.\"the same\": is the same scenario as a variant before it"],
    );
    write("{\"wrong\": {\"rolls\": 1}}");
    refused(here, 2, "sweep varied.ron", &["varied.ron:2: variants.\"wrong\".\"rolls\": "]);
}

#[test]
fn every_column_of_every_table_is_in_the_dictionary() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, "sweep grid.ron --quiet --trials 1"));
    let results = here.join("results/grid");
    let package: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(results.join("datapackage.json")).unwrap()).unwrap();
    let text = std::fs::read_to_string(results.join("columns.md")).unwrap();
    let resources = package["resources"].as_array().unwrap();
    assert_eq!(resources.len(), 7);
    for resource in resources {
        let table = resource["path"].as_str().unwrap();
        let mut rows = csv::Reader::from_path(results.join(table)).unwrap();
        let header: Vec<String> = rows.headers().unwrap().iter().map(str::to_owned).collect();
        let fields = resource["schema"]["fields"].as_array().unwrap();
        let names: Vec<&str> = fields.iter().map(|field| field["name"].as_str().unwrap()).collect();
        assert_eq!(names, header, "{table}");
        for field in fields {
            let (name, meaning) = (field["name"].as_str().unwrap(), field["description"].as_str().unwrap());
            assert!(meaning.ends_with('.'), "{table}: {name}: {meaning:?}");
            assert!(text.contains(&format!("| `{name}` | ")), "{table}: {name}");
        }
        // Cells have the types that the dictionary states.
        for row in rows.records().map(Result::unwrap) {
            for (field, cell) in fields.iter().zip(&row).filter(|(_, cell)| !cell.is_empty()) {
                let is_sound = match field["type"].as_str().unwrap() {
                    "integer" => cell.parse::<u64>().is_ok(),
                    "number" => cell.parse::<f64>().is_ok(),
                    "boolean" => ["true", "false"].contains(&cell),
                    _ => true,
                };
                assert!(is_sound, "{table}: {field}: {cell}");
            }
        }
    }
    assert!(text.contains("Of the task \"hard\" alone."), "{text}");
}

#[test]
fn the_long_table_has_every_value_once() {
    let folder = place();
    let here = folder.path();
    succeeds(&usar(here, "sweep grid.ron --quiet --trials 1 --set duration_s=120"));
    let text = succeeds(&usar(here, "export results/grid --to -"));
    let mut table = csv::Reader::from_reader(text.as_bytes());
    let header: Vec<String> = table.headers().unwrap().iter().map(str::to_owned).collect();
    let expected = [
        "case",
        "roles.carrier.speed_mps",
        "conflicts.priority",
        "policy",
        "trial",
        "seed",
        "round",
        "task",
        "metric",
        "value",
    ];
    assert_eq!(header, expected);
    let long: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let find = |case: &str, policy: &str, [round, task, metric]: [&str; 3]| -> Vec<String> {
        let is_it = |row: &&csv::StringRecord| {
            [&row[0], &row[3], &row[6], &row[7], &row[8]] == [case, policy, round, task, metric]
        };
        long.iter().filter(is_it).map(|row| row[9].to_owned()).collect()
    };
    let results = here.join("results/grid");
    for row in rows(&results, "trials.csv") {
        let (case, policy) = (&row[0], &row[3]);
        for (metric, task, name) in [
            ("distance_m", "", "distance_m"),
            ("rescuees", "hard", "rescuees_hard"),
            ("energy", "", "energy_total"),
        ] {
            assert_eq!(
                find(case, policy, ["", task, metric]),
                [row[column(&results, name)].to_owned()],
                "{name}"
            );
        }
    }
    for row in rows(&results, "rounds.csv").iter().filter(|row| &row[3] == "DIS") {
        let header = csv::Reader::from_path(results.join("rounds.csv")).unwrap().headers().unwrap().clone();
        let cell = |name: &str| row[header.iter().position(|column| column == name).unwrap()].to_owned();
        assert_eq!(find(&row[0], "DIS", [&cell("round"), &cell("task"), "energy"]), [cell("energy")]);
    }
    succeeds(&usar(here, "export results/grid --to tidy.csv"));
    assert_eq!(std::fs::read_to_string(here.join("tidy.csv")).unwrap(), text);
    refused(here, 2, "export results/grid --to tidy.csv", &["tidy.csv exists; nothing was overwritten"]);
}

#[test]
fn many_policies_are_rows() {
    let folder = place();
    let labels: Vec<String> = (1..=9).map(|i| format!("nearest-{i}=DIS")).collect();
    let policies = labels.join(",");
    let told = succeeds(&usar(
        folder.path(),
        &["sweep", "short.ron", "--trials", "1", "--policies", &policies, "--quiet"],
    ));
    let row = |start: &str| told.lines().filter(|line| line.starts_with(start)).count();
    assert_eq!(
        [row("│ policy"), row("│ nearest-1"), row("│ nearest-9"), row("│ rescuees")],
        [1, 1, 1, 0],
        "{told}"
    );
    assert!(told.lines().next().unwrap().chars().count() < 300, "{told}");
}
