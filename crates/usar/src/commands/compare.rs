//! `usar compare`: paired comparisons of a sweep's policies.

use experiments::comparison::{
    CONFIDENCE, Comparison, Effect, Interaction, LEVEL, compare, effects, interactions, limit_of_changes,
    limit_of_correction, test_in_words,
};
use experiments::metric::Metric;
use experiments::stats::bootstrap::resamples;
use experiments::sweep::host::Hosts;
use reports::table::{comparison_table, differences_table, effects_table, interactions_table};
use serde_json::json;

use crate::arguments::{FamilyArguments, ShownArguments};
use crate::input::read_sweep;
use crate::prelude::*;

/// Is A better than B, by how much, and how sure is that?
#[derive(Debug, Args)]
#[command(after_help = "\
Trials are paired by seed. For each metric (`all` takes every one) and pair of policies: mean of each, mean \
difference with its 95 % bootstrap interval, Hodges-Lehmann shift, Wilcoxon's signed-rank test, its p after \
Holm's correction over all comparisons shown, effect size (matched-pairs rank-biserial), the least \
difference that this many pairs detect with 80 % power, with a margin how many pairs have this power for \
it, and one sentence. For a sweep with axes, also how each policy's mean, and each difference, changes \
along an axis, paired by seed. With a margin, two policies are equivalent if the 90 % interval of their \
difference lies within it (two one-sided tests at 5 %). Choose metrics before looking: the correction knows \
only what is shown together.

Examples:
  usar compare results/paper
  usar compare results/paper --metric rescuees.hard --metric rescuees.easy --baseline DIS
  usar compare results/paper --policies RNE,ENG
  usar compare results/paper --metric rescuees --margin rescuees=3    equivalent within 3 rescuees?
  usar compare results/paper --metric all --json")]
pub(crate) struct Arguments {
    /// Folder of a sweep
    folder: PathBuf,
    #[command(flatten)]
    family: FamilyArguments,
    #[command(flatten)]
    shown: ShownArguments,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let folder = read_sweep(&self.folder, registry)?;
        let experiment = folder.experiment();
        let asked = self.family.asked(experiment)?;
        let comparisons = compare(&folder, &asked.metrics, asked.choice())?;
        let effects = effects(&folder, &asked.metrics, asked.choice())?;
        let interactions = interactions(&folder, &asked.metrics, asked.choice())?;
        if self.shown.is_json() {
            let output = json!({
                "sweep": experiment.name,
                "trials": experiment.trials,
                "is_complete": folder.manifest().is_complete,
                "confidence": CONFIDENCE,
                "level": LEVEL,
                "comparisons": comparisons,
                "effects": effects,
                "interactions": interactions,
            });
            return print_json(&output);
        }
        let cases = experiment.cases.iter().enumerate().filter(|_| !comparisons.is_empty());
        for (i, case) in cases {
            let place = experiment.describe(case);
            if !place.is_empty() {
                writeln!(out, "{}", place.trim_end_matches(": "))?;
            }
            let here: Vec<&Comparison> = comparisons.iter().filter(|c| c.case == i + 1).collect();
            print_table(out, &comparison_table(&here))?;
        }
        for comparison in &comparisons {
            writeln!(out, "{}", comparison.in_words)?;
        }
        if !effects.is_empty() {
            for metric in &asked.metrics {
                print_changes(out, &experiment.metrics[*metric], &comparisons, &effects, &interactions)?;
            }
            writeln!(out, "{CHANGES_NOTE}")?;
            let counts = || effects.iter().map(|one| one.n);
            let (least, most) = (counts().min().unwrap_or(0), counts().max().unwrap_or(0));
            writeln!(out, "Pairs of each change: {least} to {most}")?;
        }
        if let Some(limit) = limit_of_correction(&comparisons) {
            writeln!(out, "\n{limit}")?;
        }
        if let Some(limit) = limit_of_changes(&effects, &interactions) {
            writeln!(out, "\n{limit}")?;
        }
        if !comparisons.is_empty() {
            writeln!(out, "\n{}", footnote(&comparisons))?;
            let margins = asked.margins_in_words(experiment);
            if !margins.is_empty() {
                writeln!(out, "{margins}")?;
            }
            let rules = Hosts::read(folder.path()).rules;
            rules.iter().try_for_each(|rule| writeln!(out, "Pairs were added by a rule: {rule}"))?;
        }
        Ok(())
    }
}

/// Note below the tables of [`print_changes`].
const CHANGES_NOTE: &str = "\
Each change goes from the first value of one axis to another value, all else equal, and is paired by seed. In
brackets 95 % bootstrap intervals; *: shown after Holm's correction over all changes (of means, and of
differences), or over all comparisons";

/// Prints the effects of the axes on one metric: each policy's mean, the differences case by case, and
/// their changes.
fn print_changes(
    out: &mut dyn Write,
    metric: &Metric,
    comparisons: &[Comparison],
    effects: &[Effect],
    interactions: &[Interaction],
) -> Result<(), Failure> {
    let Metric { name, title, .. } = metric;
    let effects: Vec<&Effect> = effects.iter().filter(|one| one.metric == *name).collect();
    let interactions: Vec<&Interaction> = interactions.iter().filter(|one| one.metric == *name).collect();
    let comparisons: Vec<&Comparison> = comparisons.iter().filter(|one| one.metric == *name).collect();
    writeln!(out, "\nBy how much each policy's mean changes, in percent of what it was: {title}")?;
    print_table(out, &effects_table(&effects))?;
    if comparisons.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nDifferences between policies, case by case: {title}")?;
    print_table(out, &differences_table(&comparisons))?;
    writeln!(out, "\nBy how much these differences change: {title}")?;
    print_table(out, &interactions_table(&interactions))
}

fn footnote(comparisons: &[Comparison]) -> String {
    let count = comparisons.iter().filter(|c| c.p.is_some()).count();
    let sum = |value: fn(&Comparison) -> usize| comparisons.iter().map(value).sum::<usize>();
    let (failed, missing, undefined) = (sum(|c| c.failed), sum(|c| c.missing), sum(|c| c.undefined));
    let drawn_from = comparisons.iter().map(|c| resamples(c.n));
    let least = drawn_from.min().unwrap_or(resamples(0));
    let drawn = test_in_words(comparisons);
    format!(
        "Paired by seed. Interval: BCa bootstrap of the mean difference, widened for small n, {least} \
         resamples, fixed seed. {drawn}; two-sided;\n\
         Holm's correction over the {} above. Pairs left out, over all comparisons: \
         {failed} with a failed trial, {missing} with\n\
         a missing one, {undefined} in which the metric is not defined (no rescuee). docs/experiments.md \
         explains each figure.",
        counted(count, "comparison")
    )
}
