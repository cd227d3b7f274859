//! The sweep file as it is written.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::marker::PhantomData;

use ron::value::RawValue;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};

use super::Keep;

/// A sweep file: a scenario, what to set in it, the policies to compare, and the axes to go along.
#[derive(Debug, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SweepFile {
    /// Number of the format that the file is written in; this program reads format 2.
    #[serde(default)]
    pub format: Option<u32>,
    /// Short name; names the folder of results.
    pub name: String,
    /// What the sweep is for.
    #[serde(default)]
    pub description: String,
    /// Path of the scenario, from this file's folder.
    pub scenario: String,
    /// Fields of the scenario to set, by their paths.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, serde_json::Value>")]
    pub set: Map<Box<RawValue>>,
    /// Policies to compare; the scenario's where there are none.
    #[serde(default)]
    pub policies: Option<Vec<String>>,
    /// Options of RNE and the values that each takes: the policy `RNE` stands for every combination.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Vec<serde_json::Value>>")]
    pub readings: Map<Vec<Box<RawValue>>>,
    /// Paired trials for each case and policy.
    #[serde(default)]
    pub trials: Option<u32>,
    /// Seed of the first trial.
    #[serde(default)]
    pub first_seed: Option<u64>,
    /// Seeds of the trials, one by one, instead of `trials` and `first_seed`.
    #[serde(default)]
    pub seeds: Option<Vec<u64>>,
    /// What to keep of each trial; all that there is by default.
    #[serde(default)]
    pub keep: Keep,
    /// Metrics that the sweep is about: `compare` and `report` begin with them.
    #[serde(default)]
    pub primary: Vec<String>,
    /// The policy with which `compare` and `report` compare the others.
    #[serde(default)]
    pub baseline: Option<String>,
    /// For metrics, the largest difference that does not matter.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, f64>")]
    pub margins: Map<f64>,
    /// What is expected of the outcome: see `usar test --help`.
    #[serde(default)]
    pub expect: Vec<String>,
    /// Scenarios that differ in several fields at once, each by a name with what it sets: an axis of its own,
    /// before the others.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, BTreeMap<String, serde_json::Value>>")]
    pub variants: Map<Map<Box<RawValue>>>,
    /// Fields and the values that each takes: the full grid is run.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, Vec<serde_json::Value>>")]
    pub axes: Map<Vec<Box<RawValue>>>,
}

/// The JSON Schema of a sweep file.
#[must_use]
pub fn sweep_schema() -> serde_json::Value {
    schemars::schema_for!(SweepFile).into()
}

/// A map in the order in which it is written; duplicate keys are an error.
#[derive(Debug)]
pub(super) struct Map<V>(pub Vec<(String, V)>);

impl<V> Default for Map<V> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, V: Deserialize<'de>> Deserialize<'de> for Map<V> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<V>(PhantomData<V>);
        impl<'de, V: Deserialize<'de>> Visitor<'de> for Entries<V> {
            type Value = Map<V>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a map such as {\"costs.energy.per_step\": ...}")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Map<V>, A::Error> {
                let (mut entries, mut keys): (Vec<(String, V)>, _) = (Vec::new(), BTreeSet::new());
                while let Some((key, value)) = access.next_entry::<String, V>()? {
                    if !keys.insert(key.clone()) {
                        return Err(A::Error::custom(format!("{key:?} stands twice")));
                    }
                    entries.push((key, value));
                }
                Ok(Map(entries))
            }
        }
        deserializer.deserialize_map(Entries(PhantomData))
    }
}
