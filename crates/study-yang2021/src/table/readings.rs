//! Tables of RNE's readings.

use comfy_table::{Cell, Table};
use experiments::comparison::{digits, short};
use experiments::metric::Catalogue;
use reports::table::{headed, right};

use crate::readings::{Difference, ReadingRow, RivalRow, shown};

fn differences(differences: &[Option<Difference>]) -> impl Iterator<Item = Cell> + '_ {
    differences.iter().map(|difference| {
        let text = |d: &Difference| format!("{} ± {}", signed(d.mean), digits(d.half, 2));
        right(&difference.as_ref().map_or("-".to_owned(), text))
    })
}

fn signed(value: f64) -> String {
    if value > 0.0 { format!("+{}", short(value)) } else { short(value) }
}

/// The metrics in which readings are compared.
fn names(metrics: &Catalogue) -> impl Iterator<Item = Cell> {
    shown(metrics).into_iter().map(|place| Cell::new(&metrics[place].name))
}

/// Each reading by itself.
pub fn readings_table(rows: &[ReadingRow], metrics: &Catalogue) -> Table {
    let header = ["reading", "regrouped", "split otherwise", "trials"].map(Cell::new);
    let mut table = headed(header.into_iter().chain(names(metrics)));
    let share = |share: f64| right(&format!("{:.1} %", 100.0 * share));
    for row in rows {
        let [grouped, split] = row.regrouped;
        let cells = [Cell::new(&row.reading), share(grouped), share(split), share(row.trials)];
        table.add_row(cells.into_iter().chain(differences(&row.differences)));
    }
    table
}

/// Each reading averaged over the others.
pub fn averaged_table(rows: &[(String, Vec<Option<Difference>>)], metrics: &Catalogue) -> Table {
    let mut table = headed(std::iter::once(Cell::new("reading")).chain(names(metrics)));
    for (reading, row) in rows {
        table.add_row(std::iter::once(Cell::new(reading)).chain(differences(row)));
    }
    table
}

/// All readings against other policies.
pub fn rivals_table(rows: &[RivalRow]) -> Table {
    let mut table = headed(
        "metric,against,above,below,neither,corrected: above,corrected: below,least,greatest".split(','),
    );
    for row in rows {
        let end = |(reading, difference): &(String, Difference)| {
            Cell::new(format!("{} ± {} ({reading})", signed(difference.mean), digits(difference.half, 2)))
        };
        let names = [&row.metric, row.rival.as_deref().unwrap_or("all")].map(Cell::new);
        let counts = row.counts.iter().chain(&row.corrected).map(|count| right(&count.to_string()));
        table.add_row(names.into_iter().chain(counts).chain(row.ends.iter().flatten().map(end)));
    }
    table
}
