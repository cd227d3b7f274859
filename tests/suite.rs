//! Integration tests of the whole system, one binary.

mod support;

mod conservation;
mod errata;
mod grouping;
mod ledger;
mod pairing;
mod paper_counts;
mod scenarios;
mod trust;
