//! `hashes.csv`: the hash chains of all trials, written by a sweep and compared when it is verified.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use usar_sim::hash::{HashChain, Link, PARTS};

use crate::failure::Failure;
use crate::run::Outcome;

/// Name of the table.
pub const FILE: &str = "hashes.csv";

/// A row: one link of a trial's hash chain.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct LinkRow {
    policy: String,
    trial: u32,
    step: u64,
    /// 32 hexadecimal digits.
    digest: String,
    /// Four hexadecimal digits for each part of the state, in the order of [`PARTS`].
    parts: String,
}

/// The column that tells cases apart, where there are several.
#[derive(Debug, Deserialize)]
struct CaseColumn {
    #[serde(default)]
    case: Option<usize>,
}

impl LinkRow {
    pub(super) fn of(outcome: &Outcome) -> impl Iterator<Item = Self> {
        let links = outcome.record().map(|record| record.chain.links()).unwrap_or_default();
        links.iter().map(|link| Self {
            policy: outcome.key.label.clone(),
            trial: outcome.key.trial,
            step: link.step,
            digest: format!("{:032x}", link.digest),
            parts: link.parts.map(|part| format!("{part:04x}")).concat(),
        })
    }

    fn link(&self) -> Option<Link> {
        link_of(self.step, &self.digest, &self.parts)
    }
}

fn link_of(step: u64, digest: &str, digits: &str) -> Option<Link> {
    let digest = u128::from_str_radix(digest, 16).ok()?;
    let mut parts = [0; PARTS.len()];
    for (i, part) in parts.iter_mut().enumerate() {
        *part = u16::from_str_radix(digits.get(4 * i..4 * i + 4)?, 16).ok()?;
    }
    Some(Link { step, parts, digest })
}

/// A chain as one text.
pub(super) fn encode(links: &[Link]) -> String {
    let link = |link: &Link| {
        let parts = link.parts.map(|part| format!("{part:04x}")).concat();
        format!("{}:{:032x}:{parts}", link.step, link.digest)
    };
    links.iter().map(link).collect::<Vec<_>>().join(" ")
}

/// The chain that a text holds.
pub(super) fn decode(text: &str) -> Option<HashChain> {
    let link = |text: &str| {
        let mut pieces = text.split(':');
        let (step, digest, parts) = (pieces.next()?, pieces.next()?, pieces.next()?);
        link_of(step.parse().ok()?, digest, parts)
    };
    Some(HashChain::of(text.split_whitespace().map(link).collect::<Option<Vec<Link>>>()?))
}

/// The chains by case, policy and number of the trial.
pub type Chains = BTreeMap<(usize, String, u32), Vec<Link>>;

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
    let bad = |line: u64, reason: String| Failure::input(format!("{}:{line}: {reason}", path.display()));
    let header = reader.headers().map_err(|error| bad(1, error.to_string()))?.clone();
    let mut chains = Chains::new();
    for (record, line) in reader.records().zip(2..) {
        let record = record.map_err(|error| bad(line, error.to_string()))?;
        let row = record.deserialize::<LinkRow>(Some(&header));
        let row = row.map_err(|error| bad(line, error.to_string()))?;
        let case = record.deserialize::<CaseColumn>(Some(&header));
        let case =
            case.map_err(|error| bad(line, error.to_string()))?.case.map_or(0, |case| case.saturating_sub(1));
        let wrong = || bad(line, "digest and parts must be hexadecimal digits, 32 and 40".into());
        chains.entry((case, row.policy.clone(), row.trial)).or_default().push(row.link().ok_or_else(wrong)?);
    }
    Ok(chains)
}
