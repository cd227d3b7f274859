//! `report.html`, one file that opens from disk, and the figures in it with the numbers behind each.

pub mod claims;
mod course;
mod figure;
mod gather;
mod metrics;

use std::path::PathBuf;

use askama::Template;

use crate::comparison::{
    Choice, Comparison, compare, digits, limit_of_correction, short, short_p, test_in_words,
};
use crate::experiment::{Axis, Experiment, Seeds};
use crate::failure::Failure;
use crate::files::NewFile;
use crate::sweep::disk::{PLOTS, REPORT};
use crate::sweep::folder::Folder;
use figure::Figure;

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
    summary: Vec<Vec<String>>,
    comparisons: Vec<Row>,
    found: Vec<&'a str>,
    open: Vec<&'a str>,
    limit: Option<String>,
    test: String,
    family: usize,
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
    effect: String,
    needed: String,
    is_found: bool,
}

/// Writes the report of a sweep's case, numbered from 0, into its folder; returns where it is.
///
/// # Errors
/// The folder cannot be written to, or its journal cannot be read.
pub fn write(folder: &mut Folder, case: usize) -> Result<PathBuf, Failure> {
    let Experiment { policies, metrics, .. } = folder.experiment();
    let is_compared = policies.len() > 1;
    let all =
        if is_compared { compare(folder, &metrics.chosen(&[])?, Choice::default())? } else { Vec::new() };
    let here: Vec<&Comparison> = all.iter().filter(|comparison| comparison.case == case + 1).collect();
    let figures = figures(folder, case, &here)?;
    let page = page(folder, case, &here, &all, &figures).render().map_err(Failure::run)?;

    let path = folder.path().to_owned();
    let plots = path.join(PLOTS);
    let trouble = |error| Failure::storage(format!("cannot write to {}: {error}", plots.display()));
    std::fs::create_dir_all(&plots).map_err(trouble)?;
    for figure in &figures {
        NewFile::write(&plots, &format!("{}.svg", figure.name), figure.svg.as_bytes())?;
        NewFile::write(&plots, &format!("{}.csv", figure.name), figure.csv.as_bytes())?;
    }
    NewFile::write(&path, REPORT, page.as_bytes())?;
    Ok(path.join(REPORT))
}

fn figures(folder: &mut Folder, case: usize, comparisons: &[&Comparison]) -> Result<Vec<Figure>, Failure> {
    let gathered = gather::gather(folder, case)?;
    let experiment = folder.experiment();
    let mut figures = metrics::boxes(folder, case)?;
    figures.push(metrics::costs(folder, case)?);
    if !comparisons.is_empty() {
        figures.push(metrics::forest(experiment, comparisons)?);
    }
    figures.push(course::over_time(experiment, case, &gathered)?);
    figures.push(course::membership(experiment, case, &gathered)?);
    figures.push(course::levels(experiment, case, &gathered)?);
    figures.push(course::sorting(experiment, &gathered)?);
    figures.extend(course::trust(experiment, &gathered)?);
    figures.extend(metrics::axes(folder, case)?);
    figures.retain(|figure| !figure.svg.is_empty());
    Ok(figures)
}

fn page<'a>(
    folder: &'a Folder,
    case: usize,
    comparisons: &[&'a Comparison],
    all: &[Comparison],
    figures: &'a [Figure],
) -> Page<'a> {
    let (experiment, manifest) = (folder.experiment(), folder.manifest());
    let failed = folder.results().values().filter(|measured| measured.metrics.is_none()).count();
    let asked = experiment.keys(manifest.shard).count();
    let seeds = match &experiment.seeds {
        Seeds::From(first) => format!("{first} to {}", experiment.seed(experiment.trials)),
        Seeds::Listed(list) => format!("{list:?}"),
    };
    let facts = vec![
        (
            "program",
            format!("usar {}, commit {}, source {}", manifest.version, manifest.commit, manifest.source),
        ),
        ("trials", format!("{} for each case and policy, seeds {seeds}", experiment.trials)),
        ("policies", manifest.policies.join(", ")),
        ("checked", if manifest.is_checked { "every invariant at every step".into() } else { "no".into() }),
    ];
    let sentences = |is_found: bool| {
        let wanted = comparisons.iter().filter(|comparison| comparison.is_found() == is_found);
        wanted.map(|comparison| comparison.in_words.as_str()).collect()
    };
    let names = figure::names(experiment).into_iter();
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
        trials: experiment.trials,
        labels: experiment.policies.iter().map(|policy| policy.label.as_str()).collect(),
        summary: metrics::summary(folder, case),
        comparisons: comparisons.iter().map(|comparison| row(comparison)).collect(),
        found: sentences(true),
        open: sentences(false),
        limit: limit_of_correction(all),
        test: test_in_words(all),
        family: all.iter().filter(|comparison| comparison.p.is_some()).count(),
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
        p_holm: c.p_holm.map_or("-".to_owned(), short_p),
        effect: c.effect.map_or("-".to_owned(), |effect| format!("{effect:.2}")),
        needed: c.pairs_needed.map_or("-".to_owned(), |pairs| pairs.to_string()),
        is_found: c.is_found(),
    }
}
