//! One file per task.

pub mod coverage;
pub mod golden;
pub mod man;
pub mod pages;
pub mod quiet;
pub mod reference;
pub mod results;
pub mod scale;
pub mod scenarios;
pub mod weight;
pub mod work;
pub mod worlds;

use std::path::PathBuf;

/// The whole number at this place of the arguments.
fn number(arguments: &[String], at: usize, usual: u64) -> u64 {
    arguments.get(at).map_or(usual, |text| text.parse().expect("a whole number"))
}

/// The program `usar` that was built into the same folder as this one.
fn usar() -> PathBuf {
    std::env::current_exe().expect("this program has a path").with_file_name("usar")
}
