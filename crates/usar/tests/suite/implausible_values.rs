//! Results whose JSON and checksums are sound, but in which a value is another one. Whatever reads them reads
//! them or refuses them with a sentence; nothing panics, and no sentence names a type of the program.

use std::cell::Cell;
use std::fmt::Display;
use std::io::Read;
use std::path::Path;

use experiments::Failure;
use experiments::comparison::compare;
use experiments::sweep::audit::strange_files;
use experiments::sweep::folder::Folder;
use experiments::sweep::merge::Merge;
use experiments::sweep::tidy_rows;
use flate2::Compression;
use flate2::read::{DeflateDecoder, DeflateEncoder};
use pictures::{Look, moment, trails};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use proptest::test_runner::TestCaseResult;
use recording::{ReadError, Recording, Table};
use reports::{Wanted, write_report};
use serde_json::{Value, json};

use crate::altered_results::{Forged, cases};
use crate::place::{place, refused};
use crate::support::{succeeds, usar};

/// Bytes before the first chunk of a recording, and of the head of each chunk.
const MAGIC: usize = 8;
const HEAD: usize = 20;

/// How many were read and how many were refused.
#[derive(Debug, Default)]
struct Tally {
    read: Cell<u32>,
    refused: Cell<u32>,
}

impl Tally {
    /// Reads something, and checks how it is refused if it is.
    fn note<E: Display>(&self, read: impl FnOnce() -> Result<(), E>) -> TestCaseResult {
        let Err(error) = read() else {
            self.read.set(self.read.get() + 1);
            return Ok(());
        };
        self.refused.set(self.refused.get() + 1);
        let said = error.to_string();
        prop_assert!(!said.contains("struct ") && !said.contains("enum "), "{}", said);
        Ok(())
    }

    #[track_caller]
    fn is_both(&self) {
        assert!(self.read.get() > 0 && self.refused.get() > 4, "{self:?}");
    }
}

/// Everything that is read of a folder of results. Its report takes longest.
fn read_folder(path: &Path, is_reported: bool) -> Result<(), Failure> {
    let registry = policies::standard();
    let mut folder = Folder::read(path, &registry)?;
    tidy_rows(&mut folder, |_| Ok(()))?;
    let wanted = Wanted::of(folder.experiment())?;
    let metrics: Vec<usize> = (0..folder.experiment().metrics.len()).collect();
    compare(&folder, &metrics, wanted.asked.choice())?;
    if is_reported {
        write_report(&mut folder, wanted)?;
    }
    strange_files(&mut folder)?;
    Merge::of(&[path.to_owned()], &registry).map(drop)
}

/// Everything that is read of a recording.
fn read_recording(bytes: &[u8]) -> Result<(), String> {
    let recording = Recording::read(bytes).map_err(|error| error.to_string())?;
    let said = |error: &dyn Display| error.to_string();
    recording.told().for_each(drop);
    for number in 0..recording.frames() {
        let frame = recording.frame(number).map_err(|error| said(&error))?;
        (0..).zip(&frame.robots).for_each(|(id, robot)| drop(recording.header.world.needs_of(id, robot)));
        let _ = recording.zones_on(frame.step);
    }
    for table in Table::ALL {
        let written: Result<_, Trouble> = table.write_csv(&recording, 50, std::io::sink());
        written.map_err(|Trouble(error)| error)?;
    }
    for picture in
        [moment(&recording, recording.frame_at(7.0), &Look::default()), trails(&recording, &Look::default())]
    {
        picture.map_err(|error| said(&error))?;
    }
    #[cfg(feature = "exports")]
    exports::mcap::write(&recording, 50, std::io::Cursor::new(Vec::new())).map_err(|error| said(&error))?;
    Ok(())
}

struct Trouble(String);

impl From<ReadError> for Trouble {
    fn from(error: ReadError) -> Self {
        Self(error.to_string())
    }
}

impl From<std::io::Error> for Trouble {
    fn from(error: std::io::Error) -> Self {
        Self(error.to_string())
    }
}

/// What takes the place of one value of a JSON text.
#[derive(Debug, Clone)]
struct Bend {
    /// The way to the value: a turn at each level, until it ends or a value has no entries.
    way: Vec<Index>,
    /// What is done to the last list or object on a way that ends in it.
    change: u8,
    /// What stands in the place of a value: anything if it is drawn, else mostly a number for a number.
    anything: Option<Value>,
    number: Value,
}

