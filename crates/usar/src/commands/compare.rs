//! `usar compare`: paired comparisons of a sweep's policies.

use experiments::comparison::{
    Asked, CONFIDENCE, Comparison, Effect, Interaction, LEVEL, answer, answer_of_cases, compare, doubts,
    effects, interactions, limit_of_changes, limit_of_correction, own_question, test_in_words,
    what_would_settle,
};
use experiments::experiment::Experiment;
use experiments::sweep::host::Hosts;
use reports::table::{
    cases_table, comparison_table, differences_table, effects_table, interactions_table, verdict_table,
};
use serde_json::json;
use statistics::bootstrap::resamples;

use crate::arguments::{FamilyArguments, ShownArguments, WideArgument};
use crate::input::read_sweep;
use crate::prelude::*;

/// Is A better than B, by how much, and how sure is that?
#[derive(Debug, Args)]
#[command(after_help = "\
Says first what is shown, then, for each metric and pair of policies: the mean difference of trials paired \
by seed, its 95 % bootstrap interval, p of Wilcoxon's signed-rank test after Holm's correction over all \
comparisons shown, and a verdict. Many cases are a table of cases. --wide adds means, Hodges-Lehmann shift, \
effect size (matched-pairs rank-biserial), the least difference that this many pairs detect with 80 % \
power, with a margin how many pairs have this power for it, a sentence for each comparison, and for a sweep \
with axes how each policy's mean, and each difference, changes along an axis. With a margin, two policies \
are equivalent if the 90 % interval of their difference lies within it (two one-sided tests at 5 %). Choose \
metrics before looking: the correction knows only what is shown together. Where the sweep file asks another \
question, the answer says how its verdicts differ.

Examples:
  usar compare results/paper
  usar compare results/paper --wide
  usar compare results/paper --metric rescuees.hard --metric rescuees.easy --baseline DIS
  usar compare results/paper --metric rescuees --margin rescuees=3    equivalent within 3 rescuees?
  usar compare results/paper --metric all --json")]
pub(crate) struct Arguments {
    /// Folder of a sweep
    folder: PathBuf,
    #[command(flatten)]
    family: FamilyArguments,
    #[command(flatten)]
    shown: ShownArguments,
    #[command(flatten)]
    wide: WideArgument,
}

/// What was compared.
struct Compared<'a> {
    experiment: &'a Experiment,
    asked: &'a Asked,
    comparisons: Vec<Comparison>,
    effects: Vec<Effect>,
    interactions: Vec<Interaction>,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        let mut folder = read_sweep(&self.folder, registry)?;
        let doubts = doubts(&mut folder)?;
        let experiment = folder.experiment();
        let asked = &self.family.asked(experiment)?;
        let comparisons = compare(&folder, &asked.metrics, asked.choice())?;
        let own = own_question(&folder, asked, &comparisons)?;
        let compared = Compared {
            experiment,
            asked,
            comparisons,
            effects: effects(&folder, &asked.metrics, asked.choice())?,
            interactions: interactions(&folder, &asked.metrics, asked.choice())?,
        };
        if self.shown.is_json() {
            let output = json!({
                "sweep": experiment.name,
                "trials": experiment.trials,
                "is_complete": folder.manifest().is_complete,
                "confidence": CONFIDENCE,
                "level": LEVEL,
                "own_question": own,
                "doubts": doubts,
                "comparisons": compared.comparisons,
                "effects": compared.effects,
                "interactions": compared.interactions,
            });
            return print_json(&output);
        }
        compared.print_answer(out)?;
        if self.wide.is_wide() {
            compared.print_wide(out)?;
        } else {
            compared.print_narrow(out)?;
        }
        compared.print_notes(out)?;
        doubts.iter().try_for_each(|doubt| writeln!(out, "{doubt}"))?;
        if let Some(own) = own {
            writeln!(out, "{own}")?;
        }
        let rules = Hosts::read(folder.path()).rules;
        rules.iter().try_for_each(|rule| Ok(writeln!(out, "Pairs were added by a rule: {rule}")?))
    }
}

