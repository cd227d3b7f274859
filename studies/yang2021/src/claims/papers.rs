//! The claims of the paper.

use super::{Claim, Part, Side};

/// The columns of the authors' tables.
pub(crate) const AUTHORS_COLUMNS: &str = "method,trial,time_s,rescuees_total,rescuees_hard,rescuees_easy,\
    energy_hard,energy_easy,energy_total,hp_hard,hp_easy,hp_total,rounds";

const fn more(a: [&'static str; 2], b: [&'static str; 2]) -> Part {
    Part { a, b, claimed: Side::More }
}

const fn less(a: [&'static str; 2], b: [&'static str; 2]) -> Part {
    Part { a, b, claimed: Side::Less }
}

/// RNE has more than each other policy, in one metric.
const fn most(metric: &'static str) -> [Part; 3] {
    [
        more(["RNE", metric], ["DIS", metric]),
        more(["RNE", metric], ["ENG", metric]),
        more(["RNE", metric], ["HP_DIS", metric]),
    ]
}

/// RNE has less than each other policy, in one metric.
const fn least(metric: &'static str) -> [Part; 3] {
    [
        less(["RNE", metric], ["DIS", metric]),
        less(["RNE", metric], ["ENG", metric]),
        less(["RNE", metric], ["HP_DIS", metric]),
    ]
}

/// One metric is higher than another, under each policy.
const fn under_each_policy(a: &'static str, b: &'static str) -> [Part; 4] {
    [
        more(["RNE", a], ["RNE", b]),
        more(["DIS", a], ["DIS", b]),
        more(["ENG", a], ["ENG", b]),
        more(["HP_DIS", a], ["HP_DIS", b]),
    ]
}

const DIS_IN_EASY: &[Part] = &[
    more(["DIS", "rescuees.easy"], ["RNE", "rescuees.easy"]),
    more(["DIS", "rescuees.easy"], ["ENG", "rescuees.easy"]),
    more(["DIS", "rescuees.easy"], ["HP_DIS", "rescuees.easy"]),
];
const RNE_IN_EASY: &[Part] = &[less(["RNE", "rescuees.easy"], ["DIS", "rescuees.easy"])];

const RESULTS: &str = "results";
const TASKS: &str = "cooperation";

const fn claim(
    name: &'static str,
    section: &'static str,
    words: &'static str,
    parts: &'static [Part],
) -> Claim {
    Claim { name, words, section, parts }
}

/// The claims about the experiment, in the paper's order. The claims about numerical examples are in
/// [`super::examples`].
#[rustfmt::skip]
pub const CLAIMS: &[Claim] = &[
    claim("dearer energy", TASKS, "the hard task costs more energy per rescuee than the easy \
        one", &under_each_policy("energy_per_rescuee.hard", "energy_per_rescuee.easy")),
    claim("dearer HP", TASKS, "the hard task costs more HP per rescuee than the easy one",
        &under_each_policy("hp_per_rescuee.hard", "hp_per_rescuee.easy")),
    claim("most", RESULTS, "RNE rescues the most in total", &most("rescuees.total")),
    claim("most, hard", RESULTS, "RNE rescues the most from the hard task", &most("rescuees.hard")),
    claim("DIS in easy", RESULTS, "distance-based grouping rescues the most from the easy task", DIS_IN_EASY),
    claim("RNE in easy", RESULTS, "RNE rescues fewer from the easy task than distance-based \
        grouping", RNE_IN_EASY),
    claim("energy", RESULTS, "RNE spends the least energy per rescuee", &least("energy_per_rescuee.total")),
    claim("energy, hard", RESULTS, "RNE spends the least energy per rescuee of the hard task",
        &least("energy_per_rescuee.hard")),
    claim("HP", RESULTS, "RNE loses the least HP per rescuee", &least("hp_per_rescuee.total")),
    claim("HP, hard", RESULTS, "RNE loses the least HP per rescuee of the hard task",
        &least("hp_per_rescuee.hard")),
];
