//! Merges the shards of a sweep into one folder, with the same bytes as a single run.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use store::{Failure, refuse};
use teaming::Registry;

use super::folder::{Folder, Opening};
use super::host::Hosts;
use super::names::AGAIN;
use super::shards::Shards;
use super::store::{Order, Store};
use crate::experiment::{Experiment, Place, Shard};
use crate::run::TrialKey;

/// Largest number of missing trials that are named.
const MAX_NAMED: usize = 5;
/// Marks a trial that no shard has.
const NOBODY: u32 = u32::MAX;

/// Shards that together form a sweep.
pub struct Merge {
    experiment: Arc<Experiment>,
    /// Whether the shards check every invariant.
    is_checked: bool,
    parts: Vec<Part>,
    order: Order,
    /// For each trial, in order, the number of the shard that has it.
    owners: Vec<u32>,
}

/// One shard.
struct Part {
    path: PathBuf,
    shard: Option<Shard>,
    store: Store,
    /// The places of its trials.
    places: Vec<Place>,
}

impl Merge {
    /// Finds out which shard has which trial.
    ///
    /// # Errors
    /// A folder is damaged or does not hold a sweep; the folders hold different sweeps or come from
    /// different programs; two of them disagree about a trial; or a trial is missing.
    pub fn of(folders: &[PathBuf], registry: &Registry) -> Result<Self, Failure> {
        let [first, ..] = folders else { refuse!("there is nothing to merge") };
        let shards = Shards::like(first, registry)?;
        let (experiment, is_checked) = (Arc::clone(shards.experiment()), shards.is_checked());
        let part = |path: &PathBuf| {
            let folder = shards.read(path)?;
            let shard = folder.manifest().shard;
            let (store, places) = folder.into_store();
            Ok(Part { path: path.clone(), shard, store, places })
        };
        let parts = folders.iter().map(part).collect::<Result<Vec<_>, Failure>>()?;
        let order = Order::of(&experiment, None);
        let owners = vec![NOBODY; order.count()];
        let mut merge = Self { experiment, is_checked, parts, order, owners };
        merge.find_owners()?;
        merge.check_complete()?;
        Ok(merge)
    }

    fn find_owners(&mut self) -> Result<(), Failure> {
        for number in 0..self.parts.len() {
            let places = std::mem::take(&mut self.parts[number].places);
            places.into_iter().try_for_each(|place| self.own(number, place))?;
        }
        Ok(())
    }

    /// Records that a shard has a trial. If another shard has it as well, both must agree.
    fn own(&mut self, number: usize, place: Place) -> Result<(), Failure> {
        let Some(rank) = self.order.rank(place) else { return Ok(()) };
        let owner = self.owners[rank];
        if owner == NOBODY {
            self.owners[rank] = number as u32;
            return Ok(());
        }
        let other = owner as usize;
        if self.parts[other].store.line(place)? == self.parts[number].store.line(place)? {
            return Ok(());
        }
        let TrialKey { trial, label, seed, .. } = self.experiment.key(place);
        let [one, two] = [other, number].map(|number| self.parts[number].path.display());
        Err(Failure::input(format!("{one} and {two} disagree about trial {trial} of {label} (seed {seed})")))
    }

    /// Refuses shards that lack a trial. The message names the first missing trials, the shards to which they
    /// belong, and how these are run.
    fn check_complete(&self) -> Result<(), Failure> {
        let count = self.owners.iter().filter(|owner| **owner == NOBODY).count();
        if count == 0 {
            return Ok(());
        }
        let missing = self.experiment.places(None).zip(&self.owners).filter(|(_, owner)| **owner == NOBODY);
        let name = |(place, _)| {
            let key = self.experiment.key(place);
            let case = self.experiment.describe(&self.experiment.cases[key.case]);
            format!("{case}trial {} of {}", key.trial, key.label)
        };
        let named = missing.take(MAX_NAMED).map(name).collect::<Vec<_>>().join(", ");
        let more = if count > MAX_NAMED { ", ..." } else { "" };
        let (shards, lines): (Vec<String>, Vec<String>) = self.missing_shards().into_iter().unzip();
        let whose = if shards.is_empty() { String::new() } else { format!("shard {}: ", shards.join(", ")) };
        Err(Failure::input(format!("{whose}missing trials, {count}: {named}{more}{}", lines.concat())))
    }

    /// The shards that lack a trial, each with the line that runs it.
    fn missing_shards(&self) -> Vec<(String, String)> {
        let of = self.parts.iter().find_map(|part| part.shard).map_or(0, |shard| shard.of);
        let is_missing = |place| self.order.rank(place).is_some_and(|rank| self.owners[rank] == NOBODY);
        let all = (1..=of).map(|number| Shard { number, of });
        let missing = all.filter(|shard| self.experiment.places(Some(*shard)).any(is_missing));
        missing.map(|shard| (format!("{}/{of}", shard.number), self.again(shard))).collect()
    }

    /// The command that runs a shard, on a line of its own.
    fn again(&self, shard: Shard) -> String {
        let first = &self.parts[0].path;
        let there = self.parts.iter().find(|part| part.shard == Some(shard));
        let out =
            there.map_or_else(|| first.with_file_name(shard.number.to_string()), |part| part.path.clone());
        let check = if self.is_checked { " --check" } else { "" };
        let (file, out, Shard { number, of }) = (first.join(AGAIN), out.display(), shard);
        format!("\n  usar sweep {} --shard {number}/{of}{check} --out {out}", file.display())
    }

    /// Writes the whole sweep to a folder; no trial is held in memory twice. Messages go to `say`.
    ///
    /// # Errors
    /// The folder holds something else, a line cannot be read, the disk does not take it, or `stop` was
    /// set.
    pub fn write_to(
        mut self,
        out: &Path,
        stop: &AtomicBool,
        say: &mut dyn FnMut(String),
    ) -> Result<Folder, Failure> {
        let mut whole = Folder::open(out, Arc::clone(&self.experiment), Opening::default(), say)?;
        if whole.manifest().is_complete {
            return Ok(whole);
        }
        let (order, owners, parts) = (&self.order, &self.owners, &mut self.parts);
        let line = |place: Place| {
            let owner = order.rank(place).map_or(NOBODY, |rank| owners[rank]) as usize;
            let part = parts.get_mut(owner).ok_or_else(|| Failure::run("a shard is missing"))?;
            part.store.line(place)
        };
        whole.fill(line, stop)?;
        Hosts::add(out, self.parts.iter().flat_map(|part| Hosts::read(&part.path).runs))?;
        Ok(whole)
    }
}
