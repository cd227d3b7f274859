//! Things of one kind that are placed anew in every trial.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::checker::Checker;
use super::distribution::Amount;
use super::file::{Movable, Point, ScenarioFile};
use crate::limits;

/// Discs of debris or radiation zones, placed anew in every trial. They keep clear of homes, rest places and
/// rescuees, and debris leaves a way from home to each task and rest place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scatter {
    /// What is placed.
    pub what: Scattered,
    /// How many.
    pub count: u32,
    /// Radius, in metres. A distribution is drawn for each.
    pub radius_m: Amount,
    /// Two corners of the region in which their middles lie; the whole arena where it is left out.
    #[serde(default)]
    pub within: Option<[Point; 2]>,
    /// How they are placed.
    #[serde(default)]
    pub place: Placement,
    /// Mass and friction of debris that a robot can push; absent for fixed debris.
    #[serde(default)]
    pub movable: Option<Movable>,
}

/// What is placed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Scattered {
    /// Discs of debris.
    Debris,
    /// Radiation zones.
    Radiation,
}

/// How things are placed in a region.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub enum Placement {
    /// Each anywhere, all places alike. Debris does not overlap other debris. The default.
    #[default]
    Anywhere,
    /// In a regular grid, as square as the region allows.
    Grid,
    /// `Poisson(2.0)`: anywhere, with so many metres free between two of them (Poisson-disc sampling).
    Poisson(f64),
}

impl Scatter {
    /// The corners of its region: lower left and upper right.
    pub fn region(&self, arena_m: Point) -> [Point; 2] {
        let [a, b] = self.within.unwrap_or([[0.0, 0.0], arena_m]);
        [[a[0].min(b[0]), a[1].min(b[1])], [a[0].max(b[0]), a[1].max(b[1])]]
    }

    /// Free distance between two of its things, in metres; `None` if they may overlap.
    pub fn gap_m(&self) -> Option<f64> {
        match (self.place, self.what) {
            (Placement::Poisson(gap), _) => Some(gap),
            (_, Scattered::Debris) => Some(0.0),
            (_, Scattered::Radiation) => None,
        }
    }
}

pub(super) fn scatter(check: &mut Checker, file: &ScenarioFile) {
    for (i, scatter) in file.scatter.iter().enumerate() {
        let field = format!("scatter[{i}]");
        check.amount(&format!("{field}.radius_m"), &scatter.radius_m, limits::SAMPLED_RADIUS_M);
        for (k, corner) in scatter.within.iter().flatten().enumerate() {
            check.inside(format!("{field}.within[{k}]"), *corner, 0.0);
        }
        if scatter.movable.is_some() && scatter.what == Scattered::Radiation {
            check.fail(format!("{field}.movable"), "must be absent: radiation cannot be pushed", "a mass");
        }
    }
}
