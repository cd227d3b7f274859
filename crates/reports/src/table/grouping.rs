//! Tables of how policies group.

use experiments::rounds::{GroupLevels, KEYS, Share, SortingAgreement};
use tables::{Entry, Format, Table, right, right_or_dash, shown_as, valued};

/// How often each policy's split equals sorting.
pub fn likeness_table(policies: &[(String, [SortingAgreement; 3])]) -> Table {
    let first = policies.iter().map(|(_, agreements)| &agreements[0]).find(|likeness| likeness.rounds() > 0);
    let roles: Vec<String> = first
        .iter()
        .flat_map(|first| first.splittable_roles())
        .map(|role| format!("{}s", role.role))
        .collect();
    let before = ["policy", "rounds", "sorted by", "split"].map(str::to_owned);
    let header = before.into_iter().chain(roles.clone()).chain(["higher".to_owned()]);
    let mut table = Table::new(header);
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let beside = |share: &Share| match (share.share(), share.chance()) {
        (Some(share), Some(chance)) => {
            valued([share, chance], format!("{} ({})", percent(share), percent(chance)))
        }
        _ => right("-"),
    };
    for (label, agreements) in policies {
        for (i, (key, likeness)) in KEYS.iter().zip(agreements).enumerate() {
            let first = |text: &str| if i == 0 || is_repeated() { text.to_owned() } else { String::new() };
            let mut row = vec![
                first(label).into(),
                right(first(&likeness.rounds().to_string())),
                Entry::from(key.name),
                beside(&likeness.split),
            ];
            row.extend(roles.iter().map(|name| {
                let role = likeness.roles.iter().find(|role| format!("{}s", role.role) == *name);
                role.map_or_else(|| right("-"), |role| beside(&role.share))
            }));
            row.push(right_or_dash(likeness.harder_is_higher.share(), percent));
            table.add(row);
        }
    }
    table
}

/// Mean levels of these tasks' groups, round by round. The difference is between the first and the last
/// task.
pub fn levels_table(levels: &[GroupLevels], tasks: &[String]) -> Table {
    let mut header = ["policy", "round", "n"].map(str::to_owned).to_vec();
    for level in ["energy", "HP"] {
        header.extend(tasks.iter().map(|task| format!("{level} {task}")));
        header.push(format!("{level} difference"));
    }
    let mut table = Table::new(header);
    let shown = |level: f64| valued(level, format!("{level:.1}"));
    let mut last = "";
    for row in levels {
        let label = if row.policy == last && !is_repeated() { "" } else { &row.policy };
        last = &row.policy;
        let mut cells = vec![Entry::from(label), right(row.round), right(row.count)];
        for level in [0, 1] {
            cells.extend(row.groups.iter().map(|group| shown(group[level])));
            let ends = row.groups.first().zip(row.groups.last());
            let difference = ends.map(|(a, b)| a[level] - b[level]);
            cells.push(right_or_dash(difference, |difference| format!("{difference:+.1}")));
        }
        table.add(cells);
    }
    table
}

/// Whether a row repeats the values that it shares with the row above: in all formats except the
/// terminal's.
fn is_repeated() -> bool {
    shown_as() != Format::Table
}
