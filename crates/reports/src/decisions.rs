//! The decisions of a trial, policy by policy, as a table of a report.

use experiments::Failure;
use experiments::comparison::digits;
use experiments::run::Trial;
use experiments::sweep::folder::Folder;
use rne_core::RelativeNeedsEntropy;
use usar_sim::record::DecisionRecord;

/// The decisions of one trial.
pub(crate) struct Decisions {
    /// Number of the trial, from 1, and its seed.
    pub trial: u32,
    pub seed: u64,
    pub header: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

/// The decisions of a trial of a case that all policies finished: the one with this seed, or the first;
/// `None` if there is no such trial.
pub(crate) fn decisions(
    folder: &mut Folder,
    case: usize,
    seed: Option<u64>,
) -> Result<Option<Decisions>, Failure> {
    let policies: Vec<String> =
        folder.experiment().policies.iter().map(|policy| policy.label.clone()).collect();
    if !folder.experiment().keep.has_records() {
        return Ok(None);
    }
    let trials = folder.experiment().trials;
    let is_finished = |trial: u32| {
        (0..policies.len()).all(|policy| {
            let measured = folder.results().get(&(case, policy, trial));
            measured.is_some_and(|measured| measured.metrics.is_some())
        })
    };
    let is_wanted = |trial: u32| seed.is_none_or(|seed| folder.experiment().seed(trial) == seed);
    let wanted = (1..=trials).find(|trial| is_wanted(*trial) && is_finished(*trial));
    let Some(trial) = wanted else { return Ok(None) };
    let tasks = experiments::metric::task_names(&folder.experiment().cases[case].scenario);
    let before = ["policy", "round", "from s"].map(str::to_owned);
    let of_tasks = |what: &str| tasks.iter().map(|task| format!("{task}: {what}")).collect::<Vec<_>>();
    let header =
        [before.to_vec(), of_tasks("robots"), vec!["score (nats)".to_owned()], of_tasks("rescued")].concat();
    let mut rows = Vec::new();
    for (place, policy) in policies.iter().enumerate() {
        if let Ok(found) = folder.outcome((case, place, trial))?.result {
            rows.extend(rows_of(policy, &found, tasks.len()));
        }
    }
    let seed = folder.experiment().seed(trial);
    Ok((!rows.is_empty()).then_some(Decisions { trial, seed, header, rows }))
}

fn rows_of<'a>(policy: &'a str, trial: &'a Trial, tasks: usize) -> impl Iterator<Item = Vec<String>> + 'a {
    let row = move |asked: &DecisionRecord| {
        let round = asked.question.round;
        let records = trial.record.rounds.iter().filter(|record| record.round == round);
        let start = records.clone().next().map_or(0.0, |record| record.start_s);
        let score = asked.decision.score.map(RelativeNeedsEntropy::nats);
        let score = match score {
            None => "-".to_owned(),
            Some(None) => "infinite".to_owned(),
            Some(Some(nats)) => digits(nats, 3),
        };
        let ids = |group: &Vec<u32>| group.iter().map(u32::to_string).collect::<Vec<_>>().join(" ");
        let rescued = (0..tasks).map(|task| {
            let mut of_task = records.clone().filter(|record| record.task.index() == task);
            of_task.next().map_or(0, |record| record.rescued).to_string()
        });
        let before = [policy.to_owned(), round.to_string(), format!("{start:.1}")].into_iter();
        let groups = asked.decision.assignment.groups.iter().map(ids);
        before.chain(groups).chain([score]).chain(rescued).collect()
    };
    trial.record.decisions.iter().map(row)
}
