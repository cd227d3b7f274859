//! Objectives: the quantities by which decisions are judged.

use std::fmt;

use serde::{Deserialize, Serialize};
use usar_sim::metrics::TaskTotals;

use super::branch::Outcome;
use crate::metric::TOTAL;

type Value = fn(&TaskTotals, f64) -> Option<f64>;

/// A quantity of a decision's outcome, independent of the scenario's tasks.
struct Quantity {
    name: &'static str,
    title: &'static str,
    unit: &'static str,
    is_cost: bool,
    /// Computed from totals and the time in seconds that they cover.
    value: Value,
}

const POINTS: &str = "points";
const RATIO: &str = "points per rescuee";

#[rustfmt::skip]
const QUANTITIES: [Quantity; 7] = [
    Quantity { name: "rescuees", title: "rescuees", unit: "", is_cost: false,
        value: |t, _| Some(f64::from(t.rescued)) },
    Quantity { name: "rescue_rate", title: "rescuees per minute", unit: "1/min", is_cost: false,
        value: rate },
    Quantity { name: "energy_per_rescuee", title: "energy per rescuee", unit: RATIO, is_cost: true,
        value: |t, _| ratio(t.energy, t.rescued) },
    Quantity { name: "hp_per_rescuee", title: "HP per rescuee", unit: RATIO, is_cost: true,
        value: |t, _| ratio(t.hp, t.rescued) },
    Quantity { name: "energy", title: "energy spent", unit: POINTS, is_cost: true,
        value: |t, _| Some(t.energy) },
    Quantity { name: "hp", title: "HP lost", unit: POINTS, is_cost: true, value: |t, _| Some(t.hp) },
    Quantity { name: "time", title: "time", unit: "s", is_cost: true, value: |_, seconds| Some(seconds) },
];

fn rate(totals: &TaskTotals, seconds: f64) -> Option<f64> {
    (seconds > 0.0).then(|| 60.0 * f64::from(totals.rescued) / seconds)
}

fn ratio(cost: f64, rescued: u32) -> Option<f64> {
    (rescued > 0).then(|| cost / f64::from(rescued))
}

/// A quantity by which decisions are judged: `rescuees.total`, `energy_per_rescuee.hard`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Objective {
    name: String,
    quantity: usize,
    /// The task; all tasks together without one.
    task: Option<usize>,
    /// Whether the worst value counts as the best.
    #[serde(skip)]
    is_opposite: bool,
    /// Of a cost per rescuee over many decisions: the ratio of the sums of a fair draw, and its rescuees.
    #[serde(skip)]
    around: Option<[f64; 2]>,
}

/// An unknown name of an objective.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown metric {found:?}; decisions are judged by {}", known.join(", "))]
pub struct UnknownObjective {
    /// The unknown name.
    pub found: String,
    /// The known names.
    pub known: Vec<String>,
}

impl Objective {
    /// An objective by its name, for tasks of these names. A name without a task means all tasks together.
    ///
    /// # Errors
    /// An unknown name, with the known ones.
    pub fn parse(name: &str, tasks: &[String]) -> Result<Self, UnknownObjective> {
        let all = Self::all(tasks);
        let known = || all.iter().map(|objective| objective.name.clone()).collect();
        let total = format!("{name}.{TOTAL}");
        let found = all.iter().find(|objective| objective.name == name || objective.name == total);
        found.cloned().ok_or_else(|| UnknownObjective { found: name.to_owned(), known: known() })
    }

    /// All objectives for tasks of these names.
    pub fn all(tasks: &[String]) -> Vec<Self> {
        let of = |quantity: usize| {
            let name = QUANTITIES[quantity].name;
            if name == "time" {
                return vec![Self {
                    name: name.to_owned(),
                    quantity,
                    task: None,
                    is_opposite: false,
                    around: None,
                }];
            }
            let total = Self {
                name: format!("{name}.{TOTAL}"),
                quantity,
                task: None,
                is_opposite: false,
                around: None,
            };
            let each = tasks.iter().enumerate().map(|(task, of)| Self {
                name: format!("{name}.{of}"),
                quantity,
                task: Some(task),
                is_opposite: false,
                around: None,
            });
            std::iter::once(total).chain(each).collect()
        };
        (0..QUANTITIES.len()).flat_map(of).collect()
    }

    /// The objective for which the worst value is the best.
    #[must_use]
    pub fn opposite(self) -> Self {
        Self { is_opposite: !self.is_opposite, ..self }
    }

    /// The same objective over many decisions, with the `mean` of an objective over a fair draw at all of
    /// them. For a cost per rescuee, an outcome then has its part in the ratio of sums, also without
    /// rescuees: its linearised value, of which the mean over a fair draw is that ratio.
    #[must_use]
    pub fn over(self, mean: impl Fn(&Self) -> Option<f64>) -> Self {
        let means = self.sums().and_then(|[cost, count]| Some([mean(&cost)?, mean(&count)?]));
        let around = means.filter(|[_, count]| *count > 0.0).map(|[cost, count]| [cost / count, count]);
        Self { around, ..self }
    }

