//! `evaluations.csv`: the evaluation at each point of a search or a study. Each line has a checksum. An
//! interrupted command resumes from it.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use xxhash_rust::xxh3::Xxh3;

use crate::failure::Failure;
use crate::files::{self, NewFile};
use crate::sweep::lock::Lock;
use crate::sweep::names;

/// Name of the log.
const LOG: &str = "evaluations.csv";
/// Name of the log's last column.
const CHECKSUM: &str = "xxh3_64";

/// The use of a folder with a log.
#[derive(Debug, Clone, Copy)]
pub struct Purpose {
    /// Its name in messages: `calibration`.
    pub noun: &'static str,
    /// Name of the file that says what the log belongs to.
    pub origin: &'static str,
    /// Names of the files that are made from the log in the end.
    pub results: &'static [&'static str],
}

/// A log, held by one process.
pub struct EvaluationLog {
    path: PathBuf,
    file: File,
    /// Cells of a line, without the checksum.
    columns: usize,
    _lock: Lock,
}

impl EvaluationLog {
    /// Opens a new log, or an existing one to resume; returns the lines that it has. `origin` decides what
    /// is evaluated and must equal the log's origin. `header` are the log's columns. `is_fresh` starts
    /// over.
    ///
    /// # Errors
    /// The log belongs to something else, another process works in the folder, or the disk does not take
    /// it.
    pub fn open(
        folder: &Path,
        purpose: &Purpose,
        origin: &serde_json::Value,
        header: &[String],
        is_fresh: bool,
    ) -> Result<(Self, Vec<Vec<String>>), Failure> {
        let trouble = |error: std::io::Error| Failure::storage(format!("{}: {error}", folder.display()));
        check_folder(folder, purpose, origin, is_fresh)?;
        fs::create_dir_all(folder).map_err(trouble)?;
        let lock = Lock::take(folder, &mut |_| {})?;
        let made = [LOG].into_iter().chain(purpose.results.iter().copied());
        for name in made.filter(|name| is_fresh && folder.join(name).exists()) {
            fs::remove_file(folder.join(name)).map_err(trouble)?;
        }
        NewFile::write(folder, purpose.origin, format!("{origin:#}\n").as_bytes())?;
        let path = folder.join(LOG);
        files::check_is_file(&path)
            .map_err(|error| Failure::storage(format!("{}: {error}", path.display())))?;
        let rows = if path.exists() { read(&path, header)? } else { Vec::new() };
        let mut file = File::options().create(true).append(true).open(&path).map_err(trouble)?;
        if file.metadata().map_err(trouble)?.len() == 0 {
            let first: Vec<String> = header.iter().cloned().chain([CHECKSUM.to_owned()]).collect();
            file.write_all(line(&first)?.as_bytes()).map_err(trouble)?;
        }
        Ok((Self { path, file, columns: header.len(), _lock: lock }, rows))
    }

    /// Number of cells of a line, without the checksum.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The error for a row, counted from 0, that does not belong to this log.
    #[must_use]
    pub fn bad_row(&self, row: usize) -> Failure {
        bad_line(&self.path, row + 2)
    }

    /// Adds a line. It is on disk when this returns.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add(&mut self, mut cells: Vec<String>) -> Result<(), Failure> {
        debug_assert_eq!(cells.len(), self.columns);
        cells.push(checksum(cells.iter().map(String::as_str)));
        let written = self.file.write_all(line(&cells)?.as_bytes()).and_then(|()| self.file.sync_data());
        written.map_err(|error| Failure::storage(format!("cannot write {}: {error}", self.path.display())))
    }
}

/// Refuses a folder that belongs to something else.
fn check_folder(
    folder: &Path,
    purpose: &Purpose,
    now: &serde_json::Value,
    is_fresh: bool,
) -> Result<(), Failure> {
    let trouble = |error: std::io::Error| Failure::storage(format!("{}: {error}", folder.display()));
    let origin = folder.join(purpose.origin);
    let has_others = |folder: &Path| -> std::io::Result<bool> {
        let mut names = fs::read_dir(folder)?.flatten().map(|entry| entry.file_name());
        Ok(names.any(|name| {
            !name.to_string_lossy().starts_with(names::LOCK) && !name.to_string_lossy().ends_with(".new")
        }))
    };
    if folder.exists() && !origin.exists() && has_others(folder).map_err(trouble)? {
        return Err(Failure::input(format!(
            "--out: {} is not empty and not the folder of a {}; nothing was overwritten",
            folder.display(),
            purpose.noun
        )));
    }
    if is_fresh || !origin.exists() {
        return Ok(());
    }
    let there = ron_tree::file::read_text(&origin)
        .map_err(|error| Failure::input(format!("{}: {error}", origin.display())))?;
    check_continues(folder, purpose, &there, now)
}

