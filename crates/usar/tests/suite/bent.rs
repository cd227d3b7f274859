//! Results whose JSON and checksums are sound, but in which a value is another one. Whatever reads them reads
//! them or refuses them with a sentence; nothing panics, and no sentence names a type of the program.

use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use experiments::Failure;
use experiments::comparison::compare;
use experiments::sweep::audit::strange_files;
use experiments::sweep::folder::Folder;
use experiments::sweep::merge::Merge;
use experiments::sweep::tidy_rows;
use pictures::{Look, moment, trails};
use recording::{ReadError, Recording, Table};
use reports::{Wanted, write_report};
use serde_json::Value;
use xtask::bend::{bend, bent_recording};
use xtask::damage::Forged;

use crate::place::{place, refused};
use crate::support::{succeeds, usar};

/// How many were read and how many were refused.
#[derive(Debug, Default)]
struct Tally {
    read: u32,
    refused: u32,
}

impl Tally {
    /// Reads something, and checks how it is refused if it is.
    fn note<E: Display>(&mut self, what: &str, read: impl FnOnce() -> Result<(), E>) {
        match catch_unwind(AssertUnwindSafe(read)) {
            Err(panic) => panic!("{what}: the reader panicked: {}", experiments::panic_message(&*panic)),
            Ok(Ok(())) => self.read += 1,
            Ok(Err(error)) => {
                let said = error.to_string();
                assert!(!said.contains("struct ") && !said.contains("enum "), "{what}: {said}");
                self.refused += 1;
            }
        }
    }

    #[track_caller]
    fn is_both(&self) {
        assert!(self.read > 0 && self.refused > 4, "{self:?}");
    }
}

/// Everything that is read of a folder of results. Every fourth time its report is written, which takes longest.
fn read_folder(path: &Path, number: u64) -> Result<(), Failure> {
    let registry = policies::standard();
    let mut folder = Folder::read(path, &registry)?;
    tidy_rows(&mut folder, |_| Ok(()))?;
    let wanted = Wanted::of(folder.experiment())?;
    let metrics: Vec<usize> = (0..folder.experiment().metrics.len()).collect();
    compare(&folder, &metrics, wanted.asked.choice())?;
    if number.is_multiple_of(4) {
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
    exports::mcap::write(&recording, 50, std::io::Cursor::new(Vec::new()))
        .map(drop)
        .map_err(|error| said(&error))
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

#[test]
fn bent_folders_are_read_or_refused() {
    let folder = place();
    succeeds(&usar(
        folder.path(),
        "sweep short.ron --set duration_s=120 --trials 2 --policies RNE,DIS --out done",
    ));
    let done = folder.path().join("done");
    let forged = Forged::of(&done);
    let mut tally = Tally::default();
    for number in 0..count(60) {
        forged.line("\"policy\":\"DIS\",\"trial\":2,", |line| {
            let mut entry: Value = serde_json::from_str(line).unwrap();
            bend(&mut entry["outcome"], number);
            *line = entry.to_string();
        });
        tally.note(&format!("journal {number}"), || read_folder(&done, number));
    }
    tally.is_both();
    let mut tally = Tally::default();
    for number in 0..count(40) {
        forged.manifest(|manifest| {
            let mut bent = serde_json::to_value(&*manifest).unwrap();
            bend(&mut bent, number);
            if let Ok(bent) = serde_json::from_value(bent) {
                *manifest = bent;
            }
        });
        tally.note(&format!("manifest {number}"), || read_folder(&done, number));
    }
    tally.is_both();
    let mut tally = Tally::default();
    for number in 0..count(20) {
        forged.file("trials.csv", |text| {
            let mut cells: Vec<&str> = text.split_inclusive([',', '\n']).collect();
            let at = number as usize * 7919 % cells.len();
            cells[at] = ["inf,", "NaN,", "1e300,", "-1,", ",", "", "x\n"][number as usize % 7];
            cells.concat() + " "
        });
        tally.note(&format!("trials {number}"), || read_folder(&done, number));
    }
    assert!(tally.refused > 4, "{tally:?}");
}

#[test]
fn bent_recordings_are_read_or_refused() {
    let folder = place();
    succeeds(&usar(folder.path(), "run short.ron --seed 3 --record-fps 2 --record sound.usrec"));
    let sound = std::fs::read(folder.path().join("sound.usrec")).unwrap();
    read_recording(&sound).unwrap();
    let mut tally = Tally::default();
    for number in 0..count(300) {
        let bent = bent_recording(&sound, number);
        tally.note(&format!("recording {number}"), || read_recording(&bent));
    }
    tally.is_both();
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
        refused(folder.path(), 2, "export table done --out tidy.csv", &[line, message]);
    }
}

/// How often something is bent: as often as here, or as `USAR_BENDS` says.
fn count(usually: u64) -> u64 {
    std::env::var("USAR_BENDS").ok().and_then(|count| count.parse().ok()).unwrap_or(usually)
}
