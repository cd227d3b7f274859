//! The output of `usar oracle`.

use experiments::oracle::{Coverage, Evaluation, Objective, Outcome, Standing, Survey};
use reports::table::{Table, headed, right};
use rne_core::Assignment;
use serde_json::{Value, json};

use super::{Answer, Asked, coverage_in_words};
use crate::commands::fork::ids;
use crate::prelude::*;

pub(super) fn json(asked: &Asked, answers: &[Answer]) -> Result<(), Failure> {
    print_json(&json!({
        "scenario": asked.trial.scenario.name,
        "seed": asked.trial.seed,
        "base": asked.trial.spec.label,
        "round": asked.question.round,
        "time_s": asked.time_s,
        "metric": asked.objective.name(),
        "less_is_better": asked.objective.is_cost(),
        "answers": answers.iter().map(|answer| answer_json(asked, answer)).collect::<Vec<Value>>(),
    }))
}

/// The choices of the policies, and the played assignments, the best first.
fn answer_json(asked: &Asked, Answer { then, survey }: &Answer) -> Value {
    let objective = &asked.objective;
    let range = survey.range(objective);
    let choice = |(policy, choice): &(String, Assignment)| {
        let standing = survey.standing(objective, choice);
        json!({
            "policy": policy,
            "groups": choice.groups,
            "rank": standing.map(|standing| standing.rank),
            "value": standing.map(|standing| standing.value),
            "regret": standing.map(|standing| standing.regret),
        })
    };
    let ranked = |Evaluation { assignment, outcome }: &Evaluation| {
        let rank = survey.standing(objective, assignment).map(|standing| standing.rank);
        let value = objective.value(outcome);
        json!({"rank": rank, "value": value, "groups": assignment.groups, "outcome": outcome})
    };
    json!({
        // The policy that decides the rest of the trial; null for the end of the round.
        "then": then.as_ref().map(|then| &then.label),
        // Whether all assignments were played. If so, the best of them is the best that exists.
        "is_exact": survey.coverage == Coverage::All,
        "played": survey.evaluations.len(),
        "best": range.map(|[best, _]| best),
        "mean": survey.mean(objective),
        "worst": range.map(|[_, worst]| worst),
        "policies": asked.choices.iter().map(choice).collect::<Vec<Value>>(),
        "ranking": survey.ranked(objective).into_iter().map(ranked).collect::<Vec<Value>>(),
    })
}

pub(super) fn text(
    out: &mut dyn Write,
    asked: &Asked,
    answers: &[Answer],
    top: usize,
) -> Result<(), Failure> {
    writeln!(
        out,
        "{}, seed {}, round {} at {:.1} s; {} decided the rounds before",
        asked.trial.scenario.name,
        asked.trial.seed,
        asked.question.round,
        asked.time_s,
        asked.trial.spec.label
    )?;
    answers.iter().try_for_each(|answer| print_answer(out, asked, answer, top))
}

fn print_answer(out: &mut dyn Write, asked: &Asked, answer: &Answer, top: usize) -> Result<(), Failure> {
    let Answer { then, survey } = answer;
    let objective = &asked.objective;
    let end = then.as_ref().map_or("the end of the round".to_owned(), |then| {
        format!("the end of the trial, in which {} goes on", then.label)
    });
    writeln!(
        out,
        "played to {end}, and counted from {:.1} s on: {}",
        asked.time_s,
        coverage_in_words(survey)
    )?;
    let Some([best, worst]) = survey.range(objective) else {
        return Ok(writeln!(out, "{objective} is undefined for all of them")?);
    };
    let better = if objective.is_cost() { "less" } else { "more" };
    let mean = survey.mean(objective).unwrap_or(best);
    let [best, worst, mean] = [best, worst, mean].map(short);
    writeln!(out, "\n{objective}, {better} is better: best {best}, mean {mean}, worst {worst}")?;
    if best == worst {
        writeln!(
            out,
            "All of them come to the same, so that this metric tells nothing of the decision; --metric \
             rescue_rate or --then POLICY may."
        )?;
    }
    print_table(out, &ranking(asked, survey, top))?;
    print_table(out, &choices(asked, survey))?;
    Ok(())
}