/// The checksum of a line's other cells, in 16 hexadecimal digits.
fn checksum<'a>(cells: impl IntoIterator<Item = &'a str>) -> String {
    let mut hash = Xxh3::new();
    for cell in cells {
        hash.update(&(cell.len() as u64).to_le_bytes());
        hash.update(cell.as_bytes());
    }
    format!("{:016x}", hash.digest())
}

fn line(cells: &[String]) -> Result<String, Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(cells).map_err(Failure::run)?;
    let bytes = writer.into_inner().map_err(Failure::run)?;
    String::from_utf8(bytes).map_err(Failure::run)
}

fn bad_line(path: &Path, line: usize) -> Failure {
    Failure::input(format!(
        "{}:{line}: is not a line of a log, or was changed; --fresh starts over",
        path.display()
    ))
}

/// Reads the log and removes an incomplete last line.
fn read(path: &Path, header: &[String]) -> Result<Vec<Vec<String>>, Failure> {
    let trouble = |error: std::io::Error| Failure::storage(format!("{}: {error}", path.display()));
    let text = String::from_utf8(files::read(path).map_err(trouble)?);
    let text = text.map_err(|error| Failure::input(format!("{}: is not text: {error}", path.display())))?;
    let whole = text.rfind('\n').map_or(0, |end| end + 1);
    if whole < text.len() {
        File::options()
            .write(true)
            .open(path)
            .and_then(|file| file.set_len(whole as u64))
            .map_err(trouble)?;
    }
    let mut rows = csv::ReaderBuilder::new().has_headers(false).from_reader(&text.as_bytes()[..whole]);
    let mut read = Vec::new();
    for (i, row) in rows.records().enumerate() {
        let bad = || bad_line(path, i + 1);
        let mut cells: Vec<String> = row.map_err(|_| bad())?.iter().map(str::to_owned).collect();
        let last = cells.pop().ok_or_else(bad)?;
        if i == 0 && (cells != header || last != CHECKSUM) {
            return Err(bad());
        }
        if i > 0 && last != checksum(cells.iter().map(String::as_str)) {
            return Err(bad());
        }
        read.extend((i > 0).then_some(cells));
    }
    Ok(read)
}

/// The differences between two values, entry by entry for objects.
fn differences_of(name: &str, there: &serde_json::Value, now: &serde_json::Value) -> Vec<String> {
    match (there.as_object(), now.as_object()) {
        (Some(old), Some(new)) => {
            let keys: BTreeSet<&String> = old.keys().chain(new.keys()).collect();
            let inside = |key: &String| {
                differences_of(&format!("{name}.{key}"), &there[key.as_str()], &now[key.as_str()])
            };
            keys.into_iter().flat_map(inside).collect()
        }
        _ if there == now => Vec::new(),
        _ => vec![format!("{name}: {there} there, {now} now")],
    }
}

fn check_continues(
    folder: &Path,
    purpose: &Purpose,
    there: &str,
    now: &serde_json::Value,
) -> Result<(), Failure> {
    let there: serde_json::Value = serde_json::from_str(there).unwrap_or_default();
    let mut differences = Vec::new();
    for (key, value) in now.as_object().into_iter().flatten().filter(|(key, _)| *key != "scenario") {
        differences.extend(differences_of(key, &there[key], value));
    }
    let text = |origin: &serde_json::Value| origin["scenario"].as_str().unwrap_or_default().to_owned();
    differences.extend(crate::provenance::scenario_differences(&text(&there), &text(now)));
    if differences.is_empty() {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{} has the {} of something else; --out takes another folder, --fresh starts over:\n  {}",
        folder.display(),
        purpose.noun,
        differences.join("\n  ")
    )))
}
