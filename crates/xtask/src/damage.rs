//! Damaged folders of results: by flipped bits, and by a forger who changes numbers and recomputes every
//! checksum.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use experiments::provenance::Manifest;
use experiments::run::{Limits, Outcome, Sessions, TrialKey};
use experiments::sweep::audit::{difference, strange_files};
use experiments::sweep::folder::{Folder, Opening};
use experiments::sweep::{missing, run_trials};
use flate2::{Compression, GzBuilder};
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use xxhash_rust::xxh3::{xxh3_64, xxh3_128};

use crate::kills::{files, journal};

/// Counts of damaged folders.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Number of damaged folders.
    pub damaged: u32,
    /// Damaged folders whose damage was found by verification.
    pub found: u32,
    /// Damaged folders that everything that reads results refused.
    pub refused: u32,
    /// Damaged folders that the sweep's command restored byte for byte, or refused with a message.
    pub mended: u32,
}

/// The finished sweep in a folder, with its trials run again.
pub struct Sound {
    folder: PathBuf,
    again: Vec<Outcome>,
    forged: Forged,
}

impl Sound {
    /// Runs the trials of a finished sweep again.
    pub fn of(path: &Path) -> Self {
        let folder = Folder::read(path, &policies::standard()).expect("a sound folder");
        let experiment = folder.shared_experiment();
        let keys: Vec<TrialKey> = experiment.keys(None).collect();
        let halt = AtomicBool::new(false);
        let run = |key: TrialKey| Outcome {
            result: experiment.run_alone(&key, &mut Sessions::default(), &halt),
            key,
        };
        let again = keys.into_iter().map(run).collect();
        Self { folder: path.to_owned(), again, forged: Forged::of(path) }
    }

    /// Repeatedly flips one bit of one file and checks that the damage is found and mended.
    pub fn flip(&self, times: u32, seed: u64) -> Report {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let names: Vec<&String> = self.forged.sound.keys().collect();
        let mut report = Report::default();
        for _ in 0..times {
            self.forged.restore();
            let name = names[draws.random_range(0..names.len())];
            let mut bytes = self.forged.sound[name].clone();
            let at = draws.random_range(0..bytes.len());
            bytes[at] ^= 1 << draws.random_range(0..8);
            std::fs::write(self.folder.join(name), bytes).expect("the file can be written");
            self.judge(&mut report, &format!("{name}, byte {at}"), true);
        }
        self.forged.restore();
        report
    }

    /// Repeatedly changes one digit of one number in the journal or in a table and recomputes every
    /// checksum.
    pub fn forge(&self, times: u32, seed: u64) -> Report {
        let mut draws = ChaCha8Rng::seed_from_u64(seed);
        let mut report = Report::default();
        for round in 0..times {
            let pick = draws.random::<u64>();
            let change = move |text: &str| other_digit(text, pick);
            if round % 4 == 0 {
                self.forged.file("trials.csv", |text| change(&text));
            } else {
                let key = &self.again[draws.random_range(0..self.again.len())].key;
                let with = format!("\"policy\":\"{}\",\"trial\":{},", key.label, key.trial);
                self.forged.line(&with, |line| *line = change(line));
            }
            self.judge(&mut report, &format!("forgery {round}"), false);
        }
        self.forged.restore();
        report
    }

    fn judge(&self, report: &mut Report, what: &str, is_to_be_mended: bool) {
        report.damaged += 1;
        report.refused += u32::from(Folder::read(&self.folder, &policies::standard()).is_err());
        if self.is_found() {
            report.found += 1;
        } else {
            eprintln!("not found: {what}");
        }
        if is_to_be_mended {
            if self.is_mended() {
                report.mended += 1;
            } else {
                eprintln!("not mended: {what}");
            }
        }
    }

    /// Whether verification finds a difference.
    fn is_found(&self) -> bool {
        let Ok((mut folder, damage)) = Folder::read_damaged(&self.folder, &policies::standard()) else {
            return true;
        };
        let differs = |outcome| difference(&mut folder, outcome).is_ok_and(|difference| difference.is_some());
        damage.is_some()
            || self.again.iter().any(differs)
            || !strange_files(&mut folder).is_ok_and(|strange| strange.is_empty())
    }

    /// Whether the sweep's command refuses the folder, or restores it to its state before the damage.
    fn is_mended(&self) -> bool {
        let experiment = Arc::clone(&self.experiment());
        let Ok(mut folder) = Folder::open(&self.folder, experiment, Opening::default(), &mut |_| {}) else {
            return true;
        };
        let (limits, stop) = (Limits { jobs: 1, trial: None }, AtomicBool::new(false));
        let left = missing(&folder, None);
        run_trials(&mut folder, left, limits, &stop, |_| {}).expect("the trials run");
        folder.finish(&stop).expect("the folder can be finished");
        files(&self.folder) == self.forged.sound
    }

