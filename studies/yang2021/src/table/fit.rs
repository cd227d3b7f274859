//! The table of a calibration.

use experiments::comparison::digits;
use tables::{Entry, Table, labelled, right, valued};

use crate::calibration::{Fit, Judged, Spread, Target};

fn spread(mean: f64, sd: f64) -> Entry {
    valued([mean, sd], format!("{} ± {}", digits(mean, 4), digits(sd, 2)))
}

/// The data, and a row for each candidate of a choice.
pub fn choice_table(target: &Target, judged: &[Judged]) -> Table {
    let names = target.quantities.iter().map(|quantity| quantity.name.replace('_', " "));
    let row = |name: &str, numbers: [Entry; 2], spreads: &[Spread]| {
        labelled(name, numbers.into_iter().chain(spreads.iter().map(|s| spread(s.mean, s.sd))))
    };
    let mut table =
        Table::new(["candidate", "misfit", "nearest in"].map(str::to_owned).into_iter().chain(names));
    table.add(row("data", ["", ""].map(|text| right(text).with(())), &target.spreads));
    for judged in judged {
        let share = format!("{:.0} %", 100.0 * judged.share_nearest);
        let numbers = [valued(judged.misfit, digits(judged.misfit, 3)), valued(judged.share_nearest, share)];
        table.add(row(&judged.candidate, numbers, &judged.spreads));
    }
    table
}

/// A row for each quantity of a calibration.
pub fn fit_table(rows: &[Fit]) -> Table {
    let row = |row: &Fit| {
        [
            Entry::from(&row.quantity),
            spread(row.data_mean, row.data_sd),
            spread(row.fitted_mean, row.fitted_sd),
            spread(row.fresh_mean, row.fresh_sd),
            valued(row.off_by_sd, format!("{:+.1} sd", row.off_by_sd)),
            valued(row.sd_ratio, format!("{:.2}", row.sd_ratio)),
        ]
    };
    Table::of(["quantity", "data", "fitted", "fresh", "means apart by", "sd ratio"], rows.iter().map(row))
}
