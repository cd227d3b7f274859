//! The folder of a sweep's results: resumable at any moment, and the same bytes in the end.
//!
//! `journal.jsonl` takes each trial as it is done; when all are done, the tables are made from it. The manifest says what the sweep is from
//! the first moment on, so that the same command goes on with it and another is refused.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use usar_sim::scenario::Scenario;
use xxhash_rust::xxh3::Xxh3;

use super::journal::{self, Damage, Journal, Place};
use super::links::{self, LinkRow};
use super::rows::{GroupRow, RobotRow, RoundRow, SeriesRow, TrialRow};
use super::tables::{FileHash, NewFile, Table, columns};
use super::trial::{Outcome, TrialKey};
use crate::experiment::{Experiment, Parts, Program, Shard};
use crate::failure::Failure;
use crate::metric::{METRICS, measure};
use crate::provenance::{Manifest, SCHEMA_VERSION, scenario_differences};

const MANIFEST: &str = "manifest.json";
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
/// Held by the process that writes to the folder.
pub(crate) const LOCK: &str = ".lock";
/// Every metric of every trial.
const METRICS_FILE: &str = "metrics.csv";
const TABLES: [&str; 6] = ["trials.csv", "rounds.csv", "groups.csv", "robots.csv", "series.csv", links::FILE];

/// Damaged lines of a journal that are named.
const MAX_DAMAGES: usize = 5;

/// A sweep's folder with what is finished in it.
pub struct Folder {
    path: PathBuf,
    experiment: Arc<Experiment>,
    manifest: Manifest,
    journal: Journal,
    results: BTreeMap<Place, Measured>,
    /// Held until the folder is dropped.
    _lock: Option<File>,
}

/// What comparisons need of a trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Its status in one word.
    pub status: &'static str,
    /// Values of all metrics, in the order of [`crate::metric::METRICS`]; `None` for a trial without numbers.
    pub metrics: Option<Vec<Option<f64>>>,
    /// Why it gave nothing.
    pub failure: Option<String>,
}

impl Measured {
    fn of(outcome: &Outcome) -> Self {
        Self { status: outcome.status(), metrics: outcome.record().map(measure), failure: outcome.failure() }
    }
}

/// How a folder is opened to be written.
#[derive(Debug, Clone, Copy, Default)]
pub struct Opening {
    /// The part of the sweep to run.
    pub shard: Option<Shard>,
    /// Start over: what is there of another sweep is deleted.
    pub is_fresh: bool,
}

impl Folder {
    /// Opens the folder of a new sweep, or of one that was broken off or is to be extended. What is to be said about it goes to `say`.
    ///
    /// # Errors
    /// It belongs to something else; the folder cannot be used; another process uses it.
    pub fn open(
        path: &Path,
        experiment: Arc<Experiment>,
        opening: Opening,
        say: &mut dyn FnMut(String),
    ) -> Result<Self, Failure> {
        check_is_ours(path)?;
        let trouble = |error| Failure::storage(format!("cannot write to {}: {error}", path.display()));
        fs::create_dir_all(path).map_err(trouble)?;
        path.parent().map_or(Ok(()), sync_folder)?;
        let lock = lock(path)?;
        if opening.is_fresh {
            clear(path).map_err(trouble)?;
        }
        let manifest = Manifest::new(&experiment, opening.shard, Vec::new());
        let mut finished = None;
        if let Some(there) = read_manifest(path)? {
            check_continues(path, &there, &manifest, &experiment.base.resolved())?;
            let broken = broken_files(path, &there);
            for name in &broken {
                let name = path.join(name);
                say(format!(
                    "{}: does not have the checksum of the manifest; it is made again",
                    name.display()
                ));
            }
            let is_same = there.is_complete && there.started() == manifest;
            finished = (is_same && broken.is_empty()).then_some(there);
        } else if path.join(journal::FILE).exists() {
            return Err(Failure::storage(format!(
                "{}: has a journal but no {MANIFEST}, so what it is of is not known; --fresh starts over",
                path.display()
            )));
        }
        if let Some(manifest) = finished {
            let mut damaged = false;
            let mut note = |_| damaged = true; // it is said below
            let folder = Self::with_journal(path, Arc::clone(&experiment), manifest, true, &mut note)?;
            let missing = folder.experiment.keys(opening.shard).any(|key| !folder.has(&key));
            if !damaged && !missing {
                return Ok(Self { _lock: Some(lock), ..folder });
            }
        }
        // What the journal is of is on disk before the journal.
        let manifest = write_start(path, &experiment, opening.shard)?;
        let folder = Self::with_journal(path, experiment, manifest, true, &mut |damage| say(again(damage)))?;
        Ok(Self { _lock: Some(lock), ..folder })
    }

