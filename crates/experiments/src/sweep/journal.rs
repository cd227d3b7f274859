//! `journal.jsonl`: each trial on disk as soon as it is done, a line of JSON with its checksum. Everything else in a sweep's folder is made
//! from it.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use rne_core::Account;
use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_64;

use super::links;
use crate::experiment::{Experiment, Shard};
use crate::failure::Failure;
use crate::files;
use crate::limits::JOURNAL_LINE_BYTES;
use crate::run::{Fault, FaultKind, Outcome, Trial, TrialKey};

/// Name of the file.
pub const FILE: &str = "journal.jsonl";

/// What a line begins with, before 16 hexadecimal digits.
const HEAD: &str = "{\"xxh3_64\":\"";
/// What stands between the digits and the trial.
const MIDDLE: &str = "\",\"trial\":";

/// A place in the sweep: case, policy, trial.
pub type Place = (usize, usize, u32);

/// The journal of a sweep's folder.
pub struct Journal {
    path: PathBuf,
    file: File,
    /// Bytes that are sound.
    length: u64,
    /// Where the line of each finished trial is.
    lines: BTreeMap<Place, (u64, usize)>,
}

/// A line that cannot be used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Damage {
    /// File, line and what is wrong.
    pub what: String,
    /// Whether it is the last line, and has no end.
    pub is_cut_off: bool,
}

/// Whether a folder has a journal of this program.
#[must_use]
pub fn is_one(folder: &Path) -> bool {
    let mut head = [0; HEAD.len()];
    let read = files::open(&folder.join(FILE)).and_then(|mut file| file.read_exact(&mut head));
    read.is_ok() && head == *HEAD.as_bytes()
}

#[derive(Serialize, Deserialize)]
struct Entry {
    id: String,
    case: usize,
    policy: String,
    trial: u32,
    seed: u64,
    outcome: Stored,
}

#[derive(Serialize, Deserialize)]
enum Stored {
    Ended { trial: Box<Trial>, links: String },
    Fault(Fault),
}

impl Journal {
    /// Opens the journal of a folder, of the whole sweep or one shard, and hands each finished trial to `found`, in the order of the file. For one who writes, trials that timed
    /// out count as not run. A last line that is cut off is what a killed process was writing.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn open(
        folder: &Path,
        (experiment, shard): (&Experiment, Option<Shard>),
        is_writable: bool,
        mut found: impl FnMut(Outcome),
    ) -> Result<(Self, Vec<Damage>), Failure> {
        let path = folder.join(FILE);
        let trouble = |error| Failure::storage(format!("{}: {error}", path.display()));
        files::check_is_file(&path).map_err(trouble)?;
        let mut options = OpenOptions::new();
        options.read(true).write(is_writable).create(is_writable);
        let file = options.open(&path).map_err(trouble)?;
        if is_writable {
            File::open(folder).and_then(|folder| folder.sync_all()).map_err(trouble)?;
        }
        let mut reader = BufReader::new(&file);
        let (mut length, mut lines, mut damages) = (0, BTreeMap::new(), Vec::new());
        let mut line = Vec::new();
        for number in 1.. {
            line.clear();
            let most = JOURNAL_LINE_BYTES.most as u64;
            let size = reader.by_ref().take(most).read_until(b'\n', &mut line).map_err(trouble)?;
            if size == 0 {
                break;
            }
            if size as u64 == most && line.last() != Some(&b'\n') {
                let reason = format!("line {number} is longer than {} MiB", most >> 20);
                return Err(trouble(std::io::Error::new(std::io::ErrorKind::InvalidData, reason)));
            }
            if line.last() != Some(&b'\n') {
                let what = format!("{}:{number}: the last line is cut off", path.display());
                damages.push(Damage { what, is_cut_off: true });
                break;
            }
            match outcome_of(&line, experiment, shard) {
                Ok(outcome) => {
                    let TrialKey { case, policy, trial, .. } = outcome.key;
                    let timed_out =
                        matches!(&outcome.result, Err(fault) if fault.kind == FaultKind::TimedOut);
                    if !(timed_out && is_writable) {
                        lines.insert((case, policy, trial), (length, size));
                        found(outcome);
                    }
                }
                Err(reason) => {
                    let what = format!("{}:{number}: {reason}", path.display());
                    damages.push(Damage { what, is_cut_off: false });
                }
            }
            length += size as u64;
        }
        Ok((Self { path, file, length, lines }, damages))
    }

    /// Adds a trial: when this returns, it is on disk.
    ///
    /// # Errors
    /// The disk does not take it; the journal is as it was.
    pub fn add(&mut self, experiment: &Experiment, outcome: &Outcome) -> Result<(), Failure> {
        let line = line_of(experiment, outcome)?;
        let TrialKey { case, policy, trial, .. } = outcome.key;
        self.append(&line, (case, policy, trial))
    }

    /// Adds a line as it is.
    ///
    /// # Errors
    /// Those of [`Journal::add`].
    pub fn append(&mut self, line: &[u8], place: Place) -> Result<(), Failure> {
        let mut write = || {
            self.file.seek(SeekFrom::Start(self.length))?;
            self.file.write_all(line)?;
            self.file.set_len(self.length + line.len() as u64)?;
            self.file.sync_data()
        };
        if let Err(error) = write() {
            let _ = self.file.set_len(self.length);
            return Err(Failure::storage(format!("{}: {error}", self.path.display())));
        }
        self.lines.insert(place, (self.length, line.len()));
        self.length += line.len() as u64;
        Ok(())
    }

    /// The places of all finished trials, in order.
    pub fn places(&self) -> impl Iterator<Item = Place> + '_ {
        self.lines.keys().copied()
    }

    /// Whether a trial is finished.
    #[must_use]
    pub fn has(&self, key: &TrialKey) -> bool {
        self.lines.contains_key(&(key.case, key.policy, key.trial))
    }

    /// The line of a finished trial.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn line(&mut self, place: Place) -> Result<Vec<u8>, Failure> {
        let (start, size) = self.lines[&place];
        let mut line = vec![0; size];
        let read = self.file.seek(SeekFrom::Start(start)).and_then(|_| self.file.read_exact(&mut line));
        read.map_err(|error| Failure::storage(format!("{}: {error}", self.path.display())))?;
        Ok(line)
    }

    /// Whether the file is its lines in order and nothing else.
    ///
    /// # Errors
    /// The file cannot be looked at.
    pub fn is_tidy(&self) -> Result<bool, Failure> {
        let mut end = 0;
        let in_order = self.lines.values().all(|(start, size)| {
            let follows = *start == end;
            end += *size as u64;
            follows
        });
        let there = self.file.metadata();
        let there = there.map_err(|error| Failure::storage(format!("{}: {error}", self.path.display())))?;
        Ok(in_order && end == there.len())
    }

    /// A finished trial, with its hash chain.
    ///
    /// # Errors
    /// The file cannot be read, or was changed since it was opened.
    pub fn outcome(&mut self, place: Place, experiment: &Experiment) -> Result<Outcome, Failure> {
        let line = self.line(place)?;
        let changed = |reason| Failure::storage(format!("{}: {reason}", self.path.display()));
        outcome_of(&line, experiment, None).map_err(changed)
    }

    /// Puts the lines in order and drops those that cannot be used.
    ///
    /// # Errors
    /// The disk does not take it; the journal is as it was.
    pub fn tidy(&mut self) -> Result<(), Failure> {
        if self.is_tidy()? {
            return Ok(());
        }
        let places: Vec<Place> = self.places().collect();
        let new = self.path.with_extension("jsonl.new");
        let trouble = |error| Failure::storage(format!("{}: {error}", new.display()));
        let mut file = std::io::BufWriter::new(files::create(&new).map_err(trouble)?);
        let (mut lines, mut length) = (BTreeMap::new(), 0);
        for place in places {
            let line = self.line(place)?;
            file.write_all(&line).map_err(trouble)?;
            lines.insert(place, (length, line.len()));
            length += line.len() as u64;
        }
        let file = file.into_inner().map_err(|error| trouble(error.into_error()))?;
        file.sync_all().and_then(|()| std::fs::rename(&new, &self.path)).map_err(trouble)?;
        *self = Self { path: self.path.clone(), file, length, lines };
        Ok(())
    }
}