impl Compared<'_> {
    fn of_case(&self, case: usize) -> Vec<&Comparison> {
        self.comparisons.iter().filter(|one| one.case == case + 1).collect()
    }

    /// The answer, before any table: of the only case, or how many cases show what.
    fn print_answer(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let all: Vec<&Comparison> = self.comparisons.iter().collect();
        let said = if self.experiment.cases.len() == 1 { answer(&all) } else { answer_of_cases(&all) };
        said.map_or(Ok(()), |said| Ok(writeln!(out, "{said}\n")?))
    }

    /// Five columns a metric, or a table of cases.
    fn print_narrow(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let has_cases = self.experiment.cases.len() > 1;
        for metric in self.asked.metrics.iter().map(|metric| &self.experiment.metrics[*metric].name) {
            let here: Vec<&Comparison> =
                self.comparisons.iter().filter(|one| one.metric == *metric).collect();
            if here.is_empty() {
                self.print_means(out, metric)?;
            } else {
                writeln!(out, "{metric}")?;
                print_table(out, &if has_cases { cases_table(&here) } else { verdict_table(&here) })?;
            }
        }
        if has_cases && !self.comparisons.is_empty() {
            writeln!(out, "*: shown to differ; =: equivalent within the margin; others are undecided.")?;
            self.print_shown_changes(out)?;
        }
        Ok(())
    }

    /// The changes of differences that are shown, in sentences.
    fn print_shown_changes(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let shown: Vec<&Interaction> = self.interactions.iter().filter(|one| one.is_found()).collect();
        let (count, all) = (shown.len(), self.interactions.len());
        writeln!(out, "\nDifferences that are shown to change along an axis: {count} of {all} changes.")?;
        shown.iter().take(MOST_SENTENCES).try_for_each(|one| writeln!(out, "{}", one.in_words))?;
        if count > MOST_SENTENCES {
            writeln!(out, "{} more: --wide.", count - MOST_SENTENCES)?;
        }
        Ok(())
    }

    /// All columns, a sentence for each comparison, and all changes along axes.
    fn print_wide(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let cases = self.experiment.cases.iter().enumerate().filter(|_| !self.comparisons.is_empty());
        for (i, case) in cases {
            let place = self.experiment.describe(case);
            if !place.is_empty() {
                writeln!(out, "{}", place.trim_end_matches(": "))?;
            }
            print_table(out, &comparison_table(&self.of_case(i)))?;
        }
        self.comparisons.iter().try_for_each(|one| writeln!(out, "{}", one.in_words))?;
        if self.effects.is_empty() {
            return Ok(());
        }
        for metric in self.asked.metrics.iter().map(|metric| &self.experiment.metrics[*metric].name) {
            writeln!(out)?;
            self.print_means(out, metric)?;
            self.print_differences(out, metric)?;
        }
        writeln!(out, "{CHANGES_NOTE}")?;
        let counts = || self.effects.iter().map(|one| one.n);
        let (least, most) = (counts().min().unwrap_or(0), counts().max().unwrap_or(0));
        Ok(writeln!(out, "Pairs of each change: {least} to {most}")?)
    }

    /// The effects of the axes on each policy's mean.
    fn print_means(&self, out: &mut dyn Write, metric: &str) -> Result<(), Failure> {
        let effects: Vec<&Effect> = self.effects.iter().filter(|one| one.metric == metric).collect();
        writeln!(out, "By how much each policy's mean changes, in percent of what it was: {metric}")?;
        print_table(out, &effects_table(&effects))
    }

    /// The differences case by case, and their changes.
    fn print_differences(&self, out: &mut dyn Write, metric: &str) -> Result<(), Failure> {
        let here: Vec<&Comparison> = self.comparisons.iter().filter(|one| one.metric == metric).collect();
        if here.is_empty() {
            return Ok(());
        }
        writeln!(out, "\nDifferences between policies, case by case: {metric}")?;
        print_table(out, &differences_table(&here))?;
        writeln!(out, "\nBy how much these differences change: {metric}")?;
        let changes: Vec<&Interaction> =
            self.interactions.iter().filter(|one| one.metric == metric).collect();
        print_table(out, &interactions_table(&changes))
    }

    /// What everything stands on, and what limits it.
    fn print_notes(&self, out: &mut dyn Write) -> Result<(), Failure> {
        writeln!(out)?;
        let notes = [
            limit_of_correction(&self.comparisons),
            limit_of_changes(&self.effects, &self.interactions),
            what_would_settle(&self.comparisons),
            (!self.comparisons.is_empty()).then(|| footnote(&self.comparisons)),
            Some(self.asked.margins_in_words(self.experiment)).filter(|margins| !margins.is_empty()),
        ];
        notes.into_iter().flatten().try_for_each(|note| Ok(writeln!(out, "{note}")?))
    }
}

/// At most so many changes of differences are told in sentences.
const MOST_SENTENCES: usize = 6;

/// Note below the tables of changes.
const CHANGES_NOTE: &str = "\
Each change goes from the first value of one axis to another value, all else equal, and is paired by seed. In
brackets 95 % bootstrap intervals; *: shown after Holm's correction over all changes (of means, and of
differences), or over all comparisons";

/// What everything stands on.
fn footnote(comparisons: &[Comparison]) -> String {
    let family = comparisons.iter().filter(|c| c.p.is_some()).count();
    let ns = || comparisons.iter().map(|one| one.n);
    let (least, most) = (ns().min().unwrap_or(0), ns().max().unwrap_or(0));
    let n = if least == most { most.to_string() } else { format!("{least} to {most}") };
    let sum = |value: fn(&Comparison) -> usize| comparisons.iter().map(value).sum::<usize>();
    let left_out = [
        (
            sum(|c| c.repeated),
            "that repeat another to the last state (nothing is drawn there, so seeds do not matter)",
        ),
        (sum(|c| c.failed), "with a failed trial"),
        (sum(|c| c.missing), "with a missing one"),
        (sum(|c| c.undefined), "in which the metric is not defined (no rescuee)"),
    ];
    let left_out = left_out.iter().filter(|(count, _)| *count > 0);
    let left_out: Vec<String> = left_out.map(|(count, why)| format!("{count} {why}")).collect();
    let left_out = if left_out.is_empty() {
        String::new()
    } else {
        format!(" Pairs left out, over all comparisons: {}.", left_out.join(", "))
    };
    let resamples = comparisons.iter().map(|c| resamples(c.n)).min().unwrap_or(resamples(0));
    format!(
        "Paired by seed, n = {n}. Intervals: BCa bootstrap of the mean difference, widened for small n, \
         {resamples} resamples, fixed seed. p: Wilcoxon's signed-rank test, two-sided, {}, after Holm's \
         correction over {}.{left_out} docs/experiments.md explains each figure.",
        test_in_words(comparisons).trim_start_matches("p "),
        counted(family, "comparison")
    )
}
