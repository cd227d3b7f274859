//! What a calibration aims at: means and spreads of recorded trials.

use std::path::Path;

use usar_sim::record::TrialRecord;

use super::POLICY;
use crate::failure::Failure;
use crate::stats::Moments;

/// A quantity of a trial that a target may have, under the authors' name.
pub struct Quantity {
    /// Name of its column.
    pub name: &'static str,
    value: fn(&TrialRecord) -> f64,
}

/// All of them, in the authors' order.
const QUANTITIES: [Quantity; 7] = [
    Quantity { name: "rescuees_hard", value: |r| f64::from(r.hard.rescued) },
    Quantity { name: "rescuees_easy", value: |r| f64::from(r.easy.rescued) },
    Quantity { name: "energy_hard", value: |r| r.hard.energy },
    Quantity { name: "energy_easy", value: |r| r.easy.energy },
    Quantity { name: "hp_hard", value: |r| r.hard.hp },
    Quantity { name: "hp_easy", value: |r| r.easy.hp },
    Quantity { name: "rounds", value: |r| f64::from(r.completed_rounds) },
];

/// Mean and sample standard deviation of one quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Sample standard deviation.
    pub sd: f64,
}

impl Spread {
    /// Of at least two values.
    #[must_use]
    pub fn of(values: &[f64]) -> Option<Self> {
        let Moments { mean, sd, .. } = Moments::of(values);
        Some(Self { mean: mean?, sd: sd? })
    }

    /// How far a model's spread is from this one: the squared distance of the means in units of this standard deviation, plus the squared
    /// logarithm of the ratio of the standard deviations. The model's counts as at least a twentieth of this one.
    #[must_use]
    pub fn misfit(&self, model: &Self) -> [f64; 2] {
        let mean = (model.mean - self.mean) / self.sd;
        let spread = (model.sd.max(self.sd / 20.0) / self.sd).ln();
        [mean * mean, spread * spread]
    }
}

/// Recorded trials of the baseline.
pub struct Target {
    /// The quantities that it has.
    pub quantities: Vec<&'static Quantity>,
    /// Their means and spreads.
    pub spreads: Vec<Spread>,
    /// Number of trials.
    pub trials: usize,
}

impl Target {
    /// Reads a table with a column `method`, in which each row is the baseline, and one for each quantity.
    ///
    /// # Errors
    /// A table that cannot be read, of other policies, or with a quantity that has no spread; with file and line.
    pub fn load(path: &Path) -> Result<Self, Failure> {
        let bad = |reason: String| Failure::input(format!("{}: {reason}", path.display()));
        let mut table = csv::Reader::from_path(path).map_err(|error| bad(error.to_string()))?;
        let header = table.headers().map_err(|error| bad(error.to_string()))?.clone();
        let column = |name: &str| header.iter().position(|column| column.trim() == name);
        let method = column("method").ok_or_else(|| bad("has no column method".into()))?;
        let found: Vec<(&Quantity, usize)> =
            QUANTITIES.iter().filter_map(|quantity| Some((quantity, column(quantity.name)?))).collect();
        if found.is_empty() {
            let known = QUANTITIES.map(|quantity| quantity.name).join(", ");
            return Err(bad(format!("has none of the columns {known}")));
        }
        let mut values = vec![Vec::new(); found.len()];
        for record in table.records() {
            let record = record.map_err(|error| bad(error.to_string()))?;
            let line = record.position().map_or(0, csv::Position::line);
            if record[method].trim() != POLICY {
                return Err(bad(format!(
                    "line {line}: method must be {POLICY}: nothing else is calibrated, found {:?}",
                    &record[method]
                )));
            }
            for ((quantity, column), values) in found.iter().zip(&mut values) {
                let cell = record[*column].trim();
                let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
                values.push(value.ok_or_else(|| {
                    bad(format!("line {line}: {} must be a number, found {cell:?}", quantity.name))
                })?);
            }
        }
        let spread = |(quantity, values): (&&Quantity, &Vec<f64>)| {
            Spread::of(values).filter(|spread| spread.sd > 0.0).ok_or_else(|| {
                bad(format!(
                    "{} must differ between trials: distances are measured by its spread",
                    quantity.name
                ))
            })
        };
        let quantities: Vec<&Quantity> = found.iter().map(|(quantity, _)| *quantity).collect();
        let spreads = quantities.iter().zip(&values).map(spread).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { quantities, spreads, trials: values[0].len() })
    }

    /// The quantities of a trial.
    #[must_use]
    pub fn measure(&self, record: &TrialRecord) -> Vec<f64> {
        self.quantities.iter().map(|quantity| (quantity.value)(record)).collect()
    }

    /// How far a model is from the target: the sum over all quantities; smaller is nearer.
    #[must_use]
    pub fn misfit(&self, model: &[Spread]) -> f64 {
        self.spreads.iter().zip(model).flat_map(|(data, model)| data.misfit(model)).sum()
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "small whole numbers are exact")]
mod tests {
    use super::*;

    #[test]
    fn a_misfit_counts_standard_deviations_and_ratios() {
        let data = Spread { mean: 100.0, sd: 5.0 };
        let misfit = |mean, sd| data.misfit(&Spread { mean, sd });
        assert_eq!(misfit(100.0, 5.0), [0.0, 0.0]);
        assert_eq!(misfit(110.0, 5.0), [4.0, 0.0]);
        let [_, wide] = misfit(100.0, 5.0 * std::f64::consts::E);
        assert!((wide - 1.0).abs() < 1e-12);
        assert!((misfit(100.0, 0.0)[1] - 20_f64.ln().powi(2)).abs() < 1e-12, "no spread at all is finite");
    }

    #[test]
    fn the_authors_table_is_read() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/reference/dis_trials.csv");
        let target = Target::load(&path).unwrap();
        assert_eq!((target.trials, target.quantities.len()), (10, 7));
        // numpy: mean and std(ddof=1) of rescuees_hard
        assert!((target.spreads[0].mean - 52.8).abs() < 1e-12);
        assert!((target.spreads[0].sd - 4.211_096_452_627_46).abs() < 1e-9, "{}", target.spreads[0].sd);
    }

    #[test]
    fn another_policy_cannot_be_a_target() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("target.csv");
        std::fs::write(&path, "method,rounds\nDIS,6\nRNE,7\n").unwrap();
        let error = Target::load(&path).err().unwrap().to_string();
        assert!(error.contains("line 3: method must be DIS") && error.contains("\"RNE\""), "{error}");
    }
}