/// The line of a trial.
///
/// # Errors
/// None: a trial can be written to memory.
pub(super) fn line_of(experiment: &Experiment, outcome: &Outcome) -> Result<Vec<u8>, Failure> {
    let key = &outcome.key;
    let stored = match &outcome.result {
        Ok(trial) => {
            let links = if experiment.is_lean { &[] } else { trial.record.chain.links() };
            let links = links::encode(links);
            let mut trial = Box::new(trial.clone());
            if experiment.is_lean {
                trial.record.decisions.iter_mut().for_each(|asked| asked.decision.account = Account::None);
            }
            Stored::Ended { links, trial }
        }
        Err(fault) => Stored::Fault(fault.clone()),
    };
    let entry = Entry {
        id: experiment.id(key),
        case: key.case,
        policy: key.label.clone(),
        trial: key.trial,
        seed: key.seed,
        outcome: stored,
    };
    let entry = serde_json::to_string(&entry).map_err(Failure::run)?;
    Ok(format!("{HEAD}{:016x}{MIDDLE}{entry}}}\n", xxh3_64(entry.as_bytes())).into_bytes())
}

fn outcome_of(line: &[u8], experiment: &Experiment, shard: Option<Shard>) -> Result<Outcome, String> {
    let entry = sound(line).ok_or("the checksum does not match: the line was changed or cut")?;
    let entry: Entry = serde_json::from_slice(entry).map_err(|error| format!("is no trial: {error}"))?;
    let policy = experiment.policies.iter().position(|policy| policy.label == entry.policy);
    let name = format!("trial {} of {} (seed {})", entry.trial, entry.policy, entry.seed);
    let policy =
        policy.filter(|policy| experiment.has((entry.case, *policy, entry.trial), entry.seed, shard));
    let policy = policy.ok_or_else(|| format!("{name} is not of this sweep"))?;
    let key =
        TrialKey { case: entry.case, policy, trial: entry.trial, seed: entry.seed, label: entry.policy };
    if experiment.id(&key) != entry.id {
        return Err(format!("{name} is of another scenario, option or program"));
    }
    let result = match entry.outcome {
        Stored::Fault(fault) => Err(fault),
        Stored::Ended { mut trial, links } => {
            trial.record.chain = links::decode(&links).ok_or("has no hash chain")?;
            Ok(*trial)
        }
    };
    Ok(Outcome { key, result })
}

/// The trial in a line whose checksum matches.
fn sound(line: &[u8]) -> Option<&[u8]> {
    let rest = line.strip_prefix(HEAD.as_bytes())?;
    let (digits, rest) = rest.split_at_checked(16)?;
    let entry = rest.strip_prefix(MIDDLE.as_bytes())?.strip_suffix(b"}\n")?;
    let digits = std::str::from_utf8(digits).ok()?;
    (u64::from_str_radix(digits, 16).ok()? == xxh3_64(entry)).then_some(entry)
}
