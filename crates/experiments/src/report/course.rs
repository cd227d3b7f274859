//! Figures of how missions went: rescuees over time, who was in which group, and the trust within the team.

use rne_core::{NeedDistribution, NeedVector, RelativeNeedsEntropy, relative_entropy};

use super::figure::{Figure, Panel, draw, heat_map, layout, line_panel, names, table};
use super::gather::Gathered;
use super::metrics::capitalised;
use crate::experiment::Experiment;
use crate::failure::Failure;
use crate::rounds::{KEYS, Likeness, Share, weights_of};
use crate::stats::Moments;
use crate::stats::paired::t_half_width;
use crate::sweep::series_times;

/// Rescuees over time, with a band.
pub(super) fn over_time(
    experiment: &Experiment,
    case: usize,
    gathered: &[Gathered],
) -> Result<Figure, Failure> {
    let times: Vec<f64> = series_times(experiment.cases[case].scenario.duration_s).collect();
    let names = names(experiment);
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for (part, title) in ["rescuees total", "rescuees hard", "rescuees easy"].into_iter().enumerate() {
        let mut lines = Vec::new();
        for (i, (policy, gathered)) in experiment.policies.iter().zip(gathered).enumerate() {
            let mut points = Vec::new();
            for (at, time) in times.iter().enumerate() {
                let values: Vec<f64> = gathered.delivered.iter().map(|trial| trial[at][part]).collect();
                let Some(mean) = Moments::of(&values).mean else { continue };
                let half = t_half_width(&values);
                points.push((*time, mean, half.unwrap_or(0.0)));
                rows.push(vec![
                    title.replace(' ', "."),
                    policy.label.clone(),
                    time.to_string(),
                    values.len().to_string(),
                    mean.to_string(),
                    half.map_or(String::new(), |half| half.to_string()),
                ]);
            }
            lines.push((i, names[i].as_str(), points));
        }
        panels.extend(line_panel(&lines, [title, "time (s)", "delivered"]));
    }
    let n = gathered.iter().map(|gathered| gathered.delivered.len()).min().unwrap_or(0);
    Ok(Figure {
        name: "rescuees-over-time".into(),
        title: "Rescuees over time".into(),
        caption: format!(
            "Mean delivered up to each time, with its 95 % t interval (band). n = {n} trials or more for each policy."
        ),
        svg: if panels.is_empty() { String::new() } else { draw(panels, 3, [420.0, 320.0]) },
        csv: table(&["metric", "policy", "time_s", "n", "mean", "half_width"], rows)?,
    })
}

/// In which share of the trials each robot is sent to the hard task, round by round.
pub(super) fn membership(experiment: &Experiment, gathered: &[Gathered]) -> Result<Figure, Failure> {
    let (mut panels, mut rows, mut least) = (Vec::new(), Vec::new(), u32::MAX);
    for ((policy, name), gathered) in experiment.policies.iter().zip(&names(experiment)).zip(gathered) {
        for ((round, robot), [hard, easy]) in &gathered.groups {
            let role = gathered.roles[*robot as usize].to_owned();
            rows.push(vec![
                policy.label.clone(),
                round.to_string(),
                robot.to_string(),
                role,
                hard.to_string(),
                easy.to_string(),
            ]);
        }
        // A round counts as far as each robot was grouped in some trial.
        let robots = gathered.roles.len() as u32;
        let count = |round, robot| gathered.groups.get(&(round, robot)).copied().unwrap_or([0, 0]);
        let is_full = |round: &u32| (0..robots).all(|robot| count(*round, robot) != [0, 0]);
        let rounds: Vec<u32> = (1..u32::MAX).take_while(is_full).collect();
        if rounds.is_empty() || robots == 0 {
            continue;
        }
        let share = |round: u32, robot: u32| {
            let [hard, easy] = count(round, robot);
            f64::from(hard) / f64::from(hard + easy)
        };
        least = rounds
            .iter()
            .flat_map(|round| (0..robots).map(|robot| count(*round, robot).iter().sum()))
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
            .with_y_categories(names.collect());
        panels.push(Panel { plots, layout });
    }
    Ok(Figure {
        name: "groups".into(),
        title: "Groups over rounds".into(),
        caption: format!(
            "Share of trials in which a robot was sent to the hard task, of those in which it was grouped (n = {} or more a cell). \
             Rounds that not every robot saw are in the table only.",
            if least == u32::MAX { 0 } else { least }
        ),
        svg: if panels.is_empty() { String::new() } else { draw(panels, 2, [520.0, 380.0]) },
        csv: table(&["policy", "round", "robot", "role", "hard", "easy"], rows)?,
    })
}

