//! The shards of one sweep, for `usar cluster merge`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use store::{Failure, refuse};
use teaming::Registry;

use super::disk::{experiment_of, manifest_in, resolved_in};
use super::folder::Folder;
use crate::experiment::{Experiment, PolicySpec, Program};
use crate::provenance::{Manifest, scenario_differences};

/// The sweep that shards belong to, known from one of them.
pub struct Shards<'r> {
    first: PathBuf,
    manifest: Manifest,
    experiment: Arc<Experiment>,
    resolved: String,
    registry: &'r Registry,
}

impl<'r> Shards<'r> {
    /// The shards of the sweep in this folder.
    ///
    /// # Errors
    /// The folder does not hold a sweep, or holds one of another program.
    pub fn like(first: &Path, registry: &'r Registry) -> Result<Self, Failure> {
        let manifest = manifest_in(first)?;
        let experiment = Arc::new(experiment_of(first, &manifest, registry)?);
        check_program(first, &manifest, &experiment.policies)?;
        let resolved = experiment.base.resolved();
        Ok(Self { first: first.to_owned(), manifest, experiment, resolved, registry })
    }

    /// The whole sweep.
    pub fn experiment(&self) -> &Arc<Experiment> {
        &self.experiment
    }

    /// Whether the first shard checks every invariant.
    pub fn is_checked(&self) -> bool {
        self.manifest.is_checked
    }

    /// Reads a folder of the sweep.
    ///
    /// # Errors
    /// The folder does not hold a sweep, is damaged, or holds another sweep or one of another program.
    pub fn read(&self, path: &Path) -> Result<Folder, Failure> {
        let there = manifest_in(path)?;
        check_same(&self.first, path, &self.manifest, &there, &self.resolved)?;
        Folder::read(path, self.registry)
    }
}

/// Refuses shards of another program than this one. Policies that are programs of their own are compared
/// among the shards alone.
fn check_program(path: &Path, there: &Manifest, policies: &[PolicySpec]) -> Result<(), Failure> {
    let (mut this, that) = (Program::running(policies)?, there.program());
    for ((this, that), policy) in this.policies.iter_mut().zip(&that.policies).zip(policies) {
        if policy.made().it.program().is_some() {
            this.clone_from(that);
        }
    }
    let [there, here] = [that.digest(), this.digest()];
    if there == here {
        return Ok(());
    }
    let path = path.display();
    refuse!(
        "{path} is of a program with {there}; this has {here}: merge with the program that ran the shards"
    )
}

/// Refuses shards of different sweeps.
fn check_same(
    first_path: &Path,
    other_path: &Path,
    first: &Manifest,
    other: &Manifest,
    resolved: &str,
) -> Result<(), Failure> {
    let mut differences = first.differences(other);
    differences.extend(first.policies_lost(other).or_else(|| other.policies_lost(first)));
    let changed = first.policies_changed(other);
    differences.extend(changed.iter().map(|policy| format!("policy {policy}: its sources differ")));
    let scenario = resolved_in(other_path);
    if scenario != resolved {
        differences.extend(scenario_differences(resolved, &scenario));
    }
    if first.trials != other.trials {
        differences.push(format!("trials: {} there, {} now", first.trials, other.trials));
    }
    if differences.is_empty() {
        return Ok(());
    }
    let (one, other) = (first_path.display(), other_path.display());
    let differences = differences.join("\n  ");
    Err(Failure::input(format!("{one} and {other} are not of one sweep:\n  {differences}")))
}
