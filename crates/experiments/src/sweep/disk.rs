//! The files of a sweep's folder besides its journal and tables: the manifest, the sweep itself, and the
//! lock.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;

use scenario::Scenario;
use store::Failure;
use store::files::{self, FileHash, NewFile, file_hash, sync_folder};
use teaming::arrow::Written;
use teaming::{PolicyKind, Registry};

use super::dictionary::dictionary;
use super::names::{AGAIN, GIVEN, INPUTS, MANIFEST, RESOLVED, sweeps_in};
use super::tables::tables_of;
use super::{journal, owned};
use crate::experiment::{AnalysisPlan, Experiment, Parts, Shard, name_and_options, protocol_of};
use crate::provenance::{Manifest, scenario_differences};

/// Writes the manifest and the inputs of a sweep.
pub(super) fn write_start(
    path: &Path,
    experiment: &Experiment,
    shard: Option<Shard>,
) -> Result<Manifest, Failure> {
    let inputs = inputs(experiment)?;
    let files = inputs.iter().map(|(name, text)| FileHash::of(name, text.as_bytes())).collect();
    let manifest = Manifest::new(experiment, shard, files);
    // The manifest comes first: a folder with a manifest is ours, and no other folder is.
    write_manifest(path, &manifest)?;
    for (name, text) in &inputs {
        NewFile::write(path, name, text.as_bytes())?;
    }
    // An existing report and existing Parquet files would belong to the previous contents.
    let trouble = |error| Failure::storage(format!("cannot write to {}: {error}", path.display()));
    owned::remove_report(path).and_then(|()| owned::remove_parquets(path)).map_err(trouble)?;
    Ok(manifest)
}

/// The inputs of a sweep, as the files of its folder.
pub(super) fn inputs(experiment: &Experiment) -> Result<[(&'static str, String); 5], Failure> {
    let again = experiment.as_sweep_file(RESOLVED)?;
    let [columns, package] = dictionary(experiment);
    let [given, resolved] = [experiment.given.clone(), experiment.base.resolved()];
    Ok([(GIVEN, given), (RESOLVED, resolved), (AGAIN, again), columns, package])
}

/// The names of the files that a manifest lists.
fn listed(manifest: &Manifest) -> Vec<&'static str> {
    let tables = tables_of(manifest.keep, manifest.shard);
    let made = tables.chain([journal::ARCHIVE]).filter(|_| manifest.is_complete);
    INPUTS.into_iter().chain(made).collect()
}

pub(super) fn write_manifest(path: &Path, manifest: &Manifest) -> Result<(), Failure> {
    NewFile::write(path, MANIFEST, manifest.text()?.as_bytes())?;
    sync_folder(path)
}

/// Whether a sweep has begun in a folder: it has inputs or trials.
pub(super) fn has_begun(path: &Path) -> bool {
    [RESOLVED, journal::FILE, journal::ARCHIVE].iter().any(|name| path.join(name).exists())
}

pub(super) fn read_manifest(path: &Path) -> Result<Option<Manifest>, Failure> {
    let name = path.join(MANIFEST);
    let text = match files::read(&name) {
        Ok(text) => text,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(Failure::storage(format!("{}: {error}", name.display()))),
    };
    let sound = Manifest::parse(&text).and_then(|manifest| {
        let is_listed = manifest.files.iter().map(|file| file.name.as_str()).eq(listed(&manifest));
        if is_listed { Ok(manifest) } else { Err(Failure::input("it does not list the files of a sweep")) }
    });
    sound.map(Some).map_err(|reason| {
        let name = name.display();
        Failure::input(format!("{name}: is not a manifest of this program: {reason}; --fresh starts over"))
    })
}

/// The manifest of a folder that this program can read.
///
/// # Errors
/// The folder does not hold a sweep, or another version of the program made it.
pub fn manifest_in(path: &Path) -> Result<Manifest, Failure> {
    let not_one = |reason: &dyn std::fmt::Display| {
        Failure::input(format!("{}: is not the folder of a sweep: {reason}", path.display()))
    };
    if path.is_file() {
        return Err(not_one(&"it is a file; `usar sweep` makes a folder of results from a scenario"));
    }
    if !path.is_dir() {
        let there = Path::new("results").join(path);
        let meant = if there.is_dir() {
            format!("; did you mean {}?", there.display())
        } else {
            ron_tree::file::meant(path)
        };
        return Err(not_one(&format!("there is no such folder{meant}")));
    }
    let missing = || match sweeps_in(path) {
        sweeps if sweeps.is_empty() => not_one(&format!("{MANIFEST} is missing")),
        sweeps => {
            let names: Vec<String> = sweeps.iter().map(|sweep| sweep.display().to_string()).collect();
            not_one(&format!("these in it are: {}", names.join(", ")))
        }
    };
    read_manifest(path)?.ok_or_else(missing)
}

