//! The paper of Yang and Parasuraman (IEEE SMC 2021, arXiv 2105.07443) as a study. It is also a pattern for
//! studies of other papers.
//!
//! [`scenarios`] defines what is run. [`claims`] has the paper's claims and the verdicts on them.
//! [`readings`] shows what the paper's ambiguous places change. [`calibration`] fits a scenario to the
//! authors' recorded trials. [`predictions`] gives the results of each policy in each world. [`table`] and
//! [`page`] present all of it.

pub mod blindness;
pub mod calibration;
pub mod claims;
pub mod page;
pub mod predictions;
pub mod readings;
pub mod scenarios;
pub mod table;

/// Hash of the sources of this study.
pub const STUDY: &str = env!("STUDY");
