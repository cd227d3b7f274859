//! What of a sweep's folder is on disk besides its journal and tables: the manifest, the sweep itself, and the lock.

use std::fs::{self, File, TryLockError};
use std::path::Path;

use usar_sim::scenario::Scenario;

use super::journal;
use super::tables::TABLES;
use crate::experiment::{Experiment, Parts, Program, Shard};
use crate::failure::Failure;
use crate::files::{FileHash, NewFile, file_hash};
use crate::provenance::{Manifest, scenario_differences};

pub(super) const MANIFEST: &str = "manifest.json";
const GIVEN: &str = "experiment.ron";
const RESOLVED: &str = "resolved.ron";
/// The sweep as a file over the resolved scenario: what makes the folder again.
const AGAIN: &str = "sweep.ron";
/// Written before anything else.
const INPUTS: [&str; 3] = [GIVEN, RESOLVED, AGAIN];
/// The report, and the folder of its figures.
pub const REPORT: &str = "report.html";
/// See [`REPORT`].
pub const PLOTS: &str = "plots";
/// The folder of recordings of trials.
pub const RECORDINGS: &str = "recordings";
/// Held by the process that writes to the folder.
pub const LOCK: &str = ".lock";

/// Writes what a sweep is of.
pub(super) fn write_start(
    path: &Path,
    experiment: &Experiment,
    shard: Option<Shard>,
) -> Result<Manifest, Failure> {
    let files = vec![
        NewFile::write(path, GIVEN, experiment.given.as_bytes())?,
        NewFile::write(path, RESOLVED, experiment.base.resolved().as_bytes())?,
        NewFile::write(path, AGAIN, experiment.as_sweep_file(RESOLVED)?.as_bytes())?,
    ];
    // A report would be of what was there before.
    let trouble = |error| Failure::storage(format!("cannot write to {}: {error}", path.display()));
    remove(&path.join(REPORT)).map_err(trouble)?;
    let manifest = Manifest::new(experiment, shard, files);
    write_manifest(path, &manifest)?;
    Ok(manifest)
}

pub(super) fn write_manifest(path: &Path, manifest: &Manifest) -> Result<(), Failure> {
    NewFile::write(path, MANIFEST, manifest.text()?.as_bytes())?;
    sync_folder(path)
}

/// The names of files are on disk when their folder is.
pub(super) fn sync_folder(path: &Path) -> Result<(), Failure> {
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    let synced = File::open(path).and_then(|folder| folder.sync_all());
    synced.map_err(|error| Failure::storage(format!("{}: {error}", path.display())))
}

/// The names of all files that a sweep writes.
fn known_names() -> impl Iterator<Item = &'static str> {
    [MANIFEST, LOCK, journal::FILE, REPORT].into_iter().chain(INPUTS).chain(TABLES)
}

/// Refuses a folder that is not a sweep's: one with a manifest or a journal of this program, or with nothing but what a sweep writes first.
pub(super) fn check_is_ours(path: &Path) -> Result<(), Failure> {
    if !path.exists() {
        return Ok(());
    }
    if !path.is_dir() {
        return Err(Failure::input(format!("--out: {} is a file, not a folder", path.display())));
    }
    if is_sweeps(path) || journal::is_one(path) {
        return Ok(());
    }
    let entries = fs::read_dir(path)
        .map_err(|error| Failure::storage(format!("--out: {} cannot be read: {error}", path.display())))?;
    let comes_first =
        |name: &str| name == LOCK || name.strip_suffix(".new").is_some() || INPUTS.contains(&name);
    for entry in entries.flatten() {
        if !comes_first(&entry.file_name().to_string_lossy()) {
            return Err(Failure::input(format!(
                "--out: {} is not empty and not the folder of a sweep; nothing was overwritten",
                path.display()
            )));
        }
    }
    Ok(())
}

/// Takes the folder for this process, until the file is dropped.
///
/// # Errors
/// Another process is at work in it, or it cannot be written to.
pub fn lock(path: &Path) -> Result<File, Failure> {
    let name = path.join(LOCK);
    let trouble = |error| Failure::storage(format!("cannot write to {}: {error}", path.display()));
    let file = File::options().create(true).append(true).open(&name).map_err(trouble)?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => {
            Err(Failure::storage(format!("{}: another process is at work in this folder", path.display())))
        }
        Err(TryLockError::Error(error)) => Err(trouble(error)),
    }
}