fn bends() -> impl Strategy<Value = Bend> {
    let numbers = [
        json!(0),
        json!(1),
        json!(2),
        json!(7),
        json!(-1),
        json!(65_535),
        json!(4_294_967_295_u32),
        json!(1_u64 << 32),
        json!(u64::MAX),
        json!(1e308),
        json!(-1e308),
        json!(0.5),
        json!(1e-320),
    ];
    let odd =
        [json!(null), json!([]), json!({}), json!(""), json!("?"), json!(true), json!([[]]), json!("1")];
    let way = prop::collection::vec(any::<Index>(), 1..12);
    let anything = prop::option::weighted(0.25, select(odd.to_vec()));
    (way, 0..8_u8, anything, select(numbers.to_vec())).prop_map(|(way, change, anything, number)| Bend {
        way,
        change,
        anything,
        number,
    })
}

impl Bend {
    fn bend(&self, value: &mut Value) {
        self.bend_along(&self.way, value);
    }

    fn bend_along(&self, way: &[Index], value: &mut Value) {
        match (value, way) {
            (Value::Object(fields), [turn, rest @ ..]) if !fields.is_empty() => {
                let key = fields.keys().nth(turn.index(fields.len())).unwrap().clone();
                match (rest, self.change) {
                    ([], 0) => drop(fields.remove(&key)),
                    _ => self.bend_along(rest, &mut fields[&key]),
                }
            }
            (Value::Array(entries), [turn, rest @ ..]) if !entries.is_empty() => {
                let at = turn.index(entries.len());
                match (rest, self.change) {
                    ([], 0) => entries.clear(),
                    ([], 1) => drop(entries.remove(at)),
                    ([], 2) => entries.push(entries[at].clone()),
                    ([], 3) => entries.truncate(at),
                    ([], 4) => entries.reverse(),
                    _ => self.bend_along(rest, &mut entries[at]),
                }
            }
            (value, _) => {
                *value = match (&self.anything, &*value) {
                    (Some(anything), _) => anything.clone(),
                    (_, Value::Bool(is_true)) => json!(!is_true),
                    (_, Value::String(text)) => json!(text.repeat(2)),
                    _ => self.number.clone(),
                }
            }
        }
    }
}

#[test]
fn bent_folders_are_read_or_refused() {
    let folder = place();
    succeeds(&usar(
        folder.path(),
        "sweep short.ron --set duration_s=120 --trials 2 --policies RNE,DIS --out done",
    ));
    let done = folder.path().join("done");
    let forged = Forged::of(&done);
    let tally = Tally::default();
    cases(60, (bends(), any::<bool>()), |(bend, is_reported)| {
        forged.line("\"policy\":\"DIS\",\"trial\":2,", |line| {
            let mut entry: Value = serde_json::from_str(line).unwrap();
            bend.bend(&mut entry["outcome"]);
            *line = entry.to_string();
        });
        tally.note(|| read_folder(&done, is_reported))
    });
    tally.is_both();
    let tally = Tally::default();
    cases(40, bends(), |bend| {
        forged.manifest(|manifest| {
            let mut bent = serde_json::to_value(&*manifest).unwrap();
            bend.bend(&mut bent);
            if let Ok(bent) = serde_json::from_value(bent) {
                *manifest = bent;
            }
        });
        tally.note(|| read_folder(&done, false))
    });
    tally.is_both();
    let tally = Tally::default();
    let cell = select(&["inf,", "NaN,", "1e300,", "-1,", ",", "", "x\n"][..]);
    cases(20, (any::<Index>(), cell), |(at, cell)| {
        forged.file("trials.csv", |text| {
            let mut cells: Vec<&str> = text.split_inclusive([',', '\n']).collect();
            *at.get_mut(&mut cells) = cell;
            cells.concat() + " "
        });
        tally.note(|| read_folder(&done, false))
    });
    assert!(tally.refused.get() > 4, "{tally:?}");
}

