//! The answer of a family of comparisons, before any table: every difference that is shown, in a few words.

use super::words::{pairs_in_words, short};
use super::{Comparison, Standing, Verdict};

/// An answer has at most so many words.
const WORDS: usize = 25;

/// The answer of the comparisons of one case, in at most 25 words: every difference that is shown, every
/// equivalence, and how many comparisons are undecided. Where this takes too many words, sizes are left out,
/// then names. `None` without comparisons.
///
/// ```
/// use statistics::comparison::{Comparison, Verdict, answer};
///
/// let (metric, a, b) = ("rescuees.hard".to_owned(), "RNE".to_owned(), "DIS".to_owned());
/// let one = Comparison {
///     metric, a, b, difference: Some(13.4), p: Some(0.001), verdict: Verdict::Better,
///     ..Comparison::default()
/// };
/// assert_eq!(answer(&[&one]).unwrap(), "rescuees.hard: RNE 13.4 above DIS.");
/// ```
pub fn answer(comparisons: &[&Comparison]) -> Option<String> {
    if comparisons.iter().all(|one| one.p.is_none() && one.verdict == Verdict::Undecided) {
        let n = comparisons.iter().map(|one| one.n).max()?;
        return Some(match n {
            0 => "No pair of trials has values yet.".to_owned(),
            n => format!("No verdict: {}.", Standing::TooFew { distinct: n }),
        });
    }
    let candidates = [sized as fn(&Comparison) -> String, named].map(|of| each_named(comparisons, of));
    let fits = |text: &String| text.split_whitespace().count() <= WORDS;
    Some(candidates.into_iter().find(fits).unwrap_or_else(|| counted(comparisons)))
}

/// The names of all that is shown, metric by metric.
fn each_named(comparisons: &[&Comparison], of: fn(&Comparison) -> String) -> String {
    let (open, settled): (Vec<&Comparison>, Vec<&Comparison>) =
        comparisons.iter().copied().partition(|one| one.verdict == Verdict::Undecided);
    let mut sentences = Vec::new();
    for group in settled.chunk_by(|a, b| a.metric == b.metric) {
        let names: Vec<String> = group.iter().map(|one| of(one)).collect();
        sentences.push(format!("{}: {}.", group[0].metric, names.join(", ")));
    }
    if sentences.is_empty() {
        sentences.push("No difference is shown.".to_owned());
    }
    if !open.is_empty() {
        sentences.push(format!("Undecided: {} of {}.", open.len(), comparisons.len()));
    }
    sentences.join(" ")
}

fn sized(one: &Comparison) -> String {
    match (one.verdict, one.judged) {
        (Verdict::Same, _) => return format!("{} the same as {}", one.a, one.b),
        (Verdict::Equivalent, Some(judged)) => {
            return format!("{} within {} of {}", one.a, short(judged.margin), one.b);
        }
        _ => {}
    }
    let difference = one.difference.unwrap_or(0.0);
    let side = if difference > 0.0 { "above" } else { "below" };
    format!("{} {} {side} {}", one.a, short(difference.abs()), one.b)
}

fn named(one: &Comparison) -> String {
    let sign = match one.verdict {
        Verdict::Equivalent | Verdict::Same => "=",
        _ if one.difference.is_some_and(|difference| difference > 0.0) => ">",
        _ => "<",
    };
    format!("{}{sign}{}", one.a, one.b)
}

/// How many of each verdict, for families that are too large to be named.
fn counted(comparisons: &[&Comparison]) -> String {
    let count =
        |is: fn(Verdict) -> bool| comparisons.iter().filter(|one| is(one.verdict)).count().to_string();
    format!(
        "{} of {} differences are shown, {} are equivalences, {} are the same, {} are undecided.",
        count(Verdict::is_shown),
        comparisons.len(),
        count(|verdict| verdict == Verdict::Equivalent),
        count(|verdict| verdict == Verdict::Same),
        count(|verdict| verdict == Verdict::Undecided),
    )
}

/// The answer of comparisons in many cases: for each metric and pair, in how many cases what is shown. `None`
/// without comparisons.
pub fn answer_of_cases(comparisons: &[&Comparison]) -> Option<String> {
    let (first, cases) = (comparisons.first()?, comparisons.iter().map(|one| one.case).max()?);
    let same = |one: &&Comparison, like: &Comparison| {
        (&one.metric, &one.a, &one.b) == (&like.metric, &like.a, &like.b)
    };
    let families = comparisons.iter().filter(|one| one.case == first.case);
    let mut shown = Vec::new();
    for family in families {
        let of = || comparisons.iter().copied().filter(|one| same(one, family));
        let side = |above: bool| {
            let is_there =
                |one: &&Comparison| one.verdict.is_shown() && (one.difference > Some(0.0)) == above;
            match of().filter(is_there).count() {
                0 => None,
                count => Some(format!("{} in {count}", if above { "above" } else { "below" })),
            }
        };
        let sides: Vec<String> = [true, false].into_iter().filter_map(side).collect();
        if !sides.is_empty() {
            shown.push(format!("{}: {} {} {}", family.metric, family.a, sides.join(", "), family.b));
        }
    }
    if shown.is_empty() {
        return Some(format!("In none of the {cases} cases is a difference shown."));
    }
    Some(format!("Shown, of {cases} cases: {}.", shown.join("; ")))
}

/// What would settle the comparisons that are undecided; `None` if none is.
pub fn what_would_settle(comparisons: &[Comparison]) -> Option<String> {
    let open: Vec<&Comparison> =
        comparisons.iter().filter(|one| one.verdict == Verdict::Undecided && one.p.is_some()).collect();
    let n = open.iter().map(|one| one.n).max()?;
    let needed = open.iter().filter_map(|one| one.judged?.pairs_for_margin).max();
    Some(match needed {
        None => {
            "Undecided does not mean equal: --margin METRIC=VALUE names the largest difference that does \
                 not matter, and tells how many pairs have the power to settle it."
                .to_owned()
        }
        Some(needed) if needed > n as u64 => format!(
            "Undecided does not mean equal: with about {} pairs (here {n}), each single test has 80 % power \
             to detect a difference as large as its margin, before correction.",
            pairs_in_words(needed)
        ),
        Some(_) => format!(
            "Undecided does not mean equal: with {n} pairs, each single test has 80 % power to detect a \
             difference as large as its margin, before correction."
        ),
    })
}

/// What *the same* means, where a comparison is.
pub fn what_is_the_same(comparisons: &[Comparison]) -> Option<String> {
    let is_same = comparisons.iter().any(|one| one.verdict == Verdict::Same);
    is_same.then(|| format!("The same means {}: nothing is tested.", Standing::Same))
}
