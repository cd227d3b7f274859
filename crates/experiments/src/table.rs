//! Tables for people.

use comfy_table::presets::UTF8_FULL_CONDENSED;
use comfy_table::{Cell, CellAlignment, Table};
use usar_sim::event::ReturnCause;
use usar_sim::record::TrialRecord;

use crate::stats::{METRICS, Moments, Summary};

/// A cost per rescuee; `None` without any rescuee.
#[must_use]
pub fn ratio(cost: f64, rescuees: u32) -> Option<f64> {
    (rescuees > 0).then(|| cost / f64::from(rescuees))
}

/// Metrics down, policies across: mean ± sample standard deviation.
pub(crate) fn policy_table(policies: &[String], summaries: &[Summary]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    let header = std::iter::once(Cell::new("policy"));
    table.set_header(header.chain(policies.iter().map(|name| right(name))));
    for (i, (name, _)) in METRICS.iter().enumerate() {
        let cells = summaries.iter().map(|summary| right(&moments(&summary.metrics[i], summary.trials)));
        table.add_row(std::iter::once(Cell::new(name)).chain(cells));
    }
    table
}

/// One line per round and task.
pub(crate) fn rounds_table(record: &TrialRecord) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header([
        "round",
        "task",
        "from s",
        "to s",
        "members",
        "secured",
        "rescued",
        "energy",
        "HP",
        "turned back",
        "went home: why",
    ]);
    for round in &record.rounds {
        let members: Vec<String> = round.members.iter().map(u32::to_string).collect();
        table.add_row([
            right(&round.round.to_string()),
            Cell::new(round.task.name()),
            right(&format!("{:.1}", round.start_s)),
            right(&round.end_s.map_or("-".to_owned(), |end| format!("{end:.1}"))),
            Cell::new(members.join(" ")),
            right(&round.secured.to_string()),
            right(&round.rescued.to_string()),
            right(&format!("{:.1}", round.energy)),
            right(&format!("{:.2}", round.hp)),
            right(&round.turned_back.to_string()),
            Cell::new(round.return_cause.map_or("-", ReturnCause::name)),
        ]);
    }
    table
}

fn right(text: &str) -> Cell {
    Cell::new(text).set_alignment(CellAlignment::Right)
}

/// `mean ± sd`; with the number of trials where the quantity is not defined in all of them.
fn moments(moments: &Moments, trials: usize) -> String {
    let Some(mean) = moments.mean else { return "-".to_owned() };
    let decimals = decimals(mean);
    let sd = moments.sd.map_or(String::new(), |sd| format!(" ± {sd:.decimals$}"));
    let partly = if moments.count < trials { format!(" (n = {})", moments.count) } else { String::new() };
    format!("{mean:.decimals$}{sd}{partly}")
}

/// Decimals that show a mean with about three significant digits, and at least one.
fn decimals(mean: f64) -> usize {
    (1..8)
        .find(|decimals| mean.abs() * 10_f64.powi(*decimals) >= 100.0)
        .map_or(2, |decimals| decimals as usize)
}
