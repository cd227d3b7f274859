//! Scenario files from the result of a calibration: the calibrated world, and, as variants of it, the
//! best worlds of all readings.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use ron_tree::{Node, edited};

const HEADER: &str = "\
// The paper's experiment in a world that costs what the authors recorded: paper.ron with its free values
// fitted to their ten trials of the distance baseline (scenarios/reference/dis_trials.csv). How, how well,
// and what does not fit: docs/calibration.md.
//
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

/// Writes `paper-calibrated.ron`, the candidate in the first folder, and `when-a-robot-rests.ron`: a sweep over
/// the best candidate of each reading, as variants of it.
///
/// # Panics
/// A scenario is not what a calibration wrote, or the disk does not take the files.
pub fn write_worlds(out: &Path, chosen: &Path, best: &[PathBuf]) {
    let text = |folder: &Path| {
        std::fs::read_to_string(folder.join("calibrated.ron")).expect("a finished calibration")
    };
    let chosen = text(chosen);
    let mut sweep = READINGS.to_owned();
    for folder in best {
        let name = folder.file_name().expect("a finalist's name").to_string_lossy();
        let changes = changes(&chosen, &text(folder));
        let end = if changes.is_empty() { "" } else { "\n        " };
        writeln!(sweep, "        {name:?}: {{{changes}{end}}},").expect("memory");
    }
    sweep.push_str("    },\n)\n");
    std::fs::write(out.join("when-a-robot-rests.ron"), sweep).expect("the folder takes a file");
    std::fs::write(out.join("paper-calibrated.ron"), named(&chosen)).expect("the folder takes a file");
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
    fn the_choice_is_a_scenario_and_the_best_of_each_reading_are_its_variants() {
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
        let best = [candidate("home-1", "3.0"), candidate("once-2", "4.0")];
        write_worlds(place.path(), &best[1], &best);
        let read = |name: &str| std::fs::read_to_string(place.path().join(name)).unwrap();
        let expected = "// [paper] legend\n(\n    format: 2,\n    name: \"paper-calibrated\",\n    mission: \
            (rest_s: 4.0), // [paper]\n)\n";
        assert_eq!(read("paper-calibrated.ron"), HEADER.to_owned() + expected);
        let expected = "        \"home-1\": {\n            \"mission.rest_s\": 3.0,\n        },\n        \
            \"once-2\": {},\n    },\n)\n";
        assert_eq!(read("when-a-robot-rests.ron"), READINGS.to_owned() + expected);
    }
}
