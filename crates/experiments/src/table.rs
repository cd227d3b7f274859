//! Tables for people.

use comfy_table::presets::UTF8_FULL_CONDENSED;
use comfy_table::{Cell, CellAlignment, Table};
use usar_sim::event::ReturnCause;
use usar_sim::record::TrialRecord;

use crate::calibration::Fit;
use crate::claims::{CLAIMS, Example, PartFinding, Shares, least_difference};
use crate::commands::explain::GroupLevels;
use crate::commands::readings::{Difference, ReadingRow, RivalRow, SHOWN};
use crate::commands::reproduce::{Judged, PAPERS_TRIALS};
use crate::comparison::{Comparison, digits, short, short_p};
use crate::metric::METRICS;
use crate::rounds::{KEYS, Likeness, Share};
use crate::stats::Moments;
use crate::sweep::folder::{Folder, Measured};

/// Metrics down, policies across: mean ± sample standard deviation of one case.
pub(crate) fn policy_table(folder: &Folder, case: usize) -> Table {
    let policies = &folder.experiment().policies;
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    let header = std::iter::once(Cell::new("policy"));
    table.set_header(header.chain(policies.iter().map(|policy| right(&policy.label))));
    let mut last = "";
    for (i, metric) in METRICS.iter().enumerate().filter(|(_, metric)| metric.is_papers) {
        let cells = (0..policies.len()).map(|policy| {
            let values = values(folder, case, policy, i);
            right(&moments(&Moments::of(&values), folder.experiment().trials as usize))
        });
        table.add_row(std::iter::once(Cell::new(indented(metric.title, last))).chain(cells));
        last = metric.title;
    }
    table
}

/// The values of a metric, as far as trials ran to their end and it is defined.
pub(crate) fn values(folder: &Folder, case: usize, policy: usize, metric: usize) -> Vec<f64> {
    let range = (case, policy, 0)..=(case, policy, u32::MAX);
    let measured = folder.results().range(range).filter_map(|(_, Measured { metrics, .. })| metrics.as_ref());
    measured.filter_map(|metrics| metrics[metric]).collect()
}

/// A title of which only the last word is shown where the words before are those of the title above.
fn indented(title: &str, above: &str) -> String {
    let common = |text: &str| text.rfind(' ').map(|end| text[..end].to_owned());
    match (common(title), common(above)) {
        (Some(here), Some(there)) if here == there => " ".repeat(here.len()) + &title[here.len()..],
        _ => title.to_owned(),
    }
}

/// A row for each comparison.
pub(crate) fn comparison_table(comparisons: &[&Comparison]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header([
        "metric",
        "A - B",
        "n",
        "mean A",
        "mean B",
        "difference",
        "95 % interval",
        "shift",
        "p",
        "p Holm",
        "effect",
        "pairs for 80 %",
    ]);
    let number = |value: Option<f64>| right(&value.map_or("-".to_owned(), short));
    let mean = |value: Option<f64>| right(&value.map_or("-".to_owned(), |value| digits(value, 4)));
    for c in comparisons {
        let interval =
            c.interval.map_or("-".to_owned(), |[low, high]| format!("{} to {}", short(low), short(high)));
        let p = |p: Option<f64>| right(&p.map_or("-".to_owned(), short_p));
        table.add_row([
            Cell::new(c.metric),
            Cell::new(format!("{} - {}", c.a, c.b)),
            right(&c.n.to_string()),
            mean(c.mean_a),
            mean(c.mean_b),
            number(c.difference),
            right(&interval),
            number(c.shift),
            p(c.p),
            p(c.p_holm),
            right(&c.effect.map_or("-".to_owned(), |effect| format!("{effect:.2}"))),
            right(&c.pairs_needed.map_or("-".to_owned(), |pairs| pairs.to_string())),
        ]);
    }
    table
}

