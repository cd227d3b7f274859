//! A sweep as one long table with a row for each measured value. Every row names the policy, trial, round,
//! task and metric of its value, so that tools for data frames can filter, pivot and plot without the other
//! tables.

use store::Failure;

use super::folder::Folder;
use super::rows;
use crate::experiment::Place;
use crate::metric::Values;
use crate::run::Outcome;

/// The columns; the axes of the sweep follow the case.
pub fn tidy_columns(folder: &Folder) -> Vec<String> {
    let axes = folder.experiment().axes.iter().map(|axis| axis.path.as_str());
    let after = ["policy", "trial", "seed", "round", "task", "metric", "value"];
    ["case"].into_iter().chain(axes).chain(after).map(str::to_owned).collect()
}

/// Passes every row of the table to `write`, trial by trial: first the trial's metrics, with an empty
/// `round`, then the values of each group and round, if the sweep keeps them. `task` is empty for a value
/// of all tasks together. Undefined values have no row.
///
/// # Errors
/// The journal cannot be read; or the errors of `write`.
pub fn tidy_rows(
    folder: &mut Folder,
    mut write: impl FnMut(&[String]) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let places: Vec<Place> = folder.results().keys().copied().collect();
    for place in places {
        for [round, task, metric, value] in trial_rows(folder, place)? {
            let (case, policy, trial) = place;
            let experiment = folder.experiment();
            let mut row = vec![(case + 1).to_string()];
            row.extend(experiment.cases[case].values.iter().cloned());
            row.push(experiment.policies[policy].label.clone());
            row.extend([trial.to_string(), experiment.seed(trial).to_string(), round, task, metric, value]);
            write(&row)?;
        }
    }
    Ok(())
}

/// Round, task, metric and value of everything that was measured in a trial.
fn trial_rows(folder: &mut Folder, place: Place) -> Result<Vec<[String; 4]>, Failure> {
    let mut found = Vec::new();
    let experiment = folder.experiment();
    let measured = folder.results().get(&place).and_then(|measured| measured.metrics.as_ref());
    for (metric, value) in experiment.metrics.iter().zip(measured.into_iter().flat_map(Values::iter)) {
        let task = if metric.is_total() { "" } else { metric.part() };
        found.extend(
            value.map(|value| [String::new(), task.to_owned(), metric.declared_column(), value.to_string()]),
        );
    }
    if found.is_empty() || !experiment.keep.has_records() {
        return Ok(found);
    }
    let Outcome { key, result: Ok(trial) } = folder.outcome(place)? else { return Ok(found) };
    // Of the columns of a group, those of which a measure makes sense: not the times of its round's ends.
    let columns = rows::rounds().into_iter().filter(|column| !["", "s"].contains(&column.about.unit));
    let columns: Vec<_> = columns.collect();
    let rounds = trial.record.rounds.iter().map(|round| (&trial.record, round));
    for (round, row) in trial.record.rounds.iter().zip(rows::of(&key, rounds)) {
        let task = &trial.record.tasks[round.task.index()].task;
        let duration = round.end_s.map(|end| ("duration_s", end - round.start_s));
        let measured =
            columns.iter().filter_map(|column| Some((&*column.about.name, column.read(&row).number()?)));
        for (name, value) in duration.into_iter().chain(measured) {
            found.push([round.round.to_string(), task.clone(), name.to_owned(), value.to_string()]);
        }
    }
    Ok(found)
}
