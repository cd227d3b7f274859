//! The paper of Yang and Parasuraman (IEEE SMC 2021, arXiv 2105.07443) as a study, and a pattern for the
//! study of another paper.
//!
//! [`scenarios`] is what is run; [`claims`] what the paper says and what trials say of it; [`readings`] what
//! its ambiguous places decide; [`calibration`] fits a scenario to the authors' recorded trials; [`predictions`]
//! says what each policy does in each world; [`table`] and [`page`] show all of it to people.

pub mod calibration;
pub mod claims;
pub mod page;
pub mod predictions;
pub mod readings;
pub mod scenarios;
pub mod table;
