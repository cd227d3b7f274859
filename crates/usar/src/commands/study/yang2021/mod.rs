//! `usar study yang2021`: the paper by Yang and Parasuraman (2021).

mod calibrate;
mod claims;
mod readings;
mod sorting;

use crate::commands::verbs;

verbs!(Verb {
    Claims: claims::Arguments,
    Readings: readings::Arguments,
    Sorting: sorting::Arguments,
    Calibrate: calibrate::Arguments,
});
