//! Tables for people.

mod blocks;
mod effects;
mod format;
mod grouping;

use std::sync::OnceLock;

pub use comfy_table::Table;
use comfy_table::presets::UTF8_FULL_CONDENSED;
use comfy_table::{Cell, CellAlignment, Row};
use experiments::comparison::{Comparison, digits, moments_of, short, short_p};
use experiments::experiment::Experiment;
use experiments::sweep::folder::Folder;
use statistics::Moments;
use usar_sim::event::ReturnCause;
use usar_sim::metrics::RoundRecord;
use usar_sim::record::TrialRecord;
use usar_sim::scenario::Words;

pub use effects::{cases_table, differences_table, effects_table, interactions_table};
pub(crate) use format::Lines;
pub use format::{Format, show_as, shown_as};
pub use grouping::{levels_table, likeness_table};

/// Largest number of policies that are columns of a table; more are rows.
const MOST_COLUMNS: usize = 8;

/// Mean ± sample standard deviation of each metric and policy in one case. A row for each metric, or, if
/// there are more than eight policies, for each policy.
pub fn policy_table(folder: &Folder, case: usize) -> Table {
    let Experiment { policies, metrics, .. } = folder.experiment();
    let trials = folder.trials_of(case);
    let cell = |policy, metric| right(&moments(&moments_of(folder, (case, policy), metric), trials));
    let primary = || metrics.iter().enumerate().filter(|(_, metric)| metric.is_primary);
    if policies.len() > MOST_COLUMNS {
        let names = primary().map(|(_, metric)| right(&metric.name));
        let mut table = headed(std::iter::once(Cell::new("policy")).chain(names));
        for (policy, spec) in policies.iter().enumerate() {
            let cells = primary().map(|(metric, _)| cell(policy, metric));
            table.add_row(std::iter::once(Cell::new(&spec.label)).chain(cells));
        }
        return table;
    }
    let header = std::iter::once(Cell::new("policy"));
    let mut table = headed(header.chain(policies.iter().map(|policy| right(&policy.label))));
    let mut last = "";
    for (i, metric) in primary() {
        let cells = (0..policies.len()).map(|policy| cell(policy, i));
        table.add_row(std::iter::once(Cell::new(indented(&metric.name, last))).chain(cells));
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
    let mut table = headed(["A - B", "difference", "95 % interval", "p", "verdict"]);
    for c in comparisons {
        table.add_row([
            Cell::new(format!("{} - {}", c.a, c.b)),
            number(c.difference),
            right(&between(c.interval)),
            right(&or_dash(c.p_holm, short_p)),
            Cell::new(c.verdict_in_words()),
        ]);
    }
    table
}

/// An interval in words.
pub fn between(interval: Option<[f64; 2]>) -> String {
    or_dash(interval, |[low, high]| format!("{} to {}", short(low), short(high)))
}

/// A value as text; a dash if there is none.
pub fn or_dash<T>(value: Option<T>, text: impl FnOnce(T) -> String) -> String {
    value.map_or("-".to_owned(), text)
}

/// A short number as a cell; a dash if there is none.
pub fn number(value: Option<f64>) -> Cell {
    right(&or_dash(value, short))
}

/// A mean as a cell; a dash if there is none.
pub fn mean(value: Option<f64>) -> Cell {
    right(&or_dash(value, |value| digits(value, 4)))
}

/// A row for each comparison, with all that is known of it.
pub fn comparison_table(comparisons: &[&Comparison]) -> Table {
    let is_judged = comparisons.iter().any(|comparison| comparison.judged.is_some());
    let header =
        "metric,A - B,n,mean A,mean B,difference,95 % interval,shift,p,p Holm,effect,detectable,verdict";
    let of_margin = ["pairs for margin"].into_iter().filter(|_| is_judged);
    let mut table = headed(header.split(',').chain(of_margin).collect::<Vec<_>>());
    for c in comparisons {
        let p = |p: Option<f64>| right(&or_dash(p, short_p));
        let pairs = c.judged.and_then(|judged| judged.pairs_for_margin);
        let of_margin = [right(&or_dash(pairs, |pairs| pairs.to_string()))];
        let cells = [
            Cell::new(&c.metric),
            Cell::new(format!("{} - {}", c.a, c.b)),
            right(&c.n.to_string()),
            mean(c.mean_a),
            mean(c.mean_b),
            number(c.difference),
            right(&between(c.interval)),
            number(c.shift),
            p(c.p),
            p(c.p_holm),
            right(&or_dash(c.effect, |effect| format!("{effect:.2}"))),
            number(c.detectable),
            Cell::new(c.verdict_in_words()),
        ];
        table.add_row(cells.into_iter().chain(of_margin.into_iter().filter(|_| is_judged)));
    }
    table
}

/// A row for each round and task: what was carried and why the group went home; where there is room, also
/// when it began, what it cost, and who turned back.
pub fn rounds_table(record: &TrialRecord, words: &Words, is_wide: bool) -> Table {
    let cells = |round: &RoundRecord| {
        let members: Vec<String> = round.members.iter().map(|member| member.id.to_string()).collect();
        [
            ("round", true, right(&round.round.to_string())),
            ("task", true, Cell::new(&record.tasks[round.task.index()].task)),
            ("from s", false, right(&format!("{:.1}", round.start_s))),
            ("to s", true, right(&or_dash(round.end_s, |end| format!("{end:.1}")))),
            ("members", true, Cell::new(members.join(" "))),
            ("secured", false, right(&round.secured.to_string())),
            ("rescued", true, right(&round.rescued.to_string())),
            ("energy", true, right(&format!("{:.1}", round.energy))),
            ("HP", false, right(&format!("{:.2}", round.hp))),
            ("turned back", false, right(&round.turned_back.to_string())),
            ("went home: why", true, Cell::new(round.return_cause.map_or("-", ReturnCause::name))),
        ]
        .map(|(name, is_narrow, cell)| (is_wide || is_narrow).then(|| (words.text(name), cell)))
    };
    let mut table = Table::new();
    for round in &record.rounds {
        let (names, row): (Vec<String>, Vec<Cell>) = cells(round).into_iter().flatten().unzip();
        if table.header().is_none() {
            table = headed(names);
        }
        table.add_row(row);
    }
    table
}

/// A table in the style of the project, with this header.
pub fn headed(header: impl Into<Row>) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED).set_header(header);
    table
}

/// Width of the terminal in columns, if there is one.
static COLUMNS: OnceLock<u16> = OnceLock::new();

/// Shows tables that are wider than a terminal with this many columns in parts. Without this call, tables
/// keep their full width.
pub fn fold_at(columns: u16) {
    let _ = COLUMNS.set(columns); // the terminal is the same
}

/// Columns of the terminal; `None` for none.
fn columns() -> Option<usize> {
    COLUMNS.get().map(|columns| usize::from(*columns))
}

/// Tables with many columns are for terminals of at least so many.
const WIDE: u16 = 120;

/// Whether a table may have many columns: in a wide terminal, and where programs or pages read it.
pub fn is_wide() -> bool {
    shown_as() != Format::Table || COLUMNS.get().is_some_and(|columns| *columns >= WIDE)
}

/// A cell aligned on the right.
pub fn right(text: &str) -> Cell {
    Cell::new(text).set_alignment(CellAlignment::Right)
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
