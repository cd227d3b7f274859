//! `usar why`: explains why a robot is in its group, and why it does not move.

mod overheard;
mod robot;
mod told;

use experiments::experiment::PolicySpec;
use experiments::oracle::{Coverage, Evaluation, Objective, Survey};
use experiments::regret::OutcomeLog;
use experiments::why::{Directed, OtherChoice, directed, exchanges, other_choices};
use serde::Serialize;
use teaming::{Asked, Assignment, Decision, Member, Question, assignments};
use usar_sim::record::{DecisionRecord, Join, Status};
use usar_sim::simulation::Simulation;

use super::oracle::decision_key;
use crate::arguments::{MeasureArgument, ShownArguments, Trial, TrialArguments};
use crate::library;
use crate::prelude::*;
use crate::running::Guard;
use overheard::{Negotiation, Overheard};
use robot::{RobotStory, Watched};

/// Why is this robot in this group, and why does it stand still?
#[derive(Debug, Args)]
#[command(after_help = "\
Tells from the recorded decision of a round what drove it, need by need; how close the call was; what every \
other policy would have decided; and, if `usar oracle` was run for it, how good it was. With --robot: why \
the robot is in its group, why it does not move, why it turned back.

Examples:
  usar why scenarios/paper.ron --seed 3 --round 3
  usar why scenarios/paper.ron --seed 3 --round 3 --robot 4
  usar why scenarios/paper.ron --seed 3 --robot 4 --at 128.4
  usar why results/paper --policy ENG --seed 7 --round 2 --json")]
pub(crate) struct Arguments {
    /// Scenario file (RON), or the folder of a sweep
    #[arg(value_name = "FILE|DIR", value_parser = library::path)]
    file: PathBuf,
    #[command(flatten)]
    trial: TrialArguments,
    /// The round [default: the one at --at, or the first]
    #[arg(long, value_name = "N")]
    round: Option<u32>,
    /// A robot, by its number
    #[arg(long, value_name = "ID")]
    robot: Option<u32>,
    /// A moment, in seconds of simulated time [default: when the round begins]
    #[arg(long, value_name = "SECONDS", requires = "robot")]
    at: Option<f64>,
    /// Folder in which `usar oracle` keeps outcomes
    #[arg(long, value_name = "DIR", default_value = "results/oracle", hide_short_help = true)]
    cache: PathBuf,
    #[command(flatten)]
    shown: ShownArguments,
    #[command(flatten)]
    measure: MeasureArgument,
}

/// The oracle's judgement of a decision, in one metric, over one horizon.
#[derive(Debug, Serialize)]
struct OracleSays {
    metric: String,
    /// The policy that decides the rest of the trial; absent if the outcome is that of the round.
    then: Option<String>,
    value: f64,
    best: f64,
    worst: f64,
    rank: usize,
    played: usize,
}

