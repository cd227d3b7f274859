//! Where results come from: enough to reproduce them, and to refuse to mix them with other results.

use ron_tree::{Node, without_types};
use serde::{Deserialize, Serialize};
use store::files::FileHash;
use store::{Failure, refuse};
use usar_sim::physics::ENGINE_FEATURES;
use xxhash_rust::xxh3::xxh3_128;

use crate::experiment::{Axis, Experiment, Keep, Program, Seeds, Shard};

/// Version of the folder's layout.
pub const SCHEMA_VERSION: u32 = 9;

/// Largest number of trials that a sweep may have for each case and policy.
const MAX_TRIALS: u32 = 1_000_000;

/// Commit of the source that this program was built from, with `-dirty` where sources that decide every trial
/// were changed. Policies have hashes of their own.
pub const COMMIT: &str = env!("USAR_COMMIT");

/// `manifest.json`. It holds nothing that differs between two runs of the same sweep: no time of day, no
/// number of threads.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the folder's layout.
    pub schema_version: u32,
    program: String,
    /// Version of the program.
    pub version: String,
    /// Commit of the source: see [`COMMIT`].
    pub commit: String,
    /// Hash of the sources that decide every trial: all but those of the policies.
    pub source: String,
    /// Number of the bits: trials of one number are the same for the same scenario, policy and seed.
    pub bits: u32,
    /// Features that change numbers.
    features: Vec<String>,
    /// Name of the sweep.
    pub name: String,
    /// The policies as they were written.
    pub policies: Vec<String>,
    /// All options of each policy, with the defaults.
    pub policy_options: Vec<String>,
    /// The policies that see what is true, because they declare it: as they were written.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub policies_that_see_truth: Vec<String>,
    /// Hash of the sources of each policy.
    pub policy_sources: Vec<String>,
    /// The axes.
    pub axes: Vec<Axis>,
    /// Paired trials for each case and policy.
    pub trials: u32,
    /// Seeds of the trials.
    pub seeds: Seeds,
    /// Whether every invariant was checked at every step.
    pub is_checked: bool,
    /// What is kept of each trial.
    pub keep: Keep,
    /// Which part of the sweep this is; `None` for the whole sweep.
    pub shard: Option<Shard>,
    /// Whether all trials are finished.
    pub is_complete: bool,
    /// The files of the folder with their hashes, except the manifest.
    pub files: Vec<FileHash>,
    /// XXH3-128 of the manifest without this field.
    checksum: String,
}

/// A part of a sweep, in words.
pub(crate) fn part(shard: Option<Shard>) -> String {
    shard.map_or("whole".into(), |shard| format!("shard {}/{}", shard.number, shard.of))
}

impl Manifest {
    /// The manifest of an experiment that is not complete yet.
    pub fn new(experiment: &Experiment, shard: Option<Shard>, files: Vec<FileHash>) -> Self {
        let sees_truth = experiment.policies.iter().filter(|policy| policy.made().sees_truth());
        Self {
            schema_version: SCHEMA_VERSION,
            program: "usar".into(),
            version: experiment.program.version.clone(),
            commit: COMMIT.into(),
            source: experiment.program.source.clone(),
            bits: experiment.program.bits,
            features: ENGINE_FEATURES.map(str::to_owned).to_vec(),
            name: experiment.name.clone(),
            policies: experiment.policies.iter().map(|policy| policy.written().to_owned()).collect(),
            policy_options: experiment.policies.iter().map(|policy| policy.made().options.clone()).collect(),
            policies_that_see_truth: sees_truth.map(|policy| policy.written().to_owned()).collect(),
            policy_sources: experiment.program.policies.clone(),
            axes: experiment.axes.clone(),
            trials: experiment.trials,
            seeds: experiment.seeds.clone(),
            is_checked: experiment.is_checked,
            keep: experiment.keep,
            shard,
            is_complete: false,
            files,
            checksum: String::new(),
        }
    }

    /// The manifest as text, with its checksum.
    ///
    /// # Errors
    /// None: it can be written to memory.
    pub fn text(&self) -> Result<String, Failure> {
        let text = |manifest: &Self| serde_json::to_string_pretty(manifest).map_err(Failure::run);
        let bare = Self { checksum: String::new(), ..self.clone() };
        let checksum = format!("{:032x}", xxh3_128(text(&bare)?.as_bytes()));
        Ok(text(&Self { checksum, ..bare })? + "\n")
    }

    /// Reads a manifest.
    ///
    /// # Errors
    /// The text is not a manifest or was changed.
    pub fn parse(text: &[u8]) -> Result<Self, Failure> {
        #[derive(Deserialize)]
        struct Layout {
            schema_version: u32,
        }
        let wrong = |error: serde_json::Error| Failure::input(without_types(&error));
        let Layout { schema_version: found } = serde_json::from_slice(text).map_err(wrong)?;
        if found != SCHEMA_VERSION {
            refuse!("its layout has version {found}; this program reads version {SCHEMA_VERSION}");
        }
        let mut manifest: Self = serde_json::from_slice(text).map_err(wrong)?;
        if manifest.text()?.as_bytes() != text {
            refuse!("its checksum does not match: it was changed");
        }
        if manifest.shard.is_some_and(|shard| !(1..=shard.of).contains(&shard.number)) {
            refuse!("it is of {}, which no sweep has", manifest.part());
        }
        if !(1..=MAX_TRIALS).contains(&manifest.trials) {
            refuse!("trials: must be from 1 to {MAX_TRIALS}, found {}", manifest.trials);
        }
        manifest.checksum.clear();
        Ok(manifest)
    }

