//! The dictionary of a sweep's tables, for people (`columns.md`) and for programs (`datapackage.json`, a
//! Frictionless Data Package): each column with its type, unit and meaning, as it is declared.

use std::fmt::Write;

use exports::parquet::Kind;
use serde_json::{Value, json};

use super::column::About;
use super::rows;
use super::tables::{A_ROW_IS, all_columns, tables_of};
use crate::experiment::Experiment;

/// Names of the files: for people, and for programs.
pub(super) const DICTIONARY: [&str; 2] = ["columns.md", "datapackage.json"];

/// The dictionary of an experiment's tables: its files with their texts.
pub(super) fn dictionary(experiment: &Experiment) -> [(&'static str, String); 2] {
    let tables = tables(experiment);
    let package = format!("{:#}\n", package(experiment, &tables));
    [(DICTIONARY[0], markdown(experiment, &tables)), (DICTIONARY[1], package)]
}

/// `columns.md` of an experiment.
#[must_use]
pub fn columns_page(experiment: &Experiment) -> String {
    markdown(experiment, &tables(experiment))
}

/// A table: its file, the meaning of a row, and its columns.
type Described = (&'static str, &'static str, Vec<About>);

/// The tables of an experiment.
fn tables(experiment: &Experiment) -> Vec<Described> {
    let before = rows::before(&experiment.axes);
    let names = tables_of(experiment.keep, None).iter().zip(A_ROW_IS);
    let all = names.zip(all_columns(experiment));
    all.map(|((file, row), own)| (*file, row, before.iter().cloned().chain(own).collect())).collect()
}

/// The type of a column in a data package.
fn type_of(kind: Kind) -> &'static str {
    match kind {
        Kind::Natural => "integer",
        Kind::Number => "number",
        Kind::Truth => "boolean",
        Kind::Text => "string",
    }
}

fn markdown(experiment: &Experiment, tables: &[Described]) -> String {
    let mut text = format!(
        "# Tables of {}\n\nEmpty cells are values that are not defined. Energy and HP costs are in points: \
         percent of a robot's own maximum, unless the scenario counts otherwise (`costs.unit`).\n",
        experiment.name
    );
    for (file, row, columns) in tables {
        let _ = write!(
            text,
            "\n## {file}\n\nA row is {row}.\n\n| column | type | unit | meaning |\n| --- | --- | --- | --- \
             |\n"
        );
        for About { name, kind, unit, meaning } in columns {
            let cell = |text: &str| text.replace('|', "\\|");
            let _ = writeln!(text, "| `{}` | {} | {unit} | {} |", cell(name), type_of(*kind), cell(meaning));
        }
    }
    text
}

fn package(experiment: &Experiment, tables: &[Described]) -> Value {
    let field = |column: &About| {
        let mut field =
            json!({"name": column.name, "type": type_of(column.kind), "description": column.meaning});
        if !column.unit.is_empty() {
            field["unit"] = column.unit.into();
        }
        field
    };
    let resource = |(file, row, columns): &Described| {
        json!({
            "name": file.trim_end_matches(".csv"),
            "path": file,
            "title": format!("A row is {row}."),
            "format": "csv",
            "mediatype": "text/csv",
            "encoding": "utf-8",
            "schema": {"fields": columns.iter().map(field).collect::<Vec<_>>(), "missingValues": [""]},
        })
    };
    let name: String = experiment
        .name
        .chars()
        .map(|letter| {
            if letter.is_ascii_alphanumeric() || ".-_".contains(letter) {
                letter.to_ascii_lowercase()
            } else {
                '-'
            }
        })
        .collect();
    json!({
        "profile": "tabular-data-package",
        "name": name,
        "title": experiment.name,
        "description": experiment.base.description,
        "resources": tables.iter().map(resource).collect::<Vec<_>>(),
    })
}
