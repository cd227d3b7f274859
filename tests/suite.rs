//! Integration tests of the whole system, one binary.

mod laws;
mod support;

mod broken;
mod claims_by_radio;
mod conservation;
mod damaged;
mod determinism;
mod documents;
mod files;
mod invariants;
mod limits;
mod minimal;
mod mission_readings;
mod missions;
mod movement;
mod navigation;
mod no_peeking;
mod packages;
mod pairing;
mod paper_counts;
mod random_worlds;
mod robots_decide;
mod routes;
mod scenarios;
mod schemas;
mod sight;
mod telemetry;
