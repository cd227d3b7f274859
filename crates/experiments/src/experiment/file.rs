//! The sweep file as it is written.

use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;

use ron_tree::Node;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde::{Serialize, Serializer};

use super::Keep;

/// A sweep file: a scenario, what to set in it, the policies to compare, and the axes to go along.
#[derive(Debug, Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct SweepFile {
    /// Number of the format that the file is written in; this program reads format 2.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub format: Option<u32>,
    /// Short name; names the folder of results.
    pub name: String,
    /// What the sweep is for.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Path of the scenario, from this file's folder.
    pub scenario: String,
    /// Fields of the scenario to set, by their paths.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    #[schemars(with = "BTreeMap<String, serde_json::Value>")]
    pub set: Map<Node>,
    /// Policies to compare; the scenario's where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub policies: Option<Vec<String>>,
    /// Options of RNE and the values that each takes: the policy `RNE` stands for every combination.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    #[schemars(with = "BTreeMap<String, Vec<serde_json::Value>>")]
    pub readings: Map<Vec<Node>>,
    /// Paired trials for each case and policy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trials: Option<u32>,
    /// Seed of the first trial.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first_seed: Option<u64>,
    /// Seeds of the trials, one by one, instead of `trials` and `first_seed`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seeds: Option<Vec<u64>>,
    /// What to keep of each trial; all that there is by default.
    #[serde(default)]
    pub keep: Keep,
    /// Metrics that the sweep is about: `compare` and `report` begin with them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub primary: Vec<String>,
    /// The policy with which `compare` and `report` compare the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub baseline: Option<String>,
    /// For metrics, the largest difference that does not matter.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    #[schemars(with = "BTreeMap<String, f64>")]
    pub margins: Map<f64>,
    /// What is expected of the outcome: see `usar test --help`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub expect: Vec<String>,
    /// Scenarios that differ in several fields at once, each by a name with what it sets: an axis of its own,
    /// before the others.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    #[schemars(with = "BTreeMap<String, BTreeMap<String, serde_json::Value>>")]
    pub variants: Map<Map<Node>>,
    /// Fields and the values that each takes: the full grid is run.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    #[schemars(with = "BTreeMap<String, Vec<serde_json::Value>>")]
    pub axes: Map<Vec<Node>>,
}

/// The JSON Schema of a sweep file.
pub fn sweep_schema() -> serde_json::Value {
    schemars::schema_for!(SweepFile).into()
}

/// A map in the order in which it is written.
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
                let mut entries = Vec::new();
                while let Some(entry) = access.next_entry()? {
                    entries.push(entry);
                }
                Ok(Map(entries))
            }
        }
        deserializer.deserialize_map(Entries(PhantomData))
    }
}

impl<V: Serialize> Serialize for Map<V> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(key, value)| (key, value)))
    }
}

impl<V> Map<V> {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
