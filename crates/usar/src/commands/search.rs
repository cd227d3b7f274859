//! `usar search`: searches for the scenario in which a policy performs worst.

use std::sync::Arc;

use experiments::comparison::{CONFIDENCE, Choice, Comparison, Trials, compare, short};
use experiments::experiment::{Experiment, Overrides};
use experiments::explore::{Candidate, Descent, FOUND, Hunt, Outcome, Space, Trail};
use experiments::files::NewFile;
use experiments::job::interrupted;
use experiments::sweep::folder::{Folder, Opening};
use statistics::Moments;
use statistics::bootstrap::interval;
use statistics::comparison::Direction;

use crate::arguments::{JsonArgument, ParameterArguments, count, seed, share};
use crate::prelude::*;

/// Folder of the trials that confirm the found scenario.
const CONFIRMATION: &str = "confirmation";

/// Where does a policy fail the most?
#[derive(Debug, Args)]
#[command(after_help = "\
Searches the parameters of a scenario for values with which --policy is worst in --metric; with --against, \
with which it is the farthest behind that policy over paired seeds. The search is CMA-ES, seeded, and \
finishes its last generation. All candidates are judged by the same seeds, and the best of many is \
flattered by chance: so what was found is run again with seeds that no candidate was judged by, and only \
that is a result.

Each candidate is on disk as soon as it is done; the same command resumes where it stopped, and more \
--evaluations go on from there. The folder gets evaluations.jsonl (the log), search.json, found.ron, and the \
sweep that confirms it, confirmation/, which `usar report` shows.

Examples:
  usar search scenarios/paper.ron --policy RNE --against DIS \\
      --over mission.rest_s=0..60 --over 'radiation[*].radius_m=3..9'
  usar search scenarios/paper.ron --policy RNE --metric rescuees.hard --over 'debris.count=0..40'
  usar search scenarios/paper.ron --policy RNE --metric distance --highest --over mission.rest_s=0..60
  usar search scenarios/trust/tunnel.ron --policy HP_DIS --over 'deceit[0].lie=[Complement, Stuck, Copycat]' \
      --set 'deceit=[(who: Count(4), lie: Stuck, on: [Hp])]'")]