    /// Reads a folder, complete or not.
    ///
    /// # Errors
    /// It is not the folder of a sweep, or its files are damaged.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let not_one = |reason: &dyn std::fmt::Display| {
            Failure::input(format!("{}: is not the folder of a sweep: {reason}", path.display()))
        };
        if !path.is_dir() {
            return Err(not_one(&"there is no such folder"));
        }
        let manifest = read_manifest(path)?.ok_or_else(|| not_one(&format!("{MANIFEST} is missing")))?;
        if manifest.schema_version != SCHEMA_VERSION {
            return Err(not_one(&format!(
                "its layout has version {}; this program reads version {SCHEMA_VERSION}",
                manifest.schema_version
            )));
        }
        let experiment = Arc::new(experiment_of(path, &manifest)?);
        let broken = broken_files(path, &manifest);
        let mut damages = Vec::new();
        let folder =
            Self::with_journal(path, experiment, manifest, false, &mut |damage| damages.push(damage))?;
        if !broken.is_empty() {
            damages.push(format!(
                "{}: these files do not have the checksums of the manifest: {}; the sweep's command makes them again",
                path.display(),
                broken.join(", ")
            ));
        }
        if damages.is_empty() { Ok(folder) } else { Err(Failure::input(damages.join("\n"))) }
    }

    fn with_journal(
        path: &Path,
        experiment: Arc<Experiment>,
        manifest: Manifest,
        is_writable: bool,
        say: &mut dyn FnMut(String),
    ) -> Result<Self, Failure> {
        let mut results = BTreeMap::new();
        let (journal, damages) = Journal::open(path, &experiment, is_writable, |outcome| {
            let TrialKey { case, policy, trial, .. } = outcome.key;
            results.insert((case, policy, trial), Measured::of(&outcome));
        })?;
        // A sweep that is under way may be writing its last line.
        let may_write = !is_writable && !manifest.is_complete;
        let damages: Vec<Damage> =
            damages.into_iter().filter(|damage| !(may_write && damage.is_cut_off)).collect();
        let count = damages.len();
        damages.into_iter().take(MAX_DAMAGES).for_each(|damage| say(damage.what));
        if count > MAX_DAMAGES {
            say(format!("{}: {} further lines cannot be used", path.display(), count - MAX_DAMAGES));
        }
        Ok(Self { path: path.to_owned(), experiment, manifest, journal, results, _lock: None })
    }

    /// Goes on with more trials of the same sweep.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn extend(&mut self, experiment: Arc<Experiment>) -> Result<(), Failure> {
        self.manifest = write_start(&self.path, &experiment, self.manifest.shard)?;
        self.experiment = experiment;
        Ok(())
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it is of.
    #[must_use]
    pub fn experiment(&self) -> &Experiment {
        &self.experiment
    }

    /// What it is of, to share with threads.
    #[must_use]
    pub fn shared_experiment(&self) -> Arc<Experiment> {
        Arc::clone(&self.experiment)
    }

    /// Its manifest.
    #[must_use]
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// What is finished, by place.
    #[must_use]
    pub fn results(&self) -> &BTreeMap<Place, Measured> {
        &self.results
    }

    /// Whether a trial is finished.
    #[must_use]
    pub fn has(&self, key: &TrialKey) -> bool {
        self.journal.has(key)
    }

    /// A finished trial.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub fn outcome(&mut self, place: Place) -> Result<Outcome, Failure> {
        self.journal.outcome(place, &self.experiment)
    }

    /// Its line in the journal.
    ///
    /// # Errors
    /// The journal cannot be read.
    pub fn line(&mut self, place: Place) -> Result<Vec<u8>, Failure> {
        self.journal.line(place)
    }

    /// Takes a trial: when this returns, it is on disk.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add(&mut self, outcome: &Outcome) -> Result<(), Failure> {
        self.journal.add(&self.experiment, outcome)?;
        let TrialKey { case, policy, trial, .. } = outcome.key;
        self.results.insert((case, policy, trial), Measured::of(outcome));
        Ok(())
    }

    /// Takes the line of a trial from another folder.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add_line(&mut self, line: &[u8], place: Place, measured: Measured) -> Result<(), Failure> {
        self.journal.append(line, place)?;
        self.results.insert(place, measured);
        Ok(())
    }

    /// What is to be said when the sweep was stopped.
    #[must_use]
    pub fn interrupted(&self) -> Failure {
        let (done, path) = (self.results.len(), self.path.display());
        Failure::Interrupted(format!(
            "stopped; {done} finished trials are in {path}, and the same command goes on"
        ))
    }

    /// Makes all tables from the journal.
    fn tables(&mut self, stop: &AtomicBool) -> Result<Vec<FileHash>, Failure> {
        let experiment = Arc::clone(&self.experiment);
        let mut tables = Tables::new(&self.path, &experiment)?;
        for place in self.journal.places().collect::<Vec<_>>() {
            if stop.load(Ordering::Relaxed) {
                return Err(self.interrupted());
            }
            tables.add(&self.outcome(place)?, &experiment)?;
        }
        tables.finish()
    }

    /// `metrics.csv`: every metric of every trial that has numbers.
    fn metrics_table(&self) -> Result<FileHash, Failure> {
        let axes = self.experiment.axes.iter().map(|axis| axis.path.clone()).collect();
        let mut table = Table::new(&self.path, METRICS_FILE, axes)?;
        let header: Vec<&str> =
            ["policy", "trial", "seed"].into_iter().chain(METRICS.iter().map(|metric| metric.name)).collect();
        for ((case, policy, trial), measured) in &self.results {
            let Some(metrics) = &measured.metrics else { continue };
            let key = self.experiment.key((*case, *policy, *trial));
            let cell = |value: &Option<f64>| value.map_or(String::new(), |value| value.to_string());
            let row = [key.label, trial.to_string(), key.seed.to_string()]
                .into_iter()
                .chain(metrics.iter().map(cell));
            let row: Vec<String> = row.collect();
            let values = &self.experiment.cases[*case].values;
            table.add_record((*case, values), &header, row.iter().map(String::as_str))?;
        }
        table.finish(&header)
    }

    /// Makes the tables, unless they are there already.
    ///
    /// # Errors
    /// The disk does not take them, or `stop` was set: the same command makes them.
    pub fn finish(&mut self, stop: &AtomicBool) -> Result<(), Failure> {
        if self.manifest.is_complete {
            return Ok(());
        }
        self.journal.tidy()?;
        let finished = self.tables(stop)?;
        self.manifest.files.extend(finished);
        let journal = self.path.join(journal::FILE);
        let hash = file_hash(&journal)
            .map_err(|error| Failure::storage(format!("{}: {error}", journal.display())))?;
        self.manifest.files.push(self.metrics_table()?);
        self.manifest.files.push(FileHash { name: journal::FILE.into(), xxh3_128: hash });
        self.manifest.is_complete = true;
        write_manifest(&self.path, &self.manifest)
    }
}

