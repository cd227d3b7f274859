//! `evaluations.csv`: each candidate of a calibration as it was evaluated, from which a search goes on that was broken off.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use experiments::Failure;
use experiments::experiment::Program;
use experiments::files::{self, NewFile};
use experiments::sweep::disk;
use experiments::sweep::lock::Lock;
use xxhash_rust::xxh3::Xxh3;

use super::{Calibration, Evaluation, Free, POLICY, Spread};

/// The log.
const LOG: &str = "evaluations.csv";
/// What is made of it in the end.
const RESULTS: [&str; 2] = [CALIBRATED, "fit.csv"];
/// The scenario with what was found.
pub const CALIBRATED: &str = "calibrated.ron";
/// The last column of the log.
const CHECKSUM: &str = "xxh3_64";
/// What it is of.
pub(super) const ORIGIN: &str = "calibration.json";

/// The log of one calibration, held by one process.
pub struct Log {
    path: PathBuf,
    file: File,
    /// Cells of a line.
    columns: usize,
    evaluations: Vec<Evaluation>,
    _lock: Lock,
}

impl Log {
    /// Opens the log of a new calibration, or of one that is to go on. `is_fresh` starts over.
    ///
    /// # Errors
    /// It is of something else, another process is at work in the folder, or the disk does not take it.
    pub fn open(folder: &Path, calibration: &Calibration, is_fresh: bool) -> Result<Self, Failure> {
        let trouble = |error: std::io::Error| Failure::storage(format!("{}: {error}", folder.display()));
        let origin = folder.join(ORIGIN);
        let has_others = |folder: &Path| -> std::io::Result<bool> {
            let mut names = fs::read_dir(folder)?.flatten().map(|entry| entry.file_name());
            Ok(names.any(|name| {
                !name.to_string_lossy().starts_with(disk::LOCK) && !name.to_string_lossy().ends_with(".new")
            }))
        };
        if folder.exists() && !origin.exists() && has_others(folder).map_err(trouble)? {
            return Err(Failure::input(format!(
                "--out: {} is not empty and not the folder of a calibration; nothing was overwritten",
                folder.display()
            )));
        }
        let now = origin_of(calibration);
        if !is_fresh && origin.exists() {
            let there = ron_fields::file::read_text(&origin)
                .map_err(|error| Failure::input(format!("{}: {error}", origin.display())))?;
            check_continues(folder, &there, &now)?;
        }
        fs::create_dir_all(folder).map_err(trouble)?;
        let lock = Lock::take(folder, &mut |_| {})?;
        let path = folder.join(LOG);
        for name in [LOG].into_iter().chain(RESULTS).filter(|name| is_fresh && folder.join(name).exists()) {
            fs::remove_file(folder.join(name)).map_err(trouble)?;
        }
        NewFile::write(folder, ORIGIN, format!("{now:#}\n").as_bytes())?;
        files::check_is_file(&path)
            .map_err(|error| Failure::storage(format!("{}: {error}", path.display())))?;
        let evaluations = if path.exists() { read(&path, calibration)? } else { Vec::new() };
        let mut file = File::options().create(true).append(true).open(&path).map_err(trouble)?;
        if file.metadata().map_err(trouble)?.len() == 0 {
            file.write_all(line(&header(calibration))?.as_bytes()).map_err(trouble)?;
        }
        Ok(Self { path, file, columns: header(calibration).len(), evaluations, _lock: lock })
    }

    /// What was found for a candidate.
    #[must_use]
    pub fn find(&self, values: &[f64]) -> Option<&Evaluation> {
        self.evaluations.iter().find(|evaluation| evaluation.values == values)
    }

    /// All of it, in the order in which it was found.
    #[must_use]
    pub fn evaluations(&self) -> &[Evaluation] {
        &self.evaluations
    }

    /// The nearest to the target; the earliest of equals.
    #[must_use]
    pub fn best(&self) -> Option<&Evaluation> {
        let runs = self.evaluations.iter().filter(|evaluation| evaluation.failure.is_none());
        runs.min_by(|a, b| a.misfit.total_cmp(&b.misfit))
    }

