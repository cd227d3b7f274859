//! The verdicts as files.

use std::path::Path;

use experiments::Failure;
use experiments::files::NewFile;
use experiments::sweep::folder::Folder;
use serde::Serialize;

use super::papers::AUTHORS_COLUMNS;
use super::{CLAIMS, Example, Judged, PAPERS_TRIALS};

/// The columns of `claims.csv`: one comparison of one claim, over this number of trials.
const CLAIM_COLUMNS: &str =
    "scenario,trials,section,claim,words,verdict,comparison,n,difference,low,high,shared_low,shared_high";

/// The columns of `power.csv`: one comparison of one claim.
const POWER_COLUMNS: &str = "scenario,claim,leaning,claim_pairs_needed,holds_at_10,does_not_hold_at_10,\
    comparison,n,difference,sd,pairs_needed,least_difference_at_10";

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
                    rows.push((
                        &scenario.scenario,
                        trials,
                        claim.section,
                        claim.name,
                        claim.words,
                        finding.verdict.words(),
                        part.words(),
                        found.n,
                        found.difference,
                        found.interval.map(|[low, _]| low),
                        found.interval.map(|[_, high]| high),
                        found.shared_interval.map(|[low, _]| low),
                        found.shared_interval.map(|[_, high]| high),
                    ));
                }
            }
        }
    }
    write(out, "claims.csv", CLAIM_COLUMNS, &rows)
}

/// `examples.csv`: the paper's numerical examples.
///
/// # Errors
/// The disk does not take it.
pub fn write_examples(out: &Path, examples: &[Example]) -> Result<(), Failure> {
    let row = |one: &Example| (one.name, one.words, one.trusting, one.doubting, one.verdict.words());
    let header = "example,words,trusting_nats,doubting_nats,verdict";
    write(out, "examples.csv", header, &examples.iter().map(row).collect::<Vec<_>>())
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
                rows.push((
                    &scenario.scenario,
                    claim.name,
                    power.map(|power| power.leaning.words()),
                    power.and_then(|power| power.pairs_needed),
                    power.map(|power| power.of_few.holds),
                    power.map(|power| power.of_few.does_not_hold),
                    part.words(),
                    found.n,
                    found.difference,
                    found.sd,
                    found.pairs_needed,
                    found.least_found(),
                ));
            }
        }
    }
    write(out, "power.csv", POWER_COLUMNS, &rows)
}

/// Writes a table of tuples below its header.
fn write(out: &Path, name: &str, header: &str, rows: &[impl Serialize]) -> Result<(), Failure> {
    let mut table = csv::WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    table.write_record(header.split(',')).map_err(Failure::run)?;
    rows.iter().try_for_each(|row| table.serialize(row)).map_err(Failure::run)?;
    let bytes = table.into_inner().map_err(Failure::run)?;
    NewFile::write(out, name, &bytes).map(drop)
}