/// A number for a table: whole, or with two decimals.
fn short(value: f64) -> String {
    if value.fract() == 0.0 { format!("{value:.0}") } else { format!("{value:.2}") }
}

fn ranking(asked: &Asked, survey: &Survey, top: usize) -> Table {
    let tasks = asked.question.tasks.iter().map(|task| format!("{} group", task.name));
    let header = ["rank", asked.objective.name(), "rescued", "energy", "time s"].map(str::to_owned);
    let mut table = headed(header.into_iter().chain(tasks).collect::<Vec<_>>());
    let ranked = survey.ranked(&asked.objective);
    let last = ranked.len().saturating_sub(1);
    for (place, found) in ranked.iter().enumerate().filter(|(place, _)| *place < top || *place == last) {
        let standing = survey.standing(&asked.objective, &found.assignment);
        let rank = standing.map_or(place + 1, |standing| standing.rank);
        let rank = if place == last && rank > 1 { format!("{rank} (the worst)") } else { rank.to_string() };
        let total = found.outcome.total();
        let value = asked.objective.value(&found.outcome).map_or("-".to_owned(), short);
        let cells = [
            rank,
            value,
            rescued(&found.outcome),
            format!("{:.1}", total.energy),
            format!("{:.1}", found.outcome.duration_s),
        ];
        let groups = found.assignment.groups.iter().map(|group| ids(group));
        table.add_row(cells.into_iter().chain(groups).map(|cell| right(&cell)));
    }
    table
}

/// The number of all rescuees, and in brackets the number for each task.
fn rescued(outcome: &Outcome) -> String {
    let each: Vec<String> = outcome.tasks.iter().map(|task| task.rescued.to_string()).collect();
    format!("{} ({})", outcome.total().rescued, each.join(" + "))
}

fn choices(asked: &Asked, survey: &Survey) -> Table {
    let header = ["policy", "rank", "regret", asked.objective.name()].map(str::to_owned);
    let tasks = asked.question.tasks.iter().map(|task| format!("{} group", task.name));
    let mut table = headed(header.into_iter().chain(tasks).collect::<Vec<_>>());
    let count = survey.evaluations.len();
    for (policy, choice) in &asked.choices {
        let cells = match survey.standing(&asked.objective, choice) {
            Some(Standing { rank, regret, value }) => {
                [format!("{rank} of {count}"), short(regret), short(value)]
            }
            None => ["-", "-", "-"].map(str::to_owned),
        };
        let groups = choice.groups.iter().map(|group| ids(group));
        let cells = std::iter::once(policy.clone()).chain(cells).chain(groups);
        table.add_row(cells.map(|cell| right(&cell)));
    }
    table
}

/// Writes all outcomes as CSV, one on each line, the best first.
pub(super) fn write_csv(path: &Path, asked: &Asked, answers: &[Answer]) -> Result<(), Failure> {
    let tasks: Vec<&str> = asked.question.tasks.iter().map(|task| task.name.as_str()).collect();
    let of_tasks = |what: &str| tasks.iter().map(|task| format!("{what}_{task}")).collect::<Vec<_>>();
    let mut header =
        ["then", "rank", asked.objective.name(), "duration_s", "is_cut"].map(str::to_owned).to_vec();
    for what in ["group", "rescued", "secured", "energy", "hp"] {
        header.extend(of_tasks(what));
    }
    header.extend(["energy_ungrouped", "hp_ungrouped"].map(str::to_owned));
    let mut rows = vec![header];
    for Answer { then, survey } in answers {
        for found in survey.ranked(&asked.objective) {
            let then = then.as_ref().map_or(String::new(), |then| then.label.clone());
            rows.push([vec![then], csv_row(found, survey, &asked.objective)].concat());
        }
    }
    Destination::new("--csv", path, true)?.write(&csv_of(rows)?)
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
