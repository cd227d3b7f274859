//! The table of predictions.

use experiments::comparison::digits;
use tables::{Table, labelled, right_or_dash};

use crate::predictions::Prediction;
use crate::scenarios::POLICIES;

/// A row for each quantity, a column for each policy: the mean, and the interval for the mean of ten other
/// trials.
pub(crate) fn predictions_table(predictions: &[Prediction]) -> Table {
    let row = |first: &Prediction| {
        let of = |policy: &str| {
            let is_it = |one: &&Prediction| one.quantity == first.quantity && one.policy == policy;
            right_or_dash(predictions.iter().find(is_it), |one| {
                let [mean, low, high] = [one.mean, one.low, one.high].map(|value| digits(value, 4));
                format!("{mean} ({low} to {high})")
            })
        };
        labelled(first.quantity.replace('_', " "), POLICIES.map(of))
    };
    let first = predictions.iter().filter(|one| one.policy == predictions[0].policy);
    Table::of(labelled("quantity", POLICIES), first.map(row))
}
