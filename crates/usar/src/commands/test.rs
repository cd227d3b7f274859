//! `usar test`: tests the expectations of sweep files with as few trials as needed.

use std::collections::BTreeMap;
use std::sync::Arc;

use experiments::comparison::{Trials, short};
use experiments::expect::{Expectation, Expected, Judgement, Verdict, expectations, judge, looks};
use experiments::experiment::{Experiment, Overrides};
use experiments::run::{Outcome, TrialKey, run_all};
use experiments::sweep::folder::{Measured, Results};
use quick_junit::{NonSuccessKind, TestCase, TestCaseStatus, TestSuite};
use serde::Serialize;

use crate::arguments::{JsonArgument, ProgressArguments, count};
use crate::library;
use crate::prelude::*;

/// Does the outcome meet what the sweep file expects of it?
#[derive(Debug, Args)]
#[command(after_help = "\
A sweep file says what is expected of its outcome:

  expect: [
      \"rescuees.total >= 60 in 90 % of seeds\",        the first policy of the sweep
      \"DIS: rounds >= 5 in 100 % of seeds\",           every seed: one against it decides
      \"rescuees.total: RNE > DIS by 5 (99 %)\",        mean difference over paired seeds
      \"rescuees.total: RNE = ENG within 3\",
  ]

Trials are added (20, 40, 80, ...) until every expectation holds or fails at its confidence (95 % where none \
is named). The expectations, cases and looks of a file share the error that the confidence allows. A mean \
difference needs 8 differences or more other than the commonest one; policies that are the same in all \
trials are told to be. The exit status is 0 if all hold, and 1 otherwise. docs/experiments.md says how \
often verdicts are wrong.

