//! `usar fork`: plays a trial in which one decision is changed.

use clap::ArgGroup;
use experiments::experiment::PolicySpec;
use experiments::oracle::{Branch, Outcome, advance_to};
use serde::Serialize;
use teaming::{Asked, Assignment, Deadline, Decision, Question, Session};
use usar_sim::record::TrialRecord;
use usar_sim::simulation::Checkpoint;

use crate::arguments::{ShownArguments, Trial, TrialArguments, parse_policy};
use crate::library;
use crate::prelude::*;

/// What if round N had been decided otherwise?
#[derive(Debug, Args)]
#[command(group(ArgGroup::new("otherwise").required(true).args(["instead", "assign"])), after_help = "\
Plays a trial to the decision of a round, decides otherwise, and goes on with the same random streams. What \
differs between the two trials, shown side by side, follows from that decision.

Examples:
  usar fork scenarios/paper.ron --seed 3 --round 3 --instead DIS              DIS decides round 3, RNE goes on
  usar fork scenarios/paper.ron --seed 3 --round 3 --instead DIS --onwards    DIS decides round 3 and all \
  later ones
  usar fork scenarios/paper.ron --round 1 --assign 'hard=0,2,5,6,8,11; easy=1,3,4,7,9,10'
  usar fork results/paper --policy ENG --seed 7 --round 2 --instead RNE --json")]
pub(crate) struct Arguments {
    /// Scenario file (RON), or the folder of a sweep
    #[arg(value_name = "FILE|DIR", value_parser = library::path)]
    file: PathBuf,
    #[command(flatten)]
    trial: TrialArguments,
    /// The round
    #[arg(long, value_name = "N")]
    round: u32,
    /// The policy that decides that round instead
    #[arg(long, value_name = "POLICY")]
    instead: Option<String>,
    /// The robots of each task in that round, as `task=ids; task=ids`
    #[arg(long, value_name = "GROUPS")]
    assign: Option<String>,
    /// Let --instead decide the later rounds, too
    #[arg(long, requires = "instead")]
    onwards: bool,
    #[command(flatten)]
    shown: ShownArguments,
}

/// One of the two trials.
#[derive(Serialize)]
struct Side {
    assignment: Assignment,
    /// The outcome of the decision up to the end of its round.
    round: Outcome,
    /// The outcome of the decision up to the end of the trial.
    rest: Outcome,
    rescuees: u32,
    state_hash: String,
    record: TrialRecord,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        stop_on_signals();
        let asked = self.trial.open_to_all(&self.file, registry)?;
        let other =
            self.instead.as_deref().map(|text| parse_policy("--instead", text, registry)).transpose()?;
        let mut trial = asked.begin()?;
        let (mut base, stop) = (asked.session()?, Deadline::when(&STOP));
        advance_to(&mut trial, &mut *base, self.round, stop)?;
        let question = trial.question().ok_or_else(|| Failure::run("the trial asks nothing"))?;
        let start = trial.checkpoint();
        let team = trial.team();
        let question = Asked::of(question).knowing(&team).within(&trial).until(stop);
        let was = base.decide(&question).map_err(Failure::run)?;
        let session = |spec| session_of(spec, &asked.scenario, asked.seed);
        let mut other_session = other.as_ref().map(session).transpose()?;
        let otherwise = self.decision(&question, other_session.as_mut())?;
        let as_it_was = side(&start, was, &mut *base)?;
        let onwards = other_session.as_mut().filter(|_| self.onwards).unwrap_or(&mut base);
        let sides = [as_it_was, side(&start, otherwise, &mut **onwards)?];
        let fork = self.in_words(other.as_ref(), &asked.spec.label);
        let mut out = Report::from(format!(
            "{}, seed {}, round {} at {:.1} s\nas it was  {} decides every round\nthe fork   {fork}",
            asked.scenario.name,
            asked.seed,
            self.round,
            trial.time_s(),
            asked.spec.label
        ));
        tell(&mut out, &asked, &sides);
        out.rows("trials", &sides)?;
        Ok(out)
    }

    /// The changed decision.
    fn decision(&self, asked: &Asked, other: Option<&mut Box<dyn Session>>) -> Result<Decision, Failure> {
        let question = asked.question;
        match (other, &self.assign) {
            (Some(session), _) => session.decide(asked).map_err(Failure::run),
            (None, written) => {
                let assignment = parse_groups(written.as_deref().unwrap_or_default(), question);
                let assignment = assignment.map_err(Failure::input_at("--assign"))?;
                assignment.check(question).map_err(Failure::input_at("--assign"))?;
                Ok(Decision::of(assignment))
            }
        }
    }

    fn in_words(&self, other: Option<&PolicySpec>, base: &str) -> String {
        let round = self.round;
        match other {
            Some(other) if self.onwards => {
                format!("{} decides round {round} and all later ones", other.label)
            }
            Some(other) => format!("{} decides round {round}, {base} all others", other.label),
            None => format!("round {round} is decided by --assign, all others by {base}"),
        }
    }
}

fn side(start: &Checkpoint, decision: Decision, onwards: &mut dyn Session) -> Result<Side, Failure> {
    let assignment = decision.assignment.clone();
    let mut branch = Branch::begin(start, decision)?;
    let round = branch.to_round_end(Deadline::when(&STOP))?;
    let rest = branch.to_trial_end(onwards, Deadline::when(&STOP))?;
    let record = branch.finish();
    Ok(Side {
        assignment,
        round,
        rest,
        rescuees: record.rescued(),
        state_hash: record.state_hash.clone(),
        record,
    })
}

