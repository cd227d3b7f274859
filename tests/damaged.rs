//! Damaged texts and bytes: every loader reads them or refuses them within a second, and none panics.
//!
//! Each case damages a file of each of ten kinds, from one seed on. `PROPTEST_CASES=10000` is a long run.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use experiments::experiment::{Experiment, Overrides};
use experiments::input_table::InputTable;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use proptest::test_runner::{RngSeed, TestRunner, contextualize_config};
use scenario::Scenario;
use teaming::Question;
use usar_sim::simulation::Simulation;
use usar_sim::snapshot::Identity;

use crate::support::root;

/// Longest time that a loader may take.
const LONGEST: Duration = Duration::from_secs(1);

/// Bytes with a meaning in the formats.
const SPECIAL: &[u8] = b"()[]{},:\"'\\/*#.-+eE0193_ \n\t\0\xff\xc3";

const WALLS: &str = "(name: \"w\", duration_s: 9, dt_s: 0.02, arena_m: (30, 20), team: [(role: \"robot\", \
    count: 2, center: (5, 5), width_m: 3,
    levels: (energy: 50, hp: 60), body: (speed_mps: 3, capacity: 2))], mission: (rest_s: 10), walls: \
    [((9, 2), (9, 18)), (from: (20, 2),
    to: (20, 18), thickness_m: 0.5, doors: [(at_m: 3, width_m: 2)])], conflicts: (resolver: \
    Rotation(margin_m: 0.2)),
    errands: [(robot: 0, to: [(6, 15), (3, 3)])])";

const OVER: &str = "(base: \"minimal/pushed.ron\", name: \"over\", mission: (rest_s: 10.0), roles: (heavy: \
    (speed_mps: 3.0)), debris: [])";

const QUESTION: &str = concat!(
    r#"{"schema_version":3,"round":1,"roles":["a"],"needs":[{"name":"n","weight":1.0}],"#,
    r#""levels":[{"name":"energy","unit":"%"},{"name":"hp","unit":"%"}],"#,
    r#""tasks":[{"name":"x","difficulty":2,"place":[1.0,2.0]},{"name":"y","difficulty":1,"place":null}],"#,
    r#""quotas":[{"members":[1,1],"sizes":"Parts"}],"#,
    r#""members":[{"id":0,"role":0,"home":[0.0,0.0],"needs":[1.0],"levels":[50.0,50.0]},"#,
    r#"{"id":1,"role":0,"home":[1.0,0.0],"needs":[2.0],"levels":[60.0,null]}],"#,
    r#""history":[],"random_seed":"0000"}"#,
);

/// One change of a file, at a place of its own.
#[derive(Debug, Clone)]
enum Damage {
    Set(u8),
    Flip(u32),
    Insert(u8),
    Remove(usize),
    Repeat(usize, usize),
    Cut,
}

fn damages() -> impl Strategy<Value = Vec<(Index, Damage)>> {
    let damage = prop_oneof![
        20 => prop_oneof![any::<u8>(), select(SPECIAL)].prop_map(Damage::Set),
        10 => (0..8_u32).prop_map(Damage::Flip),
        30 => select(SPECIAL).prop_map(Damage::Insert),
        10 => (0..40_usize).prop_map(Damage::Remove),
        10 => (0..40_usize, 1..100_usize).prop_map(|(bytes, times)| Damage::Repeat(bytes, times)),
        1 => Just(Damage::Cut),
    ];
    prop::collection::vec((any::<Index>(), damage), 1..=8)
}

fn damaged(sound: &[u8], damages: &[(Index, Damage)]) -> Vec<u8> {
    let mut bytes = sound.to_vec();
    for (at, damage) in damages {
        let size = bytes.len();
        let at = at.index(size.max(1));
        match *damage {
            _ if size == 0 => {}
            Damage::Set(byte) => bytes[at] = byte,
            Damage::Flip(bit) => bytes[at] ^= 1 << bit,
            Damage::Insert(byte) => bytes.insert(at, byte),
            Damage::Remove(count) => drop(bytes.drain(at..size.min(at + count))),
            Damage::Repeat(count, times) => {
                let part = bytes[at..size.min(at + count)].repeat(times);
                bytes.splice(at..at, part);
            }
            Damage::Cut => bytes.truncate(at),
        }
    }
    bytes
}