/// The tables on their way; of a lean sweep the first two only.
struct Tables {
    trials: Table,
    rounds: Table,
    large: Option<Large>,
}

/// The tables that a lean sweep leaves out.
struct Large {
    groups: Table,
    robots: Table,
    series: Table,
    hashes: Table,
}

impl Tables {
    fn new(path: &Path, experiment: &Experiment) -> Result<Self, Failure> {
        let axes: Vec<String> = experiment.axes.iter().map(|axis| axis.path.clone()).collect();
        let table = |place: usize| Table::new(path, TABLES[place], axes.clone());
        let large = || {
            Ok::<_, Failure>(Large {
                groups: table(2)?,
                robots: table(3)?,
                series: table(4)?,
                hashes: table(5)?,
            })
        };
        let large = if experiment.is_lean { None } else { Some(large()?) };
        Ok(Self { trials: table(0)?, rounds: table(1)?, large })
    }

    fn add(&mut self, outcome: &Outcome, experiment: &Experiment) -> Result<(), Failure> {
        let number = outcome.key.case;
        let case = (number, experiment.cases[number].values.as_slice());
        self.trials.add(case, &TrialRow::new(outcome, experiment))?;
        RoundRow::of(outcome).try_for_each(|row| self.rounds.add(case, &row))?;
        let Some(large) = &mut self.large else { return Ok(()) };
        let duration_s = experiment.cases[number].scenario.duration_s;
        GroupRow::of(outcome).try_for_each(|row| large.groups.add(case, &row))?;
        RobotRow::of(outcome).try_for_each(|row| large.robots.add(case, &row))?;
        SeriesRow::of(outcome, duration_s).try_for_each(|row| large.series.add(case, &row))?;
        LinkRow::of(outcome).try_for_each(|row| large.hashes.add(case, &row))
    }

