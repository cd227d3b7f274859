//! `usar self`: the program itself.

mod completions;
mod doctor;
mod man;

use super::verbs;

verbs!(Verb { Doctor: doctor::Arguments, Completions: completions::Arguments, Man: man::Arguments });
