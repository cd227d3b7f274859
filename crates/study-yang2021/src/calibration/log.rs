//! `evaluations.jsonl`: each evaluated candidate of a calibration. An interrupted search resumes from it.

use std::path::Path;

use experiments::Failure;
use experiments::experiment::Program;
use experiments::explore::Parameter;
use experiments::job::Job;

use super::{Calibration, Evaluation, POLICY};

/// Name of the calibrated scenario.
pub const CALIBRATED: &str = "calibrated.ron";
/// Name of the file that describes the calibration.
pub(super) const ORIGIN: &str = "calibration.json";
/// Name of the log.
pub(super) const LOG: &str = "evaluations.jsonl";
/// The use of the folder, and the files made from the log in the end.
const JOB: Job = Job { noun: "calibration", origin: ORIGIN, log: LOG, results: &[CALIBRATED, "fit.csv"] };

/// The log of one calibration, held by one process.
pub struct Log {
    log: store::Log,
    evaluations: Vec<Evaluation>,
}

impl Log {
    /// Opens the log of a new calibration, or of one to resume. `is_fresh` starts over.
    ///
    /// # Errors
    /// The log belongs to something else, another process works in the folder, or the disk does not take
    /// the log.
    pub fn open(folder: &Path, calibration: &Calibration, is_fresh: bool) -> Result<Self, Failure> {
        let (log, evaluations, _) = JOB.open(folder, origin_of(calibration)?, is_fresh)?;
        Ok(Self { log, evaluations })
    }

    /// The evaluation of a candidate, if there is one.
    pub fn find(&self, values: &[f64]) -> Option<&Evaluation> {
        self.evaluations.iter().find(|evaluation| evaluation.values == values)
    }

    /// All evaluations, in the order in which they were added.
    pub fn evaluations(&self) -> &[Evaluation] {
        &self.evaluations
    }

    /// The evaluation with the least misfit; the earliest of equals.
    pub fn best(&self) -> Option<&Evaluation> {
        let runs = self.evaluations.iter().filter(|evaluation| evaluation.failure.is_none());
        runs.min_by(|a, b| a.misfit.total_cmp(&b.misfit))
    }

    /// Adds an evaluation. It is on disk when this returns.
    ///
    /// # Errors
    /// The disk does not take it.
    pub fn add(&mut self, evaluation: Evaluation) -> Result<(), Failure> {
        self.log.add(&[&evaluation])?;
        self.evaluations.push(evaluation);
        Ok(())
    }
}

/// Everything that decides the evaluations.
fn origin_of(calibration: &Calibration) -> Result<serde_json::Value, Failure> {
    let spreads = calibration.target.quantities.iter().zip(&calibration.target.spreads);
    let target: serde_json::Map<String, serde_json::Value> =
        spreads.map(|(q, s)| (q.name.clone(), serde_json::json!([s.mean, s.sd]))).collect();
    Ok(serde_json::json!({
        "program": Program::running(std::slice::from_ref(&calibration.policy))?.digest().to_string(),
        "policy": POLICY,
        "free": calibration.free.iter().map(Parameter::to_string).collect::<Vec<_>>(),
        "target": target,
        "trials": calibration.trials,
        "first_seed": calibration.first_seed,
        "first_step": calibration.first_step,
        "scenario": calibration.base.resolved(),
    }))
}
