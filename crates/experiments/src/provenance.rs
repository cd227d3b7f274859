//! Where results come from: enough to make them again.

use serde::Serialize;
use usar_sim::scenario::Scenario;
use xxhash_rust::xxh3::xxh3_128;

/// `manifest.json`. Holds nothing that differs between two runs of the same sweep: no time of day, no number of threads.
#[derive(Debug, Serialize)]
pub struct Manifest {
    schema_version: u32,
    program: &'static str,
    version: &'static str,
    /// Commit of the source, with `-dirty` where it was changed.
    commit: &'static str,
    /// Features that change numbers.
    features: [&'static str; 1],
    scenario: String,
    policies: Vec<String>,
    trials: u32,
    seeds: Vec<u64>,
    /// XXH3-128 of each file, in hexadecimal digits.
    files: Vec<FileHash>,
}

#[derive(Debug, Serialize)]
struct FileHash {
    name: &'static str,
    xxh3_128: String,
}

impl Manifest {
    /// The manifest of a sweep with these files.
    #[must_use]
    pub fn new(scenario: &Scenario, files: &[(&'static str, Vec<u8>)]) -> Self {
        let first = scenario.sweep.first_seed;
        Self {
            schema_version: 1,
            program: "usar",
            version: env!("CARGO_PKG_VERSION"),
            commit: env!("USAR_COMMIT"),
            features: ["rapier2d/enhanced-determinism"],
            scenario: scenario.name.clone(),
            policies: scenario.sweep.policies.clone(),
            trials: scenario.sweep.trials,
            seeds: (0..scenario.sweep.trials).map(|i| first.wrapping_add(u64::from(i))).collect(),
            files: files
                .iter()
                .map(|(name, content)| FileHash { name, xxh3_128: format!("{:032x}", xxh3_128(content)) })
                .collect(),
        }
    }
}