/// Parses groups in the form `task=0,2,5; task=1,3,4`.
fn parse_groups(text: &str, question: &Question) -> Result<Assignment, String> {
    let mut groups: Vec<Option<Vec<u32>>> = vec![None; question.tasks.len()];
    for part in text.split(';').map(str::trim).filter(|part| !part.is_empty()) {
        let (task, ids) =
            part.split_once('=').ok_or_else(|| format!("must be `task=ids; task=ids`, found {part:?}"))?;
        let place = question.tasks.iter().position(|known| known.name == task.trim()).ok_or_else(|| {
            let names: Vec<&str> = question.tasks.iter().map(|task| task.name.as_str()).collect();
            format!("unknown task {:?}; the tasks are {}", task.trim(), names.join(", "))
        })?;
        let id = |id: &str| {
            id.trim().parse().map_err(|_| format!("must be numbers of robots, found {:?}", id.trim()))
        };
        let ids = ids.split(',').filter(|id| !id.trim().is_empty()).map(id).collect::<Result<_, String>>()?;
        if groups[place].replace(ids).is_some() {
            return Err(format!("task {:?} is listed twice", task.trim()));
        }
    }
    Ok(Assignment::new(groups.into_iter().map(Option::unwrap_or_default).collect()))
}

/// The ids of a group, as in tables.
pub(super) fn ids(group: &[u32]) -> String {
    let ids: Vec<String> = group.iter().map(u32::to_string).collect();
    if ids.is_empty() { "-".to_owned() } else { ids.join(" ") }
}

/// The ids of a group as a cell.
pub(super) fn group(group: &[u32]) -> Entry {
    valued(group, ids(group))
}

/// How many robots of a group are others, in words.
fn changes(before: &[u32], after: &[u32]) -> String {
    let only = |here: &[u32], there: &[u32]| here.iter().filter(|id| !there.contains(id)).count();
    match (only(after, before), only(before, after)) {
        (0, 0) => "the same".to_owned(),
        (join, 0) => format!("{join} more"),
        (0, leave) => format!("{leave} fewer"),
        (join, leave) => format!("{join} new, {leave} gone"),
    }
}

fn tell(out: &mut Report, asked: &Trial, sides: &[Side; 2]) {
    let tasks = asked.tasks();
    let [before, after] = sides.each_ref().map(|side| &side.assignment.groups);
    let groups = tasks.iter().zip(before.iter().zip(after)).map(|(task, (was, fork))| {
        [right(format!("group of {task}")), group(was), group(fork), right(changes(was, fork))]
    });
    let mut table = Table::of(["what", "as it was", "the fork", "difference"], groups);
    let mut row = |name: &str, value: &dyn Fn(&Side) -> f64, decimals: usize| {
        let [was, fork] = sides.each_ref().map(value);
        let number = |value: f64| valued(value, format!("{value:.decimals$}"));
        let more = valued(fork - was, format!("{:+.decimals$}", fork - was));
        table.add([right(name), number(was), number(fork), more]);
    };
    row("round: rescued", &|side| f64::from(side.round.total().rescued), 0);
    for (place, task) in tasks.iter().enumerate() {
        row(&format!("of {task}"), &|side| f64::from(side.round.tasks[place].rescued), 0);
    }
    row("energy (points)", &|side| side.round.total().energy, 1);
    row("HP (points)", &|side| side.round.total().hp, 2);
    row("time (s)", &|side| side.round.duration_s, 1);
    row("trial: rescued", &|side| f64::from(side.rescuees), 0);
    for (place, task) in tasks.iter().enumerate() {
        row(&format!("of {task}"), &|side| f64::from(side.record.tasks[place].totals.rescued), 0);
    }
    row("energy (points)", &|side| side.record.energy(), 1);
    row("HP (points)", &|side| side.record.hp(), 2);
    out.show("differences", table);
    let [was, fork] = sides.each_ref().map(|side| &side.state_hash);
    out.say(format!("state hash   as it was {was}\n             the fork  {fork}"));
    if was == fork {
        out.say("The fork is the same trial: round for round the same groups.");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn robots_that_join_and_that_leave_are_counted() {
        let told =
            [(vec![1, 2], vec![2, 1]), (vec![1, 2], vec![]), (vec![], vec![3]), (vec![1, 2], vec![3, 1])];
        let words = told.map(|(before, after)| changes(&before, &after));
        assert_eq!(words, ["the same", "2 fewer", "1 more", "1 new, 1 gone"]);
    }

    #[test]
    fn groups_are_read_by_the_names_of_tasks() {
        let question = serde_json::json!({
            "schema_version": 3, "round": 1, "roles": [], "needs": [], "quotas": [], "members": [],
            "history": [], "tasks": [{"name": "hard", "difficulty": 2}, {"name": "easy", "difficulty": 1}],
            "random_seed": "00".repeat(32),
        });
        let question = Question::from_json(&question.to_string()).unwrap();
        let groups = |text| parse_groups(text, &question).map(|assignment| assignment.groups);
        assert_eq!(groups(" easy = 3, 1; hard=2;"), Ok(vec![vec![2], vec![1, 3]]));
        assert_eq!(groups("hard=1"), Ok(vec![vec![1], vec![]]));
        assert!(groups("far=1").unwrap_err().contains("the tasks are hard, easy"));
        assert!(groups("hard=1;hard=2").unwrap_err().contains("listed twice"));
        assert!(groups("hard=x").unwrap_err().contains("must be numbers of robots, found \"x\""));
        assert!(groups("hard").unwrap_err().contains("must be `task=ids; task=ids`"));
    }
}