/// The full account.
#[derive(Serialize)]
struct Account<'a> {
    scenario: &'a str,
    seed: u64,
    policy: &'a str,
    round: u32,
    time_s: f64,
    /// Complete, with the history of the rounds before.
    question: Question,
    decision: &'a Decision,
    /// How each robot decided, where robots did.
    #[serde(skip_serializing_if = "<[Join]>::is_empty")]
    joins: &'a [Join],
    /// The members as they really were.
    team: &'a [Member],
    /// The trust measure of `directed` and of the robot's exchanges; absent if the policy has none.
    measure: Option<String>,
    /// Unit of the trust measure.
    unit: Option<String>,
    /// Distrust between the groups by this measure, all pairs together; absent if it is infinite.
    between: Option<f64>,
    /// Distrust between the groups, need by need; empty without a measure that goes need by need.
    directed: Vec<Directed>,
    others: Vec<OtherChoice>,
    /// Empty if the oracle was not run for this decision.
    oracle: Vec<OracleSays>,
    robot: Option<RobotStory>,
    /// What the robot heard, said and knew before the round, where robots decide.
    #[serde(skip_serializing_if = "Option::is_none")]
    negotiation: Option<Negotiation>,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        stop_on_signals();
        let registry = &self.measure.chosen_in(registry)?;
        let asked = self.trial.open_to_all(&self.file, registry)?;
        let mut simulation = asked.begin()?;
        let mut session = asked.session()?;
        let mut overheard = Overheard::new(&mut *session, self.robot.unwrap_or(u32::MAX));
        let watched = self.play(&mut overheard, &asked, &mut simulation)?;
        let round = self.round.unwrap_or_else(|| simulation.decisions().len().max(1) as u32);
        let found = simulation.decisions().iter().find(|asked| asked.question.round == round);
        let Some(record) = found else {
            refuse!("--round: no round {round} began up to {:.1} s", simulation.time_s());
        };
        let mut account = self.account(&asked, &simulation, record, watched)?;
        account.negotiation = overheard.before(round);
        let mut out = told::text(&account, &asked);
        out.rows("account", [&account])?;
        Ok(out)
    }

    /// Plays the trial up to the requested moment.
    fn play(
        &self,
        session: &mut Overheard<'_>,
        asked: &Trial,
        simulation: &mut Simulation,
    ) -> Result<Option<Watched>, Failure> {
        let robots = simulation.world().robots.len();
        if let Some(robot) = self.robot.filter(|robot| *robot as usize >= robots) {
            refuse!("--robot: must be below {robots}, found {robot}");
        }
        let end = asked.scenario.duration_s;
        if let Some(at) = self.at.filter(|at| !(0.0..=end).contains(at)) {
            refuse!("--at: must be from 0 to {end} s, found {at}");
        }
        let mut watched = self.robot.map(Watched::new);
        let guard = Guard::new(f64::INFINITY);
        let last_round = self.round.unwrap_or(1);
        loop {
            let is_decided = simulation.decisions().len() >= last_round as usize;
            if is_decided && self.at.is_none_or(|at| simulation.time_s() >= at) {
                return Ok(watched);
            }
            if let Some(Status::Failed(reason)) = simulation.step(&mut *session) {
                return Err(Failure::run(reason));
            }
            if simulation.ending().is_some() {
                return Ok(watched);
            }
            watched.iter_mut().for_each(|watched| watched.listen(simulation));
            guard.look(simulation)?;
        }
    }

    fn account<'a>(
        &self,
        asked: &'a Trial,
        simulation: &'a Simulation,
        record: &'a DecisionRecord,
        watched: Option<Watched>,
    ) -> Result<Account<'a>, Failure> {
        let DecisionRecord { question, decision, .. } = record;
        let measure = asked.spec.own_measure(&asked.registry);
        let trust = measure.map(|measure| measure.it.of_team(question)).transpose().map_err(Failure::run)?;
        let directed = trust.as_ref().map(|trust| directed(&**trust, question, decision)).transpose()?;
        let between = trust.as_ref().map(|trust| trust.between(&decision.assignment)).transpose();
        let between = between.map_err(Failure::run)?.flatten().filter(|value| value.is_finite());
        let begun = simulation.metrics().rounds.iter().find(|round| round.round == question.round);
        let story = watched.map(|watched| {
            let id = watched.robot();
            let exchanges =
                trust.as_ref().map(|trust| exchanges(&**trust, question, &decision.assignment, id));
            Ok::<_, Failure>(watched.story(
                simulation,
                question,
                decision,
                exchanges.transpose()?.unwrap_or_default(),
            ))
        });
        let full = simulation.question_of(record);
        Ok(Account {
            scenario: &asked.scenario.name,
            seed: asked.seed,
            policy: &asked.spec.label,
            round: question.round,
            time_s: begun.map_or(0.0, |round| round.start_s),
            measure: measure.map(|measure| measure.label.clone()),
            unit: measure.map(|measure| measure.it.unit().to_owned()),
            between,
            directed: directed.unwrap_or_default(),
            others: other_choices(
                &Asked::of(&full).knowing(record.team()),
                &decision.assignment,
                &others(asked),
            ),
            oracle: self.oracle(asked, question, &decision.assignment)?,
            robot: story.transpose()?,
            negotiation: None,
            decision,
            joins: &record.joins,
            team: record.team(),
            question: full,
        })
    }

    /// The oracle's judgements of a decision, as far as outcomes are known.
    fn oracle(
        &self,
        asked: &Trial,
        question: &Question,
        chosen: &Assignment,
    ) -> Result<Vec<OracleSays>, Failure> {
        let key = decision_key(asked, question.round, &[])?;
        let log = OutcomeLog::find(&self.cache, &key)?;
        let tasks = asked.tasks();
        let mut said = Vec::new();
        for then in log.horizons() {
            let evaluations = log.outcomes(then.as_deref());
            let evaluations: Vec<Evaluation> = evaluations
                .map(|(assignment, outcome)| Evaluation { assignment, outcome: outcome.clone() })
                .collect();
            // An interrupted survey gives no judgement.
            if evaluations.len() as u64 == assignments::count(question) {
                let survey = Survey { evaluations, coverage: Coverage::All };
                let judged = JUDGED_BY.map(|metric| judgement(&survey, metric, &tasks, chosen));
                let of_horizon = judged.into_iter().flatten();
                said.extend(of_horizon.map(|judged| OracleSays { then: then.clone(), ..judged }));
            }
        }
        Ok(said)
    }
}

/// The metrics in which a decision is judged.
const JUDGED_BY: [&str; 2] = ["rescuees", "rescue_rate"];

fn judgement(survey: &Survey, metric: &str, tasks: &[String], chosen: &Assignment) -> Option<OracleSays> {
    let objective = Objective::parse(metric, tasks).ok()?;
    let [best, worst] = survey.range(&objective)?;
    let standing = survey.standing(&objective, chosen)?;
    Some(OracleSays {
        metric: objective.name().to_owned(),
        then: None,
        value: standing.value,
        best,
        worst,
        rank: standing.rank,
        played: survey.evaluations.len(),
    })
}

/// The policies other than the one that decided.
fn others(asked: &Trial) -> Vec<PolicySpec> {
    let all = if asked.policies.is_empty() {
        // A policy that cannot do without options is asked where they are given.
        let parse = |name| PolicySpec::parse(name, &asked.registry).ok();
        asked.registry.names().into_iter().filter_map(parse).collect()
    } else {
        asked.policies.clone()
    };
    all.into_iter().filter(|spec| spec.plain() != asked.spec.plain()).collect()
}
