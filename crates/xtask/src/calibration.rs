//! The readings of the paper's mission that a calibration compares, and the starts of its search.
//!
//! When a tired robot rests is the question; every [`Reading`] answers it. Whatever else the paper leaves
//! open is drawn anew for each start, the same for every reading: a level of each [`Factor`], all levels
//! equally often, and values of the free parameters from a Latin hypercube (`McKay`, Beckman and Conover
//! 1979).

use std::path::Path;

use experiments::explore::Parameter;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;
use ron_tree::{Node, edited};

/// Starts of each reading.
pub const STARTS: usize = 32;

/// When a tired robot rests.
pub struct Reading {
    /// Its name.
    pub name: &'static str,
    /// Values of `mission.energy_turn_back`, `mission.hp_turn_back` and `mission.empty_battery`.
    rules: [&'static str; 3],
}

/// The readings, that of the second edition first.
pub const READINGS: [Reading; 6] = [
    Reading { name: "at-once", rules: ["AtOnce", "AtOnce", "Stops"] },
    Reading { name: "when-home", rules: ["WhenHome", "AtOnce", "Stops"] },
    Reading { name: "after-round-stops", rules: ["AfterRound", "AtOnce", "Stops"] },
    Reading { name: "after-round", rules: ["AfterRound", "AtOnce", "GoesOn"] },
    Reading { name: "after-round-both-stops", rules: ["AfterRound", "AfterRound", "Stops"] },
    Reading { name: "after-round-both", rules: ["AfterRound", "AfterRound", "GoesOn"] },
];

/// Something else that the paper leaves open, with its possible values.
pub struct Factor {
    /// Its name: the path of a field, or what stands for several.
    pub name: &'static str,
    levels: &'static [Level],
}

/// A value of a factor: its name, the fields that it sets, and the parameters that it frees.
struct Level {
    name: &'static str,
    sets: &'static [(&'static str, &'static str)],
    frees: &'static [&'static str],
}

const fn level(name: &'static str, sets: &'static [(&'static str, &'static str)]) -> Level {
    Level { name, sets, frees: &[] }
}

/// The factors.
pub const FACTORS: [Factor; 8] = [
    Factor {
        name: "mission.rest_fills",
        levels: &[
            level("Both", &[("mission.rest_fills", "Both")]),
            level("Low", &[("mission.rest_fills", "Low")]),
            level("InTurn", &[("mission.rest_fills", "InTurn")]),
        ],
    },
    Factor {
        name: "costs.unit",
        levels: &[
            level("Percent", &[("costs.unit", "Percent")]),
            level("Points", &[("costs.unit", "Points")]),
        ],
    },
    Factor {
        name: "costs.energy",
        levels: &[
            Level {
                name: "per_metre",
                sets: &[("costs.energy.per_step", "0.0"), ("costs.energy.per_second", "0.0")],
                frees: &["costs.energy.per_metre = 0.1..1.5 log"],
            },
            Level {
                name: "per_step",
                sets: &[("costs.energy.per_metre", "0.0"), ("costs.energy.per_second", "0.0")],
                // 0.25 to 7.5 in a second of moving.
                frees: &["costs.energy.per_step = 0.005..0.15 log"],
            },
            Level {
                name: "per_second",
                sets: &[("costs.energy.per_metre", "0.0"), ("costs.energy.per_step", "0.0")],
                frees: &["costs.energy.per_second = 0.2..5 log"],
            },
        ],
    },
    Factor {
        name: "a group brings",
        levels: &[
            level("20", &[]),
            level("15 by resources", &[("roles.supplier.resources", "6")]),
            level("14 by capacity", &[("roles.carrier.capacity", "4")]),
        ],
    },
    Factor {
        name: "mission.resting_guides",
        levels: &[
            level("true", &[("mission.resting_guides", "true")]),
            level("false", &[("mission.resting_guides", "false")]),
        ],
    },
    Factor {
        name: "mission.rest_at_home",
        levels: &[
            level("DuringRound", &[("mission.rest_at_home", "DuringRound")]),
            level("BeforeRound", &[("mission.rest_at_home", "BeforeRound")]),
        ],
    },
    Factor {
        name: "mission.load_at_rest",
        levels: &[
            level("Delivered", &[("mission.load_at_rest", "Delivered")]),
            level("Kept", &[("mission.load_at_rest", "Kept")]),
        ],
    },
    Factor {
        name: "work",
        levels: &[
            level(
                "free",
                &[
                    ("costs.work.energy_per_second", "0.0"),
                    ("costs.work.hp_per_second", "0.0"),
                    ("mission.load_speed_loss", "0.0"),
                ],
            ),
            Level {
                name: "costs",
                sets: &[],
                frees: &[
                    "costs.work.energy_per_second = 0..2",
                    "costs.work.hp_per_second = 0..0.5",
                    "mission.load_speed_loss = 0..0.6",
                ],
            },
        ],
    },
];

