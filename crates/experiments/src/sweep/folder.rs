//! The folder of a sweep's results. It appears whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;
use usar_sim::scenario::Scenario;

use super::Outcome;
use super::rows::{RobotRow, RoundRow, TrialRow};
use crate::failure::Failure;
use crate::provenance::Manifest;

/// Where the results go: the folder that was asked for, or a new one under `results/`.
///
/// # Errors
/// The folder that was asked for is there and not empty, or is a file.
pub fn target(asked: Option<&Path>, name: &str) -> Result<PathBuf, Failure> {
    match asked {
        None => {
            let base = Path::new("results");
            let numbered = (2..).map(|n| base.join(format!("{name}-{n}")));
            let mut candidates = std::iter::once(base.join(name)).chain(numbered);
            candidates
                .find(|path| !path.exists())
                .ok_or_else(|| Failure::input("no free folder under results/"))
        }
        Some(path) => match fs::read_dir(path) {
            Ok(mut entries) => match entries.next() {
                None => Ok(path.to_owned()),
                Some(_) => Err(Failure::input(format!(
                    "--out: {} is not empty; nothing was overwritten",
                    path.display()
                ))),
            },
            Err(_) if path.exists() => {
                Err(Failure::input(format!("--out: {} is a file, not a folder", path.display())))
            }
            Err(_) => Ok(path.to_owned()),
        },
    }
}

/// Writes all files into a folder beside the target, then moves it into place.
///
/// # Errors
/// The disk does not take it.
pub fn write(target: &Path, given: &str, scenario: &Scenario, outcomes: &[Outcome]) -> Result<(), Failure> {
    let trouble = |error: std::io::Error| Failure::run(format!("cannot write {}: {error}", target.display()));
    let parent = target.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(parent).map_err(trouble)?;
    let draft = tempfile::Builder::new().prefix(".usar-").tempdir_in(parent).map_err(trouble)?;

    let resolved =
        ron::ser::to_string_pretty(&**scenario, ron::ser::PrettyConfig::new()).map_err(Failure::run)?;
    let files = [
        ("experiment.ron", given.as_bytes().to_vec()),
        ("resolved.ron", (resolved + "\n").into_bytes()),
        ("trials.csv", table(outcomes.iter().map(TrialRow::new))?),
        ("rounds.csv", table(outcomes.iter().flat_map(RoundRow::of))?),
        ("robots.csv", table(outcomes.iter().flat_map(RobotRow::of))?),
    ];
    let manifest = Manifest::new(scenario, &files);
    let manifest = serde_json::to_string_pretty(&manifest).map_err(Failure::run)? + "\n";
    let all = files.into_iter().chain([("manifest.json", manifest.into_bytes())]);
    for (name, content) in all {
        let path = draft.path().join(name);
        fs::write(&path, content).map_err(trouble)?;
        fs::File::open(&path).and_then(|file| file.sync_all()).map_err(trouble)?;
    }
    let draft = draft.keep();
    publish(&draft, target).map_err(|error| {
        let _ = fs::remove_dir_all(&draft);
        trouble(error)
    })
}

fn publish(draft: &Path, target: &Path) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        // Temporary folders are private; results are not.
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(draft, fs::Permissions::from_mode(0o755))?;
    }
    fs::rename(draft, target)
}

fn table<R: Serialize>(rows: impl Iterator<Item = R>) -> Result<Vec<u8>, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).map_err(Failure::run)?;
    }
    writer.into_inner().map_err(Failure::run)
}
