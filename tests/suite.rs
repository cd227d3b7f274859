//! Integration tests of the whole system, one binary.

mod support;

mod command_line;
mod conservation;
mod errata;
mod grouping;
mod pairing;
mod paper_counts;
mod scenarios;
mod trust;