/// Whether a file with these bytes is loaded.
type Loads = Box<dyn Fn(&[u8]) -> bool>;

/// The kinds of files: a name, a sound file, and its loader.
fn kinds(folder: &tempfile::TempDir) -> Vec<(&'static str, Vec<u8>, Loads)> {
    let file = |path: &str| std::fs::read(root().join("scenarios").join(path)).unwrap();
    let parsed = |bytes: &[u8], name: &str| {
        let path = root().join("scenarios").join(name);
        Scenario::parse(&String::from_utf8_lossy(bytes), &path).map_err(|error| error.to_string())
    };
    let scenario = move |bytes: &[u8]| parsed(bytes, "damaged.ron").is_ok();
    let drawn = move |bytes: &[u8]| {
        let scenario = parsed(bytes, "damaged.ron");
        scenario.and_then(|it| Simulation::new(&it, 1).map_err(|error| error.to_string())).is_ok()
    };
    let sweep = |bytes: &[u8]| {
        let text = String::from_utf8_lossy(bytes).into_owned();
        let place = root().join("scenarios/sweeps/damaged.ron");
        let sweep = Experiment::parse(text, &place, &Overrides::default(), &policies::standard());
        sweep.map_err(|error| error.to_string()).is_ok()
    };
    let path = folder.path().join("damaged.csv");
    let table = move |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        InputTable::read(&path).map_err(|error| error.to_string()).is_ok()
    };
    let world = Scenario::load(&root().join("scenarios/minimal/pushed.ron")).unwrap().0;
    let saved = Simulation::new(&world, 1).unwrap().snapshot("RNE");
    let snapshot =
        move |bytes: &[u8]| Identity::of(bytes).is_ok() && Simulation::restore(&world, bytes).is_ok();
    let laid_out = |bytes: &[u8]| ron_tree::formatted(&String::from_utf8_lossy(bytes)).is_ok();
    let question = |bytes: &[u8]| Question::from_json(&String::from_utf8_lossy(bytes)).is_ok();
    vec![
        ("scenario", file("minimal/pushed.ron"), Box::new(scenario)),
        ("scenario with walls", WALLS.into(), Box::new(scenario)),
        ("scenario over a base", OVER.into(), Box::new(scenario)),
        ("scenario with distributions", file("tutorial/08-chance.ron"), Box::new(drawn)),
        ("scenario with a timeline", file("tutorial/09-timeline.ron"), Box::new(drawn)),
        ("file to lay out", file("tutorial/09-timeline.ron"), Box::new(laid_out)),
        ("sweep", file("sweeps/turning-back.ron"), Box::new(sweep)),
        ("table", file("reference/dis_trials.csv"), Box::new(table)),
        ("snapshot", saved, Box::new(snapshot)),
        ("question", QUESTION.into(), Box::new(question)),
    ]
}

#[test]
fn no_loader_panics_at_a_damaged_file_or_takes_a_second() {
    let folder = tempfile::tempdir().unwrap();
    let kinds = kinds(&folder);
    let (loaded, refused) = (Cell::new(0), Cell::new(0));
    let config = ProptestConfig {
        cases: 500,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let outcome = TestRunner::new(contextualize_config(config)).run(&damages(), |damages| {
        for (name, sound, loads) in &kinds {
            let (bytes, start) = (damaged(sound, &damages), Instant::now());
            let Ok(is_loaded) = catch_unwind(AssertUnwindSafe(|| loads(&bytes))) else {
                return Err(TestCaseError::fail(format!("{name}: the loader panicked")));
            };
            let count = if is_loaded { &loaded } else { &refused };
            count.set(count.get() + 1);
            prop_assert!(start.elapsed() < LONGEST, "{}: {:?}", name, start.elapsed());
        }
        Ok(())
    });
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
    assert!(refused.get() > loaded.get() && loaded.get() > 50, "{loaded:?} loaded, {refused:?} refused");
}