    /// The manifest as it was before the first trial.
    #[must_use]
    pub fn started(&self) -> Self {
        Self { is_complete: false, files: Vec::new(), ..self.clone() }
    }

    /// Which part of the sweep this is, in words.
    pub fn part(&self) -> String {
        part(self.shard)
    }

    /// The program that made the results.
    pub fn program(&self) -> Program {
        let (version, source) = (self.version.clone(), self.source.clone());
        Program { version, source, bits: self.bits, policies: self.policy_sources.clone() }
    }

    /// Why the other results do not have all policies of these; `None` if they do.
    pub fn policies_lost(&self, other: &Self) -> Option<String> {
        let has = |policy: &String| other.policies.contains(policy);
        let lists = || [self, other].map(|manifest| manifest.policies.join(", "));
        (!self.policies.iter().all(has)).then(|| {
            let [there, now] = lists();
            format!("policies: {there} there, {now} now")
        })
    }

    /// The policies of both whose sources differ, as they were written.
    pub fn policies_changed(&self, other: &Self) -> Vec<&str> {
        let sources = |manifest: &Self, policy: &String| {
            let number = manifest.policies.iter().position(|other| other == policy)?;
            manifest.policy_sources.get(number).cloned()
        };
        let both = self.policies.iter().filter(|policy| other.policies.contains(policy));
        both.filter(|policy| sources(self, policy) != sources(other, policy)).map(String::as_str).collect()
    }

    /// Reasons why results of this manifest must not be continued by or merged with results of the other,
    /// one sentence each. The policies, the number of trials and the part of the sweep are not compared.
    pub fn differences(&self, other: &Self) -> Vec<String> {
        let mut differences = Vec::new();
        let mut compare = |what: &str, there: String, now: String| {
            if there != now {
                differences.push(format!("{what}: {there} there, {now} now"));
            }
        };
        compare("bits", self.bits.to_string(), other.bits.to_string());
        let axes = |m: &Self| {
            let set = |axis: &Axis, value: &String| {
                let settings =
                    axis.settings(value).into_iter().map(|(path, value)| format!("{path}={value}"));
                format!("{value} ({})", settings.collect::<Vec<_>>().join(", "))
            };
            let values = |axis: &Axis| {
                if axis.variants.is_empty() {
                    return axis.values.join(", ");
                }
                axis.values.iter().map(|value| set(axis, value)).collect::<Vec<_>>().join(", ")
            };
            let axis = |axis: &Axis| format!("{} [{}]", axis.path, values(axis));
            if m.axes.is_empty() {
                "none".into()
            } else {
                m.axes.iter().map(axis).collect::<Vec<_>>().join(", ")
            }
        };
        compare("axes", axes(self), axes(other));
        let seeds = |m: &Self| match &m.seeds {
            Seeds::From(first) => format!("from {first} on"),
            Seeds::Listed(list) => format!("{list:?}"),
        };
        let grows =
            matches!((&self.seeds, &other.seeds), (Seeds::Listed(a), Seeds::Listed(b)) if b.starts_with(a));
        if !grows {
            compare("seeds", seeds(self), seeds(other));
        }
        compare("--check", self.is_checked.to_string(), other.is_checked.to_string());
        compare("--keep", self.keep.name().to_owned(), other.keep.name().to_owned());
        differences
    }
}

/// The fields in which two resolved scenarios differ, one sentence each.
pub fn scenario_differences(there: &str, now: &str) -> Vec<String> {
    let tree = |text| Node::parse(text).unwrap_or_else(|_| Node::word(""));
    let (there, now) = (tree(there), tree(now));
    let leaves = |tree: &Node| -> Vec<(String, String)> {
        let leaves = tree.leaves().into_iter().map(|(path, leaf)| (path, leaf.to_string()));
        leaves.filter(|(path, _)| path != "name" && path != "description").collect()
    };
    let mut differences = Vec::new();
    for (path, new) in leaves(&now) {
        match there.get(&path).map(ToString::to_string) {
            Some(old) if old == new => {}
            Some(old) => differences.push(format!("{path}: {old} there, {new} now")),
            None => differences.push(format!("{path}: nothing there, {new} now")),
        }
    }
    let gone = leaves(&there).into_iter().filter(|(path, _)| now.get(path).is_none());
    differences.extend(gone.map(|(path, old)| format!("{path}: {old} there, nothing now")));
    differences
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_that_differ_are_named() {
        let there = "(name: \"a\", costs: (hp: 1.0), debris: [(at: (1.0, 2.0))])";
        let now = "(name: \"b\", costs: (hp: 2.0), debris: [(at: (1.0, 2.0)), (at: (3.0, 2.0))])";
        let differences = scenario_differences(there, now);
        assert_eq!(differences[0], "costs.hp: 1.0 there, 2.0 now");
        assert_eq!(differences[1], "debris[1].at[0]: nothing there, 3.0 now");
        assert!(
            scenario_differences(now, there).iter().any(|d| d == "debris[1].at[1]: 2.0 there, nothing now")
        );
        assert_eq!(scenario_differences(now, now), Vec::<String>::new());
    }
}
