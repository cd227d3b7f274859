//! The shards of one sweep: `usar cluster merge` takes them from here, and `usar cluster status` counts them
//! here, so that neither believes a folder that the other refuses.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rne_core::Registry;
use store::lock::{Holder, holder};
use store::{Failure, at};

use super::disk::{experiment_of, manifest_in, resolved_in};
use super::folder::Folder;
use super::journal;
use crate::experiment::{Experiment, PolicySpec, Program, Shard};
use crate::provenance::{Manifest, part, scenario_differences};

/// The sweep that shards belong to, known from one of them.
pub struct Shards<'r> {
    first: PathBuf,
    manifest: Manifest,
    experiment: Arc<Experiment>,
    resolved: String,
    registry: &'r Registry,
}

/// How far a shard is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Progress {
    /// Number of its finished trials.
    pub finished: usize,
    /// Whether its tables are made.
    pub is_complete: bool,
    /// The process that works in its folder now.
    pub holder: Option<Holder>,
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

    /// The manifest of the first shard.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
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

    /// How far the shard in a folder is. A shard whose journal is not there yet has no finished trial.
    ///
    /// # Errors
    /// Those of [`Shards::read`], or the folder is of another part of the sweep.
    pub fn progress(&self, path: &Path, shard: Option<Shard>) -> Result<Progress, Failure> {
        let there = manifest_in(path)?;
        if there.shard != shard {
            let (expected, found) = (part(shard), there.part());
            return Err(Failure::input(format!("{}: must be {expected}, found {found}", path.display())));
        }
        let holder = holder(path).map_err(at(path))?;
        if !there.is_complete && !path.join(journal::FILE).exists() {
            check_same(&self.first, path, &self.manifest, &there, &self.resolved)?;
            return Ok(Progress { finished: 0, is_complete: false, holder });
        }
        let finished = self.read(path)?.results().len();
        Ok(Progress { finished, is_complete: there.is_complete, holder })
    }
}

/// Refuses shards of another program than this one.
fn check_program(path: &Path, there: &Manifest, policies: &[PolicySpec]) -> Result<(), Failure> {
    let this = Program::running(policies)?;
    let that = there.program();
    if that == this {
        return Ok(());
    }
    let is_same_engine = (&that.version, &that.source) == (&this.version, &this.source);
    let sources = if is_same_engine {
        [&that, &this].map(|program| program.policies.join(", "))
    } else {
        [that.source, this.source]
    };
    let [there, here] = sources;
    Err(Failure::input(format!(
        "{} is of usar {} with source {there}; this is {} with source {here}: merge with the program that ran \
         the shards",
        path.display(),
        that.version,
        this.version,
    )))
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
