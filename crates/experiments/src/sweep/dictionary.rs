//! The dictionary of a sweep's tables, for people (`columns.md`) and for programs (`datapackage.json`, a
//! Frictionless Data Package): each column with its type, unit and meaning. Metrics are described where
//! they are declared, the other columns here.

use std::fmt::Write;

use serde_json::{Value, json};

use super::links;
use super::tables::{TABLES, all_columns, tables_of};
use crate::experiment::{Axis, Experiment};
use crate::failure::Failure;

/// Names of the files: for people, and for programs.
pub(super) const DICTIONARY: [&str; 2] = ["columns.md", "datapackage.json"];

/// A column: its name, its type, its unit and its meaning.
struct Column {
    name: String,
    kind: &'static str,
    unit: &'static str,
    meaning: String,
}

/// The meaning of a row in each table.
const ROWS: [(&str, &str); TABLES.len()] = [
    (TABLES[0], "a trial"),
    (TABLES[1], "a task's group in a round of a trial"),
    (TABLES[2], "a robot in a trial"),
    (TABLES[3], "a robot when it was grouped, in a round of a trial, with its needs as they really were"),
    (TABLES[4], "a moment of a trial, every ten seconds"),
    (links::FILE, "a link of a trial's hash chain"),
];

/// Columns other than metrics: name, type, unit, meaning. If a name has another meaning in one table, an
/// entry `table/name` precedes it.
const DESCRIBED: &[(&str, &str, &str, &str)] = &[
    ("case", "integer", "", "Number of the case, from 1: a combination of the values of the axes."),
    ("method", "string", "", "The same as policy, under the name that the paper's authors use."),
    ("policy", "string", "", "Label of the policy in the sweep."),
    (
        "trial",
        "integer",
        "",
        "Number of the trial, from 1. Trials of the same number have the same seed, whatever the policy.",
    ),
    ("seed", "integer", "", "Seed of the trial: it decides everything that is drawn."),
    (
        "status",
        "string",
        "",
        "How the trial ended: completed, nobody_can_carry, errands_over, failed, panicked or timed_out.",
    ),
    (
        "state_hash",
        "string",
        "",
        "Hash of the whole course of the trial: equal hashes, equal trials, bit for bit.",
    ),
    ("failure", "string", "", "Why the trial gave no numbers; empty where it did."),
    ("replay", "string", "", "The command that runs a failed trial alone; empty for others."),
    ("round", "integer", "", "Number of the round, from 1."),
    ("task", "string", "", "Name of the task."),
    ("start_s", "number", "s", "Simulated time when the round began."),
    (
        "end_s",
        "number",
        "s",
        "Simulated time when the group was home again; empty where the trial ended before.",
    ),
    (
        "members",
        "string",
        "",
        "Numbers of the robots in the group, with blanks between them; groups.csv has them one a row.",
    ),
    ("secured", "integer", "rescuees", "Rescuees that the group took on board in the round."),
    ("rescued", "integer", "rescuees", "Rescuees of the task that were delivered in the round."),
    ("rounds.csv/energy", "number", "points", "Energy that the group spent in the round."),
    ("rounds.csv/hp", "number", "points", "HP that the group lost in the round."),
    ("turned_back", "integer", "robots", "Members that left for a rest place in the round."),
    ("return_cause", "string", "", "Why the group went home; empty where it did not."),
    ("robot", "integer", "", "Number of the robot, from 0, in the order of the scenario's team."),
    ("role", "string", "", "Role of the robot."),
    ("groups.csv/energy", "number", "%", "Battery level when the robot was grouped."),
    ("groups.csv/hp", "number", "%", "Health level when the robot was grouped."),
    ("initial_energy", "number", "%", "Battery level when the trial began."),
    ("initial_hp", "number", "%", "Health level when the trial began."),
    ("final_energy", "number", "%", "Battery level when the trial was over."),
    ("final_hp", "number", "%", "Health level when the trial was over."),
    ("energy_spent", "number", "points", "Energy that the robot spent."),
    ("hp_lost", "number", "points", "HP that the robot lost."),
    ("robots.csv/distance_m", "number", "m", "Way that the robot travelled."),
    ("robots.csv/waiting_s", "number", "s", "Time in which the robot stood because of others."),
    (
        "robots.csv/longest_stall_s",
        "number",
        "s",
        "The longest time in which the robot had a goal and came no nearer to it.",
    ),
    ("stall_cause", "string", "", "What took the most of that time."),
    ("stall_waits_for", "integer", "", "The robot that it waited for then; empty for none."),
    ("robots.csv/stranded", "boolean", "", "Whether the robot ended with no energy."),
    ("robots.csv/disabled", "boolean", "", "Whether the robot ended with no HP."),
    ("time_s", "number", "s", "Simulated time."),
    ("step", "integer", "steps", "Number of the simulation step."),
    ("digest", "string", "", "Hash of everything up to this step, 32 hexadecimal digits."),
    (
        "parts",
        "string",
        "",
        "Hashes of the parts of the state, four hexadecimal digits each; docs/determinism.md lists the \
         parts.",
    ),
];