/// RNE from each robot to each other of its role, in the first round of the first trial.
pub(super) fn trust(
    experiment: &Experiment,
    case: usize,
    gathered: &[Gathered],
) -> Result<Option<Figure>, Failure> {
    let mut with_rounds =
        experiment.policies.iter().zip(gathered).filter(|(_, gathered)| !gathered.first_round.is_empty());
    let Some((policy, gathered)) = with_rounds.next() else { return Ok(None) };
    let team = &gathered.first_round;
    let options = &experiment.cases[case].scenario.rne;
    let weights = weights_of(team, options)?;
    let distribution = |robot: &crate::sweep::Grouped| {
        NeedDistribution::of_agent(&NeedVector::new(robot.needs.clone())?, &weights)
    };
    let distributions = team.iter().map(distribution).collect::<Result<Vec<_>, _>>().map_err(Failure::run)?;
    let rne =
        |i: usize, j: usize| relative_entropy(&distributions[i], &distributions[j]).map_err(Failure::run);
    let mut rows = Vec::new();
    for i in 0..team.len() {
        for j in 0..team.len() {
            let value = rne(i, j)?.nats().map_or("infinite".to_owned(), |nats| nats.to_string());
            rows.push(vec![team[i].robot.to_string(), team[j].robot.to_string(), value]);
        }
    }
    let mut panels = Vec::new();
    for role in ["Carrier", "Supplier", "Observer"] {
        let members: Vec<usize> =
            (0..team.len()).filter(|i| gathered.roles[team[*i].robot as usize] == role).collect();
        if members.len() < 2 {
            continue;
        }
        let mut data = Vec::new();
        for i in &members {
            let row =
                members.iter().map(|j| rne(*i, *j)).collect::<Result<Vec<RelativeNeedsEntropy>, _>>()?;
            data.push(
                row.iter().map(|rne| rne.nats().map_or(0.0, |nats| 1000.0 * nats)).collect::<Vec<f64>>(),
            );
        }
        let most = data.iter().flatten().copied().fold(0.0, f64::max);
        let plots = vec![heat_map(data, most)];
        let names: Vec<String> = members.iter().map(|i| team[*i].robot.to_string()).collect();
        let layout = layout(&plots, &format!("{}s", role.to_lowercase()))
            .with_x_categories(names.clone())
            .with_y_categories(names)
            .with_x_label("to robot")
            .with_y_label("from robot");
        panels.push(Panel { plots, layout });
    }
    Ok(Some(Figure {
        name: "trust".into(),
        title: "Relative Needs Entropy within each role".into(),
        caption: format!(
            "RNE from each robot to each other of its role when the first round of trial {} under {} was grouped, in thousandths of a nat; lower is \
             more trust. The weights are the scenario's. Between roles it is infinite wherever one lacks a need that the other has; the table \
             has all pairs. n = 1 trial.",
            gathered.first_trial, policy.label
        ),
        svg: if panels.is_empty() { String::new() } else { draw(panels, 3, [400.0, 360.0]) },
        csv: table(&["from", "to", "rne_nats"], rows)?,
    }))
}

