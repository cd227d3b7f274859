//! The laboratory as a library: experiments as files, paired trials on threads, folders of results that
//! survive interruptions, and statistics.
//!
//! It draws no figures, has no command line, and knows no particular paper. The crates above it do that.
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use experiments::experiment::{Experiment, Overrides};
//! use experiments::run::Sessions;
//!
//! let scenario = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/minimal/head_on.ron");
//! let experiment = Experiment::load(scenario.as_ref(), &Overrides::default(), &policies::standard())?;
//! let first = experiment.key((0, 0, 1)); // case, policy, trial
//! let (mut sessions, halt) = (Sessions::default(), AtomicBool::new(false));
//! let trial = experiment.run(&first, &mut sessions, &halt).expect("it runs to its end");
//! assert_eq!(trial.record.counts.errands_done, 2);
//! # Ok::<(), experiments::Failure>(())
//! ```

pub mod comparison;
pub mod deceit;
pub mod expect;
pub mod experiment;
pub mod explore;
pub mod input_table;
pub mod job;
pub mod limits;
pub mod metric;
pub mod oracle;
mod panics;
pub mod provenance;
pub mod regret;
pub mod rounds;
pub mod run;
pub mod sweep;
pub mod why;

pub use panics::{note_panic, panic_message};
pub use store::{Failure, files, refuse};
