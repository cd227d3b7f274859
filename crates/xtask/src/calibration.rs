//! The readings of the paper's mission that a calibration compares, a design of experiments for them, and
//! the conclusions from its runs.
//!
//! There are 3 x 2^7 = 384 combinations, of which the screening fits 24. For each of the three kinds of
//! rest, it fits an eighth of the other 128 combinations (a fractional factorial of resolution III, with
//! other signs for each kind of rest). The levels of each factor therefore occur in equally many runs with
//! each kind of rest, and no other single factor biases the mean over a level's runs.

use std::fmt;
use std::path::Path;

/// A reading of the mission: the field of the scenario and its possible values.
pub struct Factor {
    /// Path of the field.
    pub field: &'static str,
    /// Its values; the current one comes first.
    pub levels: &'static [&'static str],
}

/// The readings, in the order of the table. The last one is not a field: it says whether work has a cost.
/// The amount is then fitted.
pub const FACTORS: [Factor; 8] = [
    Factor { field: "mission.rest_fills", levels: &["Both", "Low", "InTurn"] },
    Factor { field: "costs.unit", levels: &["Percent", "Points"] },
    Factor { field: "mission.energy_turn_back", levels: &["AtOnce", "WhenHome"] },
    Factor { field: "mission.hp_turn_back", levels: &["AtOnce", "WhenHome"] },
    Factor { field: "mission.resting_guides", levels: &["true", "false"] },
    Factor { field: "mission.rest_at_home", levels: &["DuringRound", "BeforeRound"] },
    Factor { field: "mission.load_at_rest", levels: &["Delivered", "Kept"] },
    Factor { field: WORK, levels: &["free", "costs"] },
];

const WORK: &str = "work";

/// Parameters that are free in every run.
const FREE: [&str; 8] = [
    "roles.carrier.speed_mps + roles.supplier.speed_mps + roles.observer.speed_mps*0.666666667 = 1.5..6",
    "costs.energy.per_metre = 0.1..1.5 log",
    "radiation[*].radius_m = 3..25",
    "costs.hp.per_second = 0.02..5 log",
    "planning.exposure_price_m = 0..3",
    "mission.health_floor = 0.05..1",
    "mission.loading_s = 0.5..8",
    "mission.rest_reserve = 1..3",
];

/// Parameters that are free if work has a cost.
const FREE_WORK: [(&str, &str); 3] = [
    ("costs.work.energy_per_second", "0..2"),
    ("costs.work.hp_per_second", "0..0.5"),
    ("mission.load_speed_loss", "0..0.6"),
];

/// One level of each factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Combination([usize; FACTORS.len()]);

impl Combination {
    /// The free parameters, as arguments of `usar study yang2021 calibrate`.
    pub fn free(&self) -> Vec<String> {
        let mut free: Vec<String> = FREE.iter().map(|free| (*free).to_owned()).collect();
        if self.work_costs() {
            free.extend(FREE_WORK.iter().map(|(field, range)| format!("{field} = {range}")));
        }
        free
    }

    /// The fixed settings, as arguments of `usar study yang2021 calibrate`.
    pub fn settings(&self) -> Vec<String> {
        let fields = FACTORS.iter().zip(self.0).filter(|(factor, _)| factor.field != WORK);
        let mut settings: Vec<String> =
            fields.map(|(factor, level)| format!("{}={}", factor.field, factor.levels[level])).collect();
        if !self.work_costs() {
            settings.extend(FREE_WORK.iter().map(|(field, _)| format!("{field}=0.0")));
        }
        settings
    }

    fn work_costs(&self) -> bool {
        self.0[FACTORS.len() - 1] == 1
    }

    /// Number of factors in which two combinations differ.
    fn differences(&self, other: &Self) -> usize {
        self.0.iter().zip(other.0).filter(|(a, b)| **a != *b).count()
    }

    /// All combinations.
    fn all() -> impl Iterator<Item = Self> {
        let count: usize = FACTORS.iter().map(|factor| factor.levels.len()).product();
        (0..count).map(|mut rest| {
            Self(std::array::from_fn(|at| {
                let levels = FACTORS[at].levels.len();
                let level = rest % levels;
                rest /= levels;
                level
            }))
        })
    }
}

impl fmt::Display for Combination {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let levels: Vec<&str> =
            FACTORS.iter().zip(self.0).map(|(factor, level)| factor.levels[level]).collect();
        f.write_str(&levels.join(" "))
    }
}

