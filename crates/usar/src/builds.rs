//! What this build can write: some kinds of files need features, without which the first result is there
//! sooner.

use experiments::{Failure, refuse};

/// The features, and whether this build has them.
pub(crate) const FEATURES: [(&str, bool); 2] =
    [("pictures", cfg!(feature = "pictures")), ("exports", cfg!(feature = "exports"))];

/// The features that this build has, in words.
pub(crate) fn features() -> String {
    let there: Vec<&str> = FEATURES.iter().filter(|(_, is_there)| *is_there).map(|(name, _)| *name).collect();
    if there.is_empty() { "none".to_owned() } else { there.join(", ") }
}

/// Refuses a kind of file, by its ending, that this build does not write.
pub(crate) fn check_kind(flag: &str, ending: &str) -> Result<(), Failure> {
    let [(_, pictures), (_, exports)] = FEATURES;
    let (is_there, instead) = match ending {
        "png" | "pdf" | "gif" => (pictures, "SVG it does"),
        "mcap" | "parquet" => (exports, "CSV it does"),
        _ => (true, ""),
    };
    if !is_there {
        let kind = if ending == "parquet" { "Parquet".to_owned() } else { ending.to_uppercase() };
        refuse!(
            "{flag}: this build writes no {kind} ({instead}): cargo install --locked --path crates/usar \
             --features full"
        );
    }
    Ok(())
}
