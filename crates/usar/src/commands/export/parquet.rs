//! `usar export parquet`: the tables of a trial as Parquet.

use std::io::Write;

use clap::Args;
use experiments::Failure;
use rne_core::Registry;

use super::trial::{Form, TablesArguments};

/// Write the tables of a trial as Parquet
#[derive(Debug, Args)]
#[command(after_help = "\
The tables are robots, groups, events and decisions: a row for each thing at each time, one header, units in the names.

Examples:
  usar export parquet paper.usrec --every 1 --out tables                one row a second for each robot
  usar export parquet results/paper --policy DIS --seed 3 --out dis")]
pub(crate) struct Arguments {
    #[command(flatten)]
    tables: TablesArguments,
}

impl Arguments {
    pub(crate) fn execute(&self, registry: &Registry, out: &mut dyn Write) -> Result<(), Failure> {
        self.tables.write(Form::Parquet, registry, out)
    }
}
