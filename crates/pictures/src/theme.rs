//! The colours of the page of `usar view` in its light theme (`viewer/src/draw/theme.ts`). Groups have the
//! colours of Okabe and Ito.

pub(crate) const PAPER: &str = "#ffffff";
pub(crate) const GROUND: &str = "#fbfbf9";
pub(crate) const WALL: &str = "#4a4f57";
pub(crate) const INK: &str = "#1d2127";
pub(crate) const SOFT: &str = "#68707b";
pub(crate) const FAINT: &str = "#d5d8dc";
pub(crate) const DEBRIS: &str = "#8c8a84";
pub(crate) const MOVABLE: &str = "#c3b79c";
pub(crate) const RESCUEE: &str = "#3b414a";
pub(crate) const RADIATION: &str = "#d6a800";
pub(crate) const RADIATION_EDGE: &str = "#a98500";
pub(crate) const WAIT: &str = "#c2185b";
pub(crate) const UNGROUPED: &str = "#7b8290";
pub(crate) const ENERGY: &str = "#009e73";
pub(crate) const HP: &str = "#cc79a7";

const GROUPS: [&str; 7] = ["#0072b2", "#d98200", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#8a7d00"];

/// The colour of a task's group, or of a robot in scenarios without groups.
pub(crate) fn colour(number: usize) -> &'static str {
    GROUPS[number % GROUPS.len()]
}

/// The colour of a robot whose group has this task; `None` is a robot without a group.
pub(crate) fn group_colour(task: Option<u32>) -> &'static str {
    task.map_or(UNGROUPED, |task| colour(task as usize))
}
