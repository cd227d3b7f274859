//! `report.html`, one file that opens from disk, and the figures in it with the numbers behind each.

use std::path::PathBuf;

use askama::Template;
use experiments::Failure;
use experiments::comparison::{
    Asked, Comparison, answer, compare, digits, limit_of_correction, short, short_p, test_in_words,
};
use experiments::experiment::{Axis, Experiment, Seeds};
use experiments::stats::Moments;
use experiments::sweep::disk::{PLOTS, REPORT};
use experiments::sweep::folder::Folder;
use experiments::sweep::ours;

use crate::decisions::{Decisions, decisions};
use crate::drawing::{self, Figure};
use crate::figures::figures;
use crate::maps::{Map, ShownTrial, trails_map, world_map};

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    name: &'a str,
    description: &'a str,
    place: String,
    is_complete: bool,
    finished: usize,
    failed: usize,
    missing: usize,
    trials: u32,
    labels: Vec<&'a str>,
    /// What figures call policies whose labels are too long for them, with these.
    abbreviations: Vec<(String, &'a str)>,
    /// The answer to the first question of the sweep.
    answer: Option<String>,
    /// Whether the sweep file names its metrics.
    is_declared: bool,
    summary: Vec<Vec<String>>,
    decisions: Option<Decisions>,
    comparisons: Vec<Row>,
    found: Vec<&'a str>,
    open: Vec<&'a str>,
    limit: Option<String>,
    test: String,
    family: usize,
    maps: &'a [Map],
    figures: &'a [Figure],
    axes: &'a [Axis],
    facts: Vec<(&'static str, String)>,
    command: String,
    scenario: String,
}

/// A comparison as text.
struct Row {
    metric: String,
    pair: String,
    n: usize,
    left_out: usize,
    means: String,
    difference: String,
    interval: String,
    shift: String,
    p: String,
    p_holm: String,
    verdict: String,
    effect: String,
    needed: String,
    is_found: bool,
}

/// Writes the report of a sweep's case, numbered from 0, into its folder; returns where it is. The ways of all robots in `shown` trials
/// are drawn, and their replays written beside the figures.
///
/// # Errors
/// The folder cannot be written to, or its journal cannot be read.
pub fn write_report(folder: &mut Folder, case: usize, shown: Vec<ShownTrial>) -> Result<PathBuf, Failure> {
    let asked = Asked::of(folder.experiment(), &[], None, &[])?;
    let is_compared = folder.experiment().policies.len() > 1;
    let all = if is_compared { compare(folder, &asked.metrics, asked.choice(None))? } else { Vec::new() };
    let here: Vec<&Comparison> = all.iter().filter(|comparison| comparison.case == case + 1).collect();
    let figures = figures(folder, case, &here)?;
    let mut maps: Vec<Map> = world_map(folder.experiment(), case).into_iter().collect();
    for (number, trial) in shown.iter().enumerate() {
        maps.push(trails_map(number, trial, PLOTS)?);
    }
    let drawn = (&figures[..], &maps[..]);
    let decided = decisions(folder, case)?;
    let mut page = page(folder, case, (&here, &all), drawn);
    page.decisions = decided;
    page.answer = asked.metrics.first().and_then(|metric| answer(folder, case, *metric, &here));
    page.is_declared = asked.is_declared;
    let page = page.render().map_err(Failure::run)?;

    let mut files = vec![(REPORT.to_owned(), page.into_bytes())];
    for Figure { name, svg, csv, .. } in figures {
        files.push((format!("{PLOTS}/{name}.svg"), svg.into_bytes()));
        files.push((format!("{PLOTS}/{name}.csv"), csv.into_bytes()));
    }
    for Map { name, svg, .. } in maps {
        files.push((format!("{PLOTS}/{name}.svg"), svg.into_bytes()));
    }
    let replays = shown.into_iter().filter_map(|trial| trial.replay);
    files.extend(replays.map(|(name, content)| (format!("{PLOTS}/{name}"), content)));
    ours::write_report(folder.path(), &files)?;
    Ok(folder.path().join(REPORT))
}

fn page<'a>(
    folder: &'a Folder,
    case: usize,
    (comparisons, all): (&[&'a Comparison], &[Comparison]),
    (figures, maps): (&'a [Figure], &'a [Map]),
) -> Page<'a> {
    let (experiment, manifest) = (folder.experiment(), folder.manifest());
    let failed = folder.results().values().filter(|measured| measured.metrics.is_none()).count();
    let asked = experiment.count(manifest.shard);
    let seeds = match &experiment.seeds {
        Seeds::From(first) => format!("{first} to {}", experiment.seed(experiment.trials)),
        Seeds::Listed(list) => format!("{list:?}"),
    };
    let part = manifest.shard.map_or(String::new(), |_| format!(", dealt out: this is {}", manifest.part()));
    let facts = vec![
        (
            "program",
            format!("usar {}, commit {}, source {}", manifest.version, manifest.commit, manifest.source),
        ),
        ("trials", format!("{} for each case and policy, seeds {seeds}{part}", experiment.trials)),
        ("policies", manifest.policies.join(", ")),
        ("checked", if manifest.is_checked { "every invariant at every step".into() } else { "no".into() }),
    ];
    let sentences = |is_found: bool| {
        let wanted = comparisons.iter().filter(|comparison| comparison.is_found() == is_found);
        wanted.map(|comparison| comparison.in_words.as_str()).collect()
    };
    let names = drawing::names(experiment).into_iter();
    let pairs = names.zip(&experiment.policies).map(|(name, policy)| (name, policy.label.as_str()));
    Page {
        abbreviations: pairs.filter(|(name, label)| name != label).collect(),
        name: &experiment.name,
        description: &experiment.base.description,
        place: experiment.describe(&experiment.cases[case]).trim_end_matches(": ").to_owned(),
        is_complete: manifest.is_complete,
        finished: folder.results().len() - failed,
        failed,
        missing: asked - folder.results().len().min(asked),
        trials: folder.trials_of(case) as u32,
        labels: experiment.policies.iter().map(|policy| policy.label.as_str()).collect(),
        answer: None,
        is_declared: false,
        summary: summary(folder, case),
        decisions: None,
        comparisons: comparisons.iter().map(|comparison| row(comparison)).collect(),
        found: sentences(true),
        open: sentences(false),
        limit: limit_of_correction(all),
        test: test_in_words(all),
        family: all.iter().filter(|comparison| comparison.p.is_some()).count(),
        maps,
        figures,
        axes: &experiment.axes,
        facts,
        command: command(folder),
        scenario: experiment.cases[case].scenario.resolved(),
    }
}

/// What makes these results again.
fn command(folder: &Folder) -> String {
    let check = if folder.manifest().is_checked { " --check" } else { "" };
    format!("usar sweep sweep.ron{check} --out again\nusar report again")
}

fn row(c: &Comparison) -> Row {
    let number = |value: Option<f64>| value.map_or("-".to_owned(), short);
    let mean = |value: Option<f64>| value.map_or("-".to_owned(), |value| digits(value, 4));
    Row {
        metric: c.metric.clone(),
        pair: format!("{} - {}", c.a, c.b),
        n: c.n,
        left_out: c.failed + c.missing + c.undefined,
        means: format!("{}, {}", mean(c.mean_a), mean(c.mean_b)),
        difference: number(c.difference),
        interval: c
            .interval
            .map_or("-".to_owned(), |[low, high]| format!("{} to {}", short(low), short(high))),
        shift: number(c.shift),
        p: c.p.map_or("-".to_owned(), short_p),
        verdict: c
            .judged
            .map_or(String::new(), |judged| format!("{} ({})", judged.verdict.name(), short(judged.margin))),
        p_holm: c.p_holm.map_or("-".to_owned(), short_p),
        effect: c.effect.map_or("-".to_owned(), |effect| format!("{effect:.2}")),
        needed: c.pairs_needed.map_or("-".to_owned(), |pairs| pairs.to_string()),
        is_found: c.is_found(),
    }
}

/// The table of policies as rows of text.
fn summary(folder: &Folder, case: usize) -> Vec<Vec<String>> {
    let Experiment { policies, metrics, .. } = folder.experiment();
    let cell = |policy: usize, metric: usize| {
        let values = folder.values(case, policy, metric);
        let moments = Moments::of(&values);
        let Some(mean) = moments.mean else { return "-".to_owned() };
        let sd = moments.sd.map_or(String::new(), |sd| format!(" ± {}", short(sd)));
        let partly = if values.len() < folder.trials_of(case) {
            format!(" (n = {})", values.len())
        } else {
            String::new()
        };
        format!("{}{sd}{partly}", digits(mean, 4))
    };
    let primary = metrics.iter().enumerate().filter(|(_, metric)| metric.is_primary);
    primary
        .map(|(place, metric)| {
            std::iter::once(metric.title_with_unit())
                .chain((0..policies.len()).map(|policy| cell(policy, place)))
                .collect()
        })
        .collect()
}
