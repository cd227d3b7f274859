//! The word that a mistyped one was meant to be.

/// Of these words, the one that is nearest to a mistyped word, if one is near enough to be meant: at most a third of its characters,
/// or two, added, left out, changed, or swapped with the next. Of two that are as near, the first.
#[must_use]
pub fn nearest<'w>(word: &str, words: impl IntoIterator<Item = &'w str>) -> Option<&'w str> {
    let typed: Vec<char> = word.chars().take(MOST_CHARS).collect();
    let most = if typed.len() < 4 { 1 } else { (typed.len() / 3).max(2) };
    let near = words.into_iter().filter(|known| *known != word).map(|known| (edits(&typed, known), known));
    near.filter(|(edits, _)| *edits <= most).min_by_key(|(edits, _)| *edits).map(|(_, known)| known)
}

/// Longer words are compared by their beginnings.
const MOST_CHARS: usize = 64;

/// Number of edits that make one word of the other (optimal string alignment; Boytsov 2011); a change of case counts as none but the last resort.
fn edits(typed: &[char], known: &str) -> usize {
    let lower = |c: char| c.to_ascii_lowercase();
    let (a, b): (Vec<char>, Vec<char>) =
        (typed.iter().map(|c| lower(*c)).collect(), known.chars().take(MOST_CHARS).map(lower).collect());
    let mut rows = vec![(0..=b.len()).collect::<Vec<usize>>()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let change = usize::from(a[i - 1] != b[j - 1]);
            let mut least = (rows[i - 1][j] + 1).min(row[j - 1] + 1).min(rows[i - 1][j - 1] + change);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_word_that_was_meant_is_found() {
        let words = ["rest_s", "reach_m", "rest_reserve", "Disc", "Box"];
        for (typed, meant) in [
            ("rest", Some("rest_s")),
            ("rest_sec", Some("rest_s")),
            ("raech_m", Some("reach_m")),
            ("reserve", None),
            ("disc", Some("Disc")),
            ("Disk", Some("Disc")),
            ("box", Some("Box")),
            ("", None),
        ] {
            assert_eq!(nearest(typed, words), meant, "{typed}");
        }
        assert_eq!(nearest(&"x".repeat(1_000_000), words), None);
    }
}
