//! Verdicts on pages come out of the tables beside them.
//!
//! `<!-- verdict CLAIM FILE ROW -->+30.0 (22.9 to 37.3)` in prose: what is written up to the next `)` is the
//! difference and its interval in the row of a CSV file whose cells, with ` | ` between them, begin with ROW.
//! In a table of cells, `ROW @ COLUMN` names one. CLAIM is what the sentence says of it: `above`, `below`,
//! `equivalent`, `same` or `undecided`; of a cell with a verdict in words, these, as in `does-not-hold`. A
//! page whose claim is not what the row shows is refused.
//!
//! `<!-- differences NAME=FILE ... -->` stands before a table: a row for each comparison of the first file, a
//! column for each file, and in bold what is shown to be above or below.

use std::fmt::Write as _;
use std::path::Path;

/// Start of a verdict's mark.
pub const MARK: &str = "<!-- verdict ";

/// Start of the mark of a table of differences.
const TABLE: &str = "<!-- differences ";

/// Header of a table of comparisons as `usar compare` prints it, and of the CSV file made of such tables.
const COMPARISONS: &str = "| metric | A - B |";
const COLUMNS: [&str; 6] = ["difference", "95 % interval", "n", "p", "p Holm", "verdict"];

/// The comparisons in an answer of `usar compare --wide`, as CSV; a comparison's case stands behind it.
#[must_use]
pub fn comparisons(answer: &str) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["A - B", "metric", "case"].iter().chain(&COLUMNS)).expect("a header");
    let (mut case, mut header) = ("", Vec::new());
    for line in answer.lines() {
        let cells: Vec<&str> = line.trim_matches('|').trim().split(" | ").map(str::trim).collect();
        if line.starts_with(COMPARISONS) {
            header = cells;
        } else if line.starts_with("| ---") {
        } else if line.starts_with('|') && !header.is_empty() {
            let column = |name: &&str| cells[header.iter().position(|cell| cell == name).expect("a column")];
            let [pair, metric] = ["A - B", "metric"].map(|name| column(&name).replace("\\|", "|"));
            let rest = COLUMNS.iter().map(|name| column(name).to_owned());
            writer.write_record([pair, metric, case.to_owned()].into_iter().chain(rest)).expect("a row");
        } else {
            header.clear();
            case = match line {
                "" => case,
                sentence if sentence.ends_with('.') => "",
                title => title,
            };
        }
    }
    String::from_utf8(writer.into_inner().expect("in memory")).expect("text")
}

/// What a row shows: the claim that holds, and the difference with its interval.
struct Shown {
    claim: String,
    words: String,
}

/// What the cells of a comparison show, or the cell of a column: `+34.6 (25.2 to 44.4) *`, the star where it
/// is shown.
fn shown(header: &csv::StringRecord, row: &csv::StringRecord, column: Option<&str>) -> Shown {
    let cell = |name: &str| {
        let place = header.iter().position(|cell| cell == name);
        &row[place.unwrap_or_else(|| panic!("no column {name:?} in {header:?}"))]
    };
    let (difference, interval, verdict) = match column {
        None => (cell("difference"), cell("95 % interval"), cell("verdict")),
        Some(column) if !cell(column).contains(')') => {
            let verdict = cell(column);
            return Shown { claim: verdict.replace(' ', "-"), words: format!("({verdict})") };
        }
        Some(column) => {
            let (value, star) = cell(column).split_once(')').expect("a value with its interval");
            let (difference, interval) = value.split_once(" (").expect("a value with its interval");
            (difference, interval, if star.contains('*') { "shown" } else { "undecided" })
        }
    };
    let side = if difference.starts_with('-') { "below" } else { "above" };
    let others = ["equivalent", "undecided", "same"];
    let claim = others.into_iter().find(|word| verdict.contains(word)).unwrap_or(side);
    let sign = if difference.starts_with(['-', '+']) || difference == "0" { "" } else { "+" };
    Shown { claim: claim.to_owned(), words: format!("{sign}{difference} ({interval})") }
}