    /// The cost and the rescuees whose ratio it is; `None` for other quantities.
    fn sums(&self) -> Option<[Self; 2]> {
        let cost = QUANTITIES[self.quantity].name.strip_suffix("_per_rescuee")?;
        let of = |name: &str| {
            let quantity = QUANTITIES.iter().position(|known| known.name == name)?;
            Some(Self { quantity, ..self.clone() })
        };
        Some([of(cost)?, of("rescuees")?])
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// In words, with the unit.
    pub fn title(&self) -> String {
        let Quantity { title, unit, .. } = QUANTITIES[self.quantity];
        let part = self.name.split_once('.').map_or(String::new(), |(_, part)| format!(" {part}"));
        let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
        format!("{title}{part}{unit}")
    }

    /// Whether less is better.
    pub fn is_cost(&self) -> bool {
        QUANTITIES[self.quantity].is_cost
    }

    /// Its value; `None` where it is undefined, such as a cost per rescuee without rescuees.
    pub fn value(&self, outcome: &Outcome) -> Option<f64> {
        if let Some(([ratio, mean], parts)) = self.around.zip(self.sums()) {
            let [cost, count] = parts.map(|part| part.value(outcome));
            return Some(ratio + (cost? - ratio * count?) / mean);
        }
        let totals = match self.task {
            Some(task) => *outcome.tasks.get(task)?,
            None => outcome.total(),
        };
        (QUANTITIES[self.quantity].value)(&totals, outcome.duration_s).filter(|value| value.is_finite())
    }

    /// Its value, with the sign chosen so that more is better.
    pub fn score(&self, outcome: &Outcome) -> Option<f64> {
        let is_less_better = self.is_cost() != self.is_opposite;
        self.value(outcome).map(|value| if is_less_better { -value } else { value })
    }
}

impl fmt::Display for Objective {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome() -> Outcome {
        let totals = |rescued, energy| TaskTotals { rescued, secured: rescued, energy, hp: 0.0 };
        Outcome {
            tasks: vec![totals(4, 8.0), totals(2, 3.0)],
            ungrouped: [1.0, 0.5],
            duration_s: 120.0,
            is_cut: false,
        }
    }

    #[test]
    fn objectives_are_of_all_tasks_or_of_one() {
        let tasks = ["hard".to_owned(), "easy".to_owned()];
        let value = |name| Objective::parse(name, &tasks).unwrap().value(&outcome()).unwrap();
        let values =
            ["rescuees", "rescuees.hard", "rescue_rate", "energy_per_rescuee", "hp.total", "time"].map(value);
        assert_eq!(
            values.map(|value| (value * 1e6).round() as u64),
            [6_000_000, 4_000_000, 3_000_000, 2_000_000, 500_000, 120_000_000]
        );
        let score = |name| Objective::parse(name, &tasks).unwrap().score(&outcome()).unwrap();
        assert!(score("energy.easy") < -2.9 && score("rescuees.easy") > 1.9);
        let opposite = Objective::parse("rescuees.easy", &tasks).unwrap().opposite();
        assert_eq!((opposite.score(&outcome()), opposite.value(&outcome())), (Some(-2.0), Some(2.0)));
    }

    #[test]
    fn an_unknown_objective_lists_the_known_ones() {
        let error = Objective::parse("luck", &["hard".to_owned()]).unwrap_err();
        let expected = "unknown metric \"luck\"; decisions are judged by rescuees.total, rescuees.hard, \
            rescue_rate.total, ";
        assert!(error.to_string().starts_with(expected), "{error}");
    }

    /// Two assignments at each of two decisions; one rescues nobody and costs 4.
    #[test]
    fn over_many_decisions_a_fair_draw_has_the_ratio_of_sums() {
        let of = |rescued, energy| {
            let totals = TaskTotals { rescued, secured: rescued, energy, hp: 0.0 };
            Outcome { tasks: vec![totals], ungrouped: [0.0; 2], duration_s: 60.0, is_cut: false }
        };
        let outcomes = [of(0, 4.0), of(4, 8.0), of(2, 3.0), of(1, 3.0)];
        let mean = |objective: &Objective| {
            let values = outcomes.iter().map(|outcome| objective.value(outcome));
            values.sum::<Option<f64>>().map(|sum| sum / 4.0)
        };
        let objective = Objective::parse("energy_per_rescuee", &[]).unwrap();
        assert_eq!(mean(&objective), None, "one of them has no ratio of its own");
        let objective = objective.over(mean);
        assert!((mean(&objective).unwrap() - 18.0 / 7.0).abs() < 1e-9);
        let least = outcomes.iter().map(|outcome| objective.score(outcome).unwrap()).fold(f64::MAX, f64::min);
        assert!(
            (objective.score(&outcomes[0]).unwrap() - least).abs() < 1e-9,
            "rescuing nobody is the worst"
        );
    }

    #[test]
    fn a_cost_per_rescuee_is_undefined_without_rescuees() {
        let mut outcome = outcome();
        outcome.tasks.iter_mut().for_each(|task| task.rescued = 0);
        assert_eq!(Objective::parse("energy_per_rescuee", &[]).unwrap().value(&outcome), None);
    }
}
