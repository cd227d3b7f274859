//! Integration tests of the whole system, one binary.

mod golden;
mod journeys;
mod support;
mod worlds;

mod conservation;
mod determinism;
mod errata;
mod grouping;
mod invariants;
mod minimal;
mod pairing;
mod paper_counts;
mod random_worlds;
mod routes;
mod scenarios;
mod trust;
