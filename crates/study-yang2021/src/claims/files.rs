//! The verdicts as files.

use std::path::Path;

use experiments::Failure;
use experiments::files::NewFile;
use experiments::sweep::folder::Folder;
use serde::Serialize;

use super::papers::AUTHORS_COLUMNS;
use super::{CLAIMS, Example, Judged, PAPERS_TRIALS};

/// A CSV of a folder's trials with only the columns of the authors' tables.
///
/// # Errors
/// The table of trials cannot be read, or the disk does not take the new one.
pub fn write_authors_columns(out: &Path, folder: &Folder) -> Result<(), Failure> {
    let path = folder.path().join("trials.csv");
    let bad = |error: csv::Error| Failure::storage(format!("{}: {error}", path.display()));
    let mut trials = csv::Reader::from_path(&path).map_err(bad)?;
    let header = trials.headers().map_err(bad)?.clone();
    let missing = |name: &str| Failure::storage(format!("{}: has no column {name}", path.display()));
    let place = |name: &str| header.iter().position(|known| known == name).ok_or_else(|| missing(name));
    let places = AUTHORS_COLUMNS.split(',').map(place).collect::<Result<Vec<_>, _>>()?;
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(AUTHORS_COLUMNS.split(',')).map_err(Failure::run)?;
    for record in trials.records() {
        let record = record.map_err(bad)?;
        table.write_record(places.iter().map(|place| &record[*place])).map_err(Failure::run)?;
    }
    let bytes = table.into_inner().map_err(Failure::run)?;
    NewFile::write(out, &format!("{}.csv", folder.experiment().name), &bytes).map(drop)
}

/// `claims.csv`: each comparison of each claim.
///
/// # Errors
/// The disk does not take it.
pub fn write_claims(out: &Path, judged: &[Judged]) -> Result<(), Failure> {
    let mut rows = Vec::new();
    for scenario in judged {
        for (trials, findings) in [(PAPERS_TRIALS, &scenario.of_few), (scenario.trials, &scenario.of_all)] {
            for (claim, finding) in CLAIMS.iter().zip(findings) {
                for (part, found) in claim.parts.iter().zip(&finding.parts) {
                    rows.push(ClaimRow {
                        scenario: &scenario.scenario,
                        trials,
                        section: claim.section,
                        claim: claim.name,
                        words: claim.words,
                        verdict: finding.verdict.words(),
                        comparison: part.words(),
                        n: found.differences.len(),
                        difference: found.difference,
                        low: found.interval.map(|[low, _]| low),
                        high: found.interval.map(|[_, high]| high),
                        shared_low: found.shared_interval.map(|[low, _]| low),
                        shared_high: found.shared_interval.map(|[_, high]| high),
                    });
                }
            }
        }
    }
    write(out, "claims.csv", &rows)
}

/// `examples.csv`: the paper's numerical examples.
///
/// # Errors
/// The disk does not take it.
pub fn write_examples(out: &Path, examples: &[Example]) -> Result<(), Failure> {
    let row = |example: &Example| ExampleRow {
        example: example.name,
        words: example.words,
        trusting_nats: example.trusting,
        doubting_nats: example.doubting,
        verdict: example.verdict.words(),
    };
    write(out, "examples.csv", &examples.iter().map(row).collect::<Vec<_>>())
}

/// `power.csv`: the verdicts expected from experiments of other sizes.
///
/// # Errors
/// The disk does not take it.
pub fn write_power(out: &Path, judged: &[Judged]) -> Result<(), Failure> {
    let mut rows = Vec::new();
    for scenario in judged {
        for ((claim, finding), power) in CLAIMS.iter().zip(&scenario.of_all).zip(&scenario.powers) {
            for (part, found) in claim.parts.iter().zip(&finding.parts) {
                rows.push(PowerRow {
                    scenario: &scenario.scenario,
                    claim: claim.name,
                    leaning: power.map(|power| power.leaning.words()),
                    claim_pairs_needed: power.and_then(|power| power.pairs_needed),
                    holds_at_10: power.map(|power| power.of_few.holds),
                    does_not_hold_at_10: power.map(|power| power.of_few.does_not_hold),
                    comparison: part.words(),
                    n: found.differences.len(),
                    difference: found.difference,
                    sd: found.sd(),
                    pairs_needed: found.pairs_needed,
                    least_difference_at_10: found.least_found(),
                });
            }
        }
    }
    write(out, "power.csv", &rows)
}

fn write(out: &Path, name: &str, rows: &[impl Serialize]) -> Result<(), Failure> {
    let mut table = csv::Writer::from_writer(Vec::new());
    rows.iter().try_for_each(|row| table.serialize(row)).map_err(Failure::run)?;
    let bytes = table.into_inner().map_err(Failure::run)?;
    NewFile::write(out, name, &bytes).map(drop)
}

/// A row of `claims.csv`: one comparison of one claim, over this number of trials.
#[derive(Serialize)]
struct ClaimRow<'a> {
    scenario: &'a str,
    trials: u32,
    section: &'a str,
    claim: &'a str,
    words: &'a str,
    verdict: &'a str,
    comparison: String,
    n: usize,
    difference: Option<f64>,
    low: Option<f64>,
    high: Option<f64>,
    shared_low: Option<f64>,
    shared_high: Option<f64>,
}

/// A row of `examples.csv`: one of the paper's numerical examples.
#[derive(Serialize)]
struct ExampleRow<'a> {
    example: &'a str,
    words: &'a str,
    trusting_nats: f64,
    doubting_nats: f64,
    verdict: &'a str,
}

/// A row of `power.csv`: one comparison of one claim.
#[derive(Serialize)]
struct PowerRow<'a> {
    scenario: &'a str,
    claim: &'a str,
    leaning: Option<&'a str>,
    claim_pairs_needed: Option<u32>,
    holds_at_10: Option<f64>,
    does_not_hold_at_10: Option<f64>,
    comparison: String,
    n: usize,
    difference: Option<f64>,
    sd: Option<f64>,
    pairs_needed: Option<u64>,
    least_difference_at_10: Option<f64>,
}
