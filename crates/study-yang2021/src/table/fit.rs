//! The table of a calibration.

use comfy_table::{Cell, Table};
use experiments::comparison::digits;
use reports::table::{headed, right};

use crate::calibration::Fit;

/// A row for each quantity of a calibration.
#[must_use]
pub fn fit_table(rows: &[Fit]) -> Table {
    let mut table = headed(["quantity", "data", "fitted", "fresh", "means apart by", "sd ratio"]);
    let spread = |mean: f64, sd: f64| right(&format!("{} ± {}", digits(mean, 4), digits(sd, 2)));
    for row in rows {
        table.add_row([
            Cell::new(&row.quantity),
            spread(row.data_mean, row.data_sd),
            spread(row.fitted_mean, row.fitted_sd),
            spread(row.fresh_mean, row.fresh_sd),
            right(&format!("{:+.1} sd", row.off_by_sd)),
            right(&format!("{:.2}", row.sd_ratio)),
        ]);
    }
    table
}
