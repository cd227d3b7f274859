//! Figures of the course of missions: rescuees over time, the members of each group, and the levels of the
//! groups.

use experiments::Failure;
use experiments::experiment::Experiment;
use experiments::metric::task_names;
use experiments::run::series_times;

use super::Part;
use super::band::Band;
use super::gather::Gathered;
use super::metrics::capitalised;
use crate::drawing::{Drawing, Panel, Sketch, from_top, heat_map, is_drawn, layout, line_panel, names};

/// Rescuees over time, with a band.
pub(super) fn over_time(
    experiment: &Experiment,
    gathered: &[Gathered],
    Part { case, only, .. }: Part,
) -> Result<Sketch, Failure> {
    let times: Vec<f64> = series_times(experiment.cases[case].scenario.duration_s).collect();
    let names = names(experiment);
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for (part, place) in experiment.metrics.declared("rescuees").into_iter().enumerate() {
        let metric = &experiment.metrics[place].name;
        let mut lines = Vec::new();
        for (i, (policy, gathered)) in experiment.policies.iter().zip(gathered).enumerate() {
            if !is_drawn(only, &policy.label) {
                continue;
            }
            let mut points = Vec::new();
            for (at, time) in times.iter().enumerate() {
                let values: Vec<f64> = gathered.delivered.iter().map(|trial| trial[at][part]).collect();
                let Some(band) = Band::of(&values) else { continue };
                points.push(band.at(*time));
                rows.push(band.row([metric, &policy.label, &time.to_string()]));
            }
            lines.push((i, names[i].as_str(), points));
        }
        panels.extend(line_panel(&lines, metric, metric, "time (s)", "delivered"));
    }
    let n = gathered.iter().map(|gathered| gathered.delivered.len()).min().unwrap_or(0);
    Ok(Sketch {
        name: "rescuees-over-time".into(),
        title: capitalised(&experiment.base.words.text("rescuees over time")),
        caption: format!(
            "Mean delivered up to each time, with its 95 % t interval (band). n = {n} trials or more for \
             each policy."
        ),
        drawing: Drawing::new(panels, 3, [420.0, 320.0]),
        csv: tables::csv(["metric", "policy", "time_s", "n", "mean", "half_width"], rows)?,
    })
}

/// The share of the trials in which each robot is sent to the hardest task, round by round.
pub(super) fn membership(
    experiment: &Experiment,
    gathered: &[Gathered],
    Part { case, only, .. }: Part,
) -> Result<Sketch, Failure> {
    let scenario = &experiment.cases[case].scenario;
    let hardest = scenario.hardest_first().first().map_or(0, |task| task.index());
    let task = scenario.tasks.get(hardest).map_or("", |task| &task.name);
    let (mut panels, mut rows, mut least) = (Vec::new(), Vec::new(), u32::MAX);
    for ((policy, name), gathered) in experiment.policies.iter().zip(&names(experiment)).zip(gathered) {
        if !is_drawn(only, &policy.label) {
            continue;
        }
        for ((round, robot), tasks) in &gathered.groups {
            let role = gathered.roles[*robot as usize].clone();
            let first = [policy.label.clone(), round.to_string(), robot.to_string(), role];
            rows.push(first.into_iter().chain(tasks.iter().map(u32::to_string)).collect::<Vec<String>>());
        }
        // The rounds before the first one in which some robot was not grouped in any trial.
        let robots = gathered.roles.len() as u32;
        let nothing = vec![0; scenario.tasks.len()];
        let count = |round, robot| gathered.groups.get(&(round, robot)).unwrap_or(&nothing);
        let grouped = |round, robot| count(round, robot).iter().sum::<u32>();
        let is_full = |round: &u32| (0..robots).all(|robot| grouped(*round, robot) > 0);
        let final_round = gathered.groups.keys().map(|(round, _)| *round).max().unwrap_or(0);
        let rounds: Vec<u32> = (1..=final_round).take_while(is_full).collect();
        if rounds.is_empty() {
            continue;
        }
        let share = |round: u32, robot: u32| {
            f64::from(count(round, robot)[hardest]) / f64::from(grouped(round, robot))
        };
        least = rounds
            .iter()
            .flat_map(|round| (0..robots).map(|robot| grouped(*round, robot)))
            .chain([least])
            .min()
            .unwrap_or(0);
        let data: Vec<Vec<f64>> =
            (0..robots).map(|robot| rounds.iter().map(|round| share(*round, robot)).collect()).collect();
        let plots = vec![heat_map(data, 1.0)];
        let names =
            gathered.roles.iter().enumerate().map(|(robot, role)| format!("{robot} {}", role.to_lowercase()));
        let layout = layout(&plots, name)
            .with_x_label("round")
            .with_x_categories(rounds.iter().map(u32::to_string).collect())
            .with_y_categories(from_top(names));
        panels.push(Panel { metric: String::new(), plots, layout });
    }
    let columns = ["policy", "round", "robot", "role"].into_iter();
    let columns: Vec<&str> = columns.chain(scenario.tasks.iter().map(|task| task.name.as_str())).collect();
    Ok(Sketch {
        name: "groups".into(),
        title: "Groups over rounds".into(),
        caption: format!(
            "Share of trials in which a robot was sent to task {task}, of those in which it was grouped (n = \
             {} or more a cell). Rounds that not every robot saw are in the table only.",
            if least == u32::MAX { 0 } else { least }
        ),
        drawing: Drawing::new(panels, 2, [520.0, 380.0]),
        csv: tables::csv(&columns, rows)?,
    })
}

/// The mean levels of the groups, round by round.
pub(super) fn levels(
    experiment: &Experiment,
    gathered: &[Gathered],
    Part { case, only, .. }: Part,
) -> Result<Sketch, Failure> {
    let tasks = task_names(&experiment.cases[case].scenario);
    let names = names(experiment);
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for (level, name) in ["energy", "HP"].into_iter().enumerate() {
        for (task, task_name) in tasks.iter().enumerate() {
            let mut lines = Vec::new();
            for (i, (policy, gathered)) in experiment.policies.iter().zip(gathered).enumerate() {
                if !is_drawn(only, &policy.label) {
                    continue;
                }
                let mut points = Vec::new();
                for ((round, _), trials) in gathered.levels.iter().filter(|((_, of), _)| *of == task) {
                    let values: Vec<f64> = trials.iter().map(|trial| trial[level]).collect();
                    let Some(band) = Band::of(&values) else { continue };
                    let place = [&name.to_lowercase(), task_name, &policy.label, &round.to_string()];
                    rows.push(band.row(place.map(String::as_str)));
                    // Rounds that few trials reached carry little information and would stretch the axis.
                    if 2 * values.len() >= gathered.delivered.len() {
                        points.push(band.at(f64::from(*round)));
                    }
                }
                lines.push((i, names[i].as_str(), points));
            }
            let title = format!("{}, group of the {task_name} task", capitalised(name));
            panels.extend(line_panel(&lines, "", &title, "round", "mean level (percent)"));
        }
    }
    Ok(Sketch {
        name: "levels".into(),
        title: "Levels of the groups".into(),
        caption: "Mean battery and health level of each group's robots when it was formed, with the 95 % t \
            interval over trials (band), for rounds that half of the trials reached; the table has all \
            rounds with their n."
            .into(),
        drawing: Drawing::new(panels, 2, [480.0, 300.0]),
        csv: tables::csv(["level", "task", "policy", "round", "n", "mean", "half_width"], rows)?,
    })
}
