//! `usar oracle`: plays every assignment of a round.

mod print;

use std::collections::BTreeSet;
use std::sync::Mutex;

use experiments::experiment::{PolicySpec, Program, split_list};
use experiments::oracle::{Coverage, DEFAULT_LIMIT, Objective, Outcome, Survey, advance_to, play, survey};
use experiments::regret::{DecisionKey, OutcomeLog};
use indicatif::ProgressBar;
use rayon::prelude::*;
use teaming::{Assignment, Deadline, Decision, Question, Session, assignments};
use usar_sim::simulation::Checkpoint;

use crate::arguments::{
    PoliciesArgument, ProgressArguments, ShownArguments, Trial, TrialArguments, limit, parse_policy,
};
use crate::library;
use crate::prelude::*;

/// Number of assignments that are played before their outcomes are written to disk.
const CHUNK: usize = 16;

/// How good was this decision? Every assignment of a round, played
#[derive(Debug, Args)]
#[command(after_help = "\
Plays each assignment that the quotas allow from the moment of the decision, with the same random streams: \
to the end of the round, or, with --then, to the end of the trial, \
once for each of these policies. Prints the best and the worst, and where each policy's \
choice stands. Regret is the best value minus that of the choice.

With more assignments than --limit, it plays a random sample and goes on from the best of it by exchanging \
two robots at a time; the best found may not be the best there is, so that regrets are lower bounds. \
Outcomes are kept in --cache: an interrupted run resumes, and `usar why` finds them there.

Examples:
  usar oracle scenarios/paper.ron --seed 1 --round 1
  usar oracle scenarios/paper.ron --seed 1 --round 3 --metric rescue_rate --top 10
  usar oracle scenarios/paper.ron --round 2 --then RNE,DIS --csv outcomes.csv
  usar oracle results/paper --policy DIS --seed 4 --round 2 --policies 'RNE,RNE(sort: true),ENG' --json")]
pub(crate) struct Arguments {
    /// Scenario file (RON), or the folder of a sweep
    #[arg(value_name = "FILE|DIR", value_parser = library::path)]
    file: PathBuf,
    #[command(flatten)]
    trial: TrialArguments,
    /// The round
    #[arg(long, value_name = "N", default_value_t = 1)]
    round: u32,
    #[command(flatten)]
    policies: PoliciesArgument,
    /// Metric, e.g. `rescuees.total`
    #[arg(long, default_value = "rescuees.total")]
    metric: String,
    /// Play to the end of the trial, in which this policy decides the rest [default: to the end of the round]
    #[arg(long, value_name = "POLICY")]
    then: Option<String>,
    /// Most assignments of a decision to play, or problems to solve
    #[arg(long, hide_short_help = true, default_value_t = DEFAULT_LIMIT, value_parser = limit())]
    limit: u64,
    /// Assignments to show, from the best on
    #[arg(long, value_name = "N", default_value_t = 5)]
    top: usize,
    /// Write all numbers to this file as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Folder in which `usar oracle` keeps outcomes
    #[arg(long, value_name = "DIR", default_value = "results/oracle", hide_short_help = true)]
    cache: PathBuf,
    #[command(flatten)]
    progress: ProgressArguments,
    #[command(flatten)]
    shown: ShownArguments,
}

/// The outcomes of all assignments, with one policy for the rest of the trial.
struct Answer {
    /// The policy that decided the rest of the trial; `None` for outcomes at the end of the round.
    then: Option<PolicySpec>,
    survey: Survey,
}

/// The decision that is judged.
struct Asked<'a> {
    trial: &'a Trial,
    question: Question,
    time_s: f64,
    objective: Objective,
    /// The choice of each policy.
    choices: Vec<(String, Assignment)>,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        stop_on_signals();
        let trial = self.trial.open_to_all(&self.file, registry)?;
        let objective = Objective::parse(&self.metric, &trial.tasks());
        let objective = objective.map_err(Failure::input_at("--metric"))?;
        let onwards = self.onwards(&trial)?;
        let mut simulation = trial.begin()?;
        advance_to(&mut simulation, &mut *trial.session()?, self.round, Deadline::when(&STOP))?;
        let question =
            simulation.question().cloned().ok_or_else(|| Failure::run("the trial asks nothing"))?;
        let choices = self.choices(&trial, &teaming::Asked::of(&question).knowing(&simulation.team()))?;
        let asked = Asked { trial: &trial, question, time_s: simulation.time_s(), objective, choices };
        let key = decision_key(&trial, self.round, &onwards)?;
        let mut log = OutcomeLog::open(&self.cache, &key)?;
        let start = simulation.checkpoint();
        let mut answers = Vec::new();
        for then in onwards {
            let survey = self.play_all(&asked, &start, then.as_ref(), &mut log)?;
            answers.push(Answer { then, survey });
        }
        if let Some(path) = &self.csv {
            print::write_csv(path, &asked, &answers)?;
        }
        let top = if self.shown.is_json() { usize::MAX } else { self.top };
        Ok(print::text(&asked, &answers, top))
    }

    /// The choices of the policies that are judged.
    fn choices(
        &self,
        trial: &Trial,
        asked: &teaming::Asked<'_>,
    ) -> Result<Vec<(String, Assignment)>, Failure> {
        let parse = |text: &str| parse_policy("--policies", text, &trial.registry);
        let specs = match self.policies.list() {
            Some(list) => list.iter().map(|text| parse(text)).collect::<Result<Vec<_>, _>>()?,
            None if !trial.policies.is_empty() => trial.policies.clone(),
            // A policy that cannot do without options is judged where they are given.
            None => trial.registry.names().into_iter().filter_map(|name| parse(name).ok()).collect(),
        };
        let is_policy = |spec: &&PolicySpec| spec.is_of_question();
        let choice = |spec: &PolicySpec| {
            let decision = spec.made().open().and_then(|mut session| session.decide(asked));
            let decision =
                decision.map_err(|error| Failure::input(format!("policy {}: {error}", spec.label)))?;
            Ok((spec.label.clone(), decision.assignment))
        };
        specs.iter().filter(is_policy).map(choice).collect()
    }

    /// The policies that decide the rest of the trial; the assignments are played once for each.
    fn onwards(&self, trial: &Trial) -> Result<Vec<Option<PolicySpec>>, Failure> {
        let Some(list) = &self.then else { return Ok(vec![None]) };
        let parse = |text| parse_policy("--then", text, &trial.registry).map(Some);
        split_list(list).into_iter().map(parse).collect()
    }

    fn play_all(
        &self,
        asked: &Asked,
        start: &Checkpoint,
        then: Option<&PolicySpec>,
        log: &mut OutcomeLog,
    ) -> Result<Survey, Failure> {
        let name = then.map(PolicySpec::plain);
        let count = assignments::count(&asked.question).min(self.limit);
        let of = then.map_or("assignments".to_owned(), |then| format!("assignments, {} goes on", then.label));
        let named: Vec<Assignment> = asked.choices.iter().map(|(_, choice)| choice.clone()).collect();
        self.progress.work(count as usize, &of, |bar| {
            let batch = Batch { start, then_spec: then, then: name.as_deref(), progress: bar };
            let play = |assignments: &[Assignment]| batch.play(assignments, log);
            survey(&asked.question, &asked.objective, self.limit, &named, play)
        })?
    }
}

