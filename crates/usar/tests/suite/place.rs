//! A folder with sweeps to run, and functions that examine their results.

use std::path::{Path, PathBuf};

use crate::support::{Words, read, root, usar};

/// A folder with `short.ron`, the paper's scenario for half a minute, and `grid.ron`, a sweep file for it.
pub fn place() -> tempfile::TempDir {
    let text = read(&root().join("scenarios/paper.ron"));
    let folder = tempfile::tempdir().unwrap();
    let text = text.replace("duration_s: 600.0", "duration_s: 30.0");
    std::fs::write(folder.path().join("short.ron"), text).unwrap();
    let sweep = "(name: \"paper\", scenario: \"short.ron\", policies: \
        [\"RNE\", \"DIS\", \"ENG\", \"HP_DIS\"], trials: 10)";
    std::fs::write(folder.path().join("short.sweep.ron"), sweep).unwrap();
    let grid = "(
    name: \"grid\",
    description: \"faster carriers\",
    scenario: \"short.ron\",
    set: {\"mission.loading_s\": 1.0},
    policies: [\"RNE\", \"sum=RNE(score: Sum)\", \"DIS\"],
    trials: 2,
    axes: {
        \"roles.carrier.speed_mps\": [1.5, 3.0],
        \"conflicts.priority\": [LowestEnergyFirst, HighestEnergyFirst],
    },
)";
    std::fs::write(folder.path().join("grid.ron"), grid).unwrap();
    folder
}

/// The place of a column in a folder's `trials.csv`.
pub fn column(results: &Path, name: &str) -> usize {
    let mut table = csv::Reader::from_path(results.join("trials.csv")).unwrap();
    table.headers().unwrap().iter().position(|column| column == name).unwrap()
}

pub fn rows(folder: &Path, table: &str) -> Vec<csv::StringRecord> {
    csv::Reader::from_path(folder.join(table)).unwrap().records().map(Result::unwrap).collect()
}

/// Checks that the command ends with this status and a message that contains all of these, and leaves the
/// folder of results unchanged.
#[track_caller]
pub fn refused(folder: &Path, status: i32, arguments: &(impl Words + ?Sized), messages: &[&str]) {
    let results = folder.join("results");
    let content = |path: &Path| if path.is_dir() { format!("{:?}", tree(path)) } else { String::new() };
    let before = content(&results);
    let output = usar(folder, arguments);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{arguments:?}: {stderr}");
    for message in messages {
        assert!(stderr.contains(message), "{arguments:?} must say {message:?}, said {stderr:?}");
    }
    assert!(before == content(&results), "{arguments:?} changed the results");
}

fn tree(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut entries: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    let content = |path: &PathBuf| {
        if path.is_dir() { tree(path) } else { vec![(path.clone(), std::fs::read(path).unwrap())] }
    };
    entries.iter().flat_map(content).collect()
}