    fn finish(self) -> Result<Vec<FileHash>, Failure> {
        let mut files =
            vec![self.trials.finish(&columns::<TrialRow>()?)?, self.rounds.finish(&columns::<RoundRow>()?)?];
        if let Some(large) = self.large {
            files.push(large.groups.finish(&columns::<GroupRow>()?)?);
            files.push(large.robots.finish(&columns::<RobotRow>()?)?);
            files.push(large.series.finish(&columns::<SeriesRow>()?)?);
            files.push(large.hashes.finish(&columns::<LinkRow>()?)?);
        }
        Ok(files)
    }
}

fn again(damage: String) -> String {
    damage + "; what it held is run again"
}

/// Writes what a sweep is of.
fn write_start(path: &Path, experiment: &Experiment, shard: Option<Shard>) -> Result<Manifest, Failure> {
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

fn write_manifest(path: &Path, manifest: &Manifest) -> Result<(), Failure> {
    NewFile::write(path, MANIFEST, manifest.text()?.as_bytes())?;
    sync_folder(path)
}

/// The names of files are on disk when their folder is.
fn sync_folder(path: &Path) -> Result<(), Failure> {
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    let synced = File::open(path).and_then(|folder| folder.sync_all());
    synced.map_err(|error| Failure::storage(format!("{}: {error}", path.display())))
}

/// The names of all files that a sweep writes.
fn known_names() -> impl Iterator<Item = &'static str> {
    [MANIFEST, LOCK, journal::FILE, REPORT].into_iter().chain(INPUTS).chain(TABLES).chain([METRICS_FILE])
}

/// Refuses a folder that is not a sweep's: one with a manifest or a journal of this program, or with nothing but what a sweep writes first.
fn check_is_ours(path: &Path) -> Result<(), Failure> {
    if !path.exists() {
        return Ok(());
    }
    if !path.is_dir() {
        return Err(Failure::input(format!("--out: {} is a file, not a folder", path.display())));
    }
    let manifest = fs::read(path.join(MANIFEST)).unwrap_or_default();
    let manifest: serde_json::Value = serde_json::from_slice(&manifest).unwrap_or_default();
    if manifest["program"] == "usar" || journal::is_one(path) {
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

/// Takes the folder for this process.
pub(crate) fn lock(path: &Path) -> Result<File, Failure> {
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
fn clear(path: &Path) -> std::io::Result<()> {
    for name in known_names().filter(|name| *name != LOCK) {
        remove(&path.join(name))?;
        remove(&path.join(format!("{name}.new")))?;
    }
    let plots = fs::read_dir(path.join(PLOTS)).into_iter().flatten().flatten().map(|entry| entry.path());
    for plot in plots.filter(|plot| plot.extension().is_some_and(|kind| kind == "svg" || kind == "csv")) {
        remove(&plot)?;
    }
    let _ = fs::remove_dir(path.join(PLOTS)); // it stays where something else is in it
    Ok(())
}

fn remove(file: &Path) -> std::io::Result<()> {
    match fs::remove_file(file) {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

fn read_manifest(path: &Path) -> Result<Option<Manifest>, Failure> {
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
fn check_continues(path: &Path, there: &Manifest, now: &Manifest, resolved: &str) -> Result<(), Failure> {
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

struct HashWriter(Xxh3);

impl std::io::Write for HashWriter {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

fn file_hash(path: &Path) -> std::io::Result<String> {
    let mut hash = HashWriter(Xxh3::new());
    std::io::copy(&mut File::open(path)?, &mut hash)?;
    Ok(format!("{:032x}", hash.0.digest128()))
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

/// How many trials a folder's sweep has, if there is one.
#[must_use]
pub fn trials_in(path: &Path) -> Option<u32> {
    read_manifest(path).ok()?.map(|manifest| manifest.trials)
}
