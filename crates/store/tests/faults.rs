//! Logs on a disk with faults: what is read is a prefix of what was written, and a resumed job ends with the
//! bytes of an undisturbed one.

use std::io::{self, Cursor, Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::time::Duration;

use proptest::prelude::*;
use store::{Header, Log, Medium};

/// What happens to one operation on the disk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fault {
    /// It is refused, as by a full disk, and so is everything after it for a while.
    Fails { operations: u32 },
    /// A part of it is done, and the process is killed.
    Torn { bytes: usize },
    /// It takes a moment.
    Slow,
}

/// The bytes of a file, and the faults to come: the number of operations before each.
struct Disk<'a> {
    file: Cursor<&'a mut Vec<u8>>,
    faults: &'a mut Vec<(u32, Fault)>,
    operations: u32,
    refuses: u32,
    is_dead: bool,
}

impl<'a> Disk<'a> {
    fn new(bytes: &'a mut Vec<u8>, faults: &'a mut Vec<(u32, Fault)>) -> Self {
        Self { file: Cursor::new(bytes), faults, operations: 0, refuses: 0, is_dead: false }
    }

    /// The number of bytes of an operation that are done.
    fn operate(&mut self, bytes: usize) -> io::Result<usize> {
        let refused = || io::Error::new(io::ErrorKind::StorageFull, "no space");
        if self.is_dead || self.refuses > 0 {
            self.refuses = self.refuses.saturating_sub(1);
            return Err(refused());
        }
        self.operations += 1;
        if self.faults.first().is_none_or(|(before, _)| self.operations <= *before) {
            return Ok(bytes);
        }
        self.operations = 0;
        match self.faults.remove(0).1 {
            Fault::Fails { operations } => {
                self.refuses = operations;
                Err(refused())
            }
            Fault::Torn { bytes: done } => {
                self.is_dead = true;
                Ok(done.min(bytes))
            }
            Fault::Slow => {
                std::thread::sleep(Duration::from_micros(50));
                Ok(bytes)
            }
        }
    }
}

impl Read for Disk<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.file.read(buffer)
    }
}

impl Seek for Disk<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl Write for Disk<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let done = self.operate(bytes.len())?;
        self.file.write(&bytes[..done])
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Medium for Disk<'_> {
    fn cut(&mut self, length: u64) -> io::Result<()> {
        let length = length as usize;
        if self.operate(length)? == length {
            self.file.get_mut().truncate(length);
        }
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        self.operate(0).map(drop)
    }
}

fn header() -> Header {
    Header::new("count", "of words")
}

fn word(number: u32) -> String {
    format!("word {}", "o".repeat(number as usize % 40)) + &number.to_string()
}

fn words(numbers: std::ops::Range<u32>) -> Vec<String> {
    numbers.map(word).collect()
}

/// Does the job, `batch` words at a time, until it is done or the process is killed. A refusal of the disk is
/// met by another attempt. Returns the number of words that were said to be on disk.
fn work(disk: Disk, all: u32, batch: u32) -> u32 {
    let mut done = Vec::new();
    let name = Path::new("log");
    let found = |line: &store::Line| {
        done.push(serde_json::from_slice::<String>(line.entry)?);
        Ok(())
    };
    let Ok(mut log) = Log::on(disk, name, &header(), found) else { return 0 };
    let mut there = done.len() as u32;
    assert_eq!(done, words(0..there));
    for _ in 0..1_000 {
        if there == all {
            break;
        }
        let next = (there + batch).min(all);
        if log.add(&words(there..next)).is_ok() {
            there = next;
        }
    }
    there
}

/// What a reader finds in these bytes.
fn found(bytes: &[u8]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log");
    std::fs::write(&path, bytes).unwrap();
    let found = store::read(&path, &header()).unwrap();
    assert_eq!(std::fs::read(path).unwrap(), bytes, "a reader writes nothing");
    found
}

fn fault() -> impl Strategy<Value = Fault> {
    prop_oneof![
        (1..6_u32).prop_map(|operations| Fault::Fails { operations }),
        (0..200_usize).prop_map(|bytes| Fault::Torn { bytes }),
        Just(Fault::Slow),
    ]
}

proptest! {
    #[test]
    fn a_disturbed_log_is_a_prefix_and_a_resumed_one_is_whole(
        all in 0..30_u32,
        batch in 1..5_u32,
        mut faults in prop::collection::vec((0..20_u32, fault()), 0..12),
    ) {
        let mut undisturbed = Vec::new();
        work(Disk::new(&mut undisturbed, &mut Vec::new()), all, batch);
        prop_assert_eq!(found(&undisturbed), words(0..all));
        let mut bytes = Vec::new();
        for left in (0..=faults.len()).rev() {
            if left == 0 {
                faults.clear();
            }
            let said = work(Disk::new(&mut bytes, &mut faults), all, batch);
            let read = found(&bytes);
            prop_assert!(read.len() as u32 >= said, "{} are left of {said}", read.len());
            prop_assert_eq!(&read[..], &words(0..all)[..read.len()]);
        }
        prop_assert_eq!(bytes, undisturbed);
    }

    /// No change of a byte passes, except where it makes the last line incomplete.
    #[test]
    fn a_changed_byte_is_refused(at in any::<prop::sample::Index>(), bit in 0..8_u32) {
        let mut bytes = Vec::new();
        work(Disk::new(&mut bytes, &mut Vec::new()), 5, 1);
        let at = at.index(bytes.len() - 1);
        bytes[at] ^= 1 << bit;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log");
        std::fs::write(&path, &bytes).unwrap();
        let told = store::read::<String>(&path, &header()).unwrap_err().to_string();
        prop_assert!(told.starts_with(&format!("{}:", path.display())), "{}", told);
    }
}

#[test]
fn a_file_of_something_else_is_refused_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log");
    let line = |header: Header| String::from_utf8(header.line()).unwrap();
    for (text, says) in [
        ("MINE".to_owned(), "log:1: is not a log of this program"),
        ("MINE\n".to_owned(), "log:1: is not a log of this program"),
        (line(Header::new("sweep", "of words")), "log:1: is the log of a sweep, not of a count"),
        (line(Header::new("count", "of sheep")), "log:1: is the log of another count"),
        (line(header()) + "1\n", "log:2: the checksum does not match"),
    ] {
        std::fs::write(&path, &text).unwrap();
        let lock = store::lock::Lock::of_file(&path).unwrap();
        let refused = Log::resume::<String>(&path, &header(), lock.into()).map(drop).unwrap_err();
        assert!(refused.to_string().contains(says), "{refused}");
        assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    }
    assert_eq!(store::owned::names_in(folder.path()).unwrap(), ["log"], "no lock stays");
}

#[test]
fn a_log_has_one_writer() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log");
    let take = || store::lock::Lock::of_file(&path);
    let held = take().unwrap();
    let refused = take().unwrap_err().to_string();
    assert!(refused.contains("log: another process is at work on this file"), "{refused}");
    drop(held);
    take().unwrap();
}
