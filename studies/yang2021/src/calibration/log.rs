//! `evaluations.jsonl`: each evaluated candidate of a calibration. An interrupted search resumes from it.

use std::path::Path;

use experiments::Failure;
use experiments::experiment::Program;
use experiments::explore::Parameter;
use experiments::job::{Job, JobFolder};

use super::{Calibration, Evaluation, POLICY};

/// Name of the calibrated scenario.
pub const CALIBRATED: &str = "calibrated.ron";
/// The use of the folder, and the files made from the log in the end.
pub(super) const JOB: Job = Job {
    noun: "calibration",
    origin: "calibration.json",
    log: "evaluations.jsonl",
    results: &[CALIBRATED, "fit.csv"],
};

/// The evaluations of one calibration, in the order in which they were added.
pub type Log = JobFolder<Evaluation>;

/// Opens the folder of a new calibration, or of one to resume. `is_fresh` starts over.
///
/// # Errors
/// The folder belongs to something else, another process works in it, or the disk does not take the log.
pub fn open(folder: &Path, calibration: &Calibration, is_fresh: bool) -> Result<Log, Failure> {
    JOB.open(folder, origin_of(calibration)?, is_fresh)
}

/// The evaluation with the least misfit; the earliest of equals.
pub fn best(log: &Log) -> Option<&Evaluation> {
    let runs = log.entries.iter().filter(|evaluation| evaluation.failure.is_none());
    runs.min_by(|a, b| a.misfit.total_cmp(&b.misfit))
}

/// Everything that decides the evaluations.
fn origin_of(calibration: &Calibration) -> Result<serde_json::Value, Failure> {
    let spreads = calibration.target.quantities.iter().zip(&calibration.target.spreads);
    let target: serde_json::Map<String, serde_json::Value> =
        spreads.map(|(q, s)| (q.name.clone(), serde_json::json!([s.mean, s.sd]))).collect();
    Ok(serde_json::json!({
        "study": crate::STUDY,
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
