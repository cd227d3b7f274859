//! `usar self`: the program itself.

mod completions;
mod doctor;
mod man;

use super::verbs;

pub(crate) use completions::{ASKED, completing};

verbs!(Verb { Doctor: doctor::Arguments, Completions: completions::Arguments, Man: man::Arguments });