#[test]
fn bent_recordings_are_read_or_refused() {
    let folder = place();
    succeeds(&usar(folder.path(), "run short.ron --seed 3 --record-fps 2 --record sound.usrec"));
    let sound = std::fs::read(folder.path().join("sound.usrec")).unwrap();
    read_recording(&sound).unwrap();
    let chunks = chunks_of(&sound);
    let tally = Tally::default();
    // The header as often as all others together, and one of eight in a byte of its frames.
    let chunk = prop_oneof![4 => Just(None), 4 => any::<Index>().prop_map(Some)];
    cases(300, (chunk, bends(), any::<u8>()), |(chunk, bend, byte)| {
        let mut chunks = chunks.clone();
        let chunk = chunk.map_or(0, |chunk| chunk.index(chunks.len()));
        let (kind, content) = &mut chunks[chunk];
        if kind == b"SEGM" {
            let at = bend.way.first().map_or(0, |at| at.index(content.len()));
            content[at] = byte;
        } else {
            let mut value: Value = serde_json::from_slice(content).unwrap();
            bend.bend(&mut value);
            *content = value.to_string().into_bytes();
        }
        let bytes = [&sound[..MAGIC], &chunks.iter().flat_map(chunk_of).collect::<Vec<u8>>()].concat();
        tally.note(|| read_recording(&bytes))
    });
    tally.is_both();
}

/// The kinds and the inflated contents of a recording's chunks.
fn chunks_of(recording: &[u8]) -> Vec<(Vec<u8>, Vec<u8>)> {
    let (mut rest, mut chunks) = (&recording[MAGIC..], Vec::new());
    while !rest.is_empty() {
        let (head, after) = rest.split_at(HEAD);
        let size = u32::from_le_bytes(head[4..8].try_into().unwrap()) as usize;
        let (stored, after) = after.split_at(size);
        let mut content = Vec::new();
        DeflateDecoder::new(stored).read_to_end(&mut content).unwrap();
        chunks.push((head[..4].to_vec(), content));
        rest = after;
    }
    chunks
}

/// The bytes of a chunk, with its checksums.
fn chunk_of((kind, content): &(Vec<u8>, Vec<u8>)) -> Vec<u8> {
    let mut stored = Vec::new();
    DeflateEncoder::new(&content[..], Compression::fast()).read_to_end(&mut stored).unwrap();
    let checksum = |bytes: &[u8]| {
        let mut crc = flate2::Crc::new();
        crc.update(bytes);
        crc.sum().to_le_bytes()
    };
    let sizes = [stored.len() as u32, content.len() as u32].map(u32::to_le_bytes);
    let head = [&kind[..], &sizes[0], &sizes[1], &checksum(&stored)].concat();
    [&head[..], &checksum(&head), &stored].concat()
}

#[test]
fn a_record_that_does_not_fit_its_scenario_is_refused_by_name() {
    let folder = place();
    succeeds(&usar(folder.path(), "sweep short.ron --trials 2 --policies RNE,DIS --out done"));
    let done = folder.path().join("done");
    let forged = Forged::of(&done);
    let line = "done/journal.jsonl.gz: trial 2 of DIS (seed 2) does not fit its scenario: ";
    for (place, value, message) in [
        ("/record/tasks", "[]", "tasks must be the tasks of the scenario"),
        ("/deliveries", "[]", "deliveries must have 2 entries, one for each task, found 0"),
        ("/record/robots", "[]", "robots must be the robots of the scenario"),
        ("/record/rounds/0/task", "9", "rounds[0].task must be the number of a task, below 2, found 9"),
        ("/record/tasks/0/rescued", "4294967295", "tasks.rescued must add up to less than 2^32"),
        (
            "/record/tasks/0/energy",
            "1e308",
            "tasks[0].energy must be smaller: no trial has such a result, found 1e308",
        ),
        (
            "/record/rounds/0/members/0/id",
            "4294967295",
            "must be the number of a robot, below 12, found 4294967295",
        ),
        ("/record/decisions/0/question/members", "[]", "decisions[0].question does not fit: "),
        ("/record/seed", "7", "seed must be 2, found 7"),
    ] {
        forged.line("\"policy\":\"DIS\",\"trial\":2,", |line| {
            let mut entry: Value = serde_json::from_str(line).unwrap();
            let trial = &mut entry["outcome"]["Ended"]["trial"];
            *trial.pointer_mut(place).unwrap() = serde_json::from_str(value).unwrap();
            // The sum is of two counts.
            if place.ends_with("rescued") {
                trial["record"]["tasks"][1]["rescued"] = 1.into();
            }
            *line = entry.to_string();
        });
        refused(folder.path(), 2, "export done --to tidy.csv", &[line, message]);
    }
}
