//! The files of a finished sweep, changes of them whose checksums are computed anew, and random cases.

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use experiments::provenance::Manifest;
use flate2::read::MultiGzDecoder;
use flate2::{Compression, GzBuilder};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestCaseResult, TestRunner, contextualize_config};
use xxhash_rust::xxh3::{xxh3_64, xxh3_128};

/// The files of a folder, by name, except those that differ between two runs of the same sweep: locks that
/// killed processes left, and `host.json`.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let file = |entry: std::io::Result<std::fs::DirEntry>| {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        (name, std::fs::read(path).expect("a file"))
    };
    let is_same = |(name, _): &(String, Vec<u8>)| name != "host.json" && !name.starts_with(".lock");
    std::fs::read_dir(folder).expect("a folder").map(file).filter(is_same).collect()
}

/// The journal of a folder, while it grows or of a finished sweep.
pub fn journal(folder: &Path) -> String {
    let mut text = String::new();
    if let Ok(growing) = std::fs::read_to_string(folder.join("journal.jsonl")) {
        text = growing;
    } else if let Ok(finished) = std::fs::File::open(folder.join("journal.jsonl.gz")) {
        MultiGzDecoder::new(finished).read_to_string(&mut text).expect("a whole file");
    }
    text
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
    pub sound: BTreeMap<String, Vec<u8>>,
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

/// Tests so many random cases, always the same ones, or as many as `PROPTEST_CASES` says.
pub fn cases<S: Strategy>(usually: u32, cases: S, test: impl Fn(S::Value) -> TestCaseResult) {
    let config = ProptestConfig {
        cases: usually,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let outcome = TestRunner::new(contextualize_config(config)).run(&cases, test);
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
}