/// Parameters that are free in every start.
const FREE: [&str; 7] = [
    "roles.carrier.speed_mps + roles.supplier.speed_mps + roles.observer.speed_mps*0.666666667 = 1.5..6",
    "radiation[*].radius_m = 3..25",
    "costs.hp.per_second = 0.02..5 log",
    "planning.exposure_price_m = 0..3",
    "mission.health_floor = 0.05..1",
    "mission.loading_s = 0.5..8",
    "mission.rest_reserve = 1..3",
];

/// One level of each factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Details([usize; FACTORS.len()]);

impl Details {
    /// The details of a start, the same for every reading. Over all starts each level of a factor occurs
    /// equally often, as far as their number allows.
    #[must_use]
    pub fn of_start(start: usize) -> Self {
        Self(std::array::from_fn(|factor| shuffled(factor)[start] % FACTORS[factor].levels.len()))
    }

    /// Names of the levels, in the order of the factors.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.levels().map(|level| level.name)
    }

    fn levels(self) -> impl Iterator<Item = &'static Level> {
        FACTORS.iter().zip(self.0).map(|(factor, level)| &factor.levels[level])
    }

    /// The free parameters, as arguments of `usar study yang2021 calibrate`.
    #[must_use]
    pub fn free(self) -> Vec<&'static str> {
        let of_levels = self.levels().flat_map(|level| level.frees.iter().copied());
        FREE.into_iter().chain(of_levels).collect()
    }

    /// The fixed settings of this start under a reading: paths and values.
    #[must_use]
    pub fn settings(self, reading: &Reading) -> Vec<(&'static str, &'static str)> {
        let fields = ["mission.energy_turn_back", "mission.hp_turn_back", "mission.empty_battery"];
        let rules = fields.into_iter().zip(reading.rules);
        rules.chain(self.levels().flat_map(|level| level.sets.iter().copied())).collect()
    }
}

/// The text of a scenario from which a start begins: its free parameters have values of the Latin hypercube.
///
/// # Panics
/// The scenario does not have the fields.
#[must_use]
pub fn text_of_start(text: &str, start: usize) -> String {
    let tree = Node::parse(text).expect("a scenario");
    let free = Details::of_start(start).free();
    let parameters =
        free.iter().map(|spec| Parameter::parse(spec, &tree, &tree).expect("a field of the start"));
    let mut settings = Vec::new();
    for (number, parameter) in parameters.enumerate() {
        // Factors have the first streams. A start is in the middle of its share of the range.
        let share = (shuffled(FACTORS.len() + number)[start] as f64 + 0.5) / STARTS as f64;
        let value = parameter.value(share);
        settings.extend(parameter.settings(value).map(|(path, value)| (path.to_owned(), value)));
    }
    edited(text, &settings).expect("each field is written")
}

/// The numbers of all starts, in an order of their own for each stream.
fn shuffled(stream: usize) -> Vec<usize> {
    let mut draws = ChaCha8Rng::seed_from_u64(2026);
    draws.set_stream(stream as u64);
    let mut numbers: Vec<usize> = (0..STARTS).collect();
    numbers.shuffle(&mut draws);
    numbers
}

/// A fitted start.
pub struct Run {
    /// Place of its reading.
    pub reading: usize,
    /// Its start.
    pub start: usize,
    /// The least misfit of its calibration.
    pub misfit: f64,
}

/// Writes the runs as a table, with the least misfit of each and its details.
///
/// # Panics
/// The disk does not take it.
pub fn write_starts(path: &Path, runs: &[Run]) {
    let mut table = csv::Writer::from_path(path).expect("the folder takes a table");
    let header = ["reading", "start", "misfit"].into_iter().chain(FACTORS.iter().map(|factor| factor.name));
    table.write_record(header).expect("the folder takes a table");
    for Run { reading, start, misfit } in runs {
        let names = Details::of_start(*start);
        let cells = [READINGS[*reading].name.to_owned(), (start + 1).to_string(), format!("{misfit:.2}")];
        table
            .write_record(cells.into_iter().chain(names.names().map(str::to_owned)))
            .expect("the same folder");
    }
    table.flush().expect("the folder takes a table");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_of_a_factor_occurs_equally_often() {
        let details: Vec<Details> = (0..STARTS).map(Details::of_start).collect();
        for (place, factor) in FACTORS.iter().enumerate() {
            let levels = factor.levels.len();
            for level in 0..levels {
                let count = details.iter().filter(|one| one.0[place] == level).count();
                assert!(count.abs_diff(STARTS / levels) <= 1, "{} {level}: {count}", factor.name);
            }
        }
    }

    #[test]
    fn a_start_has_its_own_values_within_their_ranges() {
        let text = include_str!("../../../docs/calibration/start.ron");
        let [first, second] = [0, 1].map(|start| Node::parse(&text_of_start(text, start)).unwrap());
        let speed = |tree: &Node| tree.get("mission.loading_s").unwrap().to_string().parse::<f64>().unwrap();
        assert!((0.5..8.0).contains(&speed(&first)) && (0.5..8.0).contains(&speed(&second)));
        assert!((speed(&first) - speed(&second)).abs() > 0.1);
    }
}
