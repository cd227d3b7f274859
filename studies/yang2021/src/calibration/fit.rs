//! The fit: each quantity of the data beside the same quantity of the model.

use std::path::Path;

use experiments::Failure;
use experiments::files::NewFile;
use serde::Serialize;

use super::{Calibration, Spread};

/// One quantity: of the data, of the model over the seeds to which it was fitted, and of the model over
/// fresh seeds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fit {
    /// Name of the quantity.
    pub quantity: String,
    /// Mean of the data.
    pub data_mean: f64,
    /// Standard deviation of the data.
    pub data_sd: f64,
    /// Mean of the model over the seeds of the calibration.
    pub fitted_mean: f64,
    /// Standard deviation of the model over these seeds.
    pub fitted_sd: f64,
    /// Mean of the model over fresh seeds.
    pub fresh_mean: f64,
    /// Standard deviation of the model over fresh seeds.
    pub fresh_sd: f64,
    /// Difference of the means (fresh minus data), in standard deviations of the data.
    pub off_by_sd: f64,
    /// Ratio of the standard deviations, fresh to data.
    pub sd_ratio: f64,
}

impl Fit {
    /// A row for each quantity.
    pub fn rows(calibration: &Calibration, fitted: &[Spread], fresh: &[Spread]) -> Vec<Self> {
        let target = &calibration.target;
        let models = fitted.iter().zip(fresh);
        let rows = target.quantities.iter().zip(&target.spreads).zip(models);
        rows.map(|((quantity, data), (fitted, fresh))| Self {
            quantity: quantity.name.clone(),
            data_mean: data.mean,
            data_sd: data.sd,
            fitted_mean: fitted.mean,
            fitted_sd: fitted.sd,
            fresh_mean: fresh.mean,
            fresh_sd: fresh.sd,
            off_by_sd: (fresh.mean - data.mean) / data.sd,
            sd_ratio: fresh.sd / data.sd,
        })
        .collect()
    }
}

/// Writes `fit.csv`.
///
/// # Errors
/// The disk does not take it.
pub fn write_fit(folder: &Path, rows: &[Fit]) -> Result<(), Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| table.serialize(row)).map_err(Failure::run)?;
    let bytes = table.into_inner().map_err(Failure::run)?;
    NewFile::write(folder, "fit.csv", &bytes).map(drop)
}
