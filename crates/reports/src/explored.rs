//! A study of sensitivity as a figure, tables, and a ranking in words.

use experiments::Failure;
use experiments::comparison::short;
use experiments::explore::{CHANCE, Index, Outcome, Row};
use statistics::sensitivity::Known;
use tables::{Entry, Table, right};

use crate::figures::sensitivity;
use crate::table::between;

/// The drawing of a study's indices, and the table of the numbers behind it.
///
/// # Errors
/// None: all is made in memory.
pub fn sensitivity_figure(rows: &[Row]) -> Result<[Vec<u8>; 2], Failure> {
    let figure = sensitivity(rows)?.drawn();
    Ok([figure.svg.into_bytes(), figure.csv.into_bytes()])
}

/// The indices of one outcome.
pub fn sensitivity_table(rows: &[&Row]) -> Table {
    let is_of_effects = rows.iter().any(|row| matches!(row.index, Index::Effects { .. }));
    let header = if is_of_effects {
        "parameter,mu*,95 % interval,mu,95 % interval,sigma,beyond chance"
    } else {
        "parameter,alone,95 % interval,in all,95 % interval"
    };
    let row = |row: &&Row| {
        let mut cells = vec![Entry::from(&row.parameter)];
        let mut add = |known: Known| {
            cells.extend([right(short(known.value)), right(between(known.interval))]);
        };
        match row.index {
            Index::Effects { effects, beyond } => {
                add(effects.size);
                add(effects.mean);
                cells.push(right(short(effects.spread.value)));
                cells.push(right(between(beyond.and_then(|beyond| beyond.interval))));
            }
            Index::Shares(shares) => {
                add(shares.first);
                add(shares.total);
            }
            Index::Chance { first } => {
                add(first);
                cells.extend([right("-"), right("-")]);
            }
        }
        cells
    };
    Table::of(header.split(','), rows.iter().map(row))
}

/// Most parameters whose effects a sentence tells; the others are named.
const MOST_IN_WORDS: usize = 3;

/// The ranking of one outcome's parameters in words, the largest first.
pub fn ranking(outcome: &Outcome, rows: &[&Row]) -> String {
    let place = format!("{}, {}", outcome.what, outcome.who);
    if rows.is_empty() {
        return format!("{place}: has no number at some point of every block, or is the same everywhere.");
    }
    let shown: Vec<&&Row> = rows.iter().filter(|row| row.is_shown() && !row.is_chance()).collect();
    let others: Vec<&str> = rows
        .iter()
        .filter(|row| !row.is_shown() && !row.is_chance())
        .map(|row| row.parameter.as_str())
        .collect();
    let mut sentences = vec![match shown.split_first() {
        None => format!("{place}: no parameter is told apart from chance."),
        Some((most, rest)) => {
            let (next, further) = rest.split_at(rest.len().min(MOST_IN_WORDS - 1));
            let next = next.iter().map(|row| format!("; then {}{}", row.parameter, in_words(row)));
            let further: Vec<&str> = further.iter().map(|row| row.parameter.as_str()).collect();
            let further = match further.len() {
                0 => String::new(),
                _ => format!(" Also told apart from chance: {}.", further.join(", ")),
            };
            let first = format!("{place}: {} matters most{}", most.parameter, in_words(most));
            format!("{first}{}.{further}", next.collect::<String>())
        }
    }];
    if !shown.is_empty() && !others.is_empty() {
        sentences.push(format!("Not told apart from chance: {}.", others.join(", ")));
    }
    let chance = rows.iter().find(|row| row.parameter == CHANCE);
    sentences.extend(chance.and_then(|row| match row.index {
        Index::Effects { effects, .. } => {
            Some(format!("Other seeds alone change it by {}.", short(effects.size.value)))
        }
        Index::Chance { first } => {
            Some(format!("Other seeds alone make {} of the variance.", percent(first.value)))
        }
        Index::Shares(_) => None,
    }));
    sentences.join(" ")
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// The importance of a parameter, and its direction, in words.
fn in_words(row: &Row) -> String {
    match row.index {
        Index::Effects { effects, .. } => {
            let size = short(effects.size.value);
            let range = effects.size.interval.map_or(String::new(), |[low, high]| {
                format!(", 95 % interval {} to {}", short(low), short(high))
            });
            let direction = match effects.mean.interval {
                Some([low, _]) if low > 0.0 => ", and more of it raises the value",
                Some([_, high]) if high < 0.0 => ", and more of it lowers the value",
                _ => ", now up, now down",
            };
            format!(" (over its range it changes by {size} on average{range}{direction})")
        }
        Index::Shares(shares) => {
            let range = shares.first.interval.map_or(String::new(), |[low, high]| {
                format!(", 95 % interval {} to {}", percent(low), percent(high))
            });
            format!(
                " ({} of the variance alone{range}; {} with all in which it has a part)",
                percent(shares.first.value),
                percent(shares.total.value)
            )
        }
        Index::Chance { .. } => String::new(),
    }
}