/// The header and the rows of a CSV file beside a page.
fn table(folder: &Path, file: &str) -> (csv::StringRecord, Vec<csv::StringRecord>) {
    let mut reader =
        csv::Reader::from_path(folder.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
    let header = reader.headers().expect("a header").clone();
    (header, reader.records().map(|row| row.expect("a row")).collect())
}

/// The page with its verdicts and tables of differences as the files beside it have them, and what the page
/// claims and the files do not show.
#[must_use]
pub fn filled(page: &str, folder: &Path) -> (String, Vec<String>) {
    let (mut new, mut wrong, mut rest) = (String::new(), Vec::new(), page);
    while let Some((before, after)) = rest.split_once(MARK) {
        let (mark, after) = after.split_once(" -->").expect("a mark ends");
        let (claim, file, row) = match mark.splitn(3, ' ').collect::<Vec<_>>()[..] {
            [claim, file, row] => (claim, file, row.replace("\\|", "|")), // as in a cell of a table
            _ => panic!("a verdict needs CLAIM FILE ROW, found {mark:?}"),
        };
        let (row, column) =
            row.split_once(" @ ").map_or((row.as_str(), None), |(row, column)| (row, Some(column)));
        let (header, rows) = table(folder, file);
        let begins =
            |cells: &&csv::StringRecord| cells.iter().collect::<Vec<_>>().join(" | ").starts_with(row);
        let found: Vec<&csv::StringRecord> = rows.iter().filter(begins).collect();
        assert!(found.len() == 1, "{file}: {} rows begin with {row:?}", found.len());
        let shown = shown(&header, found[0], column);
        if claim != shown.claim {
            wrong.push(format!(
                "{file}: {row}: the page says {claim}, the row {}: {}",
                shown.claim, shown.words
            ));
        }
        write!(new, "{before}{MARK}{mark} -->{}", shown.words).expect("in memory");
        rest = after.split_once(')').expect("a verdict ends with )").1;
    }
    new.push_str(rest);
    (with_tables(&new, folder), wrong)
}

/// The page with its tables of differences.
fn with_tables(page: &str, folder: &Path) -> String {
    let mut new = String::new();
    let mut lines = page.split_inclusive('\n').peekable();
    while let Some(line) = lines.next() {
        new.push_str(line);
        let Some(files) = line.strip_prefix(TABLE).and_then(|rest| rest.trim_end().strip_suffix(" -->"))
        else {
            continue;
        };
        while lines.next_if(|line| line.starts_with('|')).is_some() {}
        new.push_str(&differences(files, folder));
    }
    new
}

/// The table of what `NAME=FILE ...` compare with one policy.
fn differences(files: &str, folder: &Path) -> String {
    let files: Vec<(&str, &str)> =
        files.split(' ').map(|file| file.split_once('=').expect("NAME=FILE")).collect();
    let names: Vec<String> = files.iter().map(|(name, _)| name.replace('_', " ")).collect();
    let mut text = format!("| policy | {} |\n| --- |{}\n", names.join(" | "), " ---: |".repeat(files.len()));
    let tables: Vec<_> = files.iter().map(|(_, file)| table(folder, file)).collect();
    for row in &tables[0].1 {
        let policy = row[0].rsplit_once(" - ").expect("A - B").0;
        write!(text, "| {} |", policy.replace('|', "\\|")).expect("in memory");
        for (header, rows) in &tables {
            let one = rows.iter().find(|one| one[0] == row[0]).map(|one| shown(header, one, None));
            let cell = one.map_or("-".to_owned(), |one| match one.claim.as_str() {
                "above" | "below" => format!("**{}**", one.words),
                _ => one.words,
            });
            write!(text, " {cell} |").expect("in memory");
        }
        text.push('\n');
    }
    text
}
