//! Figures of how policies group: the trust within each role, and how similar their splits are to sorting.

use experiments::Failure;
use experiments::experiment::Experiment;
use experiments::rounds::{KEYS, Share, SortingAgreement};

use super::distrust::{distrust_panel, largest};
use super::gather::Gathered;
use crate::drawing::{Drawing, Panel, Sketch, from_top, heat_map, is_drawn, layout, names};

/// The distrust of each robot towards every other of its role, in the first round of a trial, by the measure
/// of the policy that decided. All roles have one scale.
pub(super) fn trust(experiment: &Experiment, gathered: &[Gathered]) -> Result<Option<Sketch>, Failure> {
    let mut with_rounds = experiment.policies.iter().zip(gathered);
    let first = with_rounds
        .find_map(|(policy, gathered)| Some((policy, gathered.first_question.as_ref()?, gathered)));
    let Some((policy, question, gathered)) = first else { return Ok(None) };
    let Some(measure) = policy.measure(&experiment.registry) else { return Ok(None) };
    let Ok(trust) = measure.it.of_team(question) else { return Ok(None) };
    let (team, name, unit) = (&question.members, &measure.label, measure.it.unit());
    let towards = |i: usize, j: usize| trust.towards(&[team[i].id], &[team[j].id]).map_err(Failure::run);
    let mut rows = Vec::new();
    for i in 0..team.len() {
        for j in 0..team.len() {
            let value = towards(i, j)?;
            let value = if value.is_finite() { value.to_string() } else { "infinite".to_owned() };
            rows.push(vec![team[i].id.to_string(), team[j].id.to_string(), value]);
        }
    }
    let mut roles = Vec::new();
    for role in question.role_ids() {
        let members: Vec<usize> = (0..team.len()).filter(|i| team[*i].role == role).collect();
        let row = |i: &usize| members.iter().map(|j| towards(*i, *j)).collect::<Result<Vec<_>, _>>();
        let data = members.iter().map(row).collect::<Result<Vec<Vec<f64>>, _>>()?;
        let names: Vec<String> = members.iter().map(|i| team[*i].id.to_string()).collect();
        if members.len() > 1 {
            roles.push((format!("{}s", question.roles[role.index()]), names, data));
        }
    }
    let most = roles.iter().map(|(.., data)| largest(data)).fold(0.0, f64::max);
    let panels = roles.iter().map(|(title, names, data)| distrust_panel(title, names, data, most)).collect();
    let column = format!("{}_{unit}", measure.name.to_lowercase());
    Ok(Some(Sketch {
        name: "trust".into(),
        title: format!("{name} within each role"),
        caption: format!(
            "{name} from each robot to each other of its role when the first round of trial {} under {} was \
             grouped, in thousandths of its unit ({unit}); lower is more trust. It is infinite wherever one \
             robot does not trust the other at all, as where it lacks a need that the other has: such cells \
             have the darkest colour, beyond the scale, no cell of that role has its number, and the table \
             says so. The table has all pairs, those \
             between roles too. n = 1 trial.",
            gathered.first_trial, policy.label
        ),
        drawing: Drawing::new(panels, 3, [400.0, 360.0]),
        csv: tables::csv(["from", "to", &column], rows)?,
    }))
}

/// The share of the rounds in which each policy's split equals sorting.
pub(super) fn sorting(
    experiment: &Experiment,
    gathered: &[Gathered],
    only: Option<&[String]>,
) -> Result<Sketch, Failure> {
    let (mut shares, mut rows, mut labels, mut n) =
        ([Vec::new(), Vec::new()], Vec::new(), Vec::new(), usize::MAX);
    let mut roles_of_all: Vec<String> = Vec::new();
    let names = names(experiment);
    for ((policy, name), gathered) in experiment.policies.iter().zip(names).zip(gathered) {
        let rounds = gathered.agreement[0].rounds();
        if rounds == 0 || !is_drawn(only, &policy.label) {
            continue;
        }
        for (key, agreement) in KEYS.iter().zip(&gathered.agreement) {
            let cell = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
            let beside = |share: &Share| [cell(share.share()), cell(share.chance())];
            let first = [policy.label.clone(), key.name.to_owned(), rounds.to_string()];
            let roles = agreement.roles.iter().map(|role| &role.share);
            let shares = [&agreement.split].into_iter().chain(roles).chain([&agreement.harder_is_higher]);
            roles_of_all = agreement.roles.iter().map(|role| role.role.clone()).collect();
            rows.push(first.into_iter().chain(shares.flat_map(beside)).collect::<Vec<String>>());
        }
        let row = |share: fn(&SortingAgreement) -> &Share| {
            gathered
                .agreement
                .iter()
                .map(|agreement| share(agreement).share().unwrap_or(0.0))
                .collect::<Vec<f64>>()
        };
        shares[0].push(row(|agreement| &agreement.split));
        shares[1].push(row(|agreement| &agreement.harder_is_higher));
        labels.push(name);
        n = n.min(rounds);
    }
    let titles = ["the split is that of sorting by", "the harder task's group has the higher mean"];
    let panel = |(data, title): (Vec<Vec<f64>>, &str)| {
        let plots = vec![heat_map(data, 1.0)];
        let layout = layout(&plots, title)
            .with_x_categories(KEYS.iter().map(|key| key.name.to_owned()).collect())
            .with_y_categories(from_top(labels.iter().cloned()));
        Panel { metric: String::new(), plots, layout }
    };
    let is_empty = labels.is_empty();
    let panels: Vec<Panel> = shares.into_iter().zip(titles).map(panel).collect();
    let shares = ["split".to_owned()].into_iter().chain(roles_of_all).chain(["harder_is_higher".to_owned()]);
    let shares = shares.flat_map(|share| [share.clone(), format!("{share}_by_chance")]);
    let columns: Vec<String> =
        ["policy", "sorted_by", "rounds"].map(str::to_owned).into_iter().chain(shares).collect();
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    Ok(Sketch {
        name: "sorting".into(),
        title: "What the groups amount to".into(),
        caption: format!(
            "Shares of the rounds with two groups. Left: each role is split as sorting it would, whichever \
             half takes which task (by chance in the table). n = {n} rounds or more for each policy."
        ),
        drawing: Drawing::new(if is_empty { Vec::new() } else { panels }, 2, [520.0, 320.0]),
        csv: tables::csv(&columns, rows)?,
    })
}
