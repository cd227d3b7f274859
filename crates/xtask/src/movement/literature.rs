//! Figures from the literature, each with its source, and Weidmann's relation between density and speed.

use serde::Deserialize;

/// Weidmann's free speed, in metres per second: the preferred speed of the robots, too.
pub const FREE_SPEED_MPS: f64 = 1.34;

/// The constants of Weidmann's relation, in people a square metre: its shape, and the density at which all
/// stand.
const SHAPE_PER_M2: f64 = 1.913;
const JAM_PER_M2: f64 = 5.4;

/// What a figure measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// People a second and metre of width, over the width in metres.
    SpecificFlow,
    /// Mean speed in metres per second, over people a square metre.
    Speed,
}

/// A figure.
#[derive(Debug, Clone, Deserialize)]
pub struct Published {
    /// What it measures.
    pub quantity: Quantity,
    /// The width, or the density.
    pub x: f64,
    /// The value.
    pub y: f64,
    /// The experiment.
    pub series: String,
    /// Where it was read.
    pub source: String,
}

/// A measured power of a robot.
#[derive(Debug, Clone, Deserialize)]
pub struct Power {
    /// The robot.
    pub robot: String,
    /// What it did.
    pub state: String,
    /// Its speed, in metres per second.
    pub speed_mps: f64,
    /// The power, in watts.
    pub watts: f64,
    /// Its battery, in watt-hours.
    pub battery_wh: f64,
    /// Where it was read.
    pub source: String,
}

/// What came of the cases of a number of agents in a square under another method.
#[derive(Debug, Clone, Deserialize)]
pub struct Peer {
    /// The method.
    pub method: String,
    /// Number of agents.
    pub agents: u32,
    /// Number of cases.
    pub cases: u32,
    /// Cases in which two agents touched.
    pub touched: u32,
    /// Cases in which an agent did not arrive.
    pub stuck: u32,
    /// Mean extra time, and its 75th and 90th percentiles, in seconds.
    pub extra_s: f64,
    /// See `extra_s`.
    pub p75_s: f64,
    /// See `extra_s`.
    pub p90_s: f64,
    /// Mean extra time of the agents when each is alone, in seconds.
    pub alone_s: f64,
}

impl Power {
    /// The power as `costs.energy.per_second`: percent of the battery a second.
    pub fn per_second(&self) -> f64 {
        self.percent(self.watts)
    }

    /// What driving adds to the power at a stand, as `costs.energy.per_metre`: percent of the battery a
    /// metre. `None` for a robot that stands.
    pub fn per_metre(&self, standing: &Self) -> Option<f64> {
        (self.speed_mps > 0.0).then(|| self.percent((self.watts - standing.watts) / self.speed_mps))
    }

    /// Joules in percent of the battery.
    fn percent(&self, joules: f64) -> f64 {
        100.0 * joules / (3600.0 * self.battery_wh)
    }
}

/// The figures of `literature.csv`.
///
/// # Errors
/// A line is no figure.
pub fn published() -> Result<Vec<Published>, csv::Error> {
    rows(include_bytes!("literature.csv"))
}

/// The measured powers of `energy.csv`.
///
/// # Errors
/// A line is no measured power.
pub fn powers() -> Result<Vec<Power>, csv::Error> {
    rows(include_bytes!("energy.csv"))
}

/// What came of the cases of the square under other methods, by `just peers`.
///
/// # Errors
/// A line is no such row.
pub fn peers() -> Result<Vec<Peer>, csv::Error> {
    rows(include_bytes!("../../peers/square.csv"))
}

fn rows<T: for<'de> Deserialize<'de>>(text: &[u8]) -> Result<Vec<T>, csv::Error> {
    csv::Reader::from_reader(text).deserialize().collect()
}

/// Weidmann's relation (1993): the mean speed of people, in metres per second, at a density in people a
/// square metre.
pub fn weidmann(per_m2: f64) -> f64 {
    if per_m2 <= 0.0 {
        return FREE_SPEED_MPS;
    }
    let speed = FREE_SPEED_MPS * (1.0 - libm::exp(-SHAPE_PER_M2 * (1.0 / per_m2 - 1.0 / JAM_PER_M2)));
    speed.max(0.0)
}
