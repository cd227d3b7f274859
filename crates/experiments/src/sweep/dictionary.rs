//! The dictionary of a sweep's tables, for people (`columns.md`) and for programs (`datapackage.json`, a
//! Frictionless Data Package): each column with its type, unit and meaning, as it is declared.

use serde_json::{Value, json};
use tables::{About, section};

use super::tables::{Described, described, tables_of};
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
pub fn columns_page(experiment: &Experiment) -> String {
    markdown(experiment, &tables(experiment))
}

/// The tables of an experiment.
fn tables(experiment: &Experiment) -> Vec<Described> {
    described(experiment).into_iter().take(tables_of(experiment.keep, None).len()).collect()
}

fn markdown(experiment: &Experiment, tables: &[Described]) -> String {
    let mut text = format!(
        "# Tables of {}\n\nEmpty cells are values that are not defined. Energy and HP costs are in points: \
         percent of a robot's own maximum, unless the scenario counts otherwise (`costs.unit`).\n",
        experiment.name
    );
    text.extend(tables.iter().map(|table| section(table.csv, table.row_is, &table.columns)));
    text
}

fn package(experiment: &Experiment, tables: &[Described]) -> Value {
    let field = |column: &About| {
        let mut field =
            json!({"name": column.name, "type": column.kind.name(), "description": column.meaning});
        if !column.unit.is_empty() {
            field["unit"] = column.unit.into();
        }
        field
    };
    let resource = |table: &Described| {
        json!({
            "name": table.csv.trim_end_matches(".csv"),
            "path": table.csv,
            "title": format!("A row is {}.", table.row_is),
            "format": "csv",
            "mediatype": "text/csv",
            "encoding": "utf-8",
            "schema": {"fields": table.columns.iter().map(field).collect::<Vec<_>>(), "missingValues": [""]},
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
