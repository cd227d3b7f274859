//! How a question differs from the folder's own: the one that its sweep file asks, or, where it asks none,
//! the one that a command without options asks.

use store::Failure;

use super::{Asked, Comparison, Wishes, compare, p_in_words};
use crate::sweep::folder::Folder;

/// How these comparisons differ from those of the folder's own question, in a sentence or two; `None` if they
/// are the same. p values are corrected over all that is asked together, so that a narrower question may
/// have another verdict.
///
/// # Errors
/// The sweep file's question is invalid.
pub fn own_question(
    folder: &Folder,
    asked: &Asked,
    comparisons: &[Comparison],
) -> Result<Option<String>, Failure> {
    if comparisons.is_empty() {
        return Ok(None);
    }
    let own = Asked::of(folder.experiment(), &Wishes::default())?;
    if own == *asked {
        return Ok(None); // without asking twice
    }
    let owned = compare(folder, &own.metrics, own.choice())?;
    let is_same =
        |a: &Comparison, b: &Comparison| (a.case, &a.metric, &a.a, &a.b) == (b.case, &b.metric, &b.a, &b.b);
    let both: Vec<(&Comparison, &Comparison)> = comparisons
        .iter()
        .filter_map(|here| Some((here, owned.iter().find(|there| is_same(here, there))?)))
        .collect();
    let is_whole = both.len() == comparisons.len() && comparisons.len() == owned.len();
    if is_whole && own.margins == asked.margins {
        return Ok(None);
    }
    let named = if own.is_declared { "that its file asks" } else { "that is asked by default" };
    let lead = format!("The folder's own question, {named}, has {} comparisons.", owned.len());
    let others = both.iter().filter(|(here, there)| here.verdict != there.verdict);
    let others: Vec<String> = others.map(|(here, there)| otherwise(here, there)).collect();
    Ok(Some(match (both.is_empty(), others.is_empty()) {
        (true, _) => format!("{lead} None of these is among them."),
        (_, true) => format!("{lead} In it, the verdicts on {} of these are the same.", both.len()),
        _ => format!("{lead} In it, {}.", others.join("; ")),
    }))
}

/// A verdict that is another in the folder's own question.
fn otherwise(here: &Comparison, there: &Comparison) -> String {
    let p = there.p_holm.map_or(String::new(), |p| format!(" ({})", p_in_words(p)));
    let Comparison { metric, a, b, verdict, .. } = here;
    format!("{metric}, {a} - {b}, is {}{p}, not {}", there.verdict.name(), verdict.name())
}