/// What a scenario's trials say of each claim: a row for each of its comparisons.
pub(crate) fn claims_table(judged: &Judged, trials: u32) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    let few = format!("first {PAPERS_TRIALS} pairs");
    let all = format!("{trials} pairs");
    table.set_header(["claim", &few, &all, "difference", "95 % interval", "n", "first 10"]);
    let difference = |found: &PartFinding| right(&found.difference.map_or("-".to_owned(), short));
    for ((claim, few), all) in CLAIMS.iter().zip(&judged.of_few).zip(&judged.of_all) {
        table.add_row([
            Cell::new(claim.words),
            Cell::new(few.verdict.words()),
            Cell::new(all.verdict.words()),
        ]);
        for (part, (few, all)) in claim.parts.iter().zip(few.parts.iter().zip(&all.parts)) {
            table.add_row([
                Cell::new(format!("  {}", part.words())),
                Cell::new(""),
                Cell::new(""),
                difference(all),
                right(&interval(all.interval)),
                right(&all.differences.len().to_string()),
                right(&format!(
                    "{} ({})",
                    few.difference.map_or("-".to_owned(), short),
                    interval(few.interval)
                )),
            ]);
        }
    }
    table
}

fn interval(interval: Option<[f64; 2]>) -> String {
    interval.map_or("-".to_owned(), |[low, high]| format!("{} to {}", short(low), short(high)))
}

/// The paper's examples with exact values.
pub(crate) fn examples_table(examples: &[Example]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header(["example", "claim", "entropy of the one", "of the other", "verdict"]);
    for example in examples {
        table.add_row([
            Cell::new(example.name),
            Cell::new(example.words),
            right(&digits(example.trusting, 4)),
            right(&digits(example.doubting, 4)),
            Cell::new(example.verdict.words()),
        ]);
    }
    table
}

/// What experiments of other sizes would say of each claim, and find of each of its comparisons.
pub(crate) fn power_table(judged: &Judged) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header([
        "claim",
        "leans to",
        "pairs for 80 %",
        "of 10 pairs: holds",
        "does not",
        "undecided",
        "difference",
        "least found by 10",
    ]);
    let share = |share: f64| right(&format!("{:.0} %", 100.0 * share));
    for ((claim, power), finding) in CLAIMS.iter().zip(&judged.powers).zip(&judged.of_all) {
        let Some(power) = power else { continue };
        let Shares { holds, does_not_hold } = power.of_few;
        table.add_row([
            Cell::new(claim.words),
            Cell::new(power.leaning.words()),
            right(&power.pairs_needed.map_or("> 1000000".to_owned(), |pairs| pairs.to_string())),
            share(holds),
            share(does_not_hold),
            share((1.0 - holds - does_not_hold).max(0.0)),
        ]);
        for (part, found) in claim.parts.iter().zip(&finding.parts) {
            let values: Vec<f64> = found.differences.iter().map(|(_, difference)| *difference).collect();
            let least = Moments::of(&values).sd.and_then(|sd| least_difference(sd, PAPERS_TRIALS as usize));
            table.add_row([
                Cell::new(format!("  {}", part.words())),
                Cell::new(""),
                right(&found.pairs_needed.map_or("-".to_owned(), |pairs| pairs.to_string())),
                Cell::new(""),
                Cell::new(""),
                Cell::new(""),
                right(&found.difference.map_or("-".to_owned(), short)),
                right(&least.map_or("-".to_owned(), short)),
            ]);
        }
    }
    table
}

/// All verdicts side by side.
pub(crate) fn verdicts_table(judged: &[Judged], trials: u32) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    let header = judged.iter().flat_map(|scenario| {
        [PAPERS_TRIALS, trials].map(|trials| Cell::new(format!("{}, {trials} pairs", scenario.scenario)))
    });
    table.set_header(std::iter::once(Cell::new("claim")).chain(header));
    for (i, claim) in CLAIMS.iter().enumerate() {
        let verdicts = judged.iter().flat_map(|scenario| {
            [&scenario.of_few, &scenario.of_all].map(|findings| Cell::new(findings[i].verdict.words()))
        });
        table.add_row(std::iter::once(Cell::new(claim.words)).chain(verdicts));
    }
    table
}

/// How often each policy's split is that of sorting.
pub(crate) fn likeness_table(policies: &[(String, [Likeness; 3])]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header(["policy", "rounds", "sorted by", "split", "carriers", "suppliers", "higher"]);
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let beside = |share: &Share| match (share.share(), share.chance()) {
        (Some(share), Some(chance)) => right(&format!("{} ({})", percent(share), percent(chance))),
        _ => right("-"),
    };
    for (label, likenesses) in policies {
        for (i, (key, likeness)) in KEYS.iter().zip(likenesses).enumerate() {
            let first = |text: &str| if i == 0 { text.to_owned() } else { String::new() };
            table.add_row([
                Cell::new(first(label)),
                right(&first(&likeness.rounds().to_string())),
                Cell::new(key.name),
                beside(&likeness.split),
                beside(&likeness.carriers),
                beside(&likeness.suppliers),
                right(&likeness.hard_is_higher.share().map_or("-".to_owned(), percent)),
            ]);
        }
    }
    table
}

