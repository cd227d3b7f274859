//! What comes out of fixed trials, and the hashes of their last states: computed, and expected.

use std::fmt::{self, Write};
use std::path::{Path, PathBuf};

use scenario::Scenario;
use usar_sim::record::{Status, TrialRecord};
use usar_sim::simulation::Simulation;
use usar_sim::{BITS, HASH_FORMAT};
use xxhash_rust::xxh3::xxh3_128;

use crate::docs::place;

/// Time between two poses that count in an outcome, in seconds.
const POSES_S: f64 = 10.0;

/// What is said, carried and believed in the worlds with lies.
const LIES: &str = r#"
    reports: (every_s: 10, sensors: {"carrier": (energy: (sd: 2, dropout: 0.1), hp: (sd: 3))}),
    medium: (range_m: 60, loss: GilbertElliott(p: 0.05, r: 0.25, good: 0, bad: 1), delay_s: 0.2, kbps: 20),
    deceit: [(who: Count(3), lie: Exaggerate(by: 0.6), on: [Energy, Hp]), (who: Count(2), lie: Flip)],
)"#;

/// What came out of a trial.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Golden {
    name: String,
    /// Hash of the last state.
    state: String,
    /// Hash of the results, of all events, and of the poses every ten seconds.
    outcome: String,
}

/// What came out of all trials, and of which program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Goldens {
    bits: u32,
    hash_format: u32,
    trials: Vec<Golden>,
}

/// Path of the file with what is expected.
pub fn path() -> PathBuf {
    place("tests/golden.txt")
}

impl Goldens {
    /// Runs all trials, each with seed 1: the small worlds under RNE; then, with lies and a radio that loses
    /// and delays, the trust worlds and the leak behind estimators.
    pub fn computed() -> Self {
        let small = worlds("scenarios/minimal").into_iter().map(|path| golden(&path, "RNE", None));
        let estimators = ["Wmsr(f: 1, aged: false)", "Hmm | Discount", "Kalman(restart: 0)"];
        let lied = worlds("scenarios/trust").into_iter().chain([place("scenarios/leak.ron")]).enumerate();
        let lied = lied.map(|(number, path)| {
            let policy = format!("HP_DIS <- {}", estimators[number % estimators.len()]);
            golden(&path, &policy, Some(LIES))
        });
        let paper = [place("scenarios/paper.ron")].into_iter().map(|path| golden(&path, "RNE", None));
        Self { bits: BITS, hash_format: HASH_FORMAT, trials: small.chain(lied).chain(paper).collect() }
    }

    /// Reads the text of the file.
    pub fn parse(text: &str) -> Option<Self> {
        let mut lines = text.lines();
        let head: Vec<&str> = lines.next()?.split(' ').collect();
        let trial = |line: &str| {
            let [name, state, outcome] = line.split(' ').collect::<Vec<_>>().try_into().ok()?;
            Some(Golden {
                name: String::from(name),
                state: str::to_owned(state),
                outcome: str::to_owned(outcome),
            })
        };
        Some(Self {
            bits: head.get(1)?.parse().ok()?,
            hash_format: head.get(3)?.parse().ok()?,
            trials: lines.map(trial).collect::<Option<_>>()?,
        })
    }

    /// Number of the trials.
    pub fn count(&self) -> usize {
        self.trials.len()
    }

    /// Why these must not take the place of those that were expected; none if they may.
    pub fn refused_after(&self, expected: &Self) -> Option<String> {
        let differ = |of: fn(&Golden) -> &String| {
            let both = self.trials.iter().filter_map(|now| {
                let before = expected.trials.iter().find(|before| before.name == now.name)?;
                (of(now) != of(before)).then_some(now.name.as_str())
            });
            both.collect::<Vec<_>>()
        };
        let (outcomes, states) = (differ(|trial| &trial.outcome), differ(|trial| &trial.state));
        if !outcomes.is_empty() && self.bits == expected.bits {
            return Some(format!(
                "what comes out of trials has changed ({}): usar_sim::BITS must be raised from {BITS}",
                outcomes.join(", ")
            ));
        }
        let is_written_otherwise = outcomes.is_empty() && !states.is_empty();
        (is_written_otherwise && self.hash_format == expected.hash_format).then(|| {
            format!(
                "hashes of states have changed, but nothing that comes out of trials ({}): \
                 usar_sim::HASH_FORMAT must be raised from {HASH_FORMAT}",
                states.join(", ")
            )
        })
    }
}

impl fmt::Display for Goldens {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "bits {} hash_format {}", self.bits, self.hash_format)?;
        self.trials.iter().try_for_each(|of| writeln!(f, "{} {} {}", of.name, of.state, of.outcome))
    }
}

/// The scenarios in a folder, by name.
fn worlds(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(place(folder)).expect("there are worlds");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
    files.sort();
    files
}

/// Runs a trial of the scenario in a file, with more fields at its end.
fn golden(path: &Path, policy: &str, more: Option<&str>) -> Golden {
    let mut text = std::fs::read_to_string(path).expect("a scenario");
    if let Some(more) = more {
        text.truncate(text.trim_end().len() - 1);
        text.push_str(more);
    }
    let scenario = Scenario::parse(&text, path).unwrap_or_else(|error| panic!("{error}"));
    let trial = Simulation::new(&scenario, 1).expect("drawn");
    let (mut story, mut poses_s) = (String::new(), 0.0);
    let record =
        trial.run(&mut *policies::standard().open(policy).expect("known"), |time_s, events, world| {
            for event in events {
                writeln!(story, "{time_s} {}", serde_json::to_string(event).expect("an event"))
                    .expect("memory");
            }
            if time_s >= poses_s {
                poses_s += POSES_S;
                world
                    .robots
                    .iter()
                    .for_each(|robot| writeln!(story, "{:?}", robot.position).expect("memory"));
            }
        });
    let TrialRecord { state_hash: state, status, time_s, tasks, rounds, robots, counts, .. } = record;
    assert!(!matches!(status, Status::Failed(_)), "{}: {status:?}", path.display());
    let spent = [record.ungrouped_energy, record.ungrouped_hp];
    let summary = (status, time_s, tasks, rounds, robots, counts, spent);
    story += &serde_json::to_string(&summary).expect("a summary");
    Golden { name: scenario.name.clone(), state, outcome: format!("{:032x}", xxh3_128(story.as_bytes())) }
}
