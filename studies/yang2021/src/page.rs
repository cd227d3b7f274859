//! The verdicts on the paper's claims, section by section, as printed text and as a page.

use std::path::{Path, PathBuf};

use askama::Template;
use experiments::Failure;
use experiments::experiment::Digest;
use experiments::sweep::names::REPORT;
use experiments::sweep::owned::Report;
use tables::{Entry, Table};

use crate::claims::{CLAIMS, Example, Judged, LEAST_TRIALS};
use crate::predictions::{Prediction, over_worlds};
use crate::scenarios::Standing;
use crate::table::{
    claims_table, examples_table, power_table, predictions_table, ranges_table, verdicts_table,
};

/// A section of the output.
pub struct Section {
    /// Its title.
    pub title: String,
    /// Its table; `None` if there is too little data for one.
    pub table: Option<Table>,
    /// The text below the table.
    pub note: String,
}

/// All sections, the verdicts last.
pub fn sections(
    judged: &[Judged],
    examples: &[Example],
    predicted: &[(Standing, Vec<Prediction>)],
) -> Vec<Section> {
    // Of the worlds of other readings, only verdicts and ranges are shown; claims.csv and power.csv have the
    // rest.
    let main = || judged.iter().filter(|world| world.standing.is_main());
    let claims = main().map(|scenario| Section {
        title: format!("{}: what its trials say of each claim", scenario.scenario),
        table: Some(claims_table(scenario)),
        note: String::new(),
    });
    let examples = Section {
        title: "The paper's numerical examples, with exact values (nats)".to_owned(),
        table: Some(examples_table(examples)),
        note: String::new(),
    };
    let power = main().map(|scenario| {
        let table = power_table(scenario);
        let few = format!("Not said: it takes {LEAST_TRIALS} trials, there are {}.", scenario.trials);
        let note = if table.is_some() { POWER_NOTE.to_owned() } else { few };
        let title = format!("{}: what 10 pairs could have shown, and how many it takes", scenario.scenario);
        Section { title, table, note }
    });
    let verdicts =
        Section { title: "Verdicts".to_owned(), table: Some(verdicts_table(judged)), note: footnote(judged) };
    let predictions = predicted_worlds(predicted).into_iter().map(|predictions| Section {
        title: format!("Predictions of the mean of ten trials: {}", predictions[0].scenario),
        table: Some(predictions_table(&predictions)),
        note: "in brackets: the mean of ten other trials lies there in 95 % of experiments, if the world is \
            the authors'"
            .to_owned(),
    });
    let ranges = ranges_table(judged).map(|table| Section {
        title: "Ranges over the readings of when a tired robot rests".to_owned(),
        table: Some(table),
        note: RANGES_NOTE.to_owned(),
    });
    claims.chain([examples]).chain(power).chain(predictions).chain(ranges).chain([verdicts]).collect()
}

/// The predictions to show: those of the printed world, and those of all calibrated worlds together.
fn predicted_worlds(predicted: &[(Standing, Vec<Prediction>)]) -> Vec<Vec<Prediction>> {
    let of = |wanted: Standing| predicted.iter().find(|(standing, _)| *standing == wanted);
    let together = Some(over_worlds(predicted)).filter(|together| !together.is_empty());
    let calibrated = together.or_else(|| Some(of(Standing::Calibrated)?.1.clone()));
    let shown =
        of(Standing::Printed).map(|(_, predictions)| predictions.clone()).into_iter().chain(calibrated);
    shown.filter(|predictions| !predictions.is_empty()).collect()
}

const RANGES_NOTE: &str = "the least and the largest mean difference in the calibrated worlds, one for each \
    reading; all of them are in claims.csv";

const POWER_NOTE: &str = "leans to: what large experiments would say, were the means of these trials the \
    truth; pairs for 80 %: the fewest with which 80 % of\n\
    experiments say so (of a comparison: of paired t tests at 5 %); of 10 pairs: verdicts of experiments of \
    10 pairs drawn from these; least found\n\
    by 10: the difference that 80 % of experiments of 10 pairs find";

fn footnote(judged: &[Judged]) -> String {
    let alternatives = judged.iter().filter(|world| world.standing == Standing::Alternative).count();
    let worlds = if alternatives == 0 {
        String::new()
    } else {
        format!(
            "All calibrated worlds: paper-calibrated and {alternatives} that the recorded trials cannot tell \
             from it. A claim holds there if it\n\
             holds in each, and does not if it does not in one. All readings: the worlds that fit best under \
             each reading of when a tired robot rests.\n"
        )
    };
    worlds
        + &format!(
            "Paired by seed; intervals: BCa bootstrap at 95 %, widened for small n. A claim holds when the \
             interval of each of its comparisons lies on the\n\
         claimed side, and does not when one lies on the other side (by the shared interval: 95 % for all \
         its comparisons together). It\n\
         holds or is within the margin when each of its comparisons holds, or differs by less than the \
         margin of paper.sweep.ron (90 % interval):\n\
         of a claim to be the best, the best or within 5 of the best. Else it is undecided. Each verdict is \
         wrong in about 2.5 % of experiments at most; the {} claims are not corrected for one another.\n\
         studies/yang2021/docs/reproduction.md discusses them.",
            CLAIMS.len()
        )
}

#[derive(Template)]
#[template(path = "claims.html")]
struct Page<'a> {
    scenarios: Vec<&'a str>,
    sections: Vec<Shown>,
    command: String,
    program: String,
}

/// A section of the page.
struct Shown {
    title: String,
    header: Vec<String>,
    rows: Vec<Row>,
    /// Whether rows are claims and their comparisons.
    has_parts: bool,
    note: String,
}

struct Row {
    /// Whether the row is a comparison of the claim above it; such rows are indented.
    is_part: bool,
    cells: Vec<String>,
}

impl Shown {
    fn of(section: &Section) -> Self {
        let text = |row: &Vec<Entry>| row.iter().map(|entry| entry.text.trim().to_owned()).collect();
        let row = |row: &Vec<Entry>| Row {
            is_part: row.first().is_some_and(|first| first.text.starts_with(' ')),
            cells: text(row),
        };
        let table = section.table.as_ref();
        let header: Vec<String> = table.map(|table| text(&table.header)).unwrap_or_default();
        let mut rows: Vec<Row> = table.map(|table| table.rows.iter().map(row).collect()).unwrap_or_default();
        rows.iter_mut().for_each(|row| row.cells.resize(header.len(), String::new()));
        let has_parts = rows.iter().any(|row| row.is_part);
        Self { title: section.title.clone(), header, rows, has_parts, note: section.note.clone() }
    }
}

/// Writes the sections as `report.html`, the verdicts first, beside the folders of the scenarios; returns
/// its path.
///
/// # Errors
/// The disk does not take it.
pub fn write_page(
    out: &Path,
    judged: &[Judged],
    sections: &[Section],
    program: &Digest,
) -> Result<PathBuf, Failure> {
    let mut sections: Vec<Shown> = sections.iter().map(Shown::of).collect();
    sections.rotate_right(1);
    let trials = judged.first().map_or(0, |scenario| scenario.trials);
    let page = Page {
        scenarios: judged.iter().map(|scenario| scenario.scenario.as_str()).collect(),
        sections,
        command: format!("usar yang2021 claims --trials {trials}"),
        program: format!("usar of {program}, study {}", crate::STUDY),
    };
    let page = page.render().map_err(Failure::run)?;
    let mut report = Report::of(out);
    report.add(REPORT.to_owned(), &page)?;
    report.write()?;
    Ok(out.join(REPORT))
}
