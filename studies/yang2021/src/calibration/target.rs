//! The target of a calibration: means and spreads of recorded trials.

use std::path::Path;

use experiments::input_table::{CellProblem, InputRow, InputTable, Problem};
use experiments::metric::{Catalogue, Metric};
use experiments::sweep::trial_columns;
use experiments::{Failure, refuse};
use scenario::Scenario;
use serde::{Deserialize, Serialize};
use statistics::Moments;
use usar_sim::record::TrialRecord;

use super::POLICY;

/// A quantity of a trial that a target may have, under the authors' name.
pub struct Quantity {
    /// Name of its column.
    pub name: String,
    metric: Metric,
}

/// The metrics that can be fitted, in the authors' order. Metrics with tasks are fitted task by task; their
/// totals follow.
const FITTED: [&str; 4] = ["rescuees", "energy", "hp", "rounds"];

impl Quantity {
    /// All quantities that can be fitted.
    fn all(metrics: &Catalogue) -> Vec<Self> {
        let places = FITTED.iter().flat_map(|name| metrics.declared(name));
        let parts = places.map(|place| &metrics[place]).filter(|metric| !metric.is_total());
        parts.map(|metric| Self { name: metric.column(), metric: metric.clone() }).collect()
    }
}

/// Mean and sample standard deviation of one quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation.
    pub sd: f64,
}

impl Spread {
    /// The spread of at least two values.
    pub fn of(values: &[f64]) -> Option<Self> {
        let Moments { mean, sd, .. } = Moments::of(values);
        Some(Self { mean: mean?, sd: sd? })
    }

    /// Distance of a model's spread, over `model_trials` trials, from this one, over `trials`: the
    /// difference of the means and the logarithm of the ratio of the standard deviations. Each is divided
    /// by its standard error under the assumption that both samples come from one normal distribution. For
    /// a true model, the square of each is 1 on average. The model's standard deviation counts as at least
    /// a twentieth of this one.
    pub(crate) fn residuals(&self, model: &Self, trials: usize, model_trials: usize) -> [f64; 2] {
        let [n, m] = [trials, model_trials].map(|trials| trials.max(2) as f64);
        let mean = (model.mean - self.mean) / self.sd;
        let spread = (model.sd.max(self.sd / 20.0) / self.sd).ln();
        [mean / (1.0 / n + 1.0 / m).sqrt(), spread / (0.5 / (n - 1.0) + 0.5 / (m - 1.0)).sqrt()]
    }
}

/// Recorded trials of the baseline.
pub struct Target {
    /// The quantities in the table.
    pub quantities: Vec<Quantity>,
    /// Their means and spreads.
    pub spreads: Vec<Spread>,
    /// The values of each quantity, trial by trial.
    pub values: Vec<Vec<f64>>,
    /// Number of trials.
    pub trials: usize,
    /// Names of the quantities that the table lacks.
    pub missing: Vec<String>,
}

