//! The first page of the report of a sweep with several cases: the answer of each case, and how differences
//! change from case to case.

use askama::Template;
use experiments::Failure;
use experiments::comparison::{
    Comparison, Effect, Interaction, answer, answer_of_cases, effects, interactions, limit_of_changes,
};
use experiments::metric::Metric;
use experiments::sweep::folder::Folder;
use experiments::sweep::names::{PLOTS, REPORT};
use experiments::sweep::owned::Report;

use crate::case::Compared;
use crate::drawing::Figure;
use crate::figures::along_axes;
use crate::table::{differences_table, effects_table};
use crate::wanted::Wanted;

#[derive(Template)]
#[template(path = "overview.html")]
struct Overview<'a> {
    title: &'a str,
    description: &'a str,
    counts: String,
    /// In how many cases what is shown.
    answer: Option<String>,
    /// How the question differs from the sweep file's, and what a reader must know of the trials.
    warnings: &'a [String],
    is_complete: bool,
    cases: Vec<Line>,
    /// Number of cases that have a page.
    pages: usize,
    /// The values of each metric, case by case.
    changes: Vec<Change<'a>>,
    /// Changes of differences that are statistically shown.
    found: Vec<&'a str>,
    /// Changes of differences that are not shown.
    open: Vec<&'a str>,
    /// That no change can be shown, where that is so.
    limit: Option<String>,
    figures: &'a [Figure],
}

/// The overview's line of a case.
struct Line {
    place: String,
    /// Link to its page, relative to the overview; empty for none.
    page: String,
    answer: Option<String>,
}

/// The texts of a table: its header and its rows.
type Lines = (Vec<String>, Vec<Vec<String>>);

/// The changes of one metric along the axes.
struct Change<'a> {
    metric: &'a str,
    means: Lines,
    differences: Lines,
}

impl<'a> Change<'a> {
    fn of(metric: &'a Metric, effects: &[Effect], comparisons: &[Comparison]) -> Self {
        let effects: Vec<&Effect> = effects.iter().filter(|one| one.metric == metric.name).collect();
        let comparisons: Vec<&Comparison> =
            comparisons.iter().filter(|one| one.metric == metric.name).collect();
        Self {
            metric: &metric.name,
            means: effects_table(&effects).lines(),
            differences: differences_table(&comparisons).lines(),
        }
    }
}

pub(crate) fn write_overview(
    folder: &Folder,
    wanted: &Wanted,
    all: &Compared,
    pages: &[usize],
    files: &mut Report,
) -> Result<(), Failure> {
    let (experiment, comparisons) = (folder.experiment(), &all.asked);
    let changes = if experiment.policies.len() > 1 {
        interactions(folder, &wanted.asked.metrics, wanted.asked.choice())?
    } else {
        Vec::new()
    };
    let sentences = |is_wanted: bool| -> Vec<&str> {
        let is_shown = |change: &&Interaction| change.is_found() == is_wanted;
        changes.iter().filter(is_shown).map(|change| change.in_words.as_str()).collect()
    };
    let effects = effects(folder, &wanted.asked.metrics, wanted.asked.choice())?;
    let asked = wanted.asked.metrics.iter().map(|metric| &experiment.metrics[*metric]);
    let alone = (experiment.policies.len() == 1).then_some("one policy: there is nothing to compare.");
    let line = |case: usize| {
        let here: Vec<&Comparison> =
            comparisons.iter().filter(|comparison| comparison.case == case + 1).collect();
        let page =
            if pages.contains(&case) { format!("{PLOTS}/case-{}.html", case + 1) } else { String::new() };
        Line {
            place: experiment.describe(&experiment.cases[case]).trim_end_matches(": ").to_owned(),
            page,
            answer: answer(&here).or_else(|| alone.map(str::to_owned)),
        }
    };
    let figures = along_axes(folder, comparisons)?;
    let failed = folder.results().values().filter(|measured| measured.metrics.is_none()).count();
    let overview = Overview {
        title: wanted.title.as_deref().unwrap_or(&experiment.name),
        description: &experiment.base.description,
        counts: format!(
            "{} cases, {} policies, {} paired trials of each were asked for: {} finished, {failed} failed.",
            experiment.cases.len(),
            experiment.policies.len(),
            experiment.trials,
            folder.results().len() - failed,
        ),
        answer: answer_of_cases(&comparisons.iter().collect::<Vec<_>>()),
        warnings: &all.warnings,
        is_complete: folder.manifest().is_complete,
        cases: (0..experiment.cases.len()).map(line).collect(),
        pages: pages.len(),
        changes: asked.map(|metric| Change::of(metric, &effects, comparisons)).collect(),
        found: sentences(true),
        open: sentences(false),
        limit: limit_of_changes(&effects, &changes),
        figures: &figures,
    };
    files.add(REPORT.to_owned(), &overview.render().map_err(Failure::run)?)?;
    figures.iter().try_for_each(|figure| figure.add_to(files, ""))
}
