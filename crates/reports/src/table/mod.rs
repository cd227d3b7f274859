//! Tables for people.

mod effects;
mod grouping;

use experiments::comparison::{Comparison, Trials, digits, short, short_p};
use experiments::experiment::PolicySpec;
use experiments::metric::Metric;
use experiments::sweep::folder::Folder;
use scenario::Words;
use statistics::Moments;
use tables::{Entry, Format, Table, labelled, or_dash, right, right_or_dash, shown_as, valued};
use usar_sim::event::ReturnCause;
use usar_sim::metrics::RoundRecord;
use usar_sim::record::TrialRecord;

pub use effects::{cases_table, differences_table, effects_table, interactions_table};
pub use grouping::{levels_table, likeness_table};

/// Largest number of policies that are columns of a table; more are rows.
const MOST_COLUMNS: usize = 8;

/// The metrics of a table of one case: the main ones, and the time beside them where trials are not equally
/// long.
pub(crate) fn shown(folder: &Folder, case: usize) -> Vec<(usize, &Metric)> {
    let metrics = &folder.experiment().metrics;
    let time = metrics.named("time").ok();
    let of_case = folder.results().range((case, 0, 0)..(case + 1, 0, 0));
    let mut times = of_case.filter_map(|(_, measured)| measured.metrics.as_ref()?.get(time?));
    let first = times.next();
    let differ = times.any(|time| Some(time) != first);
    let is_shown = |(place, metric): &(usize, &Metric)| metric.is_primary || differ && Some(*place) == time;
    metrics.iter().enumerate().filter(is_shown).collect()
}

/// Mean ± sample standard deviation of each metric and policy in one case. A row for each metric, or, if
/// there are more than eight policies, for each policy.
pub fn policy_table(folder: &Folder, case: usize) -> Table {
    let policies = &folder.experiment().policies;
    let trials = folder.trials_of(case);
    let cell = |policy, metric| {
        let found = Trials::of(folder, case).moments(((case, policy), metric));
        right(moments(&found, trials)).with(found.mean)
    };
    let shown = shown(folder, case);
    if policies.len() > MOST_COLUMNS {
        let names = shown.iter().map(|(_, metric)| right(&metric.name));
        let row = |(policy, spec): (usize, &PolicySpec)| {
            labelled(&spec.label, shown.iter().map(move |(metric, _)| cell(policy, *metric)))
        };
        return Table::of(labelled("policy", names), policies.iter().enumerate().map(row));
    }
    let mut table = Table::new(labelled("policy", policies.iter().map(|policy| right(&policy.label))));
    let mut last = "";
    for (i, metric) in shown {
        table.add(labelled(indented(&metric.name, last), (0..policies.len()).map(|policy| cell(policy, i))));
        last = &metric.name;
    }
    table
}

/// A metric's name, of which only the part is shown if the rest equals that of the name above.
fn indented(name: &str, above: &str) -> String {
    let common = |text: &str| text.rfind('.').map(|end| text[..end].to_owned());
    let is_terminal = shown_as() == Format::Table;
    match (common(name), common(above)) {
        (Some(here), Some(there)) if here == there && is_terminal => {
            " ".repeat(here.len()) + &name[here.len()..]
        }
        _ => name.to_owned(),
    }
}

/// The comparisons of one metric in five columns, for a terminal of 80 columns.
pub fn verdict_table(comparisons: &[&Comparison]) -> Table {
    let row = |c: &&Comparison| {
        [
            format!("{} - {}", c.a, c.b).into(),
            number(c.difference),
            range(c.interval),
            right_or_dash(c.p_holm, short_p),
            c.verdict_in_words().into(),
        ]
    };
    Table::of(["A - B", "difference", "95 % interval", "p", "verdict"], comparisons.iter().map(row))
}

/// An interval in words.
pub fn between(interval: Option<[f64; 2]>) -> String {
    or_dash(interval, |[low, high]| format!("{} to {}", short(low), short(high)))
}