/// The 24 combinations of the screening.
pub fn screening() -> Vec<Combination> {
    // For each kind of rest: which of the four products of the first three factors have inverted signs.
    let turned = [[0, 0, 0, 0], [1, 1, 1, 0], [0, 1, 0, 1]];
    let mut runs = Vec::new();
    for (rest, [ab, ac, bc, abc]) in turned.into_iter().enumerate() {
        for i in 0..8_usize {
            let [a, b, c] = [i & 1, i >> 1 & 1, i >> 2 & 1];
            runs.push(Combination([rest, a, b, c, a ^ b ^ ab, a ^ c ^ ac, b ^ c ^ bc, a ^ b ^ c ^ abc]));
        }
    }
    runs
}

/// A fitted combination.
pub struct Run {
    /// Name of its folder.
    pub name: String,
    /// Its readings.
    pub combination: Combination,
    /// The least misfit of its calibration.
    pub misfit: f64,
}

impl fmt::Display for Run {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}, misfit {:.1}: {}", self.name, self.misfit, self.combination)
    }
}

/// For each level of each factor: the mean logarithm of the misfit over the runs with this level, minus the
/// mean over all runs.
fn effects(runs: &[Run]) -> Vec<Vec<f64>> {
    let mean = |runs: &mut dyn Iterator<Item = &Run>| {
        let (sum, count) = runs.fold((0.0, 0.0), |(sum, count), run| (sum + run.misfit.ln(), count + 1.0));
        sum / count
    };
    let all = mean(&mut runs.iter());
    let effect =
        |at: usize, level: usize| mean(&mut runs.iter().filter(|run| run.combination.0[at] == level)) - all;
    FACTORS
        .iter()
        .enumerate()
        .map(|(at, factor)| (0..factor.levels.len()).map(|level| effect(at, level)).collect())
        .collect()
}

/// The six combinations that are fitted further: the three with the least misfit in the screening, and the
/// three of all 384 with the least predicted misfit (sum of the effects). Each comes with its starting run
/// of the screening: the run that differs in the fewest readings, and among these the one with the least
/// misfit.
///
/// # Panics
/// There are no runs.
pub fn finalists(runs: &[Run]) -> Vec<(Combination, &Run)> {
    let mut measured: Vec<&Run> = runs.iter().collect();
    measured.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
    let mut chosen: Vec<Combination> = measured.iter().take(3).map(|run| run.combination).collect();
    let effects = effects(runs);
    let promised = |combination: &Combination| -> f64 {
        combination.0.iter().zip(&effects).map(|(level, effects)| effects[*level]).sum()
    };
    let mut all: Vec<Combination> = Combination::all().collect();
    all.sort_by(|a, b| promised(a).total_cmp(&promised(b)));
    let new: Vec<Combination> = all.into_iter().filter(|one| !chosen.contains(one)).take(3).collect();
    chosen.extend(new);
    let start = |combination: &Combination| {
        let nearest = measured.iter().min_by_key(|run| run.combination.differences(combination));
        *nearest.expect("a screening has runs")
    };
    chosen.into_iter().map(|combination| (combination, start(&combination))).collect()
}

/// Writes the runs as a table.
///
/// # Panics
/// The disk does not take it.
pub fn write_screening(path: &Path, runs: &[Run]) {
    let mut table = csv::Writer::from_path(path).expect("the folder takes a table");
    let header = ["run", "misfit"].into_iter().chain(FACTORS.iter().map(|factor| factor.field));
    table.write_record(header).expect("the folder takes a table");
    for run in runs {
        let levels =
            FACTORS.iter().zip(run.combination.0).map(|(factor, level)| factor.levels[level].to_owned());
        let cells = [run.name.clone(), run.misfit.to_string()].into_iter().chain(levels);
        table.write_record(cells).expect("the folder takes a table");
    }
    table.flush().expect("the folder takes a table");
}

/// Writes the factor by which each level of each factor multiplies the misfit.
///
/// # Panics
/// The disk does not take it.
pub fn write_effects(path: &Path, runs: &[Run]) {
    let mut table = csv::Writer::from_path(path).expect("the folder takes a table");
    table.write_record(["field", "level", "factor_on_misfit"]).expect("the folder takes a table");
    for (factor, effects) in FACTORS.iter().zip(effects(runs)) {
        for (level, effect) in factor.levels.iter().zip(effects) {
            let cells = [factor.field, level, &format!("{:.3}", effect.exp())];
            table.write_record(cells).expect("the folder takes a table");
        }
    }
    table.flush().expect("the folder takes a table");
}