    fn experiment(&self) -> Arc<experiments::experiment::Experiment> {
        let place = tempfile::tempdir().expect("a temporary folder");
        for (name, bytes) in &self.forged.sound {
            std::fs::write(place.path().join(name), bytes).expect("the file can be written");
        }
        Folder::read(place.path(), &policies::standard()).expect("a sound folder").shared_experiment()
    }
}

/// The text with one of its digits replaced by another digit.
fn other_digit(text: &str, pick: u64) -> String {
    let places: Vec<usize> =
        text.bytes().enumerate().filter(|(_, c)| c.is_ascii_digit()).map(|(i, _)| i).collect();
    let at = places[(pick % places.len() as u64) as usize];
    let digit = (text.as_bytes()[at] - b'0' + 1 + (pick >> 32) as u8 % 9) % 10;
    format!("{}{digit}{}", &text[..at], &text[at + 1..])
}

/// Name of the journal of a finished sweep.
const JOURNAL: &str = "journal.jsonl.gz";

/// Turns a gzip file without header fields into a member of a journal, whose header states its length and
/// its number of lines.
fn with_head(gzip: &[u8], lines: usize) -> Vec<u8> {
    let mut head = vec![0x1f, 0x8b, 8, 4, 0, 0, 0, 0, 0, 0xff, 12, 0, b'U', b'S', 8, 0];
    head.extend((gzip.len() as u32 + 14).to_le_bytes());
    head.extend((lines as u32).to_le_bytes());
    head.extend(&gzip[10..]);
    head
}

/// A finished sweep's folder, and its original content.
pub struct Forged {
    folder: PathBuf,
    sound: BTreeMap<String, Vec<u8>>,
}

impl Forged {
    /// Remembers the content of a finished sweep's folder.
    pub fn of(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), sound: files(folder) }
    }

    /// Restores the original content.
    pub fn restore(&self) {
        for (name, bytes) in &self.sound {
            std::fs::write(self.folder.join(name), bytes).unwrap();
        }
    }

    fn text(&self, name: &str) -> String {
        String::from_utf8(self.sound[name].clone()).unwrap()
    }

    /// Changes one file, and its checksum in the manifest.
    pub fn file(&self, name: &str, change: impl FnOnce(String) -> String) {
        self.restore();
        let text = change(self.text(name));
        assert!(text != self.text(name), "{name} is changed");
        self.bytes(name, text.as_bytes());
    }

    fn bytes(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.folder.join(name), bytes).unwrap();
        let hash = format!("{:032x}", xxh3_128(bytes));
        self.write_manifest(|manifest| {
            let listed = manifest.files.iter_mut().filter(|file| file.name == name);
            listed.for_each(|file| file.xxh3_128.clone_from(&hash));
        });
    }

    /// Changes the line of the journal that contains this text, and every checksum.
    pub fn line(&self, with: &str, change: impl FnOnce(&mut String)) {
        self.journal(|text| {
            let line = text.lines().find(|line| line.contains(with)).unwrap();
            let (_, entry) = line.split_once(",\"entry\":").unwrap();
            let mut entry = entry.strip_suffix('}').unwrap().to_owned();
            change(&mut entry);
            let sum = xxh3_64(entry.as_bytes());
            text.replace(line, &format!("{{\"xxh3_64\":\"{sum:016x}\",\"entry\":{entry}}}"))
        });
    }

    /// Changes the journal, and its checksum in the manifest.
    pub fn journal(&self, change: impl FnOnce(String) -> String) {
        self.restore();
        let text = change(journal(&self.folder));
        let mut encoder = GzBuilder::new().write(Vec::new(), Compression::fast());
        encoder.write_all(text.as_bytes()).unwrap();
        self.bytes(JOURNAL, &with_head(&encoder.finish().unwrap(), text.lines().count()));
    }

    /// Changes only the manifest, and its checksum.
    pub fn manifest(&self, change: impl FnOnce(&mut Manifest)) {
        self.restore();
        self.write_manifest(change);
    }

    fn write_manifest(&self, change: impl FnOnce(&mut Manifest)) {
        let mut manifest = Manifest::parse(&self.sound["manifest.json"]).unwrap();
        change(&mut manifest);
        std::fs::write(self.folder.join("manifest.json"), manifest.text().unwrap()).unwrap();
    }
}
