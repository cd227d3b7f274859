//! The folder of a sweep's results. It appears whole or not at all.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;
use usar_sim::scenario::Scenario;

use super::Outcome;
use super::links::{self, LinkRow};
use super::rows::{RobotRow, RoundRow, TrialRow};
use crate::failure::Failure;
use crate::provenance::Manifest;

/// Results on their way to their folder: written beside it, and moved there in one go.
pub struct Draft {
    folder: tempfile::TempDir,
    target: Target,
}

enum Target {
    /// The folder that was asked for.
    Asked(PathBuf),
    /// `results/NAME`, or the first of `results/NAME-2`, `-3`, ... that is free when the results are there.
    Next(PathBuf),
}

impl Draft {
    /// Checks that the results will find their place before they are made.
    ///
    /// # Errors
    /// The folder that was asked for is not empty or is a file, or the place cannot be written to.
    pub fn new(asked: Option<&Path>, name: &str) -> Result<Self, Failure> {
        let target = match asked {
            Some(path) => Target::Asked(check_free(path)?.to_owned()),
            None => Target::Next(Path::new("results").join(name)),
        };
        let path = match &target {
            Target::Asked(path) | Target::Next(path) => path,
        };
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let trouble = |error| Failure::input(format!("cannot write to {}: {error}", parent.display()));
        fs::create_dir_all(parent).map_err(trouble)?;
        let folder = tempfile::Builder::new().prefix(".usar-").tempdir_in(parent).map_err(trouble)?;
        Ok(Self { folder, target })
    }

    /// Writes all files and moves them into place; returns where that is.
    ///
    /// # Errors
    /// The disk does not take them. What was written is kept, and the error says where.
    pub fn publish(self, given: &str, scenario: &Scenario, outcomes: &[Outcome]) -> Result<PathBuf, Failure> {
        let files = files(given, scenario, outcomes)?;
        let draft = self.folder.keep();
        let place = || -> std::io::Result<PathBuf> {
            for (name, content) in files {
                let mut file = fs::File::create(draft.join(name))?;
                file.write_all(&content)?;
                file.sync_all()?;
            }
            make_readable(&draft)?;
            match &self.target {
                Target::Asked(path) => fs::rename(&draft, path).map(|()| path.clone()),
                Target::Next(path) => rename_to_next_free(&draft, path),
            }
        };
        place().map_err(|error| {
            Failure::run(format!(
                "cannot finish the results: {error}; what was written is in {}",
                draft.display()
            ))
        })
    }
}

fn check_free(path: &Path) -> Result<&Path, Failure> {
    if !path.exists() {
        return Ok(path);
    }
    let entries = fs::read_dir(path)
        .map_err(|_| Failure::input(format!("--out: {} is a file, not a folder", path.display())))?;
    if entries.count() > 0 {
        return Err(Failure::input(format!(
            "--out: {} is not empty; nothing was overwritten",
            path.display()
        )));
    }
    Ok(path)
}

fn rename_to_next_free(draft: &Path, first: &Path) -> std::io::Result<PathBuf> {
    let name = first.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let numbered = (2..).map(|n| first.with_file_name(format!("{name}-{n}")));
    for path in std::iter::once(first.to_owned()).chain(numbered).filter(|path| !path.exists()) {
        match fs::rename(draft, &path) {
            // Another sweep took it in the meantime.
            Err(error) if error.kind() == std::io::ErrorKind::DirectoryNotEmpty => {}
            result => return result.map(|()| path),
        }
    }
    Err(std::io::Error::other("no free name is left"))
}

/// Temporary folders are private; results are not.
fn make_readable(folder: &Path) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        fs::set_permissions(folder, fs::Permissions::from_mode(0o755))?;
    }
    Ok(())
}

type File = (&'static str, Vec<u8>);

fn files(given: &str, scenario: &Scenario, outcomes: &[Outcome]) -> Result<Vec<File>, Failure> {
    let resolved =
        ron::ser::to_string_pretty(&**scenario, ron::ser::PrettyConfig::new()).map_err(Failure::run)?;
    let mut files = vec![
        ("experiment.ron", given.as_bytes().to_vec()),
        ("resolved.ron", (resolved + "\n").into_bytes()),
        ("trials.csv", table(outcomes.iter().map(TrialRow::new))?),
        ("rounds.csv", table(outcomes.iter().flat_map(RoundRow::of))?),
        ("robots.csv", table(outcomes.iter().flat_map(RobotRow::of))?),
        (links::FILE, table(outcomes.iter().flat_map(LinkRow::of))?),
    ];
    let manifest = serde_json::to_string_pretty(&Manifest::new(scenario, &files)).map_err(Failure::run)?;
    files.push(("manifest.json", (manifest + "\n").into_bytes()));
    Ok(files)
}

fn table<R: Serialize>(rows: impl Iterator<Item = R>) -> Result<Vec<u8>, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).map_err(Failure::run)?;
    }
    writer.into_inner().map_err(Failure::run)
}