    /// Takes an evaluation: when this returns, it is on disk.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add(&mut self, evaluation: Evaluation) -> Result<(), Failure> {
        let cells = [(self.evaluations.len() + 1).to_string(), evaluation.misfit.to_string()].into_iter();
        let values = evaluation.values.iter().map(f64::to_string);
        let spreads = evaluation.spreads.iter().flat_map(|s| [s.mean.to_string(), s.sd.to_string()]);
        let mut row: Vec<String> = cells.chain(values).chain(spreads).collect();
        row.resize(self.columns - 2, String::new());
        row.push(evaluation.failure.clone().unwrap_or_default());
        row.push(checksum(row.iter().map(String::as_str)));
        let written = self.file.write_all(line(&row)?.as_bytes()).and_then(|()| self.file.sync_data());
        written
            .map_err(|error| Failure::storage(format!("cannot write {}: {error}", self.path.display())))?;
        self.evaluations.push(evaluation);
        Ok(())
    }
}

fn header(calibration: &Calibration) -> Vec<String> {
    let names = calibration.free.iter().map(|free| free.name.clone());
    let quantities = calibration.target.quantities.iter();
    let spreads = quantities.flat_map(|q| [format!("{}_mean", q.name), format!("{}_sd", q.name)]);
    let first = ["evaluation", "misfit"].map(str::to_owned);
    first.into_iter().chain(names).chain(spreads).chain(["failure", CHECKSUM].map(str::to_owned)).collect()
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

/// Reads the log; a last line that was cut off is taken away.
fn read(path: &Path, calibration: &Calibration) -> Result<Vec<Evaluation>, Failure> {
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
    let mut evaluations = Vec::new();
    for (i, row) in rows.records().enumerate() {
        let bad = || {
            Failure::input(format!(
                "{}:{}: is not a line of a log, or was changed; --fresh starts over",
                path.display(),
                i + 1
            ))
        };
        let row = row.map_err(|_| bad())?;
        if i == 0 && !row.iter().eq(header(calibration)) {
            return Err(bad());
        }
        if i > 0 {
            evaluations.push(evaluation(&row, calibration).ok_or_else(bad)?);
        }
    }
    Ok(evaluations)
}

fn evaluation(row: &csv::StringRecord, calibration: &Calibration) -> Option<Evaluation> {
    let others = row.iter().take(row.len().saturating_sub(1));
    if row.iter().next_back() != Some(&checksum(others)) {
        return None;
    }
    let number = |cell: usize| row.get(cell)?.parse::<f64>().ok().filter(|value| value.is_finite());
    let free = calibration.free.len();
    let values = (2..2 + free).map(number).collect::<Option<Vec<f64>>>()?;
    let misfit = number(1)?;
    let failure = row.get(row.len() - 2).filter(|failure| !failure.is_empty()).map(str::to_owned);
    if failure.is_some() {
        return Some(Evaluation { values, misfit, spreads: Vec::new(), failure });
    }
    let spread = |q| Some(Spread { mean: number(2 + free + 2 * q)?, sd: number(3 + free + 2 * q)? });
    let spreads = (0..calibration.target.quantities.len()).map(spread).collect::<Option<Vec<_>>>()?;
    Some(Evaluation { values, misfit, spreads, failure })
}

/// What decides the evaluations.
fn origin_of(calibration: &Calibration) -> serde_json::Value {
    let Program { version, source } = Program::this();
    let spreads = calibration.target.quantities.iter().zip(&calibration.target.spreads);
    let target: serde_json::Map<String, serde_json::Value> =
        spreads.map(|(q, s)| (q.name.clone(), serde_json::json!([s.mean, s.sd]))).collect();
    serde_json::json!({
        "program": format!("usar {version} with source {source}"),
        "policy": POLICY,
        "free": calibration.free.iter().map(Free::to_string).collect::<Vec<_>>(),
        "target": target,
        "trials": calibration.trials,
        "first_seed": calibration.first_seed,
        "first_step": calibration.first_step,
        "scenario": calibration.base.resolved(),
    })
}

/// What of a value is otherwise, entry by entry where it has names.
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

fn check_continues(folder: &Path, there: &str, now: &serde_json::Value) -> Result<(), Failure> {
    let there: serde_json::Value = serde_json::from_str(there).unwrap_or_default();
    let mut differences = Vec::new();
    for (key, value) in now.as_object().into_iter().flatten().filter(|(key, _)| *key != "scenario") {
        differences.extend(differences_of(key, &there[key], value));
    }
    let text = |origin: &serde_json::Value| origin["scenario"].as_str().unwrap_or_default().to_owned();
    differences.extend(experiments::provenance::scenario_differences(&text(&there), &text(now)));
    if differences.is_empty() {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{} has the calibration of something else; --out takes another folder, --fresh starts over:\n  {}",
        folder.display(),
        differences.join("\n  ")
    )))
}
