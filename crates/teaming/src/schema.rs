//! The version of the JSON form of questions and decisions, and its limits.

/// Version of the JSON form of questions and decisions.
pub const SCHEMA_VERSION: u32 = 3;

/// What is different since an older version, as the end of a sentence.
#[must_use]
pub fn since(found: &str) -> &'static str {
    match found {
        "2" => {
            "; since version 3, levels stand in lists with a table of their names, and no question has the \
             truth"
        }
        _ => "",
    }
}

/// Most tasks that a question may have.
pub const MAX_TASKS: usize = 64;
