//! `hashes.csv`: the hash chains of all trials, written by a sweep and compared when it is verified.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use usar_sim::hash::{Link, PARTS};

use super::Outcome;
use crate::failure::Failure;

/// Name of the table.
pub const FILE: &str = "hashes.csv";

/// A row: one link of a trial's hash chain.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct LinkRow {
    policy: String,
    trial: u32,
    step: u64,
    /// 32 hexadecimal digits.
    digest: String,
    /// Four hexadecimal digits for each part of the state, in the order of [`PARTS`].
    parts: String,
}

impl LinkRow {
    pub(super) fn of(outcome: &Outcome) -> impl Iterator<Item = Self> {
        let links = outcome.record().map(|record| record.chain.links()).unwrap_or_default();
        links.iter().map(|link| Self {
            policy: outcome.key.policy_name.clone(),
            trial: outcome.key.trial,
            step: link.step,
            digest: format!("{:032x}", link.digest),
            parts: link.parts.map(|part| format!("{part:04x}")).concat(),
        })
    }

    fn link(&self) -> Option<Link> {
        let digest = u128::from_str_radix(&self.digest, 16).ok()?;
        let mut parts = [0; PARTS.len()];
        for (i, part) in parts.iter_mut().enumerate() {
            *part = u16::from_str_radix(self.parts.get(4 * i..4 * i + 4)?, 16).ok()?;
        }
        Some(Link { step: self.step, parts, digest })
    }
}

/// The chains by policy and number of the trial.
pub type Chains = BTreeMap<(String, u32), Vec<Link>>;

/// Reads the table of a sweep's folder.
///
/// # Errors
/// It is missing, or not such a table.
pub fn read(folder: &Path) -> Result<Chains, Failure> {
    let path = folder.join(FILE);
    let mut reader = csv::Reader::from_path(&path).map_err(|error| {
        Failure::input(format!(
            "{}: is not the folder of a finished sweep: {FILE}: {error}",
            folder.display()
        ))
    })?;
    let mut chains = Chains::new();
    for (row, line) in reader.deserialize::<LinkRow>().zip(2..) {
        let bad = |reason: String| Failure::input(format!("{}:{line}: {reason}", path.display()));
        let row = row.map_err(|error| bad(error.to_string()))?;
        let link =
            row.link().ok_or_else(|| bad("digest and parts must be hexadecimal digits, 32 and 40".into()))?;
        chains.entry((row.policy, row.trial)).or_default().push(link);
    }
    Ok(chains)
}