Examples:
  usar test scenarios/paper.ron
  usar test scenarios/*.sweep.ron --max-trials 400 --junit results.xml")]
pub(crate) struct Arguments {
    /// Sweep files, or scenarios with a sweep file beside them
    #[arg(required = true, value_name = "FILE", value_parser = library::path)]
    files: Vec<PathBuf>,
    /// Most trials of each policy and case
    #[arg(long, default_value_t = 200, value_parser = count(1..=1_000_000))]
    max_trials: u32,
    #[command(flatten)]
    progress: ProgressArguments,
    /// Write the results to this file in the XML of `JUnit`
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Simulate even if it takes very long: more bodies x steps than docs/limits.md has
    #[arg(long, hide_short_help = true)]
    allow_expensive: bool,
    #[command(flatten)]
    json: JsonArgument,
}

/// An expectation of a case, with its judgement.
#[derive(Serialize)]
struct Tested {
    file: String,
    sweep: String,
    /// The case's values of the axes; empty without axes.
    case: String,
    expectation: String,
    confidence: f64,
    #[serde(flatten)]
    judgement: Judgement,
    /// Why a trial has no numbers, if there is such a trial; the expectation then fails.
    trouble: Option<String>,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let mut suites = Vec::new();
        for file in &self.files {
            let suite = Suite::load(file, self.max_trials, registry)?;
            suite.experiment.check(self.allow_expensive)?;
            suites.push(suite);
        }
        let (mut tested, mut out) = (Vec::new(), Report::default());
        for suite in suites {
            let found = suite.test(&self.progress)?;
            out.extend(found.iter().map(in_words));
            out.rows("expectations", &found)?;
            if !self.json.json {
                std::mem::take(&mut out).print()?;
            }
            tested.extend(found);
        }
        if let Some(path) = &self.junit {
            write_junit(path, &tested)?;
        }
        let wanting = tested.iter().filter(|tested| tested.judgement.verdict != Verdict::Holds).count();
        out.print()?;
        if wanting > 0 {
            return Err(Failure::run(format!("{wanting} of {} expectations do not hold", tested.len())));
        }
        Ok(Report::default())
    }
}

/// A sweep and its expectations.
struct Suite {
    file: String,
    experiment: Arc<Experiment>,
    expected: Vec<Expected>,
    /// The trials so far.
    results: Results,
}

impl Suite {
    fn load(file: &Path, most: u32, registry: &Registry) -> Result<Self, Failure> {
        let experiment = Experiment::load(file, &Overrides::default(), registry)?;
        let expected = expectations(&experiment, file)?;
        if expected.is_empty() {
            refuse!("{}: expects nothing: its sweep file has no `expect`", file.display());
        }
        let experiment = experiment.with_trials(most.min(experiment.most_trials()))?;
        experiment.check_start(file)?;
        Ok(Self {
            file: file.display().to_string(),
            experiment: Arc::new(experiment),
            expected,
            results: Results::new(),
        })
    }

    /// Runs trials until every expectation is decided in every case, or no trials are left.
    fn test(mut self, progress: &ProgressArguments) -> Result<Vec<Tested>, Failure> {
        let looks = looks(self.experiment.trials);
        let with_interval = self.expected.iter().filter(|expected| expected.what.has_interval()).count();
        let intervals = looks.len() * self.experiment.cases.len() * with_interval;
        let mut open: Vec<(usize, usize)> = (0..self.experiment.cases.len())
            .flat_map(|case| (0..self.expected.len()).map(move |place| (case, place)))
            .collect();
        let mut tested = BTreeMap::new();
        for look in &looks {
            self.run_up_to(*look, &open, progress)?;
            open.retain(|(case, place)| {
                let found = self.judge(*case, *place, *look, intervals);
                let is_open = matches!(found.judgement.verdict, Verdict::Undecided | Verdict::Same);
                tested.insert((*case, *place), found);
                is_open
            });
            if open.is_empty() {
                break;
            }
        }
        Ok(tested.into_values().collect())
    }

    /// The policies to which an expectation refers.
    fn policies(&self, place: usize) -> Vec<usize> {
        match self.expected[place].what {
            Expectation::Share { policy, .. } => vec![policy],
            Expectation::Above { policies, .. } | Expectation::Equal { policies, .. } => policies.to_vec(),
        }
    }

    fn run_up_to(
        &mut self,
        trials: u32,
        open: &[(usize, usize)],
        progress: &ProgressArguments,
    ) -> Result<(), Failure> {
        let needed = |case, policy| {
            open.iter().any(|(c, place)| *c == case && self.policies(*place).contains(&policy))
        };
        let is_missing = |key: &TrialKey| {
            let place = (key.case, key.policy, key.trial);
            key.trial <= trials && !self.results.contains_key(&place) && needed(key.case, key.policy)
        };
        let mut keys: Vec<TrialKey> = self.experiment.keys(None).filter(is_missing).collect();
        // Sorted by seed, so that policies that decide alike share their trials.
        keys.sort_by_key(|key| (key.case, key.trial, key.policy));
        if keys.is_empty() {
            return Ok(());
        }
        let bar = progress.bar(keys.len(), "trials");
        let shared = Arc::clone(&self.experiment);
        let run = Arc::new(move |key: &_, sessions: &mut _, halt: &_| shared.run(key, sessions, halt));
        let is_whole = run_all(keys, progress.limits(None), run, &STOP, |outcome: Outcome| {
            let measured = Measured::of(&outcome, &self.experiment.metrics);
            self.results.insert((outcome.key.case, outcome.key.policy, outcome.key.trial), measured);
            bar.inc(1);
            Ok(())
        })?;
        bar.finish_and_clear();
        if is_whole { Ok(()) } else { Err(Failure::Interrupted("stopped".to_owned())) }
    }

    fn judge(&self, case: usize, place: usize, trials: u32, intervals: usize) -> Tested {
        let expected = &self.expected[place];
        let of =
            |policy: usize| (1..=trials).filter_map(move |trial| self.results.get(&(case, policy, trial)));
        let trouble = self.policies(place).into_iter().flat_map(of).find_map(|one| one.failure.clone());
        let trouble = trouble.map(String::from);
        let looked_at = Trials::new(&self.experiment.metrics, &self.results, 1..=trials);
        let mut judgement = judge(expected, &looked_at, case, intervals, trials == self.experiment.trials);
        if trouble.is_some() {
            judgement.verdict = Verdict::Fails;
        }
        Tested {
            file: self.file.clone(),
            sweep: self.experiment.name.clone(),
            case: self.experiment.describe(&self.experiment.cases[case]).trim_end_matches(": ").to_owned(),
            expectation: expected.text.clone(),
            confidence: expected.confidence,
            judgement,
            trouble,
        }
    }
}

fn verdict_name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Holds => "holds",
        Verdict::Fails => "FAILS",
        Verdict::Same => "THE SAME",
        Verdict::Undecided => "UNDECIDED",
    }
}

/// The observation, in words.
fn observed(tested: &Tested) -> String {
    let Judgement { n, observed, interval, needs, .. } = &tested.judgement;
    let value = observed.map_or("nothing".to_owned(), short);
    let range =
        interval.map_or(String::new(), |[low, high]| format!(", interval {} to {}", short(low), short(high)));
    let trouble = tested.trouble.as_ref().map_or(String::new(), |trouble| format!("; {trouble}"));
    let needs = needs.as_ref().map_or(String::new(), |needs| format!("; {needs}"));
    format!("observed {value}{range}, n = {n}{needs}{trouble}")
}

fn in_words(tested: &Tested) -> String {
    let case = if tested.case.is_empty() { String::new() } else { format!(" [{}]", tested.case) };
    let verdict = verdict_name(tested.judgement.verdict);
    format!("{verdict:<9} {}{case}: {} ({})", tested.file, tested.expectation, observed(tested))
}

fn write_junit(path: &Path, tested: &[Tested]) -> Result<(), Failure> {
    let mut report = quick_junit::Report::new("usar test");
    for suite_of in tested.chunk_by(|a, b| a.file == b.file) {
        let mut suite = TestSuite::new(suite_of[0].file.clone());
        for one in suite_of {
            let mut status = match one.judgement.verdict {
                Verdict::Holds => TestCaseStatus::success(),
                _ => TestCaseStatus::non_success(NonSuccessKind::Failure),
            };
            if one.judgement.verdict != Verdict::Holds {
                status.set_message(format!("{}: {}", verdict_name(one.judgement.verdict), observed(one)));
            }
            let mut case = TestCase::new(one.expectation.clone(), status);
            case.set_classname(if one.case.is_empty() {
                one.sweep.clone()
            } else {
                format!("{} {}", one.sweep, one.case)
            });
            case.set_system_out(observed(one));
            suite.add_test_case(case);
        }
        report.add_test_suite(suite);
    }
    let text = report.to_string().map_err(Failure::run)?;
    Destination::new("--junit", path, true)?.write(text.as_bytes())
}
