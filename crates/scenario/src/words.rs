//! What a scenario calls its things: a warehouse has items and no rescuees.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What things are called in the names of metrics, in sentences, legends and pages. Columns of tables keep
/// the standard names, so that one program reads all results.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Words {
    /// What is brought home: one of it.
    pub rescuee: String,
    /// Several of it.
    pub rescuees: String,
    /// What hazards take from robots.
    pub hp: String,
    /// What takes it.
    pub radiation: String,
}

impl Default for Words {
    fn default() -> Self {
        let [rescuee, rescuees, hp, radiation] =
            ["rescuee", "rescuees", "hp", "radiation"].map(str::to_owned);
        Self { rescuee, rescuees, hp, radiation }
    }
}

impl Words {
    /// The words, by the names of their fields.
    pub(super) fn all(&self) -> [(&'static str, &str); 4] {
        let Self { rescuee, rescuees, hp, radiation } = self;
        [("rescuee", rescuee), ("rescuees", rescuees), ("hp", hp), ("radiation", radiation)]
    }

    /// A metric's name in these words: `energy_per_rescuee` is `energy_per_item`.
    pub fn metric(&self, standard: &str) -> String {
        let word = |part: &str| match part {
            "rescuee" => self.rescuee.clone(),
            "rescuees" => self.rescuees.clone(),
            "hp" => self.hp.clone(),
            other => other.to_owned(),
        };
        let of_dots = |name: &str| name.split('_').map(word).collect::<Vec<_>>().join("_");
        standard.split('.').map(of_dots).collect::<Vec<_>>().join(".")
    }

    /// A text in these words, for people: `HP per rescuee` is `condition per item`.
    pub fn text(&self, standard: &str) -> String {
        let word = |part: &str| match part {
            "HP" if self.hp == "hp" => "HP".to_owned(),
            "HP" => self.hp.clone(),
            "radiation" => self.radiation.clone(),
            "rescued" if self.rescuees != "rescuees" => self.rescuees.clone(),
            other => self.metric(other),
        };
        standard.split(' ').map(word).collect::<Vec<_>>().join(" ")
    }
}
