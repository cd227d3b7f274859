//! Tables of RNE's readings.

use experiments::comparison::{digits, short};
use experiments::metric::Catalogue;
use tables::{Entry, Table, labelled, right, right_or_dash, valued};

use crate::readings::{Difference, ReadingRow, RivalRow, shown};

fn differences(differences: &[Option<Difference>]) -> impl Iterator<Item = Entry> + '_ {
    differences.iter().map(|difference| {
        let pair = difference.as_ref().map(|difference| (difference.mean, difference.half));
        right_or_dash(pair, |(mean, half)| format!("{} ± {}", signed(mean), digits(half, 2)))
    })
}

fn signed(value: f64) -> String {
    if value > 0.0 { format!("+{}", short(value)) } else { short(value) }
}

/// The metrics in which readings are compared.
fn names(metrics: &Catalogue) -> impl Iterator<Item = &str> {
    shown(metrics).into_iter().map(|place| metrics[place].name.as_str())
}

/// Each reading by itself.
pub fn readings_table(rows: &[ReadingRow], metrics: &Catalogue) -> Table {
    let row = |row: &ReadingRow| {
        let [grouped, split] = row.regrouped;
        let shares =
            [grouped, split, row.trials].map(|share| valued(share, format!("{:.1} %", 100.0 * share)));
        labelled(&row.reading, shares.into_iter().chain(differences(&row.differences)))
    };
    let header = ["reading", "regrouped", "split otherwise", "trials"].into_iter().chain(names(metrics));
    Table::of(header, rows.iter().map(row))
}

/// Each reading averaged over the others.
pub fn averaged_table(rows: &[(String, Vec<Option<Difference>>)], metrics: &Catalogue) -> Table {
    let rows = rows.iter().map(|(reading, row)| labelled(reading, differences(row)));
    Table::of(labelled("reading", names(metrics)), rows)
}

/// All readings against other policies.
pub fn rivals_table(rows: &[RivalRow]) -> Table {
    let row = |row: &RivalRow| {
        let end = |(reading, difference): &(String, Difference)| {
            format!("{} ± {} ({reading})", signed(difference.mean), digits(difference.half, 2)).into()
        };
        let counts = row.counts.iter().chain(&row.corrected).map(right);
        let numbers = counts.chain(row.ends.iter().flatten().map(end));
        labelled(&row.metric, labelled(row.rival.as_deref().unwrap_or("all"), numbers))
    };
    let header = "metric,against,above,below,neither,corrected: above,corrected: below,least,greatest";
    Table::of(header.split(','), rows.iter().map(row))
}