pub(crate) struct Arguments {
    #[command(flatten)]
    parameters: ParameterArguments,
    /// Policy that decides, with its options in brackets
    #[arg(long)]
    policy: String,
    /// The policy that it is to be behind
    #[arg(long)]
    against: Option<String>,
    /// Metric, e.g. `rescuees.total`
    #[arg(long, default_value = "rescuees.total")]
    metric: String,
    /// Search for the lowest value or difference [default: where the metric is better high]
    #[arg(long, conflicts_with = "highest")]
    lowest: bool,
    /// Search for the highest value or difference [default: where the metric is better low]
    #[arg(long)]
    highest: bool,
    /// Candidates to ask for, the start among them
    #[arg(long, default_value_t = 60, value_parser = count(1..=1_000_000))]
    evaluations: u32,
    /// Trials of each policy, in each case or candidate
    #[arg(long, default_value_t = 10, value_parser = count(1..=100_000))]
    trials: u32,
    /// Seed of the first trial
    #[arg(long, hide_short_help = true, default_value_t = 400_001, value_parser = seed())]
    first_seed: u64,
    /// Trials of each policy that confirm what was found
    #[arg(long, default_value_t = 50, hide_short_help = true, value_parser = count(2..=100_000))]
    confirm_trials: u32,
    /// Seed of the first of these
    #[arg(long, default_value_t = 500_001, hide_short_help = true, value_parser = seed())]
    confirm_seed: u64,
    /// Seed of all that the command itself draws
    #[arg(long, default_value_t = 1, hide_short_help = true)]
    draw_seed: u64,
    /// How far the first candidates are from the scenario as it is, as a share of each range
    #[arg(long, default_value_t = 0.3, value_name = "SHARE", value_parser = share, hide_short_help = true)]
    first_step: f64,
    #[command(flatten)]
    json: JsonArgument,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry) -> Result<Report, Failure> {
        let hunt = self.hunt(registry)?;
        let folder = self.parameters.folder(&hunt.space.experiment, "search");
        let mut trail = hunt.open(&folder, self.parameters.fresh)?;
        if !self.search(&hunt, &mut trail)? {
            return Err(interrupted(&folder, "what is done is"));
        }
        let (best, outcome) = hunt.best(&trail).ok_or_else(|| {
            let reason = trail.entries.first().and_then(|first| first.outcome.as_ref().err());
            let reason = reason.map_or(String::new(), ToString::to_string);
            Failure::run(format!("no candidate could be run: {reason}"))
        })?;
        let what =
            format!("{} is {} on the seeds of the search", hunt.space.outcomes[0].name(), short(outcome));
        NewFile::write(&folder, FOUND, hunt.text(best, &what)?.as_bytes())?;
        let confirmed = self.confirm(&folder, registry)?;
        let found = Found { hunt: &hunt, trail: &trail, best, outcome };
        self.told(&found, &confirmed)?.print()?;
        self.parameters.progress.tell(format_args!("results in {}", folder.display()));
        Ok(Report::default())
    }

    fn policies(&self) -> Vec<String> {
        [Some(self.policy.clone()), self.against.clone()].into_iter().flatten().collect()
    }

    fn hunt(&self, registry: &Registry) -> Result<Hunt, Failure> {
        let ends = |first: u64, count: u32| (first, first + u64::from(count));
        let (a, b) = (ends(self.first_seed, self.trials), ends(self.confirm_seed, self.confirm_trials));
        if a.0 < b.1 && b.0 < a.1 {
            refuse!("--confirm-seed: the seeds that confirm must be others than those of the search");
        }
        let experiment = self.parameters.experiment(Some(self.policies()), self.trials, registry)?;
        let metric = experiment.metrics.named(&self.metric);
        let metric = metric.map_err(Failure::input_at("--metric"))?;
        let is_lowest = match experiment.metrics[metric].direction {
            _ if self.lowest || self.highest => self.lowest,
            Direction::Higher => true,
            Direction::Lower => false,
            Direction::Neither => {
                refuse!(
                    "--metric: {} is neither good nor bad; --lowest or --highest says what is looked for",
                    self.metric
                );
            }
        };
        let outcome = outcome(&experiment, metric);
        let space = Space::new(experiment, &self.parameters.over, vec![outcome])?;
        let descent = Descent {
            evaluations: self.evaluations as usize,
            seed: self.draw_seed,
            first_step: self.first_step,
        };
        Ok(Hunt { space, is_lowest, first_seed: self.first_seed, descent })
    }

    fn search(&self, hunt: &Hunt, trail: &mut Trail) -> Result<bool, Failure> {
        let progress = &self.parameters.progress;
        progress.tell_resumed(trail.entries.len(), "evaluations");
        progress.work(self.evaluations as usize, "evaluations", |bar| {
            hunt.search(trail, &STOP, |asked, best| {
                bar.set_position(asked as u64);
                bar.set_message(format!("(worst so far {})", short(best)));
            })
        })?
    }

    /// Runs the found scenario with fresh seeds.
    fn confirm(&self, folder: &Path, registry: &Registry) -> Result<Folder, Failure> {
        let overrides = Overrides {
            policies: Some(self.policies()),
            trials: Some(self.confirm_trials),
            first_seed: Some(self.confirm_seed),
            ..Overrides::default()
        };
        let experiment = Arc::new(Experiment::load(&folder.join(FOUND), &overrides, registry)?);
        let path = folder.join(CONFIRMATION);
        // Existing trials of another found scenario are useless.
        let is_other = path.exists()
            && Folder::read(&path, registry).map_or(true, |there| {
                there.experiment().base.resolved() != experiment.base.resolved()
                    || there.experiment().trials > experiment.trials
            });
        let opening = Opening { is_fresh: is_other || self.parameters.fresh, ..Opening::default() };
        let mut confirmed = Folder::open(&path, experiment, opening, &mut |_| {})?;
        self.parameters.progress.run_missing(&mut confirmed, None, None)?;
        confirmed.finish(&STOP)?;
        Ok(confirmed)
    }

    fn told(&self, found: &Found, confirmed: &Folder) -> Result<Report, Failure> {
        let metric = confirmed.experiment().metrics.named(&self.metric)?;
        let comparison = match &self.against {
            None => None,
            Some(against) => {
                let choice = Choice { baseline: Some(against), ..Choice::default() };
                compare(confirmed, &[metric], choice)?.into_iter().next()
            }
        };
        let alone = Trials::of(confirmed, 0).values(((0, 0), metric));
        let mut out = found.told(self.trials);
        out.rows("found", [&found.in_numbers(&alone)])?;
        out.rows("comparisons", &comparison)?;
        let last = self.confirm_seed + u64::from(self.confirm_trials) - 1;
        out.say(format!(
            "\nRun again on {} fresh seeds ({} to {last}), by which no candidate was judged:",
            self.confirm_trials, self.confirm_seed
        ));
        match comparison {
            Some(comparison) => {
                out.extend([self.verdict(found.hunt.is_lowest, &comparison), comparison.in_words]);
            }
            None => out.say(in_words(&found.hunt.space.outcomes[0], &alone)),
        }
        Ok(out)
    }
}

