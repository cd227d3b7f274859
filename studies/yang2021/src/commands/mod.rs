//! The commands: a file for each.

mod calibrate;
mod claims;
mod readings;
mod sorting;

usar::verbs!(Verb {
    Claims: claims::Arguments,
    Readings: readings::Arguments,
    Sorting: sorting::Arguments,
    Calibrate: calibrate::Arguments,
});
