//! The table of predictions.

use comfy_table::{Cell, Table};
use experiments::comparison::digits;
use reports::table::{headed, right};

use crate::predictions::Prediction;
use crate::scenarios::POLICIES;

/// A row for each quantity, a column for each policy: the mean, and the interval for the mean of ten other
/// trials.
pub(crate) fn predictions_table(predictions: &[Prediction]) -> Table {
    let mut table = headed(std::iter::once("quantity").chain(POLICIES).map(Cell::new));
    let first = predictions.iter().filter(|one| one.policy == predictions[0].policy);
    for quantity in first.map(|one| one.quantity.as_str()) {
        let of = |policy: &str| {
            let is_it = |one: &&Prediction| one.quantity == quantity && one.policy == policy;
            let text = |one: &Prediction| {
                let [mean, low, high] = [one.mean, one.low, one.high].map(|value| digits(value, 4));
                format!("{mean} ({low} to {high})")
            };
            right(&predictions.iter().find(is_it).map_or("-".to_owned(), text))
        };
        table.add_row(std::iter::once(Cell::new(quantity.replace('_', " "))).chain(POLICIES.map(of)));
    }
    table
}