/// Mean levels of the groups, round by round.
pub(crate) fn levels_table(levels: &[GroupLevels]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header([
        "policy",
        "round",
        "n",
        "energy hard",
        "easy",
        "difference",
        "HP hard",
        "easy",
        "difference",
    ]);
    let level = |level: f64| right(&format!("{level:.1}"));
    let mut last = "";
    for row in levels {
        let label = if row.policy == last { "" } else { &row.policy };
        last = &row.policy;
        table.add_row([
            Cell::new(label),
            right(&row.round.to_string()),
            right(&row.count.to_string()),
            level(row.hard[0]),
            level(row.easy[0]),
            right(&format!("{:+.1}", row.hard[0] - row.easy[0])),
            level(row.hard[1]),
            level(row.easy[1]),
            right(&format!("{:+.1}", row.hard[1] - row.easy[1])),
        ]);
    }
    table
}

fn differences(differences: &[Option<Difference>]) -> impl Iterator<Item = Cell> + '_ {
    differences.iter().map(|difference| {
        let text = |d: &Difference| format!("{} ± {}", signed(d.mean), digits(d.half, 2));
        right(&difference.as_ref().map_or("-".to_owned(), text))
    })
}

fn signed(value: f64) -> String {
    if value > 0.0 { format!("+{}", short(value)) } else { short(value) }
}

/// The titles of the metrics that readings are compared in.
fn shown() -> impl Iterator<Item = Cell> {
    let title =
        |name: &str| METRICS.iter().find(|metric| metric.name == name).map_or("", |metric| metric.title);
    SHOWN.into_iter().map(move |name| Cell::new(title(name)))
}

/// Each reading by itself.
pub(crate) fn readings_table(rows: &[ReadingRow]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    let header = ["reading", "regrouped", "split otherwise", "trials"].map(Cell::new);
    table.set_header(header.into_iter().chain(shown()));
    let share = |share: f64| right(&format!("{:.1} %", 100.0 * share));
    for row in rows {
        let [grouped, split] = row.regrouped;
        let cells = [Cell::new(&row.reading), share(grouped), share(split), share(row.trials)];
        table.add_row(cells.into_iter().chain(differences(&row.differences)));
    }
    table
}

/// Each reading averaged over the others.
pub(crate) fn averaged_table(rows: &[(String, Vec<Option<Difference>>)]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header(std::iter::once(Cell::new("reading")).chain(shown()));
    for (reading, row) in rows {
        table.add_row(std::iter::once(Cell::new(reading)).chain(differences(row)));
    }
    table
}

/// All readings against other policies.
pub(crate) fn rivals_table(rows: &[RivalRow]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header(["metric", "against", "above", "below", "neither", "least", "greatest"]);
    for row in rows {
        let end = |(reading, difference): &(String, Difference)| {
            Cell::new(format!("{} ± {} ({reading})", signed(difference.mean), digits(difference.half, 2)))
        };
        let [least, most] = &row.ends;
        let counts = row.counts.map(|count| right(&count.to_string()));
        let cells = [Cell::new(row.metric), Cell::new(&row.rival)].into_iter().chain(counts);
        table.add_row(cells.chain([end(least), end(most)]));
    }
    table
}

/// A row for each quantity of a calibration.
pub(crate) fn fit_table(rows: &[Fit]) -> Table {
    let mut table = Table::new();
    table.load_style(UTF8_FULL_CONDENSED);
    table.set_header(["quantity", "data", "fitted", "fresh", "means apart by", "sd ratio"]);
    let spread = |mean: f64, sd: f64| right(&format!("{} ± {}", digits(mean, 4), digits(sd, 2)));
    for row in rows {
        table.add_row([
            Cell::new(row.quantity),
            spread(row.data_mean, row.data_sd),
            spread(row.fitted_mean, row.fitted_sd),
            spread(row.fresh_mean, row.fresh_sd),
            right(&format!("{:+.1} sd", row.off_by_sd)),
            right(&format!("{:.2}", row.sd_ratio)),
        ]);
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

/// `mean ± sd`; with the number of trials where not all that were asked for have it.
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
