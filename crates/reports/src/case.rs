//! The page of one case of a sweep, which opens from disk, with its figures and the numbers behind each
//! figure.

use askama::Template;
use experiments::Failure;
use experiments::comparison::{
    Comparison, Trials, Verdict, answer, digits, limit_of_correction, short, short_p, test_in_words,
};
use experiments::experiment::{Axis, Experiment, PolicySpec, Seeds};
use experiments::sweep::folder::Folder;
use experiments::sweep::host::Hosts;
use experiments::sweep::names::PLOTS;
use experiments::sweep::owned::Report;
use tables::or_dash;

use crate::decisions::{Decisions, decisions};
use crate::drawing::{self, Figure};
use crate::figures::{Part, figures, is_quiet};
use crate::maps::{Map, ShownTrial, trails_map, world_map};
use crate::table::{between, moments, shown};
use crate::wanted::Wanted;

#[derive(Template)]
#[template(path = "report.html")]
struct Page<'a> {
    title: &'a str,
    /// Path of the figures relative to the page, with the prefix of their names.
    links: String,
    description: &'a str,
    place: String,
    is_complete: bool,
    finished: usize,
    failed: usize,
    missing: usize,
    trials: u32,
    labels: Vec<&'a str>,
    /// Each policy's label, and what its kind does.
    policies: Vec<(&'a str, &'a str)>,
    /// The names that figures use for policies with too long labels, each with its label.
    abbreviations: Vec<(String, &'a str)>,
    /// What is shown, in a few words.
    answer: Option<String>,
    /// How the question differs from the sweep file's, and what a reader must know of the trials.
    warnings: &'a [String],
    /// Whether the sweep file names its metrics.
    is_declared: bool,
    /// Whether some comparison has a margin.
    has_margins: bool,
    /// The margins, and who named them.
    margins: String,
    summary: Vec<Vec<String>>,
    /// What the scenario calls a rescuee.
    rescuee: &'a str,
    decisions: Option<Decisions>,
    comparisons: Vec<Row>,
    exploratory: Vec<Row>,
    /// Names of the metrics of figures that are zero in every trial.
    quiet: Vec<&'a str>,
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
    p: String,
    p_holm: String,
    verdict: String,
    detectable: String,
    pairs: String,
    pairing: String,
    is_found: bool,
    /// Whether it is the first of its metric.
    is_first: bool,
}

/// The comparisons of a sweep: those that were asked for, and the others.
pub(crate) struct Compared {
    pub asked: Vec<Comparison>,
    pub exploratory: Vec<Comparison>,
    /// How the question differs from the sweep file's, and what a reader must know of the trials.
    pub warnings: Vec<String>,
}

/// A case's page: its place, the prefix of its figures' names, and the trials that it shows.
pub(crate) struct CasePage {
    pub case: usize,
    pub file: String,
    /// Relative to the page.
    pub links: String,
    /// Relative to the folder of figures.
    pub prefix: String,
    pub shown: Vec<ShownTrial>,
}

/// Writes the page of a case, its figures and its maps.
pub(crate) fn write_case(
    folder: &mut Folder,
    wanted: &Wanted,
    all: &Compared,
    wanted_page: CasePage,
    files: &mut Report,
) -> Result<(), Failure> {
    let CasePage { case, file, links, prefix, shown } = wanted_page;
    let of_case = |all: &'_ [Comparison]| -> Vec<Comparison> {
        all.iter().filter(|comparison| comparison.case == case + 1).cloned().collect()
    };
    let (here, exploratory) = (of_case(&all.asked), of_case(&all.exploratory));
    let here: Vec<&Comparison> = here.iter().collect();
    let seed = shown.first().map(|trial| trial.seed);
    let figures = figures(folder, Part { case, only: None, seed }, &here)?;
    let mut maps: Vec<Map> = world_map(folder.experiment(), case).into_iter().collect();
    for (number, trial) in shown.iter().enumerate() {
        let beside = links.strip_suffix(prefix.as_str()).unwrap_or(&links).trim_end_matches('/');
        maps.push(trails_map(number, trial, beside)?);
    }
    let decided = decisions(folder, case, seed)?;
    let mut page = page(folder, case, &here, &all.asked);
    (page.figures, page.maps) = (&figures, &maps);
    page.decisions = decided;
    page.answer = answer(&here);
    page.warnings = &all.warnings;
    page.is_declared = wanted.asked.is_declared;
    page.margins = wanted.asked.margins_in_words(folder.experiment());
    page.exploratory = exploratory.iter().map(row).collect();
    page.links = links;
    if let Some(title) = &wanted.title {
        page.title = title;
    }
    files.add(file, &page.render().map_err(Failure::run)?)?;
    figures.iter().try_for_each(|figure| figure.add_to(files, &prefix))?;
    for Map { name, svg, .. } in maps {
        files.add(format!("{PLOTS}/{prefix}{name}.svg"), &svg)?;
    }
    let mut replays = shown.into_iter().filter_map(|trial| trial.replay);
    replays.try_for_each(|(name, content)| files.add(format!("{PLOTS}/{name}"), &content))
}

