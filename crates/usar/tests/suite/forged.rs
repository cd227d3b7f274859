//! A folder of results whose files are changed by somebody who can compute checksums.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use experiments::provenance::Manifest;
use xtask::kills::files;
use xxhash_rust::xxh3::{xxh3_64, xxh3_128};

/// A finished sweep's folder, and what was in it.
pub struct Forged {
    folder: PathBuf,
    sound: BTreeMap<String, Vec<u8>>,
}

impl Forged {
    pub fn of(folder: &Path) -> Self {
        Self { folder: folder.to_owned(), sound: files(folder) }
    }

    /// Everything as it was.
    pub fn restore(&self) {
        for (name, bytes) in &self.sound {
            std::fs::write(self.folder.join(name), bytes).unwrap();
        }
    }

    fn text(&self, name: &str) -> String {
        String::from_utf8(self.sound[name].clone()).unwrap()
    }

    /// Changes one file alone, and the manifest's checksums.
    pub fn file(&self, name: &str, change: impl FnOnce(String) -> String) {
        self.restore();
        let text = change(self.text(name));
        assert!(text != self.text(name), "{name} is changed");
        std::fs::write(self.folder.join(name), &text).unwrap();
        let hash = format!("{:032x}", xxh3_128(text.as_bytes()));
        self.write_manifest(|manifest| {
            let listed = manifest.files.iter_mut().filter(|file| file.name == name);
            listed.for_each(|file| file.xxh3_128.clone_from(&hash));
        });
    }

    /// Changes the line of the journal that has this in it, and every checksum.
    pub fn line(&self, with: &str, change: impl FnOnce(&mut String)) {
        self.file("journal.jsonl", |text| {
            let line = text.lines().find(|line| line.contains(with)).unwrap();
            let (_, entry) = line.split_once(",\"trial\":").unwrap();
            let mut entry = entry.strip_suffix('}').unwrap().to_owned();
            change(&mut entry);
            let sum = xxh3_64(entry.as_bytes());
            text.replace(line, &format!("{{\"xxh3_64\":\"{sum:016x}\",\"trial\":{entry}}}"))
        });
    }

    /// Changes the manifest alone, and its checksum.
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