impl Arguments {
    /// Whether fresh seeds confirm the result, in a sentence.
    fn verdict(&self, is_lowest: bool, comparison: &Comparison) -> String {
        let Comparison { a, b, difference, interval, .. } = comparison;
        let is_there = interval.is_some_and(|[low, high]| if is_lowest { high < 0.0 } else { low > 0.0 });
        let by = difference.map_or("-".to_owned(), |difference| short(difference.abs()));
        let (side, metric) = (if is_lowest { "below" } else { "above" }, &self.metric);
        if is_there && comparison.is_found() {
            format!("Confirmed: in this scenario {a} is {by} {side} {b} in {metric}.")
        } else {
            format!("Not confirmed: on fresh seeds {a} is not shown to be {side} {b} in {metric}.")
        }
    }
}

/// The result of a search.
struct Found<'a> {
    hunt: &'a Hunt,
    trail: &'a Trail,
    best: &'a Candidate,
    outcome: f64,
}

impl Found<'_> {
    fn told(&self, trials: u32) -> Report {
        let free = self.hunt.space.free.iter().zip(&self.best.values);
        let mut out = Report::of(free.map(|(free, value)| free.found(*value)));
        let (first, count) = (self.hunt.first_seed, self.trail.entries.len());
        let last = first + u64::from(trials) - 1;
        let start = self.trail.entries.first().and_then(|first| first.outcome.clone().ok());
        let start = start.map_or("-".to_owned(), short);
        out.say(format!(
            "\n{} is {} there, and {start} in the scenario as it is, on the {trials} seeds of the search \
             ({first} to {last});\n\
             the {} of {count} candidates, and so flattered by chance.",
            self.hunt.space.outcomes[0].name(),
            short(self.outcome),
            if self.hunt.is_lowest { "lowest" } else { "highest" }
        ));
        if self.trail.entries.first() == Some(self.best) {
            out.say("No candidate is worse than the scenario as it is.");
        }
        out
    }

    fn in_numbers(&self, alone: &[f64]) -> serde_json::Value {
        let free = self.hunt.space.free.iter().zip(&self.best.values);
        let values: serde_json::Map<String, serde_json::Value> =
            free.map(|(free, value)| (free.name.clone(), (*value).into())).collect();
        let first = self.trail.entries.first();
        serde_json::json!({
            "outcome": self.hunt.space.outcomes[0],
            "values": values,
            "on_search_seeds": self.outcome,
            "as_it_is_on_search_seeds": first.and_then(|first| first.outcome.clone().ok()),
            "confirmed_mean": Moments::of(alone).mean,
            "confirmed_interval": interval(alone, CONFIDENCE),
        })
    }
}

/// The outcome that is searched: the policy's mean of the metric, or its paired difference to the other
/// policy.
fn outcome(experiment: &Experiment, metric: usize) -> Outcome {
    let label = |policy: usize| experiment.policies[policy].label.clone();
    let less = (experiment.policies.len() > 1).then_some(1);
    let who = less.map_or_else(|| label(0), |less| format!("{} - {}", label(0), label(less)));
    Outcome { metric, policy: 0, less, who, what: experiment.metrics[metric].name.clone() }
}

/// The result of one policy, in a sentence.
fn in_words(outcome: &Outcome, values: &[f64]) -> String {
    let range = interval(values, CONFIDENCE).map_or(String::new(), |[low, high]| {
        format!(" (95 % interval {} to {}, n = {})", short(low), short(high), values.len())
    });
    let mean = Moments::of(values).mean.map_or("not defined".to_owned(), short);
    format!("{}, {}: the mean is {mean}{range}.", outcome.what, outcome.who)
}