fn page<'a>(folder: &'a Folder, case: usize, comparisons: &[&'a Comparison], all: &[Comparison]) -> Page<'a> {
    let (experiment, manifest) = (folder.experiment(), folder.manifest());
    let here = || folder.results().iter().filter(|((of, ..), _)| *of == case);
    let failed = here().filter(|(_, measured)| measured.metrics.is_none()).count();
    let asked = folder.trials_of(case) * experiment.policies.len();
    let seeds = match &experiment.seeds {
        Seeds::From(first) => format!("{first} to {}", experiment.seed(experiment.trials)),
        Seeds::Listed(list) => format!("{list:?}"),
    };
    let part = manifest.shard.map_or(String::new(), |_| format!(", dealt out: this is {}", manifest.part()));
    let mut facts = vec![
        ("program", format!("usar {}, bits {}, commit {}", manifest.version, manifest.bits, manifest.commit)),
        ("trials", format!("{} for each case and policy, seeds {seeds}{part}", experiment.trials)),
        ("policies", manifest.policies.join(", ")),
        ("invariants checked", if manifest.is_checked { "all, at every step".into() } else { "no".into() }),
    ];
    facts.extend(Hosts::read(folder.path()).rules.into_iter().map(|rule| ("stopping rule", rule)));
    let sentences = |is_open: bool| {
        let wanted = comparisons.iter().filter(|one| (one.verdict == Verdict::Undecided) == is_open);
        wanted.map(|comparison| comparison.in_words.as_str()).collect()
    };
    let names = drawing::names(experiment).into_iter();
    let pairs = names.zip(&experiment.policies).map(|(name, policy)| (name, policy.label.as_str()));
    Page {
        abbreviations: pairs.filter(|(name, label)| name != label).collect(),
        title: &experiment.name,
        links: String::new(),
        description: &experiment.base.description,
        place: experiment.describe(&experiment.cases[case]).trim_end_matches(": ").to_owned(),
        is_complete: manifest.is_complete,
        finished: here().count() - failed,
        failed,
        missing: asked.saturating_sub(here().count()),
        trials: folder.trials_of(case) as u32,
        labels: experiment.policies.iter().map(|policy| policy.label.as_str()).collect(),
        policies: experiment
            .policies
            .iter()
            .map(|spec| (spec.label.as_str(), about(spec, experiment)))
            .collect(),
        answer: None,
        warnings: &[],
        is_declared: false,
        has_margins: comparisons.iter().any(|comparison| comparison.judged.is_some()),
        margins: String::new(),
        summary: summary(folder, case),
        rescuee: &experiment.base.words.rescuee,
        decisions: None,
        comparisons: rows(comparisons),
        exploratory: Vec::new(),
        quiet: quiet(folder, case),
        found: sentences(false),
        open: sentences(true),
        limit: limit_of_correction(all),
        test: test_in_words(all),
        family: all.iter().filter(|comparison| comparison.p.is_some()).count(),
        maps: &[],
        figures: &[],
        axes: &experiment.axes,
        facts,
        command: command(folder),
        scenario: experiment.cases[case].scenario.resolved(),
    }
}

/// What a policy does, in the registry's words; empty for an unknown one.
fn about<'e>(spec: &PolicySpec, experiment: &'e Experiment) -> &'e str {
    let kinds = experiment.registry.kinds().iter();
    kinds.filter(|kind| kind.name == spec.name).map(|kind| kind.about.as_str()).next().unwrap_or_default()
}

/// Names of the metrics of figures that are zero in every trial of a case.
fn quiet(folder: &Folder, case: usize) -> Vec<&str> {
    let Experiment { metrics, .. } = folder.experiment();
    let places = metrics.figures().into_iter().flat_map(|(_, places)| places);
    places.filter(|place| is_quiet(folder, case, *place)).map(|place| metrics[place].name.as_str()).collect()
}

/// The commands that reproduce these results.
fn command(folder: &Folder) -> String {
    let check = if folder.manifest().is_checked { " --check" } else { "" };
    format!("usar sweep sweep.ron{check} --out again\nusar report again")
}

/// A row for each comparison, in groups of the same metric.
fn rows(comparisons: &[&Comparison]) -> Vec<Row> {
    let groups = comparisons.chunk_by(|a, b| a.metric == b.metric);
    let of_group = |group: &[&Comparison]| {
        let rows = group.iter().enumerate().map(|(i, one)| Row { is_first: i == 0, ..row(one) });
        rows.collect::<Vec<Row>>()
    };
    groups.flat_map(of_group).collect()
}

fn row(c: &Comparison) -> Row {
    let number = |value: Option<f64>| or_dash(value, short);
    let mean = |value: Option<f64>| or_dash(value, |value| digits(value, 4));
    let pairs = c.judged.and_then(|judged| judged.pairs_for_margin);
    Row {
        metric: if c.is_of_sums { format!("{} (ratio of sums)", c.metric) } else { c.metric.clone() },
        pair: format!("{} - {}", c.a, c.b),
        n: c.n,
        left_out: c.repeated + c.failed + c.missing + c.undefined,
        means: format!("{}, {}", mean(c.mean_a), mean(c.mean_b)),
        difference: number(c.difference),
        interval: between(c.interval),
        p: or_dash(c.p, short_p),
        verdict: c.verdict_in_words(),
        p_holm: or_dash(c.p_holm, short_p),
        detectable: number(c.detectable),
        pairs: or_dash(pairs, |pairs| pairs.to_string()),
        pairing: or_dash(c.pairing, |times| format!("{} x", digits(times, 2))),
        is_found: c.verdict.is_shown(),
        is_first: false,
    }
}

/// The table of policies as rows of text.
fn summary(folder: &Folder, case: usize) -> Vec<Vec<String>> {
    let policies = &folder.experiment().policies;
    let trials = folder.trials_of(case);
    let cell = |policy, metric| moments(&Trials::of(folder, case).moments(((case, policy), metric)), trials);
    shown(folder, case)
        .into_iter()
        .map(|(place, metric)| {
            std::iter::once(metric.name_with_unit())
                .chain((0..policies.len()).map(|policy| cell(policy, place)))
                .collect()
        })
        .collect()
}
