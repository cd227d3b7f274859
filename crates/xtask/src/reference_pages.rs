//! Pages of the reference that are made from comments and constants: `docs/events.md` and
//! `docs/columns.md`.

use std::fmt::Write;
use std::path::PathBuf;

use experiments::experiment::{Experiment, Overrides};
use experiments::sweep::columns_page;
use serde_json::Value;
use usar_sim::event::event_schema;

use crate::docs::{on_a_line, place};

const EVENTS: &str = "\
# Events: what can happen in a trial

`usar run FILE --events FILE.jsonl` writes every event of a trial as a line of JSON: `time_s`, `step`, `event`
(its name), `says` (it in a sentence), and the fields of its kind. The tables of `usar export` and the topic
`/events` of an MCAP log have the same. Robots, rescuees, debris and radiation zones have numbers from 0;
`task` is a row of the scenario's table of tasks.

The comments of the type are the source of this page: `cargo run --bin xtask -- reference` makes it.

| event | what | fields |
| --- | --- | --- |
";

const COLUMNS: &str = "\
# Columns: metrics, and the tables of sweeps and recordings

The tables in the folder of `usar sweep scenarios/paper.ron`. A sweep's own `columns.md` has its tasks, \
needs and
axes. The name of a metric on the command line has a dot before the task: the column `rescuees_hard` is
`rescuees.hard`. [Experiments](experiments.md#what-is-in-the-folder) has the other files of the folder.
The tables that `usar export --to NAME.csv` writes of a trial, NAME-robots.csv and so on, are \
[below](#recordings-robotscsv).

The program is the source of this page: `cargo run --bin xtask -- reference` makes it.
";

const MORE: &str = "
## More of trials.csv, where robots report and decide

| column | type | unit | meaning |
| --- | --- | --- | --- |
";

/// The pages, each with its path and its text.
pub fn pages() -> [(PathBuf, String); 2] {
    [(place("docs/events.md"), events()), (place("docs/columns.md"), columns())]
}

/// The columns of the paper's sweep and of recordings of its trials.
fn columns() -> String {
    let file = place("scenarios/paper.ron");
    let load = |settings: &[&str]| {
        let set = settings.iter().map(|setting| (*setting).to_owned()).collect();
        let overrides = Overrides { set, ..Overrides::default() };
        Experiment::load(&file, &overrides, &policies::standard()).expect("the paper's sweep is sound")
    };
    let experiment = load(&[]);
    let page = columns_page(&experiment);
    let (_, sweep) = page.split_once("\n\n").expect("a title");
    let talking = columns_page(&load(&["reports=()", "medium=()", "mission.decides=Robots()"]));
    let of_trials = talking.split("\n## ").find(|section| section.starts_with("trials.csv"));
    let more =
        of_trials.unwrap_or_default().lines().filter(|row| row.starts_with("| `") && !page.contains(row));
    let of_recordings = recording::Table::ALL.map(|table| {
        let file = format!("Recordings: {}.csv", table.name());
        tables::section(&file, table.row_is(), &table.columns(&experiment.base.needs))
    });
    let more: Vec<String> = more.map(|row| format!("{row}\n")).collect();
    format!("{COLUMNS}\n{sweep}{MORE}{}{}", more.concat(), of_recordings.concat())
}

/// The kinds of events, with their comments.
fn events() -> String {
    let schema = event_schema();
    let mut page = EVENTS.to_owned();
    for variant in schema["oneOf"].as_array().into_iter().flatten() {
        // A kind with fields is an object with one property: its name.
        let name = variant["const"].as_str().or(variant["required"][0].as_str()).unwrap_or_default();
        let inside = &variant["properties"][name];
        let required = inside["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let mut fields: Vec<&str> = required.collect();
        // Fields that may be absent come last.
        let all = inside["properties"].as_object().into_iter().flatten().map(|(name, _)| name.as_str());
        fields.extend(all.filter(|name| !fields.contains(name)).collect::<Vec<_>>());
        let field = |field| format!("`{field}`: {}", plain(&comment(&inside["properties"][field])));
        let fields: Vec<String> = fields.into_iter().map(field).collect();
        let _ = writeln!(page, "| `{}` | {} | {} |", snake(name), comment(variant), fields.join("; "));
    }
    page
}

fn comment(schema: &Value) -> String {
    on_a_line(schema["description"].as_str().unwrap_or_default())
}

/// A comment as part of a sentence.
fn plain(comment: &str) -> String {
    let text = comment.trim_end_matches('.');
    let mut letters = text.chars();
    let first = letters.next();
    if letters.clone().next().is_none_or(char::is_uppercase) {
        return text.to_owned(); // it begins with an abbreviation
    }
    first.into_iter().flat_map(char::to_lowercase).chain(letters).collect()
}

/// The name of a variant as it appears in files.
fn snake(name: &str) -> String {
    let mut out = String::new();
    for (at, letter) in name.char_indices() {
        if letter.is_uppercase() && at > 0 {
            out.push('_');
        }
        out.extend(letter.to_lowercase());
    }
    out
}
