//! `usar self`: the program itself.

mod completions;
mod doctor;

use super::verbs;

pub(crate) use completions::{ASKED, completing};

verbs!(Verb { Doctor: doctor::Arguments, Completions: completions::Arguments });