/// The dictionary of an experiment's tables: its files with their texts.
///
/// # Errors
/// None: it can be written to memory.
pub(super) fn dictionary(experiment: &Experiment) -> Result<[(&'static str, String); 2], Failure> {
    let tables = tables(experiment)?;
    let package = format!("{:#}\n", package(experiment, &tables));
    Ok([(DICTIONARY[0], markdown(experiment, &tables)), (DICTIONARY[1], package)])
}

/// `columns.md` of an experiment.
///
/// # Errors
/// The columns of its tables cannot be determined.
pub fn columns_page(experiment: &Experiment) -> Result<String, Failure> {
    Ok(markdown(experiment, &tables(experiment)?))
}

/// A table: its file, the meaning of a row, and its columns.
type Described = (&'static str, &'static str, Vec<Column>);

/// The tables of an experiment.
fn tables(experiment: &Experiment) -> Result<Vec<Described>, Failure> {
    let names = all_columns(experiment)?;
    let tables = ROWS.iter().zip(names).take(tables_of(experiment.keep, None).len());
    Ok(tables
        .map(|((file, row), names)| {
            let before = if experiment.axes.is_empty() { None } else { Some(described(file, "case")) };
            let axes = experiment.axes.iter().map(axis);
            let own = names.iter().map(|name| column(file, name, experiment));
            (*file, *row, before.into_iter().chain(axes).chain(own).collect())
        })
        .collect())
}

/// The column of an axis.
fn axis(axis: &Axis) -> Column {
    let are_numbers = axis.values.iter().all(|value| value.parse::<f64>().is_ok());
    let meaning = if axis.variants.is_empty() {
        "Value of this field of the scenario."
    } else {
        "Name of the variant."
    };
    Column {
        name: axis.path.clone(),
        kind: if are_numbers { "number" } else { "string" },
        unit: "",
        meaning: meaning.to_owned(),
    }
}

/// A column by its name: a metric of the trial, a need, or an entry of [`DESCRIBED`].
fn column(file: &str, name: &str, experiment: &Experiment) -> Column {
    let of_trials = [TABLES[0], TABLES[4]].contains(&file);
    if let Some(metric) = experiment.metrics.iter().find(|metric| of_trials && metric.column() == name) {
        let what = if metric.part().is_empty() || metric.is_total() {
            metric.meaning.to_owned()
        } else {
            format!("{} Of the task {:?} alone.", metric.meaning, metric.part())
        };
        let until = if file == TABLES[4] { " Up to this time." } else { "" };
        return Column { name: name.to_owned(), kind: "number", unit: metric.unit, meaning: what + until };
    }
    if let Some(need) = name.strip_prefix("need_").filter(|_| file == TABLES[3]) {
        let meaning = format!("The need {need:?} as it really was, in the units of the scenario.");
        return Column { name: name.to_owned(), kind: "number", unit: "", meaning };
    }
    described(file, name)
}

fn described(file: &str, name: &str) -> Column {
    let own = format!("{file}/{name}");
    let found =
        DESCRIBED.iter().find(|row| row.0 == own).or_else(|| DESCRIBED.iter().find(|row| row.0 == name));
    let (kind, unit, meaning) =
        found.map_or(("string", "", ""), |(_, kind, unit, meaning)| (*kind, *unit, *meaning));
    Column { name: name.to_owned(), kind, unit, meaning: meaning.to_owned() }
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
        for Column { name, kind, unit, meaning } in columns {
            let cell = |text: &str| text.replace('|', "\\|");
            let _ = writeln!(text, "| `{}` | {kind} | {unit} | {} |", cell(name), cell(meaning));
        }
    }
    text
}

fn package(experiment: &Experiment, tables: &[Described]) -> Value {
    let field = |column: &Column| {
        let mut field = json!({"name": column.name, "type": column.kind, "description": column.meaning});
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
