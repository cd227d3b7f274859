//! The ledger of results, `docs/results.csv`: for each folder below `results/` of which a page has numbers,
//! the pages, the command, worlds and seeds, whether it chose something (*fit*) or is a verdict on seeds that
//! had decided nothing (*judge*), when it was last run, and the number of its bits.
//!
//! Rows stand in the order in which they were first run.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::Path;

use experiments::files::NewFile;
use serde::{Deserialize, Serialize};
use usar_sim::BITS;

/// Name of the ledger in `docs/`.
const LEDGER: &str = "results.csv";

/// Start of the line at the head of a page whose results are older than the program.
pub const HEAD: &str = "> Trials of bits ";

/// Files that say which program made a folder; the second is that of a folder of sweeps.
const ORIGINS: [&str; 5] =
    ["manifest.json", "paper/manifest.json", "study.json", "search.json", "sensitivity.json"];

/// A row of the ledger.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// Folder or file below `results/`.
    pub output: String,
    /// Pages with numbers of it, `;` between them.
    pub page: String,
    /// Command, as typed in the project's folder; empty where it is not kept.
    pub command: String,
    /// Scenario files, `;` between them.
    pub world: String,
    /// Seeds, FIRST-LAST, `;` between ranges.
    pub seeds: String,
    /// What it was run for.
    #[serde(rename = "use")]
    pub purpose: Purpose,
    /// Day on which it was last run.
    pub date: String,
    /// Number of its bits.
    pub bits: u32,
    /// Half of the processor's minutes that it took when it was last run as a whole: minutes of two cores
    /// that do nothing else.
    pub minutes: Option<f64>,
}

/// What a result is for.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Purpose {
    /// It chose or shaped something, or only describes.
    Fit,
    /// It is a verdict on seeds that had decided nothing.
    Judge,
}

impl Row {
    /// The pages with numbers of it.
    pub fn pages(&self) -> impl Iterator<Item = &str> {
        self.page.split(';')
    }

    /// The ranges of its seeds.
    pub fn ranges(&self) -> Vec<RangeInclusive<u64>> {
        let range = |text: &str| {
            let (first, last) = text.split_once('-')?;
            Some(first.parse().ok()?..=last.parse().ok()?)
        };
        let ranges = self.seeds.split(';').map(|text| {
            range(text).unwrap_or_else(|| {
                panic!("docs/{LEDGER}: {}: seeds: must be FIRST-LAST, found {text:?}", self.output)
            })
        });
        ranges.collect()
    }

    /// The number of the bits of what is in `results/`, 0 for a program that had no number yet.
    pub fn bits_there(&self) -> Option<u32> {
        let folder = Path::new("results").join(&self.output);
        let text = ORIGINS.iter().find_map(|name| std::fs::read_to_string(folder.join(name)).ok())?;
        Some(bits_in(&text))
    }

    /// Whether its command is to be run.
    pub fn is_stale(&self) -> bool {
        self.bits < BITS || self.bits_there().is_some_and(|bits| bits != BITS)
    }
}

/// The number in `"bits": 12` or `"bits 12, policies ..."`, 0 where there is none.
pub fn bits_in(text: &str) -> u32 {
    let rest = text.split("\"bits").nth(1).unwrap_or_default();
    let digits = rest.trim_start_matches(['"', ':', ' ']);
    digits.split(|c: char| !c.is_ascii_digit()).next().and_then(|digits| digits.parse().ok()).unwrap_or(0)
}

/// The rows of the ledger in this project's folder.
pub fn read(root: &Path) -> Vec<Row> {
    let reader = csv::Reader::from_path(root.join("docs").join(LEDGER));
    let rows = reader.expect("docs/results.csv is there").into_deserialize();
    rows.map(|row| row.unwrap_or_else(|error| panic!("docs/{LEDGER}: {error}"))).collect()
}

/// The ledger's text.
pub fn text(rows: &[Row]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    rows.iter().for_each(|row| writer.serialize(row).expect("a row"));
    String::from_utf8(writer.into_inner().expect("in memory")).expect("text")
}

/// Writes in the ledger that this row was run on this day by this program, and its
/// minutes if it was run as a whole.
pub fn mark(output: &str, date: &str, minutes: Option<f64>) {
    // It may have been edited while the command ran.
    let mut rows = read(Path::new("."));
    for row in rows.iter_mut().filter(|row| row.output == output) {
        row.bits = BITS;
        date.clone_into(&mut row.date);
        row.minutes = minutes.or(row.minutes);
    }
    NewFile::write(Path::new("docs"), LEDGER, text(&rows).as_bytes())
        .expect("docs/results.csv can be written");
}

/// The lowest bits of the rows of each page.
pub fn bits_of_pages(rows: &[Row]) -> BTreeMap<&str, u32> {
    let mut bits = BTreeMap::new();
    for (page, row) in rows.iter().flat_map(|row| row.pages().map(move |page| (page, row))) {
        let lowest = bits.entry(page).or_insert(row.bits);
        *lowest = row.bits.min(*lowest);
    }
    bits
}

/// The page with the line under its title that says that its trials are older than the program, if they are.
pub fn headed(page: &str, bits: Option<u32>) -> String {
    let Some((title, rest)) = page.split_once("\n\n") else { return page.to_owned() };
    let old = rest.starts_with(HEAD).then(|| rest.split_once("\n\n")).flatten();
    let body = old.map_or(rest, |(_, body)| body);
    match bits.filter(|bits| *bits < BITS) {
        Some(bits) => format!("{title}\n\n{HEAD}{bits}; the program has {BITS}.\n\n{body}"),
        None => format!("{title}\n\n{body}"),
    }
}
