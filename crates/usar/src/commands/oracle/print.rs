//! The output of `usar oracle`.

use experiments::oracle::{Evaluation, Objective, Outcome, Standing, Survey};
use teaming::Assignment;

use super::{Answer, Asked, coverage_in_words};
use crate::commands::fork::{group, ids};
use crate::prelude::*;

pub(super) fn text(asked: &Asked, answers: &[Answer], top: usize) -> Report {
    let mut out = Report::from(format!(
        "{}, seed {}, round {} at {:.1} s; {} decided the rounds before",
        asked.trial.scenario.name,
        asked.trial.seed,
        asked.question.round,
        asked.time_s,
        asked.trial.spec.label
    ));
    answers.iter().for_each(|answer| tell_answer(&mut out, asked, answer, top));
    out
}

fn tell_answer(out: &mut Report, asked: &Asked, Answer { then, survey }: &Answer, top: usize) {
    let objective = &asked.objective;
    let end = then.as_ref().map_or("the end of the round".to_owned(), |then| {
        format!("the end of the trial, in which {} goes on", then.label)
    });
    let coverage = coverage_in_words(survey);
    out.say(format!("played to {end}, and counted from {:.1} s on: {coverage}", asked.time_s));
    let Some([best, worst]) = survey.range(objective) else {
        return out.say(format!("{objective} is undefined for all of them"));
    };
    let better = if objective.is_cost() { "less" } else { "more" };
    let mean = survey.mean(objective).unwrap_or(best);
    let [best, worst, mean] = [best, worst, mean].map(short);
    out.say(format!("\n{objective}, {better} is better: best {best}, mean {mean}, worst {worst}"));
    if best == worst {
        out.say(
            "All of them come to the same, so that this metric tells nothing of the decision; --metric \
             rescue_rate or --then POLICY may.",
        );
    }
    let of = then.as_ref().map_or(String::new(), |then| format!(", then {}", then.label));
    out.show(format!("ranking{of}"), ranking(asked, survey, top));
    out.show(format!("policies{of}"), choices(asked, survey));
}

/// A number for a table: whole, or with two decimals.
fn short(value: f64) -> String {
    if value.fract() == 0.0 { format!("{value:.0}") } else { format!("{value:.2}") }
}

/// A table with these columns and the group of each task; everything is aligned on the right.
fn grouped<'a, const N: usize>(
    asked: &Asked,
    columns: [&str; N],
    rows: impl Iterator<Item = ([Entry; N], &'a Assignment)>,
) -> Table {
    let tasks = asked.question.tasks.iter().map(|task| format!("{} group", task.name));
    let row = |(cells, choice): ([Entry; N], &'a Assignment)| {
        cells.into_iter().chain(choice.groups.iter().map(|ids| group(ids)))
    };
    Table::of(columns.map(str::to_owned).into_iter().chain(tasks), rows.map(row))
}

fn ranking(asked: &Asked, survey: &Survey, top: usize) -> Table {
    let ranked = survey.ranked(&asked.objective);
    let last = ranked.len().saturating_sub(1);
    let row = |place: usize, found: &Evaluation| {
        let standing = survey.standing(&asked.objective, &found.assignment);
        let rank = standing.map_or(place + 1, |standing| standing.rank);
        let worst = if place == last && rank > 1 { " (the worst)" } else { "" };
        let outcome = &found.outcome;
        let value = right_or_dash(asked.objective.value(outcome), short);
        let tenths = |value: f64| valued(value, format!("{value:.1}"));
        let (energy, time) = (tenths(outcome.total().energy), tenths(outcome.duration_s));
        [valued(rank, format!("{rank}{worst}")), value, rescued(outcome), energy, time]
    };
    let shown = ranked.iter().enumerate().filter(|(place, _)| *place < top || *place == last);
    let columns = ["rank", asked.objective.name(), "rescued", "energy", "time s"];
    grouped(asked, columns, shown.map(|(place, found)| (row(place, found), &found.assignment)))
}

/// The number of all rescuees, and in brackets the number for each task.
fn rescued(outcome: &Outcome) -> Entry {
    let each: Vec<u32> = outcome.tasks.iter().map(|task| task.rescued).collect();
    let words = each.iter().map(u32::to_string).collect::<Vec<_>>().join(" + ");
    valued(each, format!("{} ({words})", outcome.total().rescued))
}

fn choices(asked: &Asked, survey: &Survey) -> Table {
    let count = survey.evaluations.len();
    let row = |(policy, choice): &(String, Assignment)| match survey.standing(&asked.objective, choice) {
        Some(Standing { rank, regret, value }) => {
            let rank = valued(rank, format!("{rank} of {count}"));
            [right(policy), rank, valued(regret, short(regret)), valued(value, short(value))]
        }
        None => [policy, "-", "-", "-"].map(right),
    };
    let columns = ["policy", "rank", "regret", asked.objective.name()];
    grouped(asked, columns, asked.choices.iter().map(|choice| (row(choice), &choice.1)))
}

/// Writes all outcomes as CSV, one on each line, the best first.
pub(super) fn write_csv(path: &Path, asked: &Asked, answers: &[Answer]) -> Result<(), Failure> {
    let tasks: Vec<&str> = asked.question.tasks.iter().map(|task| task.name.as_str()).collect();
    let of_tasks = |what: &str| tasks.iter().map(|task| format!("{what}_{task}")).collect::<Vec<_>>();
    let before = ["then", "rank", asked.objective.name(), "duration_s", "is_cut"].map(str::to_owned);
    let each = ["group", "rescued", "secured", "energy", "hp"].into_iter().flat_map(of_tasks);
    let after = ["energy_ungrouped", "hp_ungrouped"].map(str::to_owned);
    let header = before.into_iter().chain(each).chain(after);
    let mut rows = Vec::new();
    for Answer { then, survey } in answers {
        for found in survey.ranked(&asked.objective) {
            let then = then.as_ref().map_or(String::new(), |then| then.label.clone());
            rows.push([vec![then], csv_row(found, survey, &asked.objective)].concat());
        }
    }
    Destination::new("--csv", path, true)?.write(tables::csv(header, rows)?.as_bytes())
}

fn csv_row(found: &Evaluation, survey: &Survey, objective: &Objective) -> Vec<String> {
    let Evaluation { assignment, outcome } = found;
    let standing = survey.standing(objective, assignment);
    let rank = standing.map_or(String::new(), |standing| standing.rank.to_string());
    let value = objective.value(outcome).map_or(String::new(), |value| value.to_string());
    let mut row = vec![rank, value, outcome.duration_s.to_string(), outcome.is_cut.to_string()];
    row.extend(assignment.groups.iter().map(|group| ids(group)));
    row.extend(outcome.tasks.iter().map(|task| task.rescued.to_string()));
    row.extend(outcome.tasks.iter().map(|task| task.secured.to_string()));
    row.extend(outcome.tasks.iter().map(|task| task.energy.to_string()));
    row.extend(outcome.tasks.iter().map(|task| task.hp.to_string()));
    row.extend(outcome.ungrouped.map(|points| points.to_string()));
    row
}