/// Deletes what a sweep wrote.
pub(super) fn clear(path: &Path) -> std::io::Result<()> {
    for name in known_names().filter(|name| *name != LOCK) {
        remove(&path.join(name))?;
        remove(&path.join(format!("{name}.new")))?;
    }
    let plots = fs::read_dir(path.join(PLOTS)).into_iter().flatten().flatten().map(|entry| entry.path());
    for plot in plots.filter(|plot| plot.extension().is_some_and(|kind| kind == "svg" || kind == "csv")) {
        remove(&plot)?;
    }
    let _ = fs::remove_dir(path.join(PLOTS)); // it stays where something else is in it
    clear_recordings(&path.join(RECORDINGS))
}

/// Deletes the recordings in a folder and in those of its cases.
fn clear_recordings(folder: &Path) -> std::io::Result<()> {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        if entry.is_dir() {
            clear_recordings(&entry)?;
        } else if entry.extension().is_some_and(|kind| kind == "usrec") {
            remove(&entry)?;
        }
    }
    let _ = fs::remove_dir(folder); // it stays where something else is in it
    Ok(())
}

fn remove(file: &Path) -> std::io::Result<()> {
    match fs::remove_file(file) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

pub(super) fn read_manifest(path: &Path) -> Result<Option<Manifest>, Failure> {
    let name = path.join(MANIFEST);
    let text = match fs::read(&name) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(Failure::storage(format!("{}: {error}", name.display()))),
    };
    Manifest::parse(&text).map(Some).map_err(|reason| {
        let name = name.display();
        Failure::input(format!("{name}: is not a manifest of this program: {reason}; --fresh starts over"))
    })
}

/// Refuses to go on with another sweep, or with fewer trials than there are.
pub(super) fn check_continues(
    path: &Path,
    there: &Manifest,
    now: &Manifest,
    resolved: &str,
) -> Result<(), Failure> {
    let mut differences = there.differences(now);
    if there.shard != now.shard {
        differences.push(format!("shard: {} there, {} now", there.part(), now.part()));
    }
    let old = fs::read_to_string(path.join(RESOLVED)).unwrap_or_default();
    differences.extend(scenario_differences(&old, resolved));
    if now.trials < there.trials {
        differences
            .push(format!("trials: {} there, {} now; trials can only be added", there.trials, now.trials));
    }
    if differences.is_empty() {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{} has results of something else; --out takes another folder, --fresh starts over:\n  {}",
        path.display(),
        differences.join("\n  ")
    )))
}

/// Names of the files that do not have the hashes of the manifest.
#[must_use]
pub fn broken_files(path: &Path, manifest: &Manifest) -> Vec<String> {
    let is_broken = |file: &&FileHash| file_hash(&path.join(&file.name)).ok() != Some(file.xxh3_128.clone());
    manifest.files.iter().filter(is_broken).map(|file| file.name.clone()).collect()
}

/// The experiment that a folder is of.
///
/// # Errors
/// Its resolved scenario cannot be read.
pub fn experiment_of(path: &Path, manifest: &Manifest) -> Result<Experiment, Failure> {
    let (base, _) = Scenario::load(&path.join(RESOLVED)).map_err(Failure::input)?;
    let given = fs::read_to_string(path.join(GIVEN)).unwrap_or_default();
    Experiment::assemble(Parts {
        name: manifest.name.clone(),
        given,
        base,
        axes: manifest.axes.clone(),
        policies: manifest.policies.clone(),
        trials: manifest.trials,
        seeds: manifest.seeds.clone(),
        is_checked: manifest.is_checked,
        is_lean: manifest.is_lean,
        program: Program { version: manifest.version.clone(), source: manifest.source.clone() },
    })
}

/// The experiment of a folder, whatever program made it.
///
/// # Errors
/// It is not the folder of a sweep.
pub fn experiment_in(path: &Path) -> Result<(Experiment, Manifest), Failure> {
    let missing = || Failure::input(format!("{}: is not the folder of a finished sweep", path.display()));
    let manifest = read_manifest(path)?.ok_or_else(missing)?;
    Ok((experiment_of(path, &manifest)?, manifest))
}

/// Whether a folder is that of a sweep, whatever program made it.
#[must_use]
pub fn is_sweeps(path: &Path) -> bool {
    let manifest = fs::read(path.join(MANIFEST)).unwrap_or_default();
    let manifest: serde_json::Value = serde_json::from_slice(&manifest).unwrap_or_default();
    manifest["program"] == "usar"
}

/// The folders of sweeps that are in a folder, by name.
pub(super) fn sweeps_in(path: &Path) -> Vec<String> {
    let entries = fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut sweeps: Vec<String> =
        entries.filter(|entry| is_sweeps(entry)).map(|entry| entry.display().to_string()).collect();
    sweeps.sort();
    sweeps
}

/// How many trials a folder's sweep has, if there is one.
#[must_use]
pub fn trials_in(path: &Path) -> Option<u32> {
    read_manifest(path).ok()?.map(|manifest| manifest.trials)
}
