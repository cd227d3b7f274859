//! The table of a calibration.

use comfy_table::{Cell, Table};
use experiments::comparison::digits;
use reports::table::{headed, right};

use crate::calibration::{Fit, Judged, Spread, Target};

/// The data, and a row for each candidate of a choice.
pub fn choice_table(target: &Target, judged: &[Judged]) -> Table {
    let first = ["candidate", "misfit", "nearest in"].map(str::to_owned);
    let names = target.quantities.iter().map(|quantity| quantity.name.replace('_', " "));
    let mut table = headed(first.into_iter().chain(names));
    let spreads = |spreads: &[Spread]| -> Vec<Cell> {
        spreads.iter().map(|s| right(&format!("{} ± {}", digits(s.mean, 4), digits(s.sd, 2)))).collect()
    };
    let row = |cells: [Cell; 3], rest: Vec<Cell>| cells.into_iter().chain(rest);
    table.add_row(row([Cell::new("data"), right(""), right("")], spreads(&target.spreads)));
    for judged in judged {
        let share = format!("{:.0} %", 100.0 * judged.share_nearest);
        let cells = [Cell::new(&judged.candidate), right(&digits(judged.misfit, 3)), right(&share)];
        table.add_row(row(cells, spreads(&judged.spreads)));
    }
    table
}

/// A row for each quantity of a calibration.
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