/// An interval as a cell; a dash if there is none.
pub fn range(interval: Option<[f64; 2]>) -> Entry {
    valued(interval, between(interval))
}

/// A short number as a cell; a dash if there is none.
pub fn number(value: Option<f64>) -> Entry {
    right_or_dash(value, short)
}

/// A mean as a cell; a dash if there is none.
pub fn mean(value: Option<f64>) -> Entry {
    right_or_dash(value, |value| digits(value, 4))
}

/// A row for each comparison, with all that is known of it.
pub fn comparison_table(comparisons: &[&Comparison]) -> Table {
    let is_judged = comparisons.iter().any(|comparison| comparison.judged.is_some());
    let header =
        "metric,A - B,n,mean A,mean B,difference,95 % interval,shift,p,p Holm,effect,detectable,verdict";
    let of_margin = ["pairs for margin"].into_iter().filter(|_| is_judged);
    let row = |c: &&Comparison| {
        let p = |p: Option<f64>| right_or_dash(p, short_p);
        let pairs = c.judged.and_then(|judged| judged.pairs_for_margin);
        let of_margin = [right_or_dash(pairs, |pairs| pairs.to_string())];
        let cells = [
            Entry::from(&c.metric),
            format!("{} - {}", c.a, c.b).into(),
            right(c.n),
            mean(c.mean_a),
            mean(c.mean_b),
            number(c.difference),
            range(c.interval),
            number(c.shift),
            p(c.p),
            p(c.p_holm),
            right_or_dash(c.effect, |effect| format!("{effect:.2}")),
            number(c.detectable),
            c.verdict_in_words().into(),
        ];
        cells.into_iter().chain(of_margin.into_iter().filter(move |_| is_judged))
    };
    Table::of(header.split(',').chain(of_margin), comparisons.iter().map(row))
}

/// A row for each round and task: what was carried and why the group went home; where there is room, also
/// when it began, what it cost, and who turned back.
pub fn rounds_table(record: &TrialRecord, words: &Words, is_wide: bool) -> Table {
    let cells = |round: &RoundRecord| {
        let members: Vec<String> = round.members.iter().map(|member| member.id.to_string()).collect();
        [
            ("round", true, right(round.round)),
            ("task", true, Entry::from(&record.tasks[round.task.index()].task)),
            ("from s", false, valued(round.start_s, format!("{:.1}", round.start_s))),
            ("to s", true, right_or_dash(round.end_s, |end| format!("{end:.1}"))),
            ("members", true, members.join(" ").into()),
            ("secured", false, right(round.secured)),
            ("rescued", true, right(round.rescued)),
            ("energy", true, valued(round.energy, format!("{:.1}", round.energy))),
            ("HP", false, valued(round.hp, format!("{:.2}", round.hp))),
            ("turned back", false, right(round.turned_back)),
            ("went home: why", true, round.return_cause.map_or("-", ReturnCause::name).into()),
        ]
        .map(|(name, is_narrow, cell)| (is_wide || is_narrow).then(|| (words.text(name), cell)))
    };
    let header = record.rounds.iter().take(1).flat_map(cells).flatten().map(|(name, _)| name);
    Table::of(
        header,
        record.rounds.iter().map(|round| cells(round).into_iter().flatten().map(|(_, cell)| cell)),
    )
}

/// `mean ± sd`, with the number of trials if some trials have no value.
pub(crate) fn moments(moments: &Moments, trials: usize) -> String {
    let Some(mean) = moments.mean else { return "-".to_owned() };
    let decimals = decimals(mean);
    let sd = moments.sd.map_or(String::new(), |sd| format!(" ± {sd:.decimals$}"));
    let partly = if moments.count < trials { format!(" (n = {})", moments.count) } else { String::new() };
    format!("{mean:.decimals$}{sd}{partly}")
}

/// Number of decimals that shows a mean with about three significant digits; at least one.
fn decimals(mean: f64) -> usize {
    (1..8)
        .find(|decimals| mean.abs() * 10_f64.powi(*decimals) >= 100.0)
        .map_or(2, |decimals| decimals as usize)
}
