//! `evaluations.csv`: each evaluated candidate of a calibration. An interrupted search resumes from it.

use std::path::Path;

use experiments::Failure;
use experiments::experiment::Program;
use experiments::explore::{EvaluationLog, Free, Purpose};

use super::{Calibration, Evaluation, POLICY, Spread};

/// Name of the calibrated scenario.
pub const CALIBRATED: &str = "calibrated.ron";
/// Name of the file that describes the calibration.
pub(super) const ORIGIN: &str = "calibration.json";
/// The use of the folder, and the files made from the log in the end.
const PURPOSE: Purpose = Purpose { noun: "calibration", origin: ORIGIN, results: &[CALIBRATED, "fit.csv"] };

/// The log of one calibration, held by one process.
pub struct Log {
    log: EvaluationLog,
    evaluations: Vec<Evaluation>,
}

impl Log {
    /// Opens the log of a new calibration, or of one to resume. `is_fresh` starts over.
    ///
    /// # Errors
    /// The log belongs to something else, another process works in the folder, or the disk does not take
    /// the log.
    pub fn open(folder: &Path, calibration: &Calibration, is_fresh: bool) -> Result<Self, Failure> {
        let (origin, header) = (origin_of(calibration)?, header(calibration));
        let (log, rows) = EvaluationLog::open(folder, &PURPOSE, &origin, &header, is_fresh)?;
        let read =
            |(i, row): (usize, &Vec<String>)| evaluation(row, calibration).ok_or_else(|| log.bad_row(i));
        let evaluations = rows.iter().enumerate().map(read).collect::<Result<Vec<_>, Failure>>()?;
        Ok(Self { log, evaluations })
    }

    /// The evaluation of a candidate, if there is one.
    #[must_use]
    pub fn find(&self, values: &[f64]) -> Option<&Evaluation> {
        self.evaluations.iter().find(|evaluation| evaluation.values == values)
    }

    /// All evaluations, in the order in which they were added.
    #[must_use]
    pub fn evaluations(&self) -> &[Evaluation] {
        &self.evaluations
    }

    /// The evaluation with the least misfit; the earliest of equals.
    #[must_use]
    pub fn best(&self) -> Option<&Evaluation> {
        let runs = self.evaluations.iter().filter(|evaluation| evaluation.failure.is_none());
        runs.min_by(|a, b| a.misfit.total_cmp(&b.misfit))
    }

    /// Adds an evaluation. It is on disk when this returns.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add(&mut self, evaluation: Evaluation) -> Result<(), Failure> {
        let cells = [(self.evaluations.len() + 1).to_string(), evaluation.misfit.to_string()].into_iter();
        let values = evaluation.values.iter().map(f64::to_string);
        let spreads = evaluation.spreads.iter().flat_map(|s| [s.mean.to_string(), s.sd.to_string()]);
        let mut row: Vec<String> = cells.chain(values).chain(spreads).collect();
        row.resize(self.log.columns() - 1, String::new());
        row.push(evaluation.failure.clone().unwrap_or_default());
        self.log.add(row)?;
        self.evaluations.push(evaluation);
        Ok(())
    }
}

fn header(calibration: &Calibration) -> Vec<String> {
    let names = calibration.free.iter().map(|free| free.name.clone());
    let quantities = calibration.target.quantities.iter();
    let spreads = quantities.flat_map(|q| [format!("{}_mean", q.name), format!("{}_sd", q.name)]);
    let first = ["evaluation", "misfit"].map(str::to_owned);
    first.into_iter().chain(names).chain(spreads).chain(["failure".to_owned()]).collect()
}

fn evaluation(row: &[String], calibration: &Calibration) -> Option<Evaluation> {
    let number = |cell: usize| row.get(cell)?.parse::<f64>().ok().filter(|value| value.is_finite());
    let free = calibration.free.len();
    let values = (2..2 + free).map(number).collect::<Option<Vec<f64>>>()?;
    let misfit = number(1)?;
    let failure = row.last().filter(|failure| !failure.is_empty()).cloned();
    if failure.is_some() {
        return Some(Evaluation { values, misfit, spreads: Vec::new(), failure });
    }
    let spread = |q| Some(Spread { mean: number(2 + free + 2 * q)?, sd: number(3 + free + 2 * q)? });
    let spreads = (0..calibration.target.quantities.len()).map(spread).collect::<Option<Vec<_>>>()?;
    Some(Evaluation { values, misfit, spreads, failure })
}

/// Everything that decides the evaluations.
fn origin_of(calibration: &Calibration) -> Result<serde_json::Value, Failure> {
    let spreads = calibration.target.quantities.iter().zip(&calibration.target.spreads);
    let target: serde_json::Map<String, serde_json::Value> =
        spreads.map(|(q, s)| (q.name.clone(), serde_json::json!([s.mean, s.sd]))).collect();
    Ok(serde_json::json!({
        "program": Program::running(std::slice::from_ref(&calibration.policy))?.digest().to_string(),
        "policy": POLICY,
        "free": calibration.free.iter().map(Free::to_string).collect::<Vec<_>>(),
        "target": target,
        "trials": calibration.trials,
        "first_seed": calibration.first_seed,
        "first_step": calibration.first_step,
        "scenario": calibration.base.resolved(),
    }))
}
