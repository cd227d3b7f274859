//! `usar compare`: paired comparisons of a sweep's policies.

use experiments::comparison::{
    Asked, Comparison, Effect, Interaction, answer, answer_of_cases, compare, doubts, effects, interactions,
    limit_of_changes, limit_of_correction, own_question, test_in_words, what_is_the_same, what_would_settle,
};
use experiments::experiment::Experiment;
use experiments::sweep::host::Hosts;
use reports::table::{
    cases_table, comparison_table, differences_table, effects_table, interactions_table, verdict_table,
};
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
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
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
        let mut out = Report::default();
        out.rows("comparisons", &compared.comparisons)?;
        out.rows("effects", &compared.effects)?;
        out.rows("interactions", &compared.interactions)?;
        compared.tell_answer(&mut out);
        if self.wide.is_wide() {
            compared.tell_wide(&mut out);
        } else {
            compared.tell_narrow(&mut out);
        }
        compared.tell_notes(&mut out);
        out.extend(doubts);
        out.extend(own);
        out.extend(
            Hosts::read(folder.path()).rules.iter().map(|rule| format!("Pairs were added by a rule: {rule}")),
        );
        Ok(out)
    }
}

impl Compared<'_> {
    fn of_case(&self, case: usize) -> Vec<&Comparison> {
        self.comparisons.iter().filter(|one| one.case == case + 1).collect()
    }

    /// The answer, before any table: of the only case, or how many cases show what.
    fn tell_answer(&self, out: &mut Report) {
        let all: Vec<&Comparison> = self.comparisons.iter().collect();
        let said = if self.experiment.cases.len() == 1 { answer(&all) } else { answer_of_cases(&all) };
        out.extend(said.map(|said| format!("{said}\n")));
    }

    /// Five columns a metric, or a table of cases.
    fn tell_narrow(&self, out: &mut Report) {
        let has_cases = self.experiment.cases.len() > 1;
        for metric in self.asked.metrics.iter().map(|metric| &self.experiment.metrics[*metric].name) {
            let here: Vec<&Comparison> =
                self.comparisons.iter().filter(|one| one.metric == *metric).collect();
            if here.is_empty() {
                self.tell_means(out, metric);
            } else {
                out.say(metric);
                out.show("comparisons", if has_cases { cases_table(&here) } else { verdict_table(&here) });
            }
        }
        if has_cases && !self.comparisons.is_empty() {
            out.say("*: shown to differ; =: equivalent within the margin; others are undecided.");
            self.tell_shown_changes(out);
        }
    }

    /// The changes of differences that are shown, in sentences.
    fn tell_shown_changes(&self, out: &mut Report) {
        let shown: Vec<&Interaction> = self.interactions.iter().filter(|one| one.is_found()).collect();
        let (count, all) = (shown.len(), self.interactions.len());
        out.say(format!("\nDifferences that are shown to change along an axis: {count} of {all} changes."));
        out.extend(shown.iter().take(MOST_SENTENCES).map(|one| &one.in_words));
        if count > MOST_SENTENCES {
            out.say(format!("{} more: --wide.", count - MOST_SENTENCES));
        }
    }

    /// All columns, a sentence for each comparison, and all changes along axes.
    fn tell_wide(&self, out: &mut Report) {
        let cases = self.experiment.cases.iter().enumerate().filter(|_| !self.comparisons.is_empty());
        for (i, case) in cases {
            let place = self.experiment.describe(case);
            if !place.is_empty() {
                out.say(place.trim_end_matches(": "));
            }
            out.show("comparisons", comparison_table(&self.of_case(i)));
        }
        out.extend(self.comparisons.iter().map(|one| &one.in_words));
        if self.effects.is_empty() {
            return;
        }
        for metric in self.asked.metrics.iter().map(|metric| &self.experiment.metrics[*metric].name) {
            out.say("");
            self.tell_means(out, metric);
            self.tell_differences(out, metric);
        }
        out.say(CHANGES_NOTE);
        let counts = || self.effects.iter().map(|one| one.n);
        let (least, most) = (counts().min().unwrap_or(0), counts().max().unwrap_or(0));
        out.say(format!("Pairs of each change: {least} to {most}"));
    }

    /// The effects of the axes on each policy's mean.
    fn tell_means(&self, out: &mut Report, metric: &str) {
        let effects: Vec<&Effect> = self.effects.iter().filter(|one| one.metric == metric).collect();
        out.say(format!("By how much each policy's mean changes, in percent of what it was: {metric}"));
        out.show("effects", effects_table(&effects));
    }

    /// The differences case by case, and their changes.
    fn tell_differences(&self, out: &mut Report, metric: &str) {
        let here: Vec<&Comparison> = self.comparisons.iter().filter(|one| one.metric == metric).collect();
        if here.is_empty() {
            return;
        }
        out.say(format!("\nDifferences between policies, case by case: {metric}"));
        out.show("comparisons", differences_table(&here));
        out.say(format!("\nBy how much these differences change: {metric}"));
        let changes: Vec<&Interaction> =
            self.interactions.iter().filter(|one| one.metric == metric).collect();
        out.show("interactions", interactions_table(&changes));
    }

    /// What everything stands on, and what limits it.
    fn tell_notes(&self, out: &mut Report) {
        out.say("");
        let notes = [
            limit_of_correction(&self.comparisons),
            limit_of_changes(&self.effects, &self.interactions),
            what_is_the_same(&self.comparisons),
            what_would_settle(&self.comparisons),
            (!self.comparisons.is_empty()).then(|| footnote(&self.comparisons)),
            Some(self.asked.margins_in_words(self.experiment)).filter(|margins| !margins.is_empty()),
        ];
        out.extend(notes.into_iter().flatten());
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