/// A batch of assignments that are being played.
struct Batch<'a> {
    start: &'a Checkpoint,
    then_spec: Option<&'a PolicySpec>,
    then: Option<&'a str>,
    progress: &'a ProgressBar,
}

impl Batch<'_> {
    /// Plays the assignments that the log lacks, in parallel, and writes each outcome as it arrives.
    fn play(&self, assignments: &[Assignment], log: &mut OutcomeLog) -> Result<Vec<Outcome>, Failure> {
        let missing: Vec<&Assignment> =
            assignments.iter().filter(|assignment| log.get(self.then, assignment).is_none()).collect();
        self.progress.inc((assignments.len() - missing.len()) as u64);
        let log = Mutex::new(log);
        missing.par_chunks(CHUNK).try_for_each(|chunk| {
            let mut onwards =
                self.then_spec.map(|spec| spec.made().open()).transpose().map_err(Failure::run)?;
            let played = chunk.iter().map(|assignment| self.play_one(assignment, onwards.as_mut()));
            let played = played.collect::<Result<Vec<_>, Failure>>()?;
            let mut log = log.lock().map_err(|_| Failure::run("a thread panicked"))?;
            log.add(self.then, chunk, &played)
        })?;
        let log = log.into_inner().map_err(|_| Failure::run("a thread panicked"))?;
        let outcome = |assignment| log.get(self.then, assignment).cloned();
        let outcomes: Option<Vec<Outcome>> = assignments.iter().map(outcome).collect();
        outcomes.ok_or_else(|| Failure::run("an assignment was not played"))
    }

    fn play_one(
        &self,
        assignment: &Assignment,
        onwards: Option<&mut Box<dyn Session>>,
    ) -> Result<Outcome, Failure> {
        if is_stopped() {
            return Err(Failure::Interrupted("stopped; the same command goes on".to_owned()));
        }
        let decision = Decision::of(assignment.clone());
        let outcome = play(self.start, decision, onwards, Deadline::when(&STOP));
        self.progress.inc(1);
        Ok(outcome?)
    }
}

/// The key under which the outcomes of a decision are stored.
pub(super) fn decision_key(
    trial: &Trial,
    round: u32,
    thens: &[Option<PolicySpec>],
) -> Result<DecisionKey, Failure> {
    // Any policy may go on after the decision, so that all that there are decide outcomes.
    let names = trial.registry.names().into_iter();
    let mut specs: Vec<PolicySpec> =
        names.filter_map(|name| PolicySpec::parse(name, &trial.registry).ok()).collect();
    specs.push(trial.spec.clone());
    // Those that go on and are known by more than their kinds, such as a program that is named in the
    // options.
    let known: BTreeSet<Option<String>> = specs.iter().map(|spec| spec.made().fingerprint()).collect();
    specs.extend(thens.iter().flatten().filter(|then| !known.contains(&then.made().fingerprint())).cloned());
    Ok(DecisionKey {
        program: Program::running(&specs)?.digest().to_string(),
        scenario: trial.scenario.name.clone(),
        resolved: trial.scenario.resolved(),
        seed: trial.seed,
        base: trial.spec.plain(),
        round,
    })
}

/// The number of played assignments, in words.
fn coverage_in_words(survey: &Survey) -> String {
    let played = survey.evaluations.len();
    match survey.coverage {
        Coverage::All => format!("all {played} assignments that the quotas allow"),
        Coverage::Sample { of, drawn, searched } => {
            let of = if of == u64::MAX { "more than 10^19".to_owned() } else { of.to_string() };
            format!(
                "{drawn} of {of} assignments, drawn at random, and {searched} of a local search: regrets are \
                 lower bounds"
            )
        }
    }
}
