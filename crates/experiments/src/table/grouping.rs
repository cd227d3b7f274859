//! Tables of how policies group.

use comfy_table::{Cell, Table};

use super::{headed, right};
use crate::rounds::{GroupLevels, KEYS, Likeness, Share};

/// How often each policy's split is that of sorting.
pub(crate) fn likeness_table(policies: &[(String, [Likeness; 3])]) -> Table {
    let mut table = headed(["policy", "rounds", "sorted by", "split", "carriers", "suppliers", "higher"]);
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
    let mut table = headed([
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
