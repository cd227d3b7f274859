//! Scenario files from the result of a calibration: the calibrated world, and, as variants of it, the
//! worlds that the data cannot tell apart from it.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use ron_tree::{Node, edited};

/// Finalists that are nearest in at least this share of the draws cannot be told apart from the choice.
const NOT_TOLD_APART: f64 = 0.05;

const HEADER: &str = "\
// The paper's experiment in a world that costs what the authors recorded: paper.ron with its free values
// fitted to their ten trials of the distance baseline (scenarios/reference/dis_trials.csv). How, how well,
// and what does not fit: docs/calibration.md.
//
";

const WORLDS: &str = "\
// The calibrated worlds that the authors' recorded trials cannot tell from scenarios/paper-calibrated.ron:
// what is claimed of it should hold in them as well. Made by `just calibrate`; docs/calibration.md says how.
(
    name: \"calibrated-worlds\",
    scenario: \"../paper-calibrated.ron\",
    policies: [\"RNE\", \"DIS\", \"ENG\", \"HP_DIS\"],
    trials: 50,
    variants: {
";

const READINGS: &str = "\
// For each reading of when a tired robot rests, the world that fits the authors' recorded trials best under it, as
// changes of scenarios/paper-calibrated.ron. Made by `just calibrate`; docs/calibration.md says how well each fits.
(
    name: \"when-a-robot-rests\",
    scenario: \"../paper-calibrated.ron\",
    policies: [\"RNE\", \"DIS\", \"ENG\", \"HP_DIS\"],
    trials: 100,
    first_seed: 600001,
    primary: [\"rescuees.total\", \"rescuees.hard\", \"rescuees.easy\"],
    baseline: \"DIS\",
    margins: {\"rescuees.total\": 5.0, \"rescuees.hard\": 5.0, \"rescuees.easy\": 5.0},
    variants: {
";

/// Writes `paper-calibrated.ron` and `calibrated-worlds.ron`. `choice` is the table of the choice; its
/// first row is the chosen candidate.
///
/// # Panics
/// A table or a scenario is not what a calibration wrote, or the disk does not take the files.
pub fn write_worlds(choice: &Path, folders: &[PathBuf]) {
    let mut table = csv::Reader::from_path(choice).expect("the choice has a table");
    let rows: Vec<csv::StringRecord> = table.records().map(|row| row.expect("a table")).collect();
    let text = |row: &csv::StringRecord| {
        let folder = folders.iter().find(|folder| folder.ends_with(&row[0])).expect("a finalist's name");
        std::fs::read_to_string(folder.join("calibrated.ron")).expect("a finished calibration")
    };
    let (first, others) = rows.split_first().expect("there are finalists");
    let chosen = text(first);
    let mut worlds = WORLDS.to_owned();
    for row in others {
        if row[3].parse::<f64>().expect("a share") >= NOT_TOLD_APART {
            let changes = changes(&chosen, &text(row));
            writeln!(worlds, "        {:?}: {{{changes}\n        }},", &row[0]).expect("memory");
        }
    }
    worlds.push_str("    },\n)\n");
    let out = choice.parent().expect("it is in a folder");
    std::fs::write(out.join("calibrated-worlds.ron"), worlds).expect("the folder takes a file");
    std::fs::write(out.join("paper-calibrated.ron"), named(&chosen)).expect("the folder takes a file");
}

/// Writes `when-a-robot-rests.ron`: a sweep over these worlds, the best of each reading, as variants of the
/// calibrated world of the repository.
///
/// # Panics
/// A scenario is not what a calibration wrote, or the disk does not take the file.
pub fn write_readings(out: &Path, base: &str, folders: &[PathBuf]) {
    let mut sweep = READINGS.to_owned();
    for folder in folders {
        let text = std::fs::read_to_string(folder.join("calibrated.ron")).expect("a finished calibration");
        let name = folder.file_name().expect("a finalist's name").to_string_lossy();
        writeln!(sweep, "        {:?}: {{{}\n        }},", name, changes(base, &text)).expect("memory");
    }
    sweep.push_str("    },\n)\n");
    std::fs::write(out.join("when-a-robot-rests.ron"), sweep).expect("the folder takes a file");
}

/// A candidate's text, with the header and the name of the scenario in the repository. Every policy may run
/// in it.
fn named(text: &str) -> String {
    let legend = text.find("// [paper]").expect("a legend");
    let text = text[legend..].replace(", only_policy: \"DIS\"", "");
    let name = [("name".to_owned(), "\"paper-calibrated\"".to_owned())];
    let text = edited(&text, &name).expect("it has a name");
    HEADER.to_owned() + &text.replacen("(\n", "(\n    format: 2,\n", 1)
}

/// The values in which the second scenario differs from the first, as entries of a variant, one a line.
fn changes(from: &str, to: &str) -> String {
    let [from, to] = [from, to].map(|text| Node::parse(text).expect("a scenario that was run"));
    let is_fixed = |path: &str| ["name", "only_policy", "description"].contains(&path);
    let is_new = |(path, leaf): &(String, &Node)| !is_fixed(path) && from.get(path) != Some(*leaf);
    let entry = |(path, leaf): (String, &Node)| format!("\n            {path:?}: {leaf},");
    to.leaves().into_iter().filter(is_new).map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_choice_is_a_scenario_and_what_cannot_be_told_from_it_are_its_variants() {
        let place = tempfile::tempdir().unwrap();
        let candidate = |name: &str, rest: &str| {
            let folder = place.path().join(name);
            std::fs::create_dir(&folder).unwrap();
            let text = format!(
                "// Fitted\n// Start.\n//\n// [paper] legend\n(\n    name: \"s-fitted\", \
                 only_policy: \"DIS\",\n    mission: (rest_s: {rest}), // [paper]\n)\n"
            );
            std::fs::write(folder.join("calibrated.ron"), text).unwrap();
            folder
        };
        let folders = [candidate("final-1", "3.0"), candidate("final-2", "4.0"), candidate("final-3", "5.0")];
        let choice = place.path().join("choice.csv");
        let table = "candidate,misfit,edge_penalty,share_nearest\n\
            final-2,1,0,0.9\nfinal-1,2,0,0.06\nfinal-3,9,0,0.04\n";
        std::fs::write(&choice, table).unwrap();
        write_worlds(&choice, &folders);
        let read = |name: &str| std::fs::read_to_string(place.path().join(name)).unwrap();
        let expected = "// [paper] legend\n(\n    format: 2,\n    name: \"paper-calibrated\",\n    mission: \
            (rest_s: 4.0), // [paper]\n)\n";
        assert_eq!(read("paper-calibrated.ron"), HEADER.to_owned() + expected);
        let expected =
            "        \"final-1\": {\n            \"mission.rest_s\": 3.0,\n        },\n    },\n)\n";
        assert_eq!(read("calibrated-worlds.ron"), WORLDS.to_owned() + expected);
    }
}