/// In which share of the rounds each policy's split is the one that sorting gives.
pub(super) fn sorting(experiment: &Experiment, gathered: &[Gathered]) -> Result<Figure, Failure> {
    let (mut shares, mut rows, mut labels, mut n) =
        ([Vec::new(), Vec::new()], Vec::new(), Vec::new(), usize::MAX);
    let names = names(experiment);
    for ((policy, name), gathered) in experiment.policies.iter().zip(names).zip(gathered) {
        let rounds = gathered.likeness[0].rounds();
        if rounds == 0 {
            continue;
        }
        for (key, likeness) in KEYS.iter().zip(&gathered.likeness) {
            let cell = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
            let beside = |share: &Share| [cell(share.share()), cell(share.chance())];
            let first = [policy.label.clone(), key.name.to_owned(), rounds.to_string()];
            let shares = [&likeness.split, &likeness.carriers, &likeness.suppliers, &likeness.hard_is_higher];
            rows.push(first.into_iter().chain(shares.into_iter().flat_map(beside)).collect::<Vec<String>>());
        }
        let row = |share: fn(&Likeness) -> &Share| {
            gathered
                .likeness
                .iter()
                .map(|likeness| share(likeness).share().unwrap_or(0.0))
                .collect::<Vec<f64>>()
        };
        shares[0].push(row(|likeness| &likeness.split));
        shares[1].push(row(|likeness| &likeness.hard_is_higher));
        labels.push(name);
        n = n.min(rounds);
    }
    let titles = ["the split is that of sorting by", "the hard task's group has the higher mean"];
    let panel = |(data, title): (Vec<Vec<f64>>, &str)| {
        let plots = vec![heat_map(data, 1.0)];
        let layout = layout(&plots, title)
            .with_x_categories(KEYS.iter().map(|key| key.name.to_owned()).collect())
            .with_y_categories(labels.clone());
        Panel { plots, layout }
    };
    let is_empty = labels.is_empty();
    let panels: Vec<Panel> = shares.into_iter().zip(titles).map(panel).collect();
    Ok(Figure {
        name: "sorting".into(),
        title: "What the groups amount to".into(),
        caption: format!(
            "Shares of the rounds with two groups. Left: each role is split as sorting it would, whichever half takes which task (by \
             chance in the table). n = {n} rounds or more for each policy."
        ),
        svg: if is_empty { String::new() } else { draw(panels, 2, [520.0, 320.0]) },
        csv: table(
            &[
                "policy",
                "sorted_by",
                "rounds",
                "split",
                "split_by_chance",
                "carriers",
                "carriers_by_chance",
                "suppliers",
                "suppliers_by_chance",
                "hard_is_higher",
                "hard_is_higher_by_chance",
            ],
            rows,
        )?,
    })
}

/// The mean levels of the groups, round by round.
pub(super) fn levels(experiment: &Experiment, gathered: &[Gathered]) -> Result<Figure, Failure> {
    let names = names(experiment);
    let (mut panels, mut rows) = (Vec::new(), Vec::new());
    for (level, name) in ["energy", "HP"].into_iter().enumerate() {
        for (task, task_name) in ["hard", "easy"].into_iter().enumerate() {
            let mut lines = Vec::new();
            for (i, (policy, gathered)) in experiment.policies.iter().zip(gathered).enumerate() {
                let mut points = Vec::new();
                for ((round, _), trials) in gathered.levels.iter().filter(|((_, of), _)| *of == task) {
                    let values: Vec<f64> = trials.iter().map(|trial| trial[level]).collect();
                    let Some(mean) = Moments::of(&values).mean else { continue };
                    let half = t_half_width(&values);
                    rows.push(vec![
                        name.to_lowercase(),
                        task_name.into(),
                        policy.label.clone(),
                        round.to_string(),
                        values.len().to_string(),
                        mean.to_string(),
                        half.map_or(String::new(), |half| half.to_string()),
                    ]);
                    // Rounds that few trials reached say little and would stretch the axis.
                    if 2 * values.len() >= gathered.delivered.len() {
                        points.push((f64::from(*round), mean, half.unwrap_or(0.0)));
                    }
                }
                lines.push((i, names[i].as_str(), points));
            }
            let title = format!("{}, group of the {task_name} task", capitalised(name));
            panels.extend(line_panel(&lines, [&title, "round", "mean level (percent)"]));
        }
    }
    Ok(Figure {
        name: "levels".into(),
        title: "Levels of the groups".into(),
        caption: "Mean battery and health level of each group's robots when it was formed, with the 95 % t interval over trials (band), for rounds that \
                  half of the trials reached; the table has all rounds with their n."
            .into(),
        svg: if panels.is_empty() { String::new() } else { draw(panels, 2, [480.0, 300.0]) },
        csv: table(&["level", "task", "policy", "round", "n", "mean", "half_width"], rows)?,
    })
}