impl Target {
    /// Reads a table with the columns of `trials.csv`: quantities, and `method`, which must be the baseline
    /// in each row.
    ///
    /// # Errors
    /// The table cannot be read, has an unknown column, or has trials of another policy or another duration
    /// than the scenario's; or a quantity is not a number or has no spread. All problems are reported at
    /// once, with file and line.
    pub fn load(path: &Path, scenario: &Scenario) -> Result<Self, Failure> {
        let table = InputTable::read(path)?;
        let metrics = Catalogue::of(scenario);
        let Columns { found, missing, mut problems } = Columns::of(&table, &metrics);
        let mut values = vec![Vec::new(); found.len()];
        for row in table.rows() {
            problems.extend(check(row, scenario, &metrics).into_iter().map(|problem| (row.line, problem)));
            for (quantity, values) in found.iter().zip(&mut values) {
                match number(row, &quantity.name) {
                    Ok(value) => values.extend(value),
                    Err(problem) => problems.push((row.line, problem.to_string())),
                }
            }
        }
        if !problems.is_empty() {
            return Err(table.refused(problems));
        }
        let shown = path.display();
        let trials = table.rows().len();
        if trials < 2 {
            refuse!("{shown}: must have at least two trials, found {trials}");
        }
        let spread = |(quantity, values): (&Quantity, &Vec<f64>)| {
            Spread::of(values).filter(|spread| spread.sd > 0.0).ok_or_else(|| {
                Failure::input(format!(
                    "{shown}: {} must differ between trials: distances are measured by its spread",
                    quantity.name
                ))
            })
        };
        let spreads = found.iter().zip(&values).map(spread).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { quantities: found, spreads, values, trials, missing })
    }

    /// The quantities of a trial.
    ///
    /// # Errors
    /// The trial lacks a quantity.
    pub fn measure(&self, record: &TrialRecord) -> Result<Vec<f64>, Failure> {
        let value = |quantity: &Quantity| {
            let value = quantity.metric.value(record);
            value.ok_or_else(|| Failure::run(format!("{} is not defined in a trial", quantity.name)))
        };
        self.quantities.iter().map(value).collect()
    }

    /// Distance of a model from the target, from this many trials of the model: the sum over all
    /// quantities. Smaller is nearer. For a true model, it is twice the number of quantities on average.
    pub fn misfit(&self, model: &[Spread], model_trials: usize) -> f64 {
        misfit(&self.spreads, model, self.trials, model_trials)
    }

    /// The residuals of all quantities: for each, the distance of the means and of the spreads, in standard
    /// errors.
    pub(super) fn residuals(&self, model: &[Spread], model_trials: usize) -> Vec<f64> {
        residuals(&self.spreads, model, self.trials, model_trials).collect()
    }
}

/// Distance of a model's spreads from the data's, for these numbers of trials of the data and of the model.
pub(super) fn misfit(data: &[Spread], model: &[Spread], trials: usize, model_trials: usize) -> f64 {
    residuals(data, model, trials, model_trials).map(|residual| residual * residual).sum()
}

fn residuals(
    data: &[Spread],
    model: &[Spread],
    trials: usize,
    model_trials: usize,
) -> impl Iterator<Item = f64> {
    data.iter().zip(model).flat_map(move |(data, model)| data.residuals(model, trials, model_trials))
}

/// The columns of a table.
struct Columns {
    found: Vec<Quantity>,
    missing: Vec<String>,
    /// Problems in the header.
    problems: Vec<Problem>,
}

impl Columns {
    fn of(table: &InputTable, metrics: &Catalogue) -> Self {
        let mut problems = Vec::new();
        let (known, all) = (trial_columns(metrics), Quantity::all(metrics));
        let names: Vec<&str> = all.iter().map(|quantity| quantity.name.as_str()).collect();
        let names = names.join(", ");
        for unknown in table.columns().filter(|name| !known.iter().any(|column| column == name)) {
            problems
                .push((1, format!("{unknown:?} is no column of trials.csv; what can be fitted: {names}")));
        }
        if table.column("method").is_none() {
            problems.push((1, "has no column method".to_owned()));
        }
        let (found, missing): (Vec<_>, Vec<_>) =
            all.into_iter().partition(|quantity| table.column(&quantity.name).is_some());
        if found.is_empty() && problems.is_empty() {
            problems.push((1, format!("has none of the columns {names}")));
        }
        Self { found, missing: missing.into_iter().map(|quantity| quantity.name).collect(), problems }
    }
}

/// A number that is not negative; `None` if there is no such column.
fn number(row: InputRow, name: &str) -> Result<Option<f64>, CellProblem> {
    row.number(name, 0.0..=f64::MAX)
}

/// Problems in the cells that are not fitted.
fn check(row: InputRow, scenario: &Scenario, metrics: &Catalogue) -> Vec<String> {
    let mut problems = Vec::new();
    if let Some(method) = row.text("method").filter(|method| *method != POLICY) {
        problems.push(format!("method must be {POLICY}: nothing else is calibrated, found {method:?}"));
    }
    let mut told = |name: &str| {
        number(row, name).unwrap_or_else(|problem| {
            problems.push(problem.to_string());
            None
        })
    };
    let (time_s, total) = (told("time_s"), told("rescuees_total"));
    let (duration_s, dt_s) = (scenario.duration_s, scenario.dt_s);
    if let Some(time_s) = time_s.filter(|time_s| (time_s - duration_s).abs() > dt_s / 2.0) {
        problems.push(format!("time_s must be the scenario's duration_s, {duration_s}, found {time_s}"));
    }
    let tasks = metrics.declared("rescuees").into_iter().map(|place| &metrics[place]);
    let parts = tasks.filter(|metric| !metric.is_total()).map(|metric| number(row, &metric.column()));
    if let (Ok(Some(parts)), Some(total)) = (parts.collect::<Result<Option<Vec<f64>>, _>>(), total) {
        let sum: f64 = parts.iter().sum();
        if (total - sum).abs() > 1e-6 {
            problems.push(format!("rescuees_total must be the sum over the tasks, {sum}, found {total}"));
        }
    }
    problems
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "small whole numbers are exact")]
mod tests {
    use super::*;

