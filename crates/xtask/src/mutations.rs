//! Damaged files for all loaders: valid scenarios, sweep files, tables, questions and snapshots with bytes
//! changed at random.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use experiments::experiment::{Experiment, Overrides};
use experiments::input_table::InputTable;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rne_core::Question;
use usar_sim::scenario::Scenario;
use usar_sim::simulation::Simulation;
use usar_sim::snapshot::Identity;

/// Bytes with a meaning in the formats.
const SPECIAL: &[u8] = b"()[]{},:\"'\\/*#.-+eE0193_ \n\t\0\xff\xc3";

/// The counts of a run.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Number of files that were loaded nevertheless.
    pub loaded: u32,
    /// Number of files that were refused.
    pub refused: u32,
    /// Files with which a loader panicked: the kind, and the mutation's number.
    pub panics: Vec<(&'static str, u64)>,
    /// Longest time that a loader took.
    pub longest: Duration,
}

/// Returns whether a file with these bytes is loaded.
type Loader = dyn Fn(&[u8]) -> bool;

/// A kind of file: a valid file, and its loader.
struct Kind {
    name: &'static str,
    good: Vec<u8>,
    loads: Box<Loader>,
}

/// Loads this many damaged files, the kinds in turn. `folder` is used for kinds that are read from disk.
pub fn run(count: u64, first: u64, folder: &Path) -> Outcome {
    let kinds = kinds(folder);
    let mut outcome = Outcome::default();
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    for number in first..first + count {
        let kind = &kinds[number as usize % kinds.len()];
        let bytes = damaged(&kind.good, number);
        let start = Instant::now();
        match catch_unwind(AssertUnwindSafe(|| (kind.loads)(&bytes))) {
            Ok(true) => outcome.loaded += 1,
            Ok(false) => outcome.refused += 1,
            Err(_) => outcome.panics.push((kind.name, number)),
        }
        outcome.longest = outcome.longest.max(start.elapsed());
    }
    std::panic::set_hook(hook);
    outcome
}

/// Applies one to eight changes: a byte changed, added or removed, a part repeated or removed, or the end
/// cut off.
fn damaged(good: &[u8], number: u64) -> Vec<u8> {
    let mut draws = ChaCha8Rng::seed_from_u64(number);
    let mut bytes = good.to_vec();
    for _ in 0..draws.random_range(1..=8) {
        let at = draws.random_range(0..bytes.len().max(1)).min(bytes.len());
        let end = (at + draws.random_range(0..40)).min(bytes.len());
        let special = SPECIAL[draws.random_range(0..SPECIAL.len())];
        match draws.random_range(0..8) {
            0 if at < bytes.len() => bytes[at] = draws.random_range(0..=255),
            1 if at < bytes.len() => bytes[at] = special,
            2 if at < bytes.len() => bytes[at] ^= 1 << draws.random_range(0..8),
            3 => bytes.insert(at, special),
            4 => drop(bytes.drain(at..end)),
            5 => {
                let part = bytes[at..end].repeat(draws.random_range(1..100));
                bytes.splice(at..at, part);
            }
            6 if draws.random_range(0..10) == 0 => bytes.truncate(at),
            _ => bytes.insert(at, SPECIAL[draws.random_range(0..12)]),
        }
    }
    bytes
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn kinds(folder: &Path) -> Vec<Kind> {
    let text = |path: &str| std::fs::read(root().join(path)).expect("a file of the repository");
    let scenario = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes);
        Scenario::parse(&text, "damaged.ron".as_ref()).map_err(|error| error.to_string()).is_ok()
    };
    let sweep = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes).into_owned();
        let place = root().join("scenarios/sweeps/damaged.ron");
        Experiment::parse(text, &place, &Overrides::default(), &policies::standard())
            .map_err(|error| error.to_string())
            .is_ok()
    };
    let path = folder.join("damaged.csv");
    let table = move |bytes: &[u8]| {
        std::fs::write(&path, bytes).expect("the folder can be written to");
        InputTable::read(&path).map_err(|error| error.to_string()).is_ok()
    };
    let world = Scenario::load(&root().join("scenarios/minimal/pushed.ron")).expect("it loads").0;
    let snapshot = Simulation::new(&world, 1).expect("it is drawn").snapshot("RNE");
    let restored =
        move |bytes: &[u8]| Identity::of(bytes).is_ok() && Simulation::restore(&world, bytes).is_ok();
    let walls = b"(name: \"w\", duration_s: 9, dt_s: 0.02, arena_m: (30, 20), team: [(role: \"robot\", \
        count: 2, center: (5, 5), width_m: 3,
        levels: (energy: 50, hp: 60), body: (speed_mps: 3, capacity: 2))], mission: (rest_s: 10), walls: \
        [((9, 2), (9, 18)), (from: (20, 2),
        to: (20, 18), thickness_m: 0.5, doors: [(at_m: 3, width_m: 2)])], conflicts: (resolver: \
        Rotation(margin_m: 0.2)),
        errands: [(robot: 0, to: [(6, 15), (3, 3)])])";
    let over = b"(base: \"minimal/pushed.ron\", name: \"over\", mission: (rest_s: 10.0), roles: (heavy: \
        (speed_mps: 3.0)), debris: [])";
    let based = |bytes: &[u8]| {
        let place = root().join("scenarios/damaged.ron");
        Scenario::parse(&String::from_utf8_lossy(bytes), &place).map_err(|error| error.to_string()).is_ok()
    };
    let drawn = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes);
        let scenario = Scenario::parse(&text, "damaged.ron".as_ref()).map_err(|error| error.to_string());
        let Ok(scenario) = scenario else { return false };
        Simulation::new(&scenario, 1).map_err(|error| error.to_string()).is_ok()
    };
    let laid_out = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes);
        ron_tree::formatted(&text).is_ok()
    };
    let question = |bytes: &[u8]| Question::from_json(&String::from_utf8_lossy(bytes)).is_ok();
    let kind = |name, good: Vec<u8>, loads: Box<Loader>| Kind { name, good, loads };
    vec![
        kind("scenario", text("scenarios/minimal/pushed.ron"), Box::new(scenario)),
        kind("scenario with walls", walls.to_vec(), Box::new(scenario)),
        kind("scenario over a base", over.to_vec(), Box::new(based)),
        kind("scenario with distributions", text("scenarios/tutorial/08-chance.ron"), Box::new(drawn)),
        kind("scenario with a timeline", text("scenarios/tutorial/09-timeline.ron"), Box::new(drawn)),
        kind("file to lay out", text("scenarios/tutorial/09-timeline.ron"), Box::new(laid_out)),
        kind("sweep", text("scenarios/sweeps/turning-back.ron"), Box::new(sweep)),
        kind("table", text("scenarios/reference/dis_trials.csv"), Box::new(table)),
        kind("snapshot", snapshot, Box::new(restored)),
        kind("question", QUESTION.as_bytes().to_vec(), Box::new(question)),
    ]
}

const QUESTION: &str = r#"{"schema_version":2,"round":1,"roles":["a"],"needs":[{"name":"n","weight":1.0}],"tasks":[{"name":"x","difficulty":2,"place":[1.0,2.0]},{"name":"y","difficulty":1,"place":null}],"quotas":[{"members":[1,1],"sizes":"Parts"}],"members":[{"id":0,"role":0,"home":[0.0,0.0],"needs":[1.0],"energy_level":50.0,"hp_level":50.0},{"id":1,"role":0,"home":[1.0,0.0],"needs":[2.0],"energy_level":60.0,"hp_level":70.0}],"history":[],"random_seed":"0000"}"#;
