//! Tables that are wider than the terminal: long texts fold between words, and what is still too wide is
//! shown in blocks of columns, one below the other. No word and no number is cut.

use std::collections::BTreeSet;

use textwrap::core::display_width;

use crate::text::{Entry, Table};

/// A text of more columns than this may be folded.
const FOLDED: usize = 28;

/// What a column takes beside its text: two spaces and a line.
const BESIDE: usize = 3;

/// The table for a terminal with so many columns.
pub(crate) fn in_blocks(table: &Table, columns: usize) -> String {
    let mut rows: Vec<Vec<Entry>> = std::iter::once(&table.header).chain(&table.rows).cloned().collect();
    let mut widths = widths(&rows);
    let excess = (total(&widths) + 1).saturating_sub(columns);
    if excess == 0 {
        return table.boxed();
    }
    let widest = (0..widths.len()).max_by_key(|column| widths[*column]);
    if let Some(column) = widest.filter(|column| widths[*column] > FOLDED) {
        let width = widths[column].saturating_sub(excess).max(FOLDED);
        rows.iter_mut().for_each(|row| fold(row, column, width));
        widths = self::widths(&rows);
    }
    let blocks = blocks(&widths, keys(&rows), columns).into_iter().map(|block| {
        let of_block = |row: &Vec<Entry>| -> Vec<Entry> {
            block.iter().filter_map(|column| row.get(*column).cloned()).collect()
        };
        Table::of(of_block(&rows[0]), rows[1..].iter().map(of_block)).boxed()
    });
    blocks.collect()
}

/// The width of each column's text.
fn widths(rows: &[Vec<Entry>]) -> Vec<usize> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |entry: &Entry| entry.text.lines().map(display_width).max().unwrap_or(0);
    let of_column = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(width).max();
    (0..columns).map(|column| of_column(column).unwrap_or(0)).collect()
}

fn total(widths: &[usize]) -> usize {
    widths.iter().map(|width| width + BESIDE).sum()
}

/// Folds a cell between words, if it is wider than this.
fn fold(row: &mut [Entry], column: usize, width: usize) {
    let Some(entry) = row.get_mut(column) else { return };
    if display_width(&entry.text) > width {
        *entry = textwrap::fill(&entry.text, textwrap::Options::new(width).break_words(false)).into();
    }
}

/// How many columns at the left it takes to tell rows apart: one, or two.
fn keys(rows: &[Vec<Entry>]) -> usize {
    let firsts: Vec<&str> = rows.iter().filter_map(|row| Some(row.first()?.text.as_str())).collect();
    let is_unique = firsts.iter().collect::<BTreeSet<_>>().len() == firsts.len();
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    if is_unique || columns < 4 { 1 } else { 2 }
}

/// The columns of each block: those that tell rows apart, and as many others as there is room for.
fn blocks(widths: &[usize], keys: usize, columns: usize) -> Vec<Vec<usize>> {
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    for column in keys..widths.len() {
        let fits = blocks.last().is_some_and(|block| {
            let taken: Vec<usize> = block.iter().chain([&column]).map(|column| widths[*column]).collect();
            total(&taken) < columns
        });
        match blocks.last_mut().filter(|_| fits) {
            Some(block) => block.push(column),
            None => blocks.push((0..keys).chain([column]).collect()),
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_wider_than_the_terminal_is_shown_in_blocks_without_cutting_a_word() {
        let mut table = Table::new(["name", "first number", "second number"]);
        table.add(["energy_per_rescuee.total", "4.44 ± 0.22", "4.31 ± 0.22"]);
        assert_eq!(in_blocks(&table, 80), table.boxed());
        let shown = in_blocks(&table, 45);
        assert_eq!(shown.matches("energy_per_rescuee.total").count(), 2, "{shown}");
        assert!(shown.contains("4.44 ± 0.22") && shown.contains("second number"), "{shown}");
        assert!(shown.lines().all(|line| display_width(line) <= 45), "{shown}");
    }

    #[test]
    fn each_block_says_what_its_rows_are() {
        let mut table = Table::new(["metric", "pair", "difference", "interval"]);
        for pair in ["A - B", "A - C"] {
            table.add(["rescuees.total", pair, "10.5", "7.92 to 13.2"]);
        }
        let shown = in_blocks(&table, 40);
        assert_eq!(shown.matches("rescuees.total ┆ A - C").count(), 2, "{shown}");
    }

    #[test]
    fn long_texts_fold_between_words() {
        let mut table = Table::new(["task", "members"]);
        let members = (0..40).map(|robot| robot.to_string()).collect::<Vec<_>>().join(" ");
        table.add(["bulk", members.as_str()]);
        let shown = in_blocks(&table, 60);
        assert!(shown.lines().all(|line| display_width(line) <= 60), "{shown}");
        assert!(shown.contains(" 39 ") && shown.contains("│ bulk ┆ 0 1 2 "), "{shown}");
    }
}