    #[test]
    fn a_misfit_counts_standard_errors() {
        let data = Spread { mean: 100.0, sd: 5.0 };
        let misfit =
            |mean, sd| data.residuals(&Spread { mean, sd }, 10, 10).map(|residual| residual * residual);
        assert_eq!(misfit(100.0, 5.0), [0.0, 0.0]);
        assert!((misfit(110.0, 5.0)[0] - 4.0 / 0.2).abs() < 1e-12);
        let [_, wide] = misfit(100.0, 5.0 * std::f64::consts::E);
        assert!((wide - 9.0).abs() < 1e-12);
        let none = misfit(100.0, 0.0)[1];
        assert!((none - 9.0 * 20_f64.ln().powi(2)).abs() < 1e-9, "no spread at all is finite");
        let [more, _] = data.residuals(&Spread { mean: 110.0, sd: 5.0 }, 10, 40);
        assert!(
            (more * more - 4.0 / 0.125).abs() < 1e-12,
            "more trials of the model: the same distance weighs more"
        );
    }

    #[test]
    fn of_a_true_model_each_term_is_one_on_average() {
        use rand::{RngExt, SeedableRng};
        use statrs::distribution::{ContinuousCDF, Normal};
        let (mut draws, normal) = (rand::rngs::ChaCha8Rng::seed_from_u64(1), Normal::new(50.0, 4.0).unwrap());
        let mut spread = |trials: usize| {
            let values: Vec<f64> =
                (0..trials).map(|_| normal.inverse_cdf(draws.random_range(0.0..1.0))).collect();
            Spread::of(&values).unwrap()
        };
        let worlds = 4_000;
        let mut sums = [0.0; 2];
        for _ in 0..worlds {
            let [mean, sd] = spread(10).residuals(&spread(20), 10, 20).map(|residual| residual * residual);
            sums = [sums[0] + mean, sums[1] + sd];
        }
        // By the t distribution of few trials, the first is (n - 1) / (n - 3) on average, and the variance
        // of the logarithm is a little larger.
        let [mean, sd] = sums.map(|sum| sum / f64::from(worlds));
        assert!((1.15..1.45).contains(&mean) && (0.9..1.3).contains(&sd), "{mean} {sd}");
    }

    fn papers() -> Scenario {
        Scenario::load(&scenarios().join("paper.ron")).unwrap().0
    }

    fn scenarios() -> std::path::PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios")
    }

    #[test]
    fn the_authors_table_is_read() {
        let path = scenarios().join("reference/dis_trials.csv");
        let target = Target::load(&path, &papers()).unwrap();
        let names: Vec<&str> = target.quantities.iter().map(|quantity| quantity.name.as_str()).collect();
        let expected =
            ["rescuees_hard", "rescuees_easy", "energy_hard", "energy_easy", "hp_hard", "hp_easy", "rounds"];
        assert_eq!((target.trials, names), (10, expected.to_vec()));
        // numpy: mean and std(ddof=1) of rescuees_hard
        assert!((target.spreads[0].mean - 52.8).abs() < 1e-12);
        assert!((target.spreads[0].sd - 4.211_096_452_627_46).abs() < 1e-9, "{}", target.spreads[0].sd);
    }

    #[test]
    fn another_policy_cannot_be_a_target() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("target.csv");
        std::fs::write(&path, "method,rounds\nDIS,6\nRNE,7\n").unwrap();
        let error = Target::load(&path, &papers()).err().unwrap().to_string();
        assert!(error.contains(":3: method must be DIS") && error.contains("\"RNE\""), "{error}");
    }
}
