//! Damaged folders of finished sweeps: each flipped bit is found and mended, and each forged number is found
//! although every checksum was computed anew.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use experiments::experiment::Experiment;
use experiments::run::{Limits, Outcome, Sessions, TrialKey};
use experiments::sweep::audit::{difference, strange_files};
use experiments::sweep::folder::{Folder, Opening};
use experiments::sweep::{missing, run_trials};
use proptest::prelude::*;
use proptest::sample::Index;

use crate::altered_results::{Forged, cases, files};
use crate::place::place;
use crate::support::{succeeds, usar};

/// A finished sweep in a folder, with its trials run again.
struct Sound {
    path: PathBuf,
    experiment: Arc<Experiment>,
    again: Vec<Outcome>,
    forged: Forged,
}

impl Sound {
    /// A sweep of four trials in this folder.
    fn within(folder: &tempfile::TempDir) -> Self {
        succeeds(&usar(folder.path(), "sweep short.ron --trials 2 --policies RNE,DIS --out done"));
        let path = folder.path().join("done");
        let experiment = Folder::read(&path, &policies::standard()).unwrap().shared_experiment();
        let halt = AtomicBool::new(false);
        let run = |key: TrialKey| Outcome {
            result: experiment.run_alone(&key, &mut Sessions::default(), &halt),
            key,
        };
        let again = experiment.keys(None).map(run).collect();
        Self { forged: Forged::of(&path), path, experiment, again }
    }

    /// Whether verification finds a difference.
    fn is_found(&self) -> bool {
        let Ok((mut folder, damage)) = Folder::read_damaged(&self.path, &policies::standard()) else {
            return true;
        };
        let differs = |outcome| difference(&mut folder, outcome).is_ok_and(|difference| difference.is_some());
        damage.is_some()
            || self.again.iter().any(differs)
            || !strange_files(&mut folder).is_ok_and(|strange| strange.is_empty())
    }

    /// Whether the sweep's command refuses the folder, or restores it to its state before the damage.
    fn is_mended(&self) -> bool {
        let experiment = Arc::clone(&self.experiment);
        let Ok(mut folder) = Folder::open(&self.path, experiment, Opening::default(), &mut |_| {}) else {
            return true;
        };
        let (limits, stop) = (Limits { jobs: 1, trial: None }, AtomicBool::new(false));
        let left = missing(&folder, None);
        run_trials(&mut folder, left, limits, &stop, |_| {}).unwrap();
        folder.finish(&stop).unwrap();
        files(&self.path) == self.forged.sound
    }
}

#[test]
fn each_flipped_bit_is_found_and_mended() {
    let folder = place();
    let sound = Sound::within(&folder);
    cases(32, (any::<Index>(), any::<Index>(), 0..8_u32), |(file, at, bit)| {
        sound.forged.restore();
        let (name, bytes) = sound.forged.sound.iter().nth(file.index(sound.forged.sound.len())).unwrap();
        let (mut bytes, at) = (bytes.clone(), at.index(bytes.len()));
        bytes[at] ^= 1 << bit;
        std::fs::write(sound.path.join(name), bytes).unwrap();
        prop_assert!(sound.is_found(), "not found: {}, byte {}", name, at);
        prop_assert!(sound.is_mended(), "not mended: {}, byte {}", name, at);
        Ok(())
    });
}

#[test]
fn each_forged_number_is_found() {
    let folder = place();
    let sound = Sound::within(&folder);
    cases(16, (any::<Index>(), any::<Index>(), 1..10_u8), |(place, digit, more)| {
        let change = |text: &str| other_digit(text, digit, more);
        match sound.again.get(place.index(sound.again.len() + 1)) {
            None => sound.forged.file("trials.csv", |text| change(&text)),
            Some(Outcome { key, .. }) => {
                let with = format!("\"policy\":\"{}\",\"trial\":{},", key.label, key.trial);
                sound.forged.line(&with, |line| *line = change(line));
            }
        }
        prop_assert!(sound.is_found());
        Ok(())
    });
}

/// The text with one of its digits replaced by another digit.
fn other_digit(text: &str, digit: Index, more: u8) -> String {
    let places: Vec<usize> =
        text.bytes().enumerate().filter(|(_, c)| c.is_ascii_digit()).map(|(i, _)| i).collect();
    let at = *digit.get(&places);
    let digit = (text.as_bytes()[at] - b'0' + more) % 10;
    format!("{}{digit}{}", &text[..at], &text[at + 1..])
}
