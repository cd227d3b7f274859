//! The version of the JSON form of questions and decisions, and its limits.

/// Version of the JSON form of questions and decisions.
pub const SCHEMA_VERSION: u32 = 2;

/// Most tasks that a question may have.
pub const MAX_TASKS: usize = 64;