/// The resolved scenario of a folder, as text.
pub(super) fn resolved_in(path: &Path) -> String {
    let text = files::read(&path.join(RESOLVED)).unwrap_or_default();
    String::from_utf8_lossy(&text).into_owned()
}

/// Refuses to continue a different sweep, or to continue with fewer trials or policies than there are.
pub(super) fn check_continues(
    path: &Path,
    there: &Manifest,
    now: &Manifest,
    resolved: &str,
) -> Result<(), Failure> {
    let mut differences = there.differences(now);
    differences.extend(there.policies_lost(now));
    if there.shard != now.shard {
        differences.push(format!("shard: {} there, {} now", there.part(), now.part()));
    }
    differences.extend(scenario_differences(&resolved_in(path), resolved));
    if now.trials < there.trials {
        differences.push(format!(
            "trials: {} there, more than the {} asked for; none are taken away",
            there.trials, now.trials
        ));
    }
    if differences.is_empty() {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{} has results of something else; --out takes another folder, --fresh starts over:\n  {}",
        path.display(),
        differences.join("\n  ")
    )))
}

/// Names of the files whose hashes differ from the manifest.
pub fn broken_files(path: &Path, manifest: &Manifest) -> Vec<String> {
    let is_broken = |file: &&FileHash| file_hash(&path.join(&file.name)).ok() != Some(file.xxh3_128.clone());
    manifest.files.iter().filter(is_broken).map(|file| file.name.clone()).collect()
}

/// The experiment of a folder, with policies of a registry. Policies that the registry does not have are
/// [absent](PolicyKind::absent): their results can be read.
///
/// # Errors
/// Its resolved scenario cannot be read.
pub fn experiment_of(path: &Path, manifest: &Manifest, registry: &Registry) -> Result<Experiment, Failure> {
    let (base, _) = Scenario::load(&path.join(RESOLVED)).map_err(Failure::input)?;
    let given = files::read(&path.join(GIVEN)).unwrap_or_default();
    let given = String::from_utf8(given).unwrap_or_default();
    Experiment::assemble(Parts {
        name: manifest.name.clone(),
        plan: AnalysisPlan::in_text(&given),
        given,
        base,
        axes: manifest.axes.clone(),
        policies: manifest.policies.clone(),
        registry: with_absent(registry.clone(), manifest),
        trials: manifest.trials,
        seeds: manifest.seeds.clone(),
        is_checked: manifest.is_checked,
        keep: manifest.keep,
        program: Some(manifest.program()),
    })
}

/// The registry with stand-ins for the policies and the protocols of a manifest that it does not have.
fn with_absent(mut registry: Registry, manifest: &Manifest) -> Registry {
    let mut absent: BTreeMap<(bool, String), BTreeMap<String, String>> = BTreeMap::new();
    let mut note = |is_protocol: bool, known: &[PolicyKind], [written, all]: [&str; 2]| {
        let (name, options) = name_and_options(written);
        if !name.is_empty() && known.iter().all(|kind| kind.name != name) {
            let spelled_out = absent.entry((is_protocol, name.to_owned())).or_default();
            spelled_out.insert(options.trim().to_owned(), all.to_owned());
        }
    };
    for (written, all) in manifest.policies.iter().zip(&manifest.policy_options) {
        // Estimators are not those of the other program.
        let of_all = Written::of(all);
        note(false, registry.kinds(), [written, of_all.rule]);
        if let (Some(protocol), Some(all)) = (protocol_of(written), of_all.protocol) {
            let options = all.find('(').map_or("", |at| &all[at..]);
            note(true, registry.protocols(), [protocol, options]);
        }
    }
    for ((is_protocol, name), spelled_out) in absent {
        let kind = PolicyKind::absent(&name, spelled_out);
        // The registry has none of this name.
        let _ = if is_protocol { registry.add_protocol(kind) } else { registry.add(kind) };
    }
    registry
}

/// The experiment of a folder. The program that made it may be another one.
///
/// # Errors
/// The folder does not hold a sweep.
pub fn experiment_in(path: &Path, registry: &Registry) -> Result<(Experiment, Manifest), Failure> {
    let missing = || Failure::input(format!("{}: is not the folder of a finished sweep", path.display()));
    let manifest = read_manifest(path)?.ok_or_else(missing)?;
    Ok((experiment_of(path, &manifest, registry)?, manifest))
}

/// Number of trials of a folder's sweep, if it holds one.
pub fn trials_in(path: &Path) -> Option<u32> {
    read_manifest(path).ok()?.map(|manifest| manifest.trials)
}
